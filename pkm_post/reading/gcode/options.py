# SPDX-License-Identifier: LGPL-2.1-or-later
"""Options: settings that a G-code program does not contain and the user must supply, and limits of its execution.

Input: choices of the user, lengths in mm, angles in degrees. Output: frozen values. Nothing is guessed: a required but
missing option is a fault of the program. The limits let every execution end in bounded time and memory.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from pkm_post.model import Diagnostics, Program, Tool
from pkm_post.reading.units import UNITS

Point = tuple[float, float, float]
ReadResult = tuple[Program | None, Diagnostics]
"""The program, or None if there are errors; and the diagnostics."""

AXIS_WORDS: dict[str, str] = {"none": "", "vector": "IJK", "AC": "AC", "BC": "BC", "AB": "AB", "RPY": "ABC"}
"""Letters of each tool axis notation."""

VECTOR_WORDS: dict[str, tuple[str, ...]] = {"I": ("I", "A3", "TX"), "J": ("J", "B3", "TY"), "K": ("K", "C3", "TZ")}
"""Words for each vector component, in all dialects."""

NORMAL_WORDS = ("NX", "NY", "NZ")
"""The words of the surface normal."""


def axis_names(axis_words: str) -> tuple[str, ...]:
    """The words that move the tool axis, in all dialects."""
    letters = AXIS_WORDS[axis_words]
    return tuple(name for letter in letters for name in VECTOR_WORDS.get(letter, (letter,)))


DWELL_UNITS: dict[str, float] = {"s": 1.0, "ms": 0.001}
"""s per dwell unit."""

FLAVOUR_NAMES = ("rs274", "fanuc")
"""Keys of ``flavours.FLAVOURS``."""


@dataclass(frozen=True)
class ReadOptions:
    """Settings for reading a G-code program.

    Attributes:
        tools: the tools in the magazine, by number; D and H words also refer to them.
        default_tool: replaces every missing tool, and the tool of a program that calls none.
        axis_words: tool axis notation, a key of ``AXIS_WORDS``: "vector" is I J K after G43.5 and its equivalents on
            other controls, A3= B3= C3= after TRAORI and TX TY TZ after LN; "AC", "BC" and "AB" are rotary words after
            G43.4, "RPY" those of LinuxCNC's hexapod: k = Rz(C) Ry(B) Rx(A) e_z.
        work_offsets: by name, "G54" to "G59.3" or "G54.1P1" to "G54.1P300", origin in mm and angle about Z in degrees,
            in {C}. If empty, {C} is the frame of the only work offset that the program uses.
        machine_offsets: those of the machine, for a program with several; the first one that it uses must be 0.
        work_offset: name of the one in force at the beginning, whose frame is {C}; empty if the program chooses it.
        machine_zero: tool tip position in {C}, mm, where X, Y and Z of G53 are zero: with ``work_offsets`` {C}'s own
            zero.
        home: target of G28, in {C}, mm; ``machine_zero`` if None.
        second_home: target of G30, in {C}, mm; ``machine_zero`` if None.
        start: initial tool tip position in {C}; without it motion starts once X, Y and Z are programmed.
        block_delete: whether to skip blocks that begin with ``/``, or the switches whose blocks are skipped.
        unit: length unit before G20 or G21, a key of ``UNITS``.
        flavour: one of ``FLAVOUR_NAMES``; guessed from the program if None.
        dwell_unit: unit of P of G4 and of cycles, a key of ``DWELL_UNITS``; that of the flavour if None.
        left_out: unsupported codes to skip, such as "M21".
        functions: numbers of machine-specific M codes, such as 21, which become events.
        spindle_axis: whether the spindle can be an axis; otherwise tapping is refused.
        feed: speed of cutting moves before the first F, mm/s, where F is per minute; None if unknown: such moves are
            refused.
        folders: folders searched for subprogram files, in this order.
        needs_end: whether the text is a complete program, which must end with M2, M30 or a percent sign; an MDI line is
            not.
        needs_motion: whether to refuse a program without motion.
        feed_time: s in the unit of time of F per minute (G94).
        most_reported: most faults of a kind reported individually.
    """

    tools: Mapping[int, Tool] = field(default_factory=dict)
    default_tool: Tool | None = None
    axis_words: str = "none"
    work_offsets: Mapping[str, tuple[float, float, float, float]] = field(default_factory=dict)
    machine_offsets: Mapping[str, tuple[float, float, float, float]] = field(default_factory=dict)
    work_offset: str = ""
    machine_zero: Point | None = None
    home: Point | None = None
    second_home: Point | None = None
    start: Point | None = None
    block_delete: bool | tuple[int, ...] = False
    unit: str = "mm"
    flavour: str | None = None
    dwell_unit: str | None = None
    left_out: tuple[str, ...] = ()
    functions: tuple[int, ...] = ()
    spindle_axis: bool = False
    feed: float | None = None
    folders: tuple[Path, ...] = ()
    needs_end: bool = False
    needs_motion: bool = True
    feed_time: float = 60.0
    most_reported: int = 50

    def __post_init__(self) -> None:
        if self.feed is not None and not 0 < self.feed < math.inf:
            raise ValueError(f"feed: expected a finite number above 0, got {self.feed}")
        for name, allowed in (
            ("axis_words", (*AXIS_WORDS,)),
            ("unit", (*UNITS,)),
            ("flavour", (*FLAVOUR_NAMES, None)),
            ("dwell_unit", (*DWELL_UNITS, None)),
        ):
            if getattr(self, name) not in allowed:
                expected = ", ".join(each for each in allowed if each)
                raise ValueError(f"{name}: expected one of {expected}, got {getattr(self, name)!r}")

    def tool(self, number: int) -> Tool | None:
        """The tool with that number, or the default tool."""
        return self.tools.get(number, self.default_tool)


@dataclass(frozen=True)
class ExecutionLimits:
    """Bounds of an execution.

    Attributes:
        blocks: executed blocks, including those that yield no plain block.
        operations: values and operators evaluated in expressions, and G and M codes output.
        depth: call depth, including the main program.
        files: files of subprograms.
    """

    blocks: int = 10_000_000
    operations: int = 100_000_000
    depth: int = 10
    files: int = 100

    def __post_init__(self) -> None:
        for name in ("blocks", "operations", "depth", "files"):
            if getattr(self, name) < 1:
                raise ValueError(f"{name}: expected at least 1, got {getattr(self, name)}")


DEFAULT_OPTIONS = ReadOptions()
DEFAULT_LIMITS = ExecutionLimits()
