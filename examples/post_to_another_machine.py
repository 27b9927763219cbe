# SPDX-License-Identifier: LGPL-2.1-or-later
"""Post the first CAM job of the active document for a machine that a machine file describes, with looser tolerances.

The arguments of the job apply, except for those given here. The machine is the example machine, limited to 20 mm/s.
"""

import re
from pathlib import Path

import FreeCAD

import pkm_post as pkm

document = FreeCAD.ActiveDocument
folder = Path(document.FileName).parent / "another_machine"
folder.mkdir(exist_ok=True)
machine = folder / "careful.toml"
text = pkm.find_machine("example_6tps").read_text(encoding="utf-8")
machine.write_text(re.sub(r"(?m)^(rapid|feed)_speed = .*$", r"\1_speed = 20.0", text), encoding="utf-8")

arguments = "--tip-tolerance 0.002 --axis-tolerance 0.002 --also csv"
try:
    for posted in pkm.post(pkm.jobs(document)[0], machine, folder, arguments=arguments):
        seconds = posted.report["motion"]["duration_s"]
        for diagnostic in posted.diagnostics:
            FreeCAD.Console.PrintWarning(f"{diagnostic}\n")
        FreeCAD.Console.PrintMessage(f"{posted.program}: {seconds:.1f} s of motion\n")
except pkm.Refused as refused:
    FreeCAD.Console.PrintError(f"{refused}\n")
