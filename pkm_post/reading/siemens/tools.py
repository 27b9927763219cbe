# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tools: numbers for the tools of a program, which Siemens's language may call by name.

Input: T words, numbers or texts. Output: tool numbers. A name refers to the tool of that name in the options, a
text of digits to that number, and any other name gets the lowest number unused in the program.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import replace

from pkm_post.model import Tool
from pkm_post.reading.gcode.options import ReadOptions
from pkm_post.reading.siemens.diagnostics import BlockFault
from pkm_post.reading.siemens.variables import Value

_NUMBER = re.compile(r"(?<![A-Z0-9_])T\s*(?:=\s*\"?)?\s*(\d+)", re.IGNORECASE)
_CHANGE = re.compile(r"(?<![A-Z0-9_])M\s*(?:=\s*)?0*6(?![0-9.])", re.IGNORECASE)
MOST = 1_000_000_000


class Tools:
    """The tools that a program calls.

    Args:
        statements: the lines that may call tools, without comments.
        options: with the tools of the user.
    """

    def __init__(self, statements: Iterable[str], options: ReadOptions) -> None:
        lines = list(statements)
        self._taken = {int(found[1]) for line in lines for found in _NUMBER.finditer(line)} | {0}
        self._numbers = {tool.name.upper(): number for number, tool in options.tools.items() if tool.name}
        self._options = options
        self.named: dict[str, int] = {}
        """Numbers assigned to names."""
        self.has_change = any(_CHANGE.search(line) for line in lines)
        """Whether the program has M6; without it T changes the tool at once."""

    def number(self, value: Value) -> int:
        """The number of a tool.

        Raises:
            BlockFault: it is not a whole number.
        """
        if isinstance(value, str):
            return int(value) if value.isdigit() and len(value) < 10 else self._of_name(value)  # noqa: PLR2004
        if value < 0 or value != round(value) or value > MOST:
            raise BlockFault("G406", f"T{value:g}")
        return round(value)

    def _of_name(self, name: str) -> int:
        key = name.upper()
        if key not in self._numbers:
            number = next(number for number in range(1, len(self._taken) + 2) if number not in self._taken)
            self._taken.add(number)
            self._numbers[key] = self.named[name] = number
        return self._numbers[key]

    def tool(self, number: int) -> Tool | None:
        """The tool with a number; tool 0 before the first change."""
        return self._options.tool(max(number, 0))

    def named_tool(self, number: int) -> Tool | None:
        """The tool with a number, with the name used in the program."""
        tool = self.tool(number)
        name = next((name for name, given in self.named.items() if given == number), "")
        return tool and replace(tool, number=number, name=name or tool.name)

    def notes(self) -> tuple[str, ...]:
        """The numbers of named tools, for the report."""
        return tuple(f'tool "{name}" is number {number} here' for name, number in self.named.items())
