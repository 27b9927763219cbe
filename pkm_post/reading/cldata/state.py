# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reader state: the modal state that statements set, in file order, and the records they leave.

Each change is recorded with its statement row; the affected motions are found later, all at once. Lengths are in mm and
times in s; points, axes and arcs stay as written.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from pkm_post.model import Array, EventKind, Tool
from pkm_post.reading.cldata.cycle_notation import Cycle
from pkm_post.reading.cldata.diagnostics import StatementDiagnostics
from pkm_post.reading.cldata.options import Dialect, ReadOptions
from pkm_post.reading.cldata.statements import Statement, Statements
from pkm_post.reading.units import UNITS

Vector = tuple[float, ...]


@dataclass(frozen=True)
class LengthUnit:
    """The unit of a file.

    Attributes:
        name: a key of ``options.UNITS``; empty if the file does not define it.
        evidence: the defining words and their location; or the reason why there is no unit.
        stated: whether UNITS defines it.
        contradiction: a feed of the other unit, empty if there is none.
    """

    name: str
    evidence: str
    stated: bool = False
    contradiction: str = ""


@dataclass(frozen=True)
class Feed:
    """A feed: mm/s, or 1/s for inverse time; NaN if there is none, per turn of a spindle whose speed is unknown."""

    value: float
    inverse: bool = False
    per_turn: bool = False


@dataclass(frozen=True)
class SurfaceSpeed:
    """A SPINDL in SMM or SFM: its event, motions before it, mm/min at the edge of the cutter, sense, and tool."""

    event: int
    motions: int
    speed: float
    sense: float
    tool: int


@dataclass(frozen=True)
class Arc:
    """An arc that ends at the next point.

    Attributes:
        centre: as written.
        axis: as written.
        radius: as written, NaN if not given.
        angle: sweep in rad, NaN if not given.
        turns: full turns before the remaining sweep.
        sense: sense of rotation: 1 right-handed about its axis, -1 left-handed, 0 if not given.
        seen_from_tool: the sense is about the tool axis, regardless of the direction of the arc axis.
        minor: the arc is less than half a turn.
        rise: along the axis, either way, as written; NaN if not given.
    """

    centre: Vector
    axis: Vector
    radius: float = float("nan")
    angle: float = float("nan")
    turns: int = 0
    sense: float = 0.0
    seen_from_tool: bool = False
    minor: bool = False
    rise: float = float("nan")


@dataclass(frozen=True)
class ArcData:
    """A circle pending its motion, its row, and the rise or fall of the tool on it, as written."""

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
    """A point not given by a plain GOTO.

    Attributes:
        position: as written.
        axis: as written, None if absent.
        start: it is the current tool position, not a target (FROM).
    """

    position: Vector
    axis: Vector | None = None
    start: bool = False


@dataclass(frozen=True)
class PointMeaning:
    """Statement of the file about its points under CUTCOM: "centre" or "contour", and its wording."""

    points: str
    words: str


@dataclass(frozen=True)
class Cutcom:
    """A CUTCOM that begins, changes or ends compensation, or goes on with another cutter.

    Attributes:
        row: the statement from which it applies: its own, or that of the cutter.
        written: its statement.
        side: 1 for LEFT, -1 for RIGHT, 0 for OFF.
        plane: the coordinate normal to the named plane; None if no plane is named.
        tool: tool number.
        radius: tool radius, mm; 0 if unknown.
        point_meaning: as stated by the file, None if it states none.
    """

    row: int
    written: int
    side: float
    plane: int | None
    tool: int
    radius: float
    point_meaning: PointMeaning | None


@dataclass
class NurbsMotion:
    """One motion along a curve of MOVNRB, as written.

    Attributes:
        row: its first statement.
        counts: order, knots, weights and control points, as stated; empty before MOVNRB/ON.
        five_axis: whether there is a second curve.
        values: the knots (1), and coordinates of the control points (2 and 3).
        points: statement rows of NEXT and OFF; 0 before.
    """

    row: int
    five_axis: bool = False
    counts: list[float] = field(default_factory=list)
    values: dict[float, list[float]] = field(default_factory=lambda: {1.0: [], 2.0: [], 3.0: []})
    points: tuple[int, int] = (0, 0)


@dataclass
class ReaderState:
    """Modal state during reading, and the recorded changes, each with its statement row.

    Attributes:
        statements: of the file.
        dialect: of the file.
        options: of the user.
        faults: collects the faults.
        goto_rows: rows of the plain GOTO statements.
        gotos_before: (N,) their count up to each row.
        file_unit: the length unit of the file.
        scale: mm per active length unit.
        unit: name of that unit.
        feed_word: unit of feeds that are written without one.
        feed_per_turn: mm per revolution, 0 if the feed is not per revolution.
        feed: active feed of moves, None before the first.
        spindle_speed: 1/min; NaN for a surface speed of a cutter that is not yet known.
        spindle_sense: 1 clockwise, -1 counterclockwise; the last one while it is stopped.
        spindle_on: whether it turns.
        spindle_limit: of surface speeds, 1/min; 0 if none.
        surface_speed: the last speed, if it is one of the surface.
        coolant: the last one that was on.
        tool: active tool number.
        changed_tool: tool number of the last tool change, -1 before the first.
        motions_at_change: number of motions before it.
        motions_recorded: number of motions before the last tool was recorded.
        inserted_name: tool name for the next cutter.
        tool_name: of the active cutter.
        tool_length: mm, 0 if unknown.
        diameter: mm.
        corner_radius: mm.
        corner_known: whether the file gives it.
        bottom_angle: rad.
        side_angle: rad.
        point_angle: of its tip, rad; 0 if unknown.
        point_meaning: of the points under CUTCOM, None if the file does not state it.
        cycle: last cycle, also after CYCLE/OFF.
        cycle_return: INIT or CLEAR, the return height of the next cycles; empty before.
        machining_frame: (4, 4) active frame of the points, mm.
        transforms: (4, 4) by word, active ones of ORIGIN, TRANS, TRACUT, TRACUT/LAST and COPY, mm.
        work_from_file: (4, 4) from the frame in which machining frames are defined to the work frame, mm.
        tangent: start direction of the next TLON,GOFWD.
        part_surface: of PSIS; None for the tool position.
        arc_rise: of the next ARCDAT or MOVARC, as written.
        arc_data: circle of the next ARCMOV.
        end_of_program: row of the last END or REWIND, -1 before.
        ended: whether FINI was read.
        tools: by number.
        used_cutters: by number, diameter, corner radius and angles of the cutters that were used as this tool.
        stated_lengths: by number, the different gauge lengths that the file gives a tool, mm.
        operations: names; the first is that of the rows before any operation.
    """

    statements: Statements
    dialect: Dialect
    options: ReadOptions
    faults: StatementDiagnostics
    goto_rows: Array
    gotos_before: Array
    file_unit: LengthUnit

    scale: float = 1.0
    unit: str = ""
    feed_word: str = "PERMIN"
    feed_per_turn: float = 0.0
    feed: Feed | None = None
    spindle_speed: float = 0.0
    spindle_sense: float = 1.0
    spindle_on: bool = False
    spindle_limit: float = 0.0
    surface_speed: SurfaceSpeed | None = None
    coolant: float = 1.0
    tool: int = 0
    changed_tool: int = -1
    motions_at_change: int = 0
    motions_recorded: int = 0
    inserted_name: str = ""
    tool_name: str = ""
    tool_length: float = 0.0
    diameter: float = 0.0
    corner_radius: float = 0.0
    corner_known: bool = False
    bottom_angle: float = 0.0
    side_angle: float = 0.0
    point_angle: float = 0.0
    point_meaning: PointMeaning | None = None
    cycle: Cycle | None = None
    cycle_return: str = ""
    machining_frame: Array | None = None
    work_from_file: Array | None = None
    tangent: Vector | None = None
    part_surface: Plane | None = None
    arc_rise: float = 0.0
    arc_data: ArcData | None = None
    end_of_program: int = -1
    ended: bool = False

    transforms: dict[str, Array] = field(default_factory=dict)
    tools: dict[int, Tool] = field(default_factory=dict)
    used_cutters: dict[int, set[tuple[float, ...]]] = field(default_factory=dict)
    stated_lengths: dict[int, list[float]] = field(default_factory=dict)
    operations: list[str] = field(default_factory=lambda: [""])
    operation_starts: list[tuple[int, int]] = field(default_factory=list)
    points: list[tuple[int, Point]] = field(default_factory=list)
    rapids: list[int] = field(default_factory=list)
    feeds: list[tuple[int, Feed]] = field(default_factory=list)
    axes: list[tuple[int, Vector]] = field(default_factory=list)
    scales: list[tuple[int, float]] = field(default_factory=list)
    frames: list[tuple[int, Array]] = field(default_factory=list)
    arcs: list[tuple[int, Arc]] = field(default_factory=list)
    arc_reading: list[str] = field(default_factory=list)
    commented_circles: list[tuple[int, Arc]] = field(default_factory=list)
    cycles: list[tuple[int, Cycle | None]] = field(default_factory=list)
    cycle_interpretations: dict[str, list[int]] = field(default_factory=dict)
    cutcoms: list[Cutcom] = field(default_factory=list)
    nurbs: list[NurbsMotion] = field(default_factory=list)
    events: list[tuple[int, EventKind, float]] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.unit = self.options.units or self.file_unit.name or "mm"
        self.scale = UNITS[self.unit]
        self.scales.append((-1, self.scale))
        if self.options.feed is not None:
            self.set_feed(-1, Feed(self.options.feed))

    def report(self, code: str, row: int, found: str) -> None:
        """Report a fault of a statement."""
        self.faults.add(code, self.statements.place(row), found)

    def report_items(self, row: int, statement: Statement, expected: str) -> None:
        """Report a statement whose items are not those expected."""
        self.report("L402", row, f"{statement.word}/{statement.items_text()}, expected {expected}")

    def expect_values(self, row: int, statement: Statement, *counts: int) -> list[float]:
        """The values of a statement; empty, with a fault, unless their number is one of the counts."""
        values = statement.values
        if len(values) in counts:
            return values
        self.report_items(row, statement, f"{' or '.join(map(str, counts))} values")
        return []

    @property
    def turning_speed(self) -> float:
        """The speed of the spindle, 1/min; 0 while it is stopped."""
        return self.spindle_speed if self.spindle_on else 0.0

    def motions_before(self, row: int) -> int:
        """Number of motions before a statement, with all preceding statements read."""
        return int(self.gotos_before[row]) + sum(at < row and not point.start for at, point in self.points)

    def set_feed(self, row: int, feed: Feed) -> None:
        """Set the feed from here on."""
        self.feed = feed
        self.feeds.append((row, feed))
