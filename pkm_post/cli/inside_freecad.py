# SPDX-License-Identifier: LGPL-2.1-or-later
"""A FreeCAD document can be read by FreeCAD alone: outside of it a command runs itself inside FreeCADCmd."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

_ADDON = Path(__file__).resolve().parents[2]
_READ_BY_FREECAD = (".fcstd", ".step", ".stp")
_START = "import sys; sys.path.insert(0, sys.argv.pop(1)); from pkm_post.cli import main; sys.exit(main(sys.argv[1:]))"
"""As ``-m pkm_post``, wherever the add-on is."""


def is_inside() -> bool:
    """Whether this process is FreeCAD's."""
    return "FreeCAD" in sys.modules


def needs_freecad(files: Sequence[Path], solids: Sequence[str] = ()) -> bool:
    """Whether this process cannot read one of the files, by their names, which needs no NumPy.

    Args:
        files: documents and part programs.
        solids: files of part, stock and fixtures.
    """
    if is_inside():
        return False
    if any(file.suffix.lower() in _READ_BY_FREECAD for file in (*files, *map(Path, solids))):
        return True
    from pkm_post.sources import is_part_program

    return not all(map(is_part_program, files))


def run_inside(arguments: Sequence[str]) -> int:
    """Run the same command inside FreeCADCmd, with this add-on loaded; the exit code."""
    command = command_inside(arguments)
    return subprocess.run(command, check=False).returncode if command else 1


def command_inside(arguments: Sequence[str]) -> list[str]:
    """How a command is started inside FreeCADCmd, with this add-on loaded; nothing if there is no FreeCAD, as told."""
    freecad = _freecad_command()
    if not freecad:
        print("FreeCAD 1.0 or newer is needed: install it, or name its FreeCADCmd in $FREECADCMD", file=sys.stderr)
        return []
    frame, module = _ADDON / "tools" / "run_script.py", _ADDON / "pkm_post" / "__main__.py"
    return [*freecad, "-M", str(_ADDON), str(frame), "--", str(module), *arguments]


def command_outside(arguments: Sequence[str]) -> list[str]:
    """How a command is started in a Python like this one, which is not FreeCAD's."""
    return [sys.executable, "-c", _START, str(_ADDON), *arguments]


def _freecad_command() -> list[str]:
    """How FreeCADCmd is started: as the user says, by the finder that comes with the add-on, or from the path."""
    if os.environ.get("FREECADCMD"):
        return [os.environ["FREECADCMD"]]
    finder = _ADDON / "tools" / "freecad"
    if finder.exists() and shutil.which("bash"):
        return [str(finder)]
    found = shutil.which("freecadcmd") or shutil.which("FreeCADCmd")
    return [found] if found else []
