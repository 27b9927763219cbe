# SPDX-License-Identifier: LGPL-2.1-or-later
"""Options of reading CL data: what files leave open, or say wrongly."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from pkm_post.cldata.dialects import DIALECTS
from pkm_post.model import Tool

UNITS: dict[str, float] = {"mm": 1.0, "inch": 25.4}
"""mm in one unit of length."""

POINT = ("x", "y", "z")
AXIS = ("i", "j", "k")
NORMAL = ("nx", "ny", "nz")
CONTACT = ("px", "py", "pz")
_VALUES = {*POINT, *AXIS, *NORMAL, *CONTACT}
_HANDS = ("right", "left", "vote")
_FRAMES = ("first", "absolute")
CONTOUR_DATA = ("centre", "contour")
"""What the points under CUTCOM can be."""
CYCLE_VALUES = ("depth", "feed", "clearance", "return", "step", "dwell")
"""What a number without a word in a CYCLE statement may be."""


@dataclass(frozen=True)
class ReadOptions:
    """How CL data is to be read.

    Attributes:
        dialect: name in ``DIALECTS``; detected from the file if None.
        units: key of ``UNITS``; overrides what the file says.
        hand: "right", "left" or "vote": how arcs turn about their axis; overrides the dialect. "vote" takes for the
            whole file the hand under which most arcs are shorter than half a turn.
        goto_values: for GOTO with other than 3 or 6 values what each value is: "x y z", "i j k" the tool axis,
            "nx ny nz" the surface normal, "px py pz" the contact point, which is not used.
        cycle_values: what the numbers of a CYCLE statement are that follows its kind without words, in order, out of
            ``CYCLE_VALUES``: depth down from the point, clearance and return height up from it.
        frame: "first": the work frame is the first machining frame of the file; "absolute": the frame that those
            are given in.
        tools: by number; they take precedence over what the file says of them, but for a name and a length that they
            do not have.
        contour_data: "centre" or "contour": what the points under CUTCOM are; overrides what the file says.
        wear: mm by tool number that CUTCOM offsets the path by beside the radius of the tool, or alone where the
            points are the centre of the tool; below 0 for a cutter that is smaller.
        default_tool: gives the gauge length of tools for which neither the file nor ``tools`` has one.
        needs_end: whether the text is a whole file, which FINI, or END-OF-PATH and its like, has to end.
    """

    dialect: str | None = None
    units: str | None = None
    hand: str | None = None
    goto_values: Mapping[int, tuple[str, ...]] = field(default_factory=dict)
    cycle_values: tuple[str, ...] = ()
    frame: str = "first"
    tools: Mapping[int, Tool] = field(default_factory=dict)
    contour_data: str | None = None
    wear: Mapping[int, float] = field(default_factory=dict)
    default_tool: Tool | None = None
    needs_end: bool = False

    def __post_init__(self) -> None:
        tables: dict[str, tuple[str | None, ...]] = {
            "dialect": (None, *DIALECTS),
            "units": (None, *UNITS),
            "hand": (None, *_HANDS),
            "frame": _FRAMES,
            "contour_data": (None, *CONTOUR_DATA),
        }
        for name, allowed in tables.items():
            if getattr(self, name) not in allowed:
                raise ValueError(f"{name}: expected one of {allowed}, got {getattr(self, name)!r}")
        for number, wear in self.wear.items():
            if not math.isfinite(wear):
                raise ValueError(f"wear: expected finite lengths, got {wear} for tool {number}")
        if len(set(self.cycle_values)) != len(self.cycle_values) or not {*self.cycle_values} <= {*CYCLE_VALUES}:
            raise ValueError(f"cycle_values: expected different names out of {CYCLE_VALUES}, got {self.cycle_values!r}")
        for count, names in self.goto_values.items():
            if len(names) != count or len(set(names)) != count or not {*POINT} <= {*names} <= _VALUES:
                raise ValueError(f"goto_values: expected {count} different names with x, y, z, got {names!r}")

    def value_names(self, count: int) -> tuple[str, ...] | None:
        """What the values of a GOTO are, None if that is not known."""
        return self.goto_values.get(count, {3: POINT, 6: POINT + AXIS}.get(count))
