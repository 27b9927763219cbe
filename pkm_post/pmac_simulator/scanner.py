# SPDX-License-Identifier: LGPL-2.1-or-later
"""Scanner: a line of text that is read from the left, piece by piece."""

from __future__ import annotations

import re
from functools import cache

from pkm_post.pmac_simulator.errors import DATA, CommandError

CONSTANT = r"\$[0-9A-F]{1,12}|[0-9]+\.?[0-9]*|\.[0-9]+"


@cache
def _compiled(pattern: str) -> re.Pattern[str]:
    return re.compile(r" *(?:" + pattern + r")", re.IGNORECASE | re.ASCII)


class Scanner:
    """A line and how far it has been read; spaces between pieces are skipped, capitals and small letters are alike."""

    def __init__(self, text: str) -> None:
        self.text = text.replace("\t", " ")
        self.position = 0

    def take(self, pattern: str) -> re.Match[str] | None:
        """Read a piece if the line goes on with it."""
        match = _compiled(pattern).match(self.text, self.position)
        if match is not None:
            self.position = match.end()
        return match

    def expect(self, pattern: str) -> re.Match[str]:
        """Read a piece.

        Raises:
            CommandError: the line goes on otherwise.
        """
        match = self.take(pattern)
        if match is None:
            raise CommandError(DATA)
        return match

    def at_end(self) -> bool:
        """Whether nothing is left but spaces and a comment."""
        return self.take(r"(?:;.*)?$") is not None

    def rest(self) -> str:
        """All that is left, read by this."""
        text, self.position = self.text[self.position :], len(self.text)
        return text
