# SPDX-License-Identifier: LGPL-2.1-or-later
"""Inside FreeCAD: only FreeCAD can read its documents, so elsewhere a command reruns itself inside FreeCADCmd.

FreeCAD's exit code 0 is unreliable: it also exits so without finding the script, as does a program that is not FreeCAD.
The command therefore exits with its own codes inside, and any other code means that it was not reached.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

_PACKAGE = Path(__file__).resolve().parents[1]
_ADDON = _PACKAGE.parent
_IN_A_WHEEL = _PACKAGE / "tools"
_TOOLS = _IN_A_WHEEL if _IN_A_WHEEL.is_dir() else _ADDON / "tools"
_START_INSIDE = str(_PACKAGE / "cli" / "start_inside.py")
_READ_BY_FREECAD = (".fcstd", ".step", ".stp")
_START = "import sys; sys.path.insert(0, sys.argv.pop(1)); from pkm_post.cli import main; sys.exit(main(sys.argv[1:]))"
"""Equivalent of ``-m pkm_post`` for any location of the add-on."""
INTERRUPTED = 130
"""Exit code after Ctrl-C, as in shells."""
_INSIDE = 64
"""Offset of the command line's exit codes inside: neither FreeCAD nor the shell uses such codes."""
_CODES = (0, 1, 2)
_NOT_STARTED, _NOT_DONE = "F140", "F141"


def is_inside() -> bool:
    """Whether this process is FreeCAD."""
    return "FreeCAD" in sys.modules


def needs_freecad(files: Sequence[Path], solids: Sequence[str] = ()) -> bool:
    """Whether one of the files needs FreeCAD, judged by name, without NumPy.

    Args:
        files: documents and part programs.
        solids: files of part, stock and fixtures.
    """
    if is_inside():
        return False
    if any(file.suffix.lower() in _READ_BY_FREECAD for file in (*files, *map(Path, solids))):
        return True
    from pkm_post.reading import is_part_program

    return not all(map(is_part_program, files))


def run_inside(arguments: Sequence[str]) -> int:
    """Run the same command inside FreeCADCmd and return the exit code."""
    command = command_inside(arguments)
    if not command:
        return 1
    try:
        ended = subprocess.run(command, check=False).returncode
    except OSError as fault:
        print(not_started(command, fault), file=sys.stderr)
        return 1
    code, why = judged(command, ended)
    if why:
        print(why, file=sys.stderr)
    return code


def command_inside(arguments: Sequence[str]) -> list[str]:
    """Command line that runs a command inside FreeCADCmd; empty, after a message, if FreeCAD is missing.

    FreeCAD loads an add-on as such. A wheel is not loaded: its folder contains packages for another Python.
    """
    freecad = freecad_command()
    if not freecad:
        print(told(_NOT_STARTED, "FreeCADCmd", "there is none on the path"), file=sys.stderr)
        return []
    addon = ["-M", str(_ADDON)] if (_ADDON / "Init.py").exists() else []
    return [*freecad, *addon, str(_TOOLS / "run_script.py"), "--", _START_INSIDE, *arguments]


def command_outside(arguments: Sequence[str]) -> list[str]:
    """Command line that runs a command in a Python like this one, outside FreeCAD."""
    return [sys.executable, "-c", _START, str(_ADDON), *arguments]


def as_ended_inside(code: int) -> int:
    """FreeCAD exit code that represents one of the command line."""
    return _INSIDE + code if code in _CODES else code


def judged(command: Sequence[str], ended: int) -> tuple[int, str]:
    """Exit code of the started command line, and the message if it did not run to its end.

    Args:
        command: from ``command_inside`` or ``command_outside``.
        ended: exit code of the process.
    """
    if _START_INSIDE not in command or ended == INTERRUPTED:
        return ended, ""
    if ended - _INSIDE in _CODES:
        return ended - _INSIDE, ""
    return 1, told(_NOT_DONE, command[0], f"exit code {ended}")


def not_started(command: Sequence[str], fault: OSError) -> str:
    """Message for a command that the system cannot start."""
    return told(_NOT_STARTED, command[0], fault.strerror or str(fault))


def freecad_command(environment: Mapping[str, str] = os.environ, system: str = sys.platform) -> list[str]:
    """FreeCADCmd command line: from the user's setting, the add-on's finder, or the path.

    The finder is a bash script. Windows cannot run it, and a bash on its path belongs to another system, WSL.
    """
    if environment.get("FREECADCMD"):
        return [environment["FREECADCMD"]]
    finder, path = _ADDON / "tools" / "freecad", environment.get("PATH")
    if system != "win32" and finder.exists() and shutil.which("bash", path=path):
        return [str(finder)]
    found = shutil.which("freecadcmd", path=path) or shutil.which("FreeCADCmd", path=path)
    return [found] if found else []


def told(code: str, place: str, found: str) -> str:
    """Format a diagnostic; in short without NumPy, which the rule table needs."""
    try:
        from pkm_post.model import Diagnostic, Place
    except ImportError:
        return f"{place}: error {code}: {found}"
    return str(Diagnostic(code, Place(place), found))
