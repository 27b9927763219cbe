# SPDX-License-Identifier: LGPL-2.1-or-later
"""Terminal: diagnostics on stderr, the progress line, and consoles and Ctrl-C of the processes started here.

The progress line shows the current step and its share. It is overwritten, and cleared before other output. If stderr is
not a terminal there is no line.

On Windows a process started by a program without a console opens a console window, unless it gets a hidden one, and
Ctrl-C only reaches the processes of one console. A process in its own process group gets no Ctrl-C; its parent can send
it a break, which ends a Python process unless a handler raises KeyboardInterrupt. Other systems have no such flags;
process groups and signals are enough there: a batch system ends a process by SIGTERM, which its children do not get.
[Microsoft Learn, Process Creation Flags; GenerateConsoleCtrlEvent]
"""

from __future__ import annotations

import signal
import sys
import threading
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from subprocess import Popen
    from types import FrameType

if sys.platform == "win32":
    import ctypes
    import msvcrt
    from subprocess import CREATE_NEW_PROCESS_GROUP as _NEW_GROUP
    from subprocess import CREATE_NO_WINDOW as _NO_WINDOW
else:
    import termios

    _NO_WINDOW = _NEW_GROUP = 0

_ENDS = ("SIGBREAK",) if sys.platform == "win32" else ("SIGTERM", "SIGHUP")
"""Signals that end a process: a break; termination, and the end of its terminal."""
_started: set[Popen[Any]] = set()
"""Processes that end with this one."""
_CLEAR = "\r\x1b[K"


def print_diagnostics(diagnostics: Iterable[object]) -> None:
    """Print diagnostics or other messages on stderr, one a line."""
    for diagnostic in diagnostics:
        print(diagnostic, file=sys.stderr)


def drop_typed_ahead() -> None:
    """Drop what was typed at a terminal before it is asked for: a key that bounces must not start a machine."""
    if not sys.stdin.isatty():
        return
    if sys.platform == "win32":
        while msvcrt.kbhit():
            msvcrt.getwch()
    else:
        termios.tcflush(sys.stdin.fileno(), termios.TCIFLUSH)


class ProgressLine:
    """Progress line of one task.

    Args:
        subject: name of the task.
    """

    def __init__(self, subject: str) -> None:
        self._subject = subject
        self._is_terminal = sys.stderr.isatty()

    def __enter__(self) -> ProgressLine:
        return self

    def __exit__(self, *raised: object) -> None:
        self.clear()

    def show(self, step: str, share: float) -> None:
        """Show the step and its completed share, 0 to 1; as ``posting.Progress``."""
        self._write(f"{_CLEAR}{self._subject}: {step} {share:.0%}" if step else _CLEAR)

    def print(self, line: str) -> None:
        """Print a permanent line on stdout."""
        self._write(_CLEAR)
        print(line, flush=self._is_terminal)

    def clear(self) -> None:
        """Clear the line."""
        self._write(_CLEAR)

    def _write(self, text: str) -> None:
        if self._is_terminal:
            sys.stderr.write(text)
            sys.stderr.flush()


BREAK: int | None = getattr(signal, "CTRL_BREAK_EVENT", None)
"""Signal that replaces Ctrl-C for a process in its own group; None on systems other than Windows."""


def has_console() -> bool:
    """Whether this process has a console, so that its user may press Ctrl-C."""
    if sys.platform == "win32":
        return bool(ctypes.windll.kernel32.GetConsoleCP())
    return sys.stdin is not None and sys.stdin.isatty()


def flags_with_us() -> int:
    """Creation flags of a process that receives Ctrl-C as we do."""
    return 0 if has_console() else _NO_WINDOW


def flags_by_us() -> int:
    """Creation flags of a process that we interrupt after Ctrl-C."""
    return _NEW_GROUP if has_console() else _NO_WINDOW


def interrupt_on_end() -> None:
    """Let the signals that end this process raise KeyboardInterrupt, like Ctrl-C, so that it cleans up."""
    if threading.current_thread() is threading.main_thread():
        for name in _ENDS:
            if signal.getsignal(getattr(signal, name)) is signal.SIG_DFL:  # nohup ignores SIGHUP
                signal.signal(getattr(signal, name), _interrupt)


def _interrupt(number: int, frame: FrameType | None) -> None:
    """Interrupt this process once: a further signal must not end its cleaning up."""
    for name in _ENDS:
        signal.signal(getattr(signal, name), signal.SIG_IGN)
    if sys.platform != "win32":  # there, a break reaches them all
        for process in tuple(_started):
            process.terminate()
    raise KeyboardInterrupt


@contextmanager
def ended_with_us(process: Popen[Any]) -> Iterator[None]:
    """End a process when a signal ends this one."""
    _started.add(process)
    try:
        yield
    finally:
        _started.discard(process)
