# SPDX-License-Identifier: LGPL-2.1-or-later
"""Options of reading CL data: the dialects of CAM systems, and settings that files omit or state wrongly."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, field

from pkm_post.model import Tool
from pkm_post.reading.units import UNITS


@dataclass(frozen=True)
class Dialect:
    """One dialect.

    Attributes:
        name: key in ``DIALECTS``.
        title: the CAM systems that write it.
        marks: regular expression for line starts unique to this dialect.
        hand: "right" or "left": sense of rotation of an arc about its given axis; "vote" if unknown.
        frames: major words that define the frame of the points; in other dialects such words are informative only.
        insert_is_tool: INSERT names the tool.
        goto_continues: further points follow on separate lines, without GOTO, and comments may hold circles.
        tight_arcs_are_centre: an arc under CUTCOM too tight for the tool to follow as a contour proves that the points
            are the tool centre; in other dialects the tool may equally be too large.
    """

    name: str
    title: str
    marks: str
    hand: str
    frames: frozenset[str] = frozenset()
    insert_is_tool: bool = False
    goto_continues: bool = False
    tight_arcs_are_centre: bool = False


DIALECTS: dict[str, Dialect] = {
    dialect.name: dialect
    for dialect in (
        Dialect("nx", "NX CLSF", r"TOOL PATH/|END-OF-PATH|PAINT/PATH|MSYS[ \t]*/|TLDATA[ \t]*/", "left",
                frozenset({"MSYS"}), goto_continues=True),
        Dialect("creo", "Creo, Pro/ENGINEER NCL", r"\$\$\*[ \t]+Pro/CLfile|\$\$->|REMARK[ \t]*->", "right",
                frozenset({"CSYS"})),
        Dialect("catia", "CATIA aptsource",
                r"\$\$[ \t]*CATIA APT|\$\$\*CATIA0|\$\$[ \t]*OPERATION NAME[ \t]*:|TLON,GOFWD", "right",
                frozenset({"CATIA0"})),
        Dialect("solidworks", "SolidWorks CAM, CAMWorks APT", r"CSI_SET_|TRNTYP/|UNIT/", "right", insert_is_tool=True,
                tight_arcs_are_centre=True),
        Dialect("camplete", "Fusion, HSMWorks for CAMplete", r"MCS[ \t]*/|CSI_", "left", frozenset({"MCS"})),
        Dialect("makino", "Makino FF APT-CL", r"PPRINT/APTCL-SPEC,MAKINO|PPRINT/BEGIN-SECTION", "left"),
        Dialect("apt", "NCL, APT", r"(?!)", "vote", frozenset({"MSYS", "CSYS", "CATIA0", "MCS", "MCSYS"}),
                goto_continues=True),
    )
}  # fmt: skip
"""The dialects by name, the most specific ones first."""

_SEARCHED = 200_000
"""Characters of a file searched to detect its dialect."""


def detect_dialect(text: str) -> Dialect:
    """The dialect matched by most lines at the start of a text; "apt" if none matches."""
    head = text[:_SEARCHED]
    counts = {
        name: len(re.findall(rf"^[ \t]*(?:{dialect.marks})", head, re.MULTILINE | re.IGNORECASE))
        for name, dialect in DIALECTS.items()
    }
    best = max(counts, key=lambda name: counts[name])
    return DIALECTS[best if counts[best] else "apt"]


POINT = ("x", "y", "z")
AXIS = ("i", "j", "k")
NORMAL = ("nx", "ny", "nz")
CONTACT = ("px", "py", "pz")
GOTO_VALUES = (POINT, AXIS, NORMAL, CONTACT)
"""Possible meanings of the values of a GOTO, by vector."""
_HANDS = ("right", "left", "vote")
_FRAMES = ("first", "absolute")
CONTOUR_DATA = ("centre", "contour")
"""Possible meanings of the points under CUTCOM."""
CYCLE_VALUES = ("depth", "feed", "clearance", "return", "step", "dwell", "diameter")
"""Possible meanings of a number without a word in a CYCLE statement; "diameter" is that of a countersink."""
CYCLE_STROKES = ("drill", "deep", "break", "ream")
"""Strokes that a kind of cycle may have."""
_KIND = re.compile(r"\w+(?:,\w+)?", re.ASCII)


@dataclass(frozen=True)
class ReadOptions:
    """Settings for reading CL data.

    Attributes:
        dialect: name in ``DIALECTS``; detected from the file if None.
        units: key of ``UNITS``; overrides the file.
        hand: "right", "left" or "vote": sense of rotation of arcs about their axis; overrides the dialect. "vote"
            selects for the whole file the sense under which most arcs are shorter than half a turn.
        goto_values: for GOTO with other than 3 or 6 values the meaning of each value: "x y z", "i j k" the tool axis,
            "nx ny nz" the surface normal, "px py pz" the contact point. With "x y z", the tool tip, the contact point
            is ignored; without it, compensation computes the tip from contact point and normal.
        cycle_values: meanings of the numbers that follow the kind of a CYCLE statement without words, in order, out of
            ``CYCLE_VALUES``: depth down from the point, clearance and return height up from it.
        cycle_kinds: strokes, out of ``CYCLE_STROKES``, of kinds of cycles by their words, such as "BORE"; they override
            those of the CAM system.
        feed: speed of cutting moves before the first FEDRAT, mm/s; None if unknown: such moves are refused.
        machine_zero: home position of the tool tip in the work frame, mm, for GOHOME without a point; None if unknown.
        frame: "first": the work frame is the first machining frame of the file; "absolute": the frame those are defined
            in.
        tools: by number; they override the tool data of the file, except for a missing name or length.
        contour_data: "centre" or "contour": meaning of the points under CUTCOM; overrides the file.
        wear: mm by tool number, added to the tool radius as the path offset of CUTCOM, or the whole offset where the
            points are the tool centre; negative for a smaller cutter.
        default_tool: supplies the gauge length of tools for which neither the file nor ``tools`` has one.
        needs_end: whether the text is a complete file, which must end with FINI, or END-OF-PATH or similar.
    """

    dialect: str | None = None
    units: str | None = None
    hand: str | None = None
    goto_values: Mapping[int, tuple[str, ...]] = field(default_factory=dict)
    cycle_values: tuple[str, ...] = ()
    cycle_kinds: Mapping[str, str] = field(default_factory=dict)
    feed: float | None = None
    machine_zero: tuple[float, float, float] | None = None
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
        if self.feed is not None and not (math.isfinite(self.feed) and self.feed > 0):
            raise ValueError(f"feed: expected a finite number above 0, got {self.feed}")
        for number, wear in self.wear.items():
            if not math.isfinite(wear):
                raise ValueError(f"wear: expected finite lengths, got {wear} for tool {number}")
        if len(set(self.cycle_values)) != len(self.cycle_values) or not {*self.cycle_values} <= {*CYCLE_VALUES}:
            raise ValueError(f"cycle_values: expected different names out of {CYCLE_VALUES}, got {self.cycle_values!r}")
        for kind, strokes in self.cycle_kinds.items():
            if not _KIND.fullmatch(kind) or kind != kind.upper() or strokes not in CYCLE_STROKES:
                raise ValueError(f"cycle_kinds: expected words and one of {CYCLE_STROKES}, got {kind!r}: {strokes!r}")
        for count, names in self.goto_values.items():
            whole = {name for each in GOTO_VALUES if {*each} & {*names} for name in each}
            placed = {*POINT} <= {*names} or {*CONTACT, *NORMAL} <= {*names}
            if len(names) != count or len(set(names)) != count or not placed or {*names} != whole:
                expected = "x, y, z, or px, py, pz and nx, ny, nz"
                raise ValueError(f"goto_values: expected {count} different names with {expected}, got {names!r}")

    def value_names(self, count: int) -> tuple[str, ...] | None:
        """Meanings of the values of a GOTO, None if unknown."""
        return self.goto_values.get(count, {3: POINT, 6: POINT + AXIS}.get(count))
