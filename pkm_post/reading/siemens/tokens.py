# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tokens: one block of a Siemens program as names, letters, numbers, texts and signs.

Input: a line without its comment. Output: tokens with their columns. A name has a letter or an underscore as each of
its first two characters [SiemensNC, identifiers], so that G1X10 is two addresses and CR=10 is one.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from pkm_post.reading.siemens.diagnostics import BlockFault

_TOKEN = re.compile(
    r"""[ \t\f\v]*(?:
      (?P<text>"[^"]*")
    | (?P<number>'H[0-9A-F]+'|'B[01]+'|(?:\d+\.?\d*|\.\d+)(?:EX[+-]?\d+)?)
    | (?P<name>\$[A-Z_]+\w*|[A-Z_][A-Z_]\w*)
    | (?P<letter>[A-Z])
    | (?P<sign><<|>=|<=|<>|==|[-+*/(),\[\]=<>:%.])
    )""",
    re.IGNORECASE | re.VERBOSE | re.ASCII,
)
_MOST_SHOWN = 30


@dataclass(frozen=True)
class Token:
    """A token.

    Attributes:
        kind: "text", "number", "name", "letter" or "sign".
        text: as written, names and letters in upper case.
        column: from 1.
    """

    kind: str
    text: str
    column: int

    def number(self) -> float:
        """The value of a number.

        Raises:
            BlockFault: it is too large.
        """
        if self.text.startswith("'"):
            return float(int(self.text[2:-1], 16 if self.text[1].upper() == "H" else 2))
        value = float(self.text.upper().replace("EX", "E"))
        if value == float("inf"):
            raise BlockFault("G103", self.text[:_MOST_SHOWN], self.column)
        return value


def tokens_of(line: str) -> list[Token]:
    """The tokens of a line without a comment.

    Raises:
        BlockFault: a character starts no token.
    """
    found: list[Token] = []
    place = 0
    line = line.rstrip()
    while place < len(line):
        match = _TOKEN.match(line, place)
        if match is None:
            rest = line[place:].lstrip()
            raise BlockFault("G101", f"'{rest[:1]}'", len(line) - len(rest) + 1)
        kind = str(match.lastgroup)
        text = match[kind]
        found.append(Token(kind, text if kind == "text" else text.upper(), match.start(kind) + 1))
        place = match.end()
    return found


class Cursor:
    """Reads the tokens of a block from left to right."""

    def __init__(self, tokens: list[Token]) -> None:
        self._tokens = tokens
        self.place = 0

    def peek(self, ahead: int = 0) -> Token:
        """A following token; an empty sign after the last one."""
        place = self.place + ahead
        if place < len(self._tokens):
            return self._tokens[place]
        last = self._tokens[-1] if self._tokens else None
        return Token("end", "", last.column + len(last.text) if last else 1)

    def since(self, place: int) -> list[Token]:
        """The tokens read from a place on."""
        return self._tokens[place : self.place]

    def at_end(self) -> bool:
        """Whether all tokens are read."""
        return self.place >= len(self._tokens)

    def next(self) -> Token:
        """Read a token."""
        token = self.peek()
        self.place += 1
        return token

    def takes(self, *texts: str) -> bool:
        """Read the next token if it is one of some signs or names."""
        token = self.peek()
        if token.text in texts and token.kind in ("sign", "name", "letter"):
            self.place += 1
            return True
        return False

    def expect(self, text: str) -> Token:
        """Read a sign or name.

        Raises:
            BlockFault: the next token is another.
        """
        token = self.peek()
        if not self.takes(text):
            raise BlockFault("G601", f"{token.text or 'the end of the block'} instead of {text}", token.column)
        return token
