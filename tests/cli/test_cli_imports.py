# SPDX-License-Identifier: LGPL-2.1-or-later
"""A short program is posted soon: what takes time to import, and is not needed for it, is not imported."""

import gc
import os
import subprocess
import sys
from pathlib import Path

import pytest
from interpreter import PYTHON
from machines import text_without_jerk

ADDON = Path(__file__).parents[2]
PROGRAM = """\
T1 M6 G43 H1
G21 G90 G94 S8000 M3
G0 X0 Y0 Z30
G1 X10 Y0 Z20 F600
G1 X20 Y5 Z20
G1 X30 Y5 Z20
G1 X30 Y15 Z20
G0 Z30
M5
M30
"""
CODE = """
import sys
import numpy
before = set(sys.modules)
from pkm_post.cli import main
code = main(sys.argv[1:])
print("IMPORTED", *sorted(set(sys.modules) - before))
sys.exit(code)
"""
NOT_NEEDED = (
    "FreeCAD",
    "asyncio",
    "concurrent.futures",
    "csv",
    "lark",
    "logging",
    "matplotlib",
    "numpy.fft",
    "numpy.ma",
    "numpy.polynomial",
    "numpy.random",
    "paramiko",
    "serial",
    "socket",
    "subprocess",
    "xml",
    "zipfile",
)
"""Packages and modules of others."""
ROOMS_NOT_NEEDED = (
    "api",
    "cli.batch",
    "cli.pmac",
    "cli.programs",
    "cli.reach",
    "control",
    "freecad_app",
    "machine.calibration",
    "machine.reach.best_position",
    "machine.reach.reach_map",
    "planning.window.planner",
    "posting.place_search",
    "posting.stiffness",
    "reading.cldata",
    "reading.gcode.execute",
    "reading.siemens.reader",
    "removal",
    "report.plots",
    "system.document",
    "system.packages",
    "toolpath.from_line",
    "toolpath.surface",
    "writing.controllers.power_pmac",
    "writing.gcode",
    "writing.kinematics",
)
"""Modules and packages of our own."""


@pytest.fixture(scope="module", params=["example_6tps", "jumping.toml"])
def machine(request):
    """The example as it is shipped, and without limits of jerk."""
    return request.param


@pytest.fixture(scope="module")
def imported(machine, tmp_path_factory):
    """What a process imported that posted a short program."""
    folder = tmp_path_factory.mktemp("posted")
    (folder / "jumping.toml").write_text(text_without_jerk(), encoding="utf-8")
    (folder / "part.ngc").write_text(PROGRAM, encoding="ascii")
    words = f"post part.ngc --machine={machine} --work-offset=0,0,250 --tool-length 1=60"
    command = [PYTHON, "-c", CODE, *words.split()]
    environment = os.environ | {"PYTHONPATH": str(ADDON)}
    ran = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, timeout=300, check=False)
    assert ran.returncode == 0, ran.stderr
    assert (folder / "part.pmc").is_file()
    (found,) = (line.split()[1:] for line in ran.stdout.splitlines() if line.startswith("IMPORTED"))
    return set(found)


def test_what_a_short_program_does_not_need_is_not_imported(machine, imported):
    assert "pkm_post.posting.steps" in imported
    of_others = {name for name in imported if name.startswith(tuple(f"{one}." for one in NOT_NEEDED))}
    assert not of_others | imported.intersection(NOT_NEEDED)
    rooms = [f"pkm_post.{one}" for one in ROOMS_NOT_NEEDED]
    assert ("pkm_post.planning.jerk.profile" in imported) == (machine == "example_6tps")
    assert ("pkm_post.planning.profile.refinement" in imported) == (machine != "example_6tps")
    assert not [name for name in imported if f"{name}.".startswith(tuple(f"{room}." for room in rooms))]


@pytest.mark.parametrize("name", ROOMS_NOT_NEEDED)
def test_the_modules_of_the_list_are_there(name):
    path = ADDON / "pkm_post" / name.replace(".", "/")
    assert path.is_dir() or path.with_suffix(".py").is_file()


def test_an_interrupt_of_the_imports_is_no_traceback(monkeypatch):
    class Interrupted:
        def __getattr__(self, name):
            raise KeyboardInterrupt

    monkeypatch.setattr(gc, "set_threshold", lambda *_: None)  # other tests shall keep theirs
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "1")
    from pkm_post.__main__ import run

    monkeypatch.setitem(sys.modules, "pkm_post.cli", Interrupted())
    assert run() == 130
