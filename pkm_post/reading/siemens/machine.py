# SPDX-License-Identifier: LGPL-2.1-or-later
"""Machine: path, tools, options and state of a running program, with the elementary actions of blocks.

Input: moves and dwells of blocks and cycles. Output: motions and events in ``path``, and notes for the report.
"""

from __future__ import annotations

from pkm_post.model import EventKind
from pkm_post.reading.gcode.options import UNITS, ReadOptions
from pkm_post.reading.siemens.blocks import Call, Notes
from pkm_post.reading.siemens.buffer import ABSOLUTE
from pkm_post.reading.siemens.diagnostics import BlockFault, LineDiagnostics
from pkm_post.reading.siemens.path import Path
from pkm_post.reading.siemens.scan import ScannedLines
from pkm_post.reading.siemens.tools import Tools
from pkm_post.reading.units import LONG_DWELL


class SiemensMachine:
    """The machine that runs a program.

    Args:
        lines: of the program.
        options: read options.
        tools: of the program.
        faults: collects the faults.
    """

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
