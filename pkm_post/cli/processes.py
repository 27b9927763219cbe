# SPDX-License-Identifier: LGPL-2.1-or-later
"""Processes: commands that run again inside FreeCADCmd.

Only FreeCAD can read its documents, so outside of it a command runs again inside FreeCADCmd. FreeCAD's exit code 0 is
unreliable: it also exits with 0 if the script is missing, as may a program that is not FreeCAD. The command therefore
uses its own exit codes inside, and any other code means that it did not run.
"""

from __future__ import annotations

import errno
import os
import shutil
import sys
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

from pkm_post.cli import terminal
from pkm_post.cli.terminal import print_diagnostics
from pkm_post.system import FREECADCMD, FreeCADCommand, freecad_command

_PACKAGE = Path(__file__).resolve().parents[1]
_ADDON = _PACKAGE.parent
_IN_A_WHEEL = _PACKAGE / "tools"
_TOOLS = _IN_A_WHEEL if _IN_A_WHEEL.is_dir() else _ADDON / "tools"
_FINDER = _ADDON / "tools" / "freecad"
_START_INSIDE = str(_PACKAGE / "cli" / "start_inside.py")
DOCUMENTS = (".FCStd", ".FCBak")
"""Suffixes of documents, as FreeCAD writes them."""
_SOLIDS = (".step", ".stp")
_START = "import sys; sys.path.insert(0, sys.argv.pop(1)); from pkm_post.cli import main; sys.exit(main(sys.argv[1:]))"
"""Equivalent of ``-m pkm_post`` for any location of the add-on."""
INTERRUPTED = 130
"""Exit code after Ctrl-C, as in shells."""
_INSIDE = 64
"""Offset of the command line's exit codes inside: neither FreeCAD nor the shell uses such codes."""
_CODES = (0, 1, 2)
_NO_MEMORY, _NOT_STARTED, _NOT_DONE, _ENDED = "F130", "F140", "F141", "F144"
TIME_TO_END = 10.0
"""Seconds for a process to clean up before it is killed."""


def is_inside() -> bool:
    """Whether this process is FreeCAD."""
    return "FreeCAD" in sys.modules


def is_document(file: Path) -> bool:
    """Whether a file is a FreeCAD document, judged by name."""
    return file.suffix.lower() in map(str.lower, DOCUMENTS)


def needs_freecad(files: Sequence[Path], solids: Sequence[str] = ()) -> bool:
    """Whether one of the files needs FreeCAD, judged by name, without NumPy.

    Args:
        files: documents and part programs; one that does not exist is refused without FreeCAD.
        solids: files of part, stock and fixtures.
    """
    documents = any(is_document(file) and os.path.exists(file) for file in files)
    return not is_inside() and (documents or any(name.lower().endswith(_SOLIDS) for name in solids))


def run_inside(arguments: Sequence[str]) -> int:
    """Run the same command inside FreeCADCmd and return the exit code."""
    command = command_inside(arguments)
    if not command:
        return 1
    try:
        ended = _run_with_us(command)
    except OSError as fault:
        print_diagnostics([start_fault(command, fault)])
        return 1
    code, fault_text = outcome(command, ended)
    if fault_text:
        print_diagnostics([fault_text])
    return code


def _run_with_us(command: Sequence[str]) -> int:
    """Run a command that ends when we are interrupted; return its exit code. Then it gets time to clean up."""
    import subprocess

    process = subprocess.Popen(command, creationflags=terminal.flags_with_us())
    try:
        with terminal.ended_with_us(process):
            return process.wait()
    except KeyboardInterrupt:
        try:
            process.wait(TIME_TO_END)
        except (KeyboardInterrupt, subprocess.TimeoutExpired):
            process.kill()
        raise


def command_inside(arguments: Sequence[str], say: Callable[[Iterable[str]], None] = print_diagnostics) -> list[str]:
    """Command line that runs a command inside FreeCADCmd; empty, after a message, if FreeCAD is missing.

    FreeCAD loads an add-on itself. The folder of a wheel is not loaded, as it has packages for another Python.
    """
    freecad = _freecad_command()
    if not freecad.words:
        say([diagnostic_text(_NOT_STARTED, "FreeCADCmd", freecad.missing)])
        return []
    addon = ["-M", str(_ADDON)] if (_ADDON / "Init.py").exists() else []
    return [*freecad.words, *addon, str(_TOOLS / "run_script.py"), "--", _START_INSIDE, *arguments]


def command_outside(arguments: Sequence[str]) -> list[str]:
    """Command line that runs a command in a Python like this one, outside FreeCAD."""
    return [sys.executable, "-c", _START, str(_ADDON), *arguments]


def inner_exit_code(code: int) -> int:
    """FreeCAD exit code that represents one of the command line."""
    return _INSIDE + code if code in _CODES else code


def outcome(command: Sequence[str], ended: int, file: str = "") -> tuple[int, str]:
    """Exit code of the started command line, and the message if it did not run to its end.

    Args:
        command: from ``command_inside`` or ``command_outside``.
        ended: exit code of the process.
        file: that it posts.
    """
    inside = _START_INSIDE in command
    code = ended - _INSIDE if inside and ended != INTERRUPTED else ended
    if code in (*_CODES, INTERRUPTED):
        return code, ""
    place = (_NOT_DONE, command[0]) if inside else (_ENDED, file)
    return 1, diagnostic_text(*place, f"exit code {ended}")


def start_fault(command: Sequence[str], fault: OSError, file: str = "") -> str:
    """Message for a command that the system cannot start."""
    place = (_NOT_STARTED, command[0]) if _START_INSIDE in command else (_ENDED, file)
    if fault.errno == errno.ENOMEM:
        place = (_NO_MEMORY, file or command[0])
    return diagnostic_text(*place, fault.strerror or str(fault))


def _freecad_command() -> FreeCADCommand:
    """FreeCADCmd, from the finder of a checkout, which creates one if missing, or from an installation.

    The finder is a bash script. Windows cannot run it; a bash on its path is that of WSL.
    """
    has_finder = sys.platform != "win32" and _FINDER.exists() and shutil.which("bash") is not None
    if has_finder and not os.environ.get(FREECADCMD):
        return FreeCADCommand((str(_FINDER),))
    return freecad_command()


def wrong_usage(code: str, place: str, found: str) -> int:
    """Print the diagnostic of an argument; return exit code 2."""
    print_diagnostics([diagnostic_text(code, place, found)])
    return 2


def diagnostic_text(code: str, place: str, found: str) -> str:
    """Format a diagnostic; abbreviated without NumPy, which the rule table needs."""
    try:
        from pkm_post.model import Diagnostic, Place
    except ImportError:
        return f"{place}: error {code}: {found}"
    return str(Diagnostic(code, Place(place), found))
