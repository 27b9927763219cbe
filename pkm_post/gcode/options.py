# SPDX-License-Identifier: LGPL-2.1-or-later
"""Options: what a G-code program does not say itself and a person has to say for it.

Enters: choices of the user, lengths in mm, angles in degrees as people give them. Leaves: one frozen value that is
handed to every step that reads. Nothing here is guessed: what is not given and is needed is a fault of the program.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from pkm_post.model import Tool

Point = tuple[float, float, float]

AXIS_WORDS: dict[str, str] = {"none": "", "vector": "IJK", "AC": "AC", "BC": "BC", "AB": "AB", "RPY": "ABC"}
"""For each way to say the tool axis the letters that say it."""

VECTOR_WORDS: dict[str, tuple[str, ...]] = {"I": ("I", "A3", "TX"), "J": ("J", "B3", "TY"), "K": ("K", "C3", "TZ")}
"""For each component of a vector the words that say it, in the dialects there are."""

NORMAL_WORDS = ("NX", "NY", "NZ")
"""The words of the surface normal."""


def axis_names(axis_words: str) -> tuple[str, ...]:
    """The words that move the tool axis, in all dialects."""
    letters = AXIS_WORDS[axis_words]
    return tuple(name for letter in letters for name in VECTOR_WORDS.get(letter, (letter,)))


UNITS: dict[str, float] = {"mm": 1.0, "inch": 25.4}
"""mm in one unit of length."""

DWELL_UNITS: dict[str, float] = {"s": 1.0, "ms": 0.001}
"""s in one unit of dwells."""


@dataclass(frozen=True)
class ReadOptions:
    """How a G-code program is to be read.

    Attributes:
        tools: the tools in the magazine, by number; D and H words name them as well.
        default_tool: stands in for every tool that is not among them, and for the tool of a program that calls none.
        axis_words: how the tool axis is said, a key of ``AXIS_WORDS``: "vector" is I J K after G43.5 and what other
            controls write for it, A3= B3= C3= after TRAORI and TX TY TZ after LN; "AC", "BC" and "AB" are rotary words
            after G43.4, "RPY" those of LinuxCNC's hexapod: k = Rz(C) Ry(B) Rx(A) e_z.
        work_offsets: by name, "G54" to "G59.3", origin in mm and angle about Z in degrees, in {C}. Without any, {C} is
            the frame of the one work offset that the program uses.
        home: where G28 goes, in {C}, mm.
        second_home: where G30 goes.
        start: where the tool tip is before the program, in {C}; without it nothing moves before X, Y and Z are said.
        block_delete: whether blocks that begin with ``/`` are left out.
        unit: of lengths before G20 or G21, a key of ``UNITS``.
        dwell_unit: of P of G4 and of cycles, a key of ``DWELL_UNITS``.
        needs_end: whether the text is a whole program, which M2, M30 or a percent sign has to end; a line typed by
            hand is none.
    """

    tools: Mapping[int, Tool] = field(default_factory=dict)
    default_tool: Tool | None = None
    axis_words: str = "none"
    work_offsets: Mapping[str, tuple[float, float, float, float]] = field(default_factory=dict)
    home: Point | None = None
    second_home: Point | None = None
    start: Point | None = None
    block_delete: bool = False
    unit: str = "mm"
    dwell_unit: str = "s"
    needs_end: bool = False

    def __post_init__(self) -> None:
        for name, allowed in (("axis_words", AXIS_WORDS), ("unit", UNITS), ("dwell_unit", DWELL_UNITS)):
            if getattr(self, name) not in allowed:
                raise ValueError(f"{name}: expected one of {', '.join(allowed)}, got {getattr(self, name)!r}")

    def tool(self, number: int) -> Tool | None:
        """The tool of that number, or what stands in for it."""
        return self.tools.get(number, self.default_tool)
