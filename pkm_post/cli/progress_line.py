# SPDX-License-Identifier: LGPL-2.1-or-later
"""Progress line: the last line of a terminal says what is being done and how far it is; elsewhere nothing is said.

Steps and shares enter; a line on stderr is written over and over, and is gone when there is something to print.
"""

from __future__ import annotations

import sys

_CLEAR = "\r\x1b[K"


class ProgressLine:
    """The line, for one thing that is being done.

    Args:
        subject: what it is done to.
    """

    def __init__(self, subject: str) -> None:
        self._subject = subject
        self._is_seen = sys.stderr.isatty()

    def __enter__(self) -> ProgressLine:
        """The line, while something is being done."""
        return self

    def __exit__(self, *raised: object) -> None:
        """However that ends, nothing is left in the terminal."""
        self.clear()

    def show(self, step: str, share: float) -> None:
        """Say the step and the share that is done, 0 to 1; as ``pipeline.Progress``."""
        self._write(f"{_CLEAR}{self._subject}: {step} {share:.0%}" if step else _CLEAR)

    def print(self, line: str) -> None:
        """Print a line that stays."""
        self._write(_CLEAR)
        print(line, flush=self._is_seen)

    def clear(self) -> None:
        """Leave nothing in the terminal."""
        self._write(_CLEAR)

    def _write(self, text: str) -> None:
        if self._is_seen:
            sys.stderr.write(text)
            sys.stderr.flush()
