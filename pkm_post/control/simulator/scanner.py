# SPDX-License-Identifier: LGPL-2.1-or-later
"""Scanner: reads a line of text from the left, token by token."""

from __future__ import annotations

import re
from functools import cache

from pkm_post.control.simulator.errors import DATA, CommandError

CONSTANT = r"\$[0-9A-F]{1,12}|[0-9]+\.?[0-9]*|\.[0-9]+"


@cache
def _compiled(pattern: str) -> re.Pattern[str]:
    return re.compile(r" *(?:" + pattern + r")", re.IGNORECASE | re.ASCII)


class Scanner:
    """A line and the read position; spaces between tokens are skipped, and case is ignored."""

    def __init__(self, text: str) -> None:
        self.text = text.replace("\t", " ")
        self.position = 0

    def take(self, pattern: str) -> re.Match[str] | None:
        """Read a token if it comes next."""
        match = _compiled(pattern).match(self.text, self.position)
        if match is not None:
            self.position = match.end()
        return match

    def expect(self, pattern: str) -> re.Match[str]:
        """Read a token.

        Raises:
            CommandError: it does not come next.
        """
        match = self.take(pattern)
        if match is None:
            raise CommandError(DATA)
        return match

    def at_end(self) -> bool:
        """Whether only spaces and a comment are left."""
        return self.take(r"(?:;.*)?$") is not None

    def rest(self) -> str:
        """Read everything that is left."""
        text, self.position = self.text[self.position :], len(self.text)
        return text
