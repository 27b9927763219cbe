# SPDX-License-Identifier: LGPL-2.1-or-later
"""Course: what the statements of a file set, in the order of the file, while they are read one after the other.

What a statement changes is noted with the row of the statement; which motions it concerns is found afterwards
for all at once. Lengths are in mm and times in s from here on; points stay as written until then.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from pkm_post.cldata.cycles import Cycle
from pkm_post.cldata.dialects import Dialect
from pkm_post.cldata.faults import Faults
from pkm_post.cldata.length_unit import LengthUnit
from pkm_post.cldata.options import UNITS, ReadOptions
from pkm_post.cldata.statements import Statements
from pkm_post.model import EventKind, Tool
from pkm_post.model.program import Array

Vector = tuple[float, ...]


@dataclass(frozen=True)
class Feed:
    """A feed: mm/s, or one over seconds if it is inverse time."""

    value: float
    inverse: bool = False


@dataclass(frozen=True)
class Arc:
    """An arc that ends at the next point.

    Attributes:
        centre: as written.
        axis: as written.
        radius: as written, NaN if it is not given.
        angle: rad that it turns, NaN if that is not given.
        turns: full turns that it makes before the rest.
        way: 1 if it turns right-handed about its axis, -1 if left-handed, 0 if that is not given.
        seen_from_tool: the way is about the tool axis, whichever way the axis of the arc points.
        shorter: it is less than half a turn.
    """

    centre: Vector
    axis: Vector
    radius: float = float("nan")
    angle: float = float("nan")
    turns: int = 0
    way: float = 0.0
    seen_from_tool: bool = False
    shorter: bool = False


@dataclass(frozen=True)
class ArcData:
    """A circle that waits for its motion, its row, and how far the tool rises or falls on it, as written."""

    row: int
    arc: Arc
    rise: float


@dataclass(frozen=True)
class Plane:
    """A plane: its unit normal as written, and its distance from the origin along it, mm."""

    normal: Vector
    distance: float


@dataclass(frozen=True)
class Point:
    """A point that no plain GOTO gives.

    Attributes:
        position: as written.
        axis: as written, None if the point has none.
        start: it is where the tool is, not where it goes (FROM).
    """

    position: Vector
    axis: Vector | None = None
    start: bool = False


@dataclass(frozen=True)
class Said:
    """What the file says of its points under CUTCOM: "centre" or "contour", in its own words, and in which row."""

    points: str
    words: str
    row: int


@dataclass(frozen=True)
class Cutcom:
    """A CUTCOM that begins, changes or ends compensation.

    Attributes:
        row: its statement.
        side: 1 for LEFT, -1 for RIGHT, 0 for OFF.
        plane: the coordinate that the plane it names is normal to; None if it names none.
        tool: number of the tool.
        radius: of the tool, mm; 0 where it is not known.
        said: what the points are, None if the file does not say so.
    """

    row: int
    side: float
    plane: int | None
    tool: int
    radius: float
    said: Said | None


@dataclass
class Course:
    """State while reading, and what was noted, each with the row of its statement.

    ``goto_rows`` are the rows of plain GOTO statements, ``gotos_before`` is for each row their number before it;
    ``file_unit`` is what the file says of its lengths.
    """

    statements: Statements
    dialect: Dialect
    options: ReadOptions
    faults: Faults
    goto_rows: Array
    gotos_before: Array
    file_unit: LengthUnit

    scale: float = 1.0
    unit: str = ""
    feed_word: str = "PERMIN"
    feed_per_turn: float = 0.0
    feed: Feed | None = None
    speed: float = 0.0
    turning: float = 0.0
    tool: int = 0
    insert: str = ""
    tool_name: str = ""
    tool_changed: int = -1
    motions_settled: int = 0
    motions_at_change: int = 0
    diameter: float = 0.0
    corner: float = 0.0
    corner_known: bool = False
    bottom_angle: float = 0.0
    side_angle: float = 0.0
    length: float = 0.0
    points_said: Said | None = None
    cycle_return: str = ""
    cycle: Cycle | None = None
    local: Array | None = None
    shift: Array | None = None
    work_from_given: Array | None = None
    tangent: Vector | None = None
    part_surface: Plane | None = None
    slope: float = 0.0
    arc_data: ArcData | None = None
    ended: bool = False

    tools: dict[int, Tool] = field(default_factory=dict)
    operations: list[str] = field(default_factory=lambda: [""])
    points: list[tuple[int, Point]] = field(default_factory=list)
    rapids: list[int] = field(default_factory=list)
    feeds: list[tuple[int, Feed]] = field(default_factory=list)
    axes: list[tuple[int, Vector]] = field(default_factory=list)
    scales: list[tuple[int, float]] = field(default_factory=list)
    frames: list[tuple[int, Array]] = field(default_factory=list)
    arcs: list[tuple[int, Arc]] = field(default_factory=list)
    circles: list[tuple[int, Arc]] = field(default_factory=list)
    cycles: list[tuple[int, Cycle | None]] = field(default_factory=list)
    cycles_read: dict[str, list[int]] = field(default_factory=dict)
    cutcoms: list[Cutcom] = field(default_factory=list)
    starts: list[tuple[int, int]] = field(default_factory=list)
    events: list[tuple[int, EventKind, float]] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.unit = self.options.units or self.file_unit.name or "mm"
        self.scale = UNITS[self.unit]
        self.scales.append((-1, self.scale))

    def tell(self, code: str, row: int, found: str) -> None:
        """Note a fault of a statement."""
        self.faults.add(code, self.statements.place(row), found)

    def set_feed(self, row: int, feed: Feed) -> None:
        """From here on this feed."""
        self.feed = feed
        self.feeds.append((row, feed))
