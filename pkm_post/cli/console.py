# SPDX-License-Identifier: LGPL-2.1-or-later
"""Console: differences of Windows for processes started by a program: console windows, and Ctrl-C.

A process started by a program without a console opens a console window, unless it gets a hidden one, and Ctrl-C only
reaches the processes of one console. A process in its own process group gets no Ctrl-C; its parent can send it a break,
which ends a Python process unless a handler raises KeyboardInterrupt. Other systems have no such flags; process groups
and signals are enough there. [Microsoft Learn, Process Creation Flags; GenerateConsoleCtrlEvent]
"""

from __future__ import annotations

import signal
import sys
import threading

if sys.platform == "win32":
    import ctypes
    from subprocess import CREATE_NEW_PROCESS_GROUP as _NEW_GROUP
    from subprocess import CREATE_NO_WINDOW as _NO_WINDOW

    def has_console() -> bool:
        """Whether this process has a console, so that its user may press Ctrl-C."""
        return bool(ctypes.windll.kernel32.GetConsoleCP())
else:
    _NO_WINDOW = _NEW_GROUP = 0

    def has_console() -> bool:
        """Whether this process has a console, so that its user may press Ctrl-C."""
        return sys.stdin is not None and sys.stdin.isatty()


BREAK: int | None = getattr(signal, "CTRL_BREAK_EVENT", None)
"""Signal that replaces Ctrl-C for a process in its own group; None on systems other than Windows."""


def flags_with_us() -> int:
    """Creation flags of a process that receives Ctrl-C as we do."""
    return 0 if has_console() else _NO_WINDOW


def flags_by_us() -> int:
    """Creation flags of a process that we interrupt after Ctrl-C."""
    return _NEW_GROUP if has_console() else _NO_WINDOW


def interrupt_on_break() -> None:
    """Let a break raise KeyboardInterrupt, like Ctrl-C, so that the process cleans up."""
    number = getattr(signal, "SIGBREAK", None)
    if number is not None and threading.current_thread() is threading.main_thread():
        signal.signal(number, signal.default_int_handler)
