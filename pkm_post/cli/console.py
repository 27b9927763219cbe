# SPDX-License-Identifier: LGPL-2.1-or-later
"""Console: what Windows does otherwise with the processes of a program: windows that open, and Ctrl-C.

A process of a program without a console opens a console window, unless it gets a hidden one, and Ctrl-C reaches the
processes of one console only. In a process group of its own a process does not get Ctrl-C; its parent can send it a
break, which Python takes for the end of the process unless a handler raises KeyboardInterrupt. Elsewhere there are no
such flags, and process groups and signals do all of it. [Microsoft Learn, Process Creation Flags;
GenerateConsoleCtrlEvent]
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
"""Sent to a process in a group of its own as Ctrl-C; None where the system has no consoles of this kind."""


def flags_with_us() -> int:
    """Creation flags of a process that Ctrl-C reaches as it reaches us."""
    return 0 if has_console() else _NO_WINDOW


def flags_by_us() -> int:
    """Creation flags of a process that we interrupt when Ctrl-C has reached us."""
    return _NEW_GROUP if has_console() else _NO_WINDOW


def interrupt_on_break() -> None:
    """Let a break raise KeyboardInterrupt, as Ctrl-C does, so that what was begun is tidied up."""
    number = getattr(signal, "SIGBREAK", None)
    if number is not None and threading.current_thread() is threading.main_thread():
        signal.signal(number, signal.default_int_handler)
