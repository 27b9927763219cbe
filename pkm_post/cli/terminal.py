# SPDX-License-Identifier: LGPL-2.1-or-later
"""Terminal: diagnostics on stderr, and the progress line, the last line of a terminal.

The line shows the current step and its share. It is overwritten, and cleared before other output. If
stderr is not a terminal there is no line.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable

if sys.platform == "win32":
    import msvcrt
else:
    import termios

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
        """Show the line during the task."""
        return self

    def __exit__(self, *raised: object) -> None:
        """Clear the line, however the task ends."""
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
