# SPDX-License-Identifier: LGPL-2.1-or-later
"""Machine: path, tools, options and state of a running program, with the elementary actions of blocks.

Input: moves and dwells of blocks and cycles, and T words. Output: motions and events in ``path``, tool numbers, and
notes for the report. A tool's name refers to the tool of that name in the options, a text of digits to that number, and
any other name gets the lowest number unused in the program.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import replace

from pkm_post.model import EventKind, Tool
from pkm_post.reading.gcode.options import ReadOptions
from pkm_post.reading.siemens.blocks import Call, Notes
from pkm_post.reading.siemens.buffer import ABSOLUTE
from pkm_post.reading.siemens.diagnostics import BlockFault, LineDiagnostics
from pkm_post.reading.siemens.path import Path
from pkm_post.reading.siemens.scan import ScannedLines
from pkm_post.reading.siemens.variables import Value
from pkm_post.reading.units import LONG_DWELL, UNITS

_NUMBER = re.compile(r"(?<![A-Z0-9_])T\s*(?:=\s*\"?)?\s*(\d+)", re.IGNORECASE)
_CHANGE = re.compile(r"(?<![A-Z0-9_])M\s*(?:=\s*)?0*6(?![0-9.])", re.IGNORECASE)
MOST = 1_000_000_000


class Tools:
    """The tools that a program calls in some lines, which have no comments."""

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
            return int(value) if value.isdecimal() and len(value) < 10 else self._of_name(value)  # noqa: PLR2004
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


class SiemensMachine:
    """The machine that runs a program."""

    def __init__(self, lines: ScannedLines, options: ReadOptions, tools: Tools, faults: LineDiagnostics) -> None:
        self.options, self.tools, self.notes = options, tools, Notes()
        self.path = Path(lines, options.axis_words, faults)
        self.state = self.path.state
        if options.unit == "inch":
            self.state.scale = self.state.feed_scale = UNITS["inch"]
        if options.feed is not None:
            self.state.feed = options.feed * 60 / self.state.feed_scale
        self.lines, self.faults = lines, faults
        self.modal_call: Call | None = None

    def move(self, row: int, motion: int, words: dict[str, float]) -> None:
        """Move of a cycle to absolute coordinates in the active unit; an F word stays active."""
        self.path.buffer.add_block(row, motion, words, dict.fromkeys(words, ABSOLUTE))

    def dwell(self, row: int, seconds: float) -> None:
        """Add a dwell.

        Raises:
            BlockFault: it is below zero.
        """
        if not seconds >= 0:
            raise BlockFault("G406", f"a dwell of {seconds:g} s")
        if seconds > LONG_DWELL:
            self.faults.add(row, "G428", f"{seconds:g} s")
        self.path.add_event(EventKind.DWELL, seconds)

    def seconds_of_turns(self, turns: float) -> float:
        """The time of some turns of the spindle.

        Raises:
            BlockFault: the spindle is stopped.
        """
        if not self.state.spindle():
            raise BlockFault("G606", f"a dwell of {turns:g} turns while the spindle stands still")
        return turns * 60 / abs(self.state.spindle())

    def begin_cycle(self) -> tuple[int, float]:
        """Begin a cycle, whose corners are not rounded; return motion code and feed, to restore after it."""
        self.state.exact_path = True
        return self.state.motion, self.state.feed

    def end_cycle(self, before: tuple[int, float]) -> None:
        """Flush the moves of a cycle, and restore motion code and feed."""
        self.path.flush()
        self.state.motion, self.state.feed = before
        self.state.exact_path = False

    def finish(self, row: int) -> None:
        """Flush pending moves, and stop spindle and coolant."""
        self.path.flush()
        speeds = [event.value for event in self.path.sections.events if event.kind is EventKind.SPINDLE]
        if speeds and speeds[-1]:
            self.path.add_event(EventKind.SPINDLE, 0.0)
        if self.state.coolant:
            self.path.add_event(EventKind.COOLANT, 0.0)
