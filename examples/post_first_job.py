# SPDX-License-Identifier: LGPL-2.1-or-later
"""Post the first CAM job of the active document into the folder of the document, with the arguments of the job."""

from pathlib import Path

import FreeCAD

import pkm_post as pkm

document = FreeCAD.ActiveDocument
try:
    (posted,) = pkm.post(pkm.jobs(document)[0], out=Path(document.FileName).parent)
    for file in posted.files:
        FreeCAD.Console.PrintMessage(f"{file}\n")
except pkm.Refused as refused:
    FreeCAD.Console.PrintError(f"{refused}\n")
