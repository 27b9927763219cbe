# SPDX-License-Identifier: LGPL-2.1-or-later
"""A FreeCAD document can be read by FreeCAD alone: outside of it a command runs itself inside FreeCADCmd.

Exit code 0 of FreeCAD says little: it ends so where it does not find the script, and so does a program that is no
FreeCAD. The command therefore ends inside with exit codes of its own, and any other says that it did not get there.
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
"""As ``-m pkm_post``, wherever the add-on is."""
INTERRUPTED = 130
"""The exit code of what Ctrl-C ended, as shells have it."""
_INSIDE = 64
"""What is added inside to the exit code of the command line: neither FreeCAD nor the shell has such codes."""
_CODES = (0, 1, 2)
_NOT_STARTED, _NOT_DONE = "F140", "F141"


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
    """Run the same command inside FreeCADCmd; the exit code."""
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
    """How a command is started inside FreeCADCmd; nothing if there is no FreeCAD, which is said then.

    An add-on is loaded as such. A wheel is not: the folder it is in has packages for another Python.
    """
    freecad = freecad_command()
    if not freecad:
        print(told(_NOT_STARTED, "FreeCADCmd", "there is none on the path"), file=sys.stderr)
        return []
    addon = ["-M", str(_ADDON)] if (_ADDON / "Init.py").exists() else []
    return [*freecad, *addon, str(_TOOLS / "run_script.py"), "--", _START_INSIDE, *arguments]


def command_outside(arguments: Sequence[str]) -> list[str]:
    """How a command is started in a Python like this one, which is not FreeCAD's."""
    return [sys.executable, "-c", _START, str(_ADDON), *arguments]


def as_ended_inside(code: int) -> int:
    """The exit code of FreeCAD that stands for one of the command line."""
    return _INSIDE + code if code in _CODES else code


def judged(command: Sequence[str], ended: int) -> tuple[int, str]:
    """The exit code of the command line that was started, and what is to be said if it did not get to its end.

    Args:
        command: what ``command_inside`` or ``command_outside`` gave.
        ended: the exit code of the process.
    """
    if _START_INSIDE not in command or ended == INTERRUPTED:
        return ended, ""
    if ended - _INSIDE in _CODES:
        return ended - _INSIDE, ""
    return 1, told(_NOT_DONE, command[0], f"exit code {ended}")


def not_started(command: Sequence[str], fault: OSError) -> str:
    """What is to be said of a command that the system does not start."""
    return told(_NOT_STARTED, command[0], fault.strerror or str(fault))


def freecad_command(environment: Mapping[str, str] = os.environ, system: str = sys.platform) -> list[str]:
    """How FreeCADCmd is started: as the user says, by the finder that comes with the add-on, or from the path.

    The finder is a script for bash. Windows starts none, and a bash on its path is that of another system, WSL.
    """
    if environment.get("FREECADCMD"):
        return [environment["FREECADCMD"]]
    finder, path = _ADDON / "tools" / "freecad", environment.get("PATH")
    if system != "win32" and finder.exists() and shutil.which("bash", path=path):
        return [str(finder)]
    found = shutil.which("freecadcmd", path=path) or shutil.which("FreeCADCmd", path=path)
    return [found] if found else []


def told(code: str, place: str, found: str) -> str:
    """A diagnostic as text; without a NumPy, which its table needs, in short."""
    try:
        from pkm_post.model import Diagnostic, Place
    except ImportError:
        return f"{place}: error {code}: {found}"
    return str(Diagnostic(code, Place(place), found))
