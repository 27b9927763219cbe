# SPDX-License-Identifier: LGPL-2.1-or-later
"""Progress line: the last line of a terminal shows the current step and share; elsewhere there is no output.

Input: steps and shares. A line on stderr is overwritten, and cleared when there is something to print.
"""

from __future__ import annotations

import sys

_CLEAR = "\r\x1b[K"


class ProgressLine:
    """Progress line of one task.

    Args:
        subject: of the task.
    """

    def __init__(self, subject: str) -> None:
        self._subject = subject
        self._is_seen = sys.stderr.isatty()

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
        """Print a permanent line."""
        self._write(_CLEAR)
        print(line, flush=self._is_seen)

    def clear(self) -> None:
        """Clear the line."""
        self._write(_CLEAR)

    def _write(self, text: str) -> None:
        if self._is_seen:
            sys.stderr.write(text)
            sys.stderr.flush()
