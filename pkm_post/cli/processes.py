# SPDX-License-Identifier: LGPL-2.1-or-later
"""Processes: commands that run in processes of their own, inside FreeCADCmd or several at a time.

Only FreeCAD can read its documents, so outside of it a command runs again inside FreeCADCmd. FreeCAD's exit code 0 is
unreliable: it also exits so without finding the script, as does a program that is not FreeCAD. The command therefore
exits with codes of its own inside, and any other code means that it was not reached.

The output of parallel commands is printed in their order, that of each kept together. Ctrl-C ends them all.
"""

from __future__ import annotations

import contextlib
import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from pkm_post.cli import console
from pkm_post.cli.terminal import ProgressLine, print_diagnostics
from pkm_post.system import FREECADCMD, FreeCADCommand, freecad_command, thread_share

_PACKAGE = Path(__file__).resolve().parents[1]
_ADDON = _PACKAGE.parent
_IN_A_WHEEL = _PACKAGE / "tools"
_TOOLS = _IN_A_WHEEL if _IN_A_WHEEL.is_dir() else _ADDON / "tools"
_FINDER = _ADDON / "tools" / "freecad"
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
_TIME_TO_END = 10.0
"""Seconds for a process to clean up before it is killed."""
_HAS_GROUPS = os.name == "posix"
"""Whether a process can lead a process group, so that all its children end with it."""


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
        ended = _run_with_us(command)
    except OSError as fault:
        print_diagnostics([start_fault(command, fault)])
        return 1
    code, fault_text = outcome(command, ended)
    if fault_text:
        print_diagnostics([fault_text])
    return code


def _run_with_us(command: Sequence[str]) -> int:
    """Run a command that Ctrl-C reaches as well, and return its exit code; after Ctrl-C it gets time to clean up."""
    process = subprocess.Popen(command, creationflags=console.flags_with_us())
    try:
        return process.wait()
    except KeyboardInterrupt:
        try:
            process.wait(_TIME_TO_END)
        except (KeyboardInterrupt, subprocess.TimeoutExpired):
            process.kill()
        raise


def command_inside(arguments: Sequence[str]) -> list[str]:
    """Command line that runs a command inside FreeCADCmd; empty, after a message, if FreeCAD is missing.

    FreeCAD loads an add-on as such. A wheel is not loaded: its folder contains packages for another Python.
    """
    freecad = _freecad_command()
    if not freecad.words:
        print_diagnostics([diagnostic_text(_NOT_STARTED, "FreeCADCmd", freecad.missing)])
        return []
    addon = ["-M", str(_ADDON)] if (_ADDON / "Init.py").exists() else []
    return [*freecad.words, *addon, str(_TOOLS / "run_script.py"), "--", _START_INSIDE, *arguments]


def command_outside(arguments: Sequence[str]) -> list[str]:
    """Command line that runs a command in a Python like this one, outside FreeCAD."""
    return [sys.executable, "-c", _START, str(_ADDON), *arguments]


def inner_exit_code(code: int) -> int:
    """FreeCAD exit code that represents one of the command line."""
    return _INSIDE + code if code in _CODES else code


def outcome(command: Sequence[str], ended: int) -> tuple[int, str]:
    """Exit code of the started command line, and the message if it did not run to its end.

    Args:
        command: from ``command_inside`` or ``command_outside``.
        ended: exit code of the process.
    """
    if _START_INSIDE not in command or ended == INTERRUPTED:
        return ended, ""
    if ended - _INSIDE in _CODES:
        return ended - _INSIDE, ""
    return 1, diagnostic_text(_NOT_DONE, command[0], f"exit code {ended}")


def start_fault(command: Sequence[str], fault: OSError) -> str:
    """Message for a command that the system cannot start."""
    return diagnostic_text(_NOT_STARTED, command[0], fault.strerror or str(fault))


def _freecad_command() -> FreeCADCommand:
    """FreeCADCmd, by the finder of a checkout, which makes one where there is none, or where it is installed.

    The finder is a bash script. Windows cannot run it, and a bash on its path belongs to another system, WSL.
    """
    has_finder = sys.platform != "win32" and _FINDER.exists() and shutil.which("bash") is not None
    if has_finder and not os.environ.get(FREECADCMD):
        return FreeCADCommand((str(_FINDER),))
    return freecad_command()


def diagnostic_text(code: str, place: str, found: str) -> str:
    """Format a diagnostic; in short without NumPy, which the rule table needs."""
    try:
        from pkm_post.model import Diagnostic, Place
    except ImportError:
        return f"{place}: error {code}: {found}"
    return str(Diagnostic(code, Place(place), found))


@dataclass
class _Child:
    """A command in a separate process."""

    command: Sequence[str]
    variables: Mapping[str, str]
    process: subprocess.Popen[str] | None = None
    is_wanted: bool = True

    def run(self) -> tuple[int, str, str]:
        """Run it and return exit code, output and errors."""
        if not self.is_wanted:
            return 1, "", ""
        try:
            self.process = self._start()
        except OSError as fault:
            return 1, "", f"{start_fault(self.command, fault)}\n"
        if not self.is_wanted:
            self.interrupt()
        printed, errors = self.process.communicate()
        code, fault_text = outcome(self.command, self.process.returncode)
        return code, printed, f"{errors}{fault_text}\n" if fault_text else errors

    def _start(self) -> subprocess.Popen[str]:
        return subprocess.Popen(
            self.command,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            encoding="utf-8",
            errors="replace",
            env=os.environ | self.variables | {"PYTHONIOENCODING": "utf-8"},  # independent of the locale
            start_new_session=_HAS_GROUPS,
            creationflags=console.flags_by_us(),
        )

    def interrupt(self) -> None:
        """Interrupt it as by Ctrl-C, so that it cleans up."""
        self.is_wanted = False
        if self.process is None or self.process.poll() is not None:
            return
        if _HAS_GROUPS:
            self._signal(signal.SIGINT)
        elif console.BREAK is not None and console.has_console():
            self.process.send_signal(console.BREAK)
        else:
            self.process.terminate()

    def end(self) -> None:
        """Wait for its end, with a timeout."""
        if self.process is not None:
            try:
                self.process.wait(_TIME_TO_END)
            except subprocess.TimeoutExpired:
                self._signal(signal.SIGKILL) if _HAS_GROUPS else self.process.kill()

    def _signal(self, number: int) -> None:
        if self.process is not None:
            with contextlib.suppress(ProcessLookupError):  # it has already ended
                os.killpg(self.process.pid, number)


def run_parallel(commands: Sequence[Sequence[str]], at_a_time: int, doing: str) -> int:
    """Run commands; return 0 if all succeeded, 130 after Ctrl-C, and 1 otherwise.

    Args:
        commands: command lines.
        at_a_time: most parallel processes.
        doing: task shown in the terminal.
    """
    children, line, code = [_Child(command, thread_share(at_a_time)) for command in commands], ProgressLine(doing), 0
    with ThreadPoolExecutor(at_a_time) as pool:
        try:
            for number, (ended, printed, errors) in enumerate(pool.map(_Child.run, children)):
                line.clear()
                print(printed, end="", flush=True)
                print(errors, end="", file=sys.stderr, flush=True)
                code = code or int(ended != 0)
                line.show(f"{number + 1} of {len(children)}", (number + 1) / len(children))
        except BaseException as fault:
            _end_all(children)
            if not isinstance(fault, KeyboardInterrupt):
                raise
            code = INTERRUPTED
        finally:
            line.clear()
    return code


def _end_all(children: Sequence[_Child]) -> None:
    for child in children:
        child.interrupt()
    for child in children:
        child.end()
