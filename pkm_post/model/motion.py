# SPDX-License-Identifier: LGPL-2.1-or-later
"""Motion: tool poses by path parameter or time in the machine frame {M}, and strut lengths by time.

Units: mm, rad, s; times of knots in whole milliseconds. Between two knots each strut follows the unique cubic with the
lengths and speeds of both (position-velocity-time, PVT: a cubic Hermite).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.model.columns import Array, RowType, freeze, uniform
from pkm_post.model.program import Event

AT_FEED = 0.95
"""Fraction of a feed at which it counts as reached."""
_VECTOR: RowType = (np.float64, (3,))
_NUMBER: RowType = (np.float64, ())
MOTION_BY_TIME: dict[str, RowType] = {
    "time_ms": (np.int64, ()),
    "tip": (np.float64, (3,)),
    "axis": (np.float64, (3,)),
    "spin": (np.float64, ()),
    "tip_rate": (np.float64, (3,)),
    "axis_rate": (np.float64, (3,)),
    "spin_rate": (np.float64, ()),
    "tool_length": (np.float64, ()),
    "segment": (np.int32, ()),
}
STRUT_COLUMNS: dict[str, RowType] = {
    "time_ms": (np.int64, ()),
    "length": (np.float64, (6,)),
    "speed": (np.float64, (6,)),
}


@dataclass(frozen=True)
class Poses:
    """Columns of N tool poses in {M}; ``_1`` and ``_2`` are derivatives by the same parameter.

    Attributes:
        tip, tip_1, tip_2: (N, 3) tool tip in mm.
        axis, axis_1, axis_2: (N, 3) unit tool axis.
        spin, spin_1, spin_2: (N,) rotation of the platform about the tool axis.
        tool_length: (N,) gauge length of the tool in use.
        segment: (N,) trajectory segment the pose lies on.
    """

    tip: Array
    tip_1: Array
    tip_2: Array
    axis: Array
    axis_1: Array
    axis_2: Array
    spin: Array
    spin_1: Array
    spin_2: Array
    tool_length: Array
    segment: Array

    def __post_init__(self) -> None:
        vectors = dict.fromkeys(("tip", "tip_1", "tip_2", "axis", "axis_1", "axis_2"), _VECTOR)
        numbers = dict.fromkeys(("spin", "spin_1", "spin_2", "tool_length"), _NUMBER)
        freeze(self, len(self.tip), vectors | numbers | {"segment": (np.int64, ())})

    def __len__(self) -> int:
        return len(self.tip)


@dataclass(frozen=True)
class Motion:
    """Columns of M knots in time.

    Attributes:
        time_ms: (M,) whole milliseconds since the start, strictly increasing; dwells do not count.
        tip: (M, 3) tool tip.
        axis: (M, 3) unit tool axis.
        spin: (M,) spin.
        tip_rate: (M, 3) velocity of the tip, mm/s.
        axis_rate: (M, 3) rate of the unit tool axis, 1/s.
        spin_rate: (M,) rate of the spin, rad/s.
        tool_length: (M,) gauge length of the tool in use.
        segment: (M,) trajectory segment of the knot; the earlier one at a joint.
        joint_time: (N,) s, time at the end of each of the N trajectory segments.
        events: by knot: the motion stops at knot r, the event takes place, the motion resumes.
    """

    time_ms: Array
    tip: Array
    axis: Array
    spin: Array
    tip_rate: Array
    axis_rate: Array
    spin_rate: Array
    tool_length: Array
    segment: Array
    joint_time: Array
    events: tuple[Event, ...]

    def __post_init__(self) -> None:
        freeze(self, len(self.time_ms), MOTION_BY_TIME)
        freeze(self, len(self.joint_time), {"joint_time": (np.float64, ())})

    def __len__(self) -> int:
        return len(self.time_ms)

    def poses(self, rows: slice | Array = slice(None)) -> Poses:
        """Poses at all or some knots, with their rates; second derivatives are unknown and set to zero."""
        tip = self.tip[rows]
        unknown = uniform([0.0] * 3, len(tip))
        return Poses(
            tip=tip,
            tip_1=self.tip_rate[rows],
            tip_2=unknown,
            axis=self.axis[rows],
            axis_1=self.axis_rate[rows],
            axis_2=unknown,
            spin=self.spin[rows],
            spin_1=self.spin_rate[rows],
            spin_2=unknown[:, 0],
            tool_length=self.tool_length[rows],
            segment=self.segment[rows],
        )


@dataclass(frozen=True)
class FeedStudy:
    """The feed along a motion, at M even instants: columns in mm/s.

    Attributes:
        time: (M,) s.
        programmed: (M,) programmed feed.
        possible: (M,) highest tip speed that the machine limits allow there.
        planned: (M,) tip speed.
        limit: (M,) index into ``limits`` of the limit that binds; -1 where the plan is at the programmed feed.
        limits: names of the limits.
        row: (M,) segment of the trajectory.
        cutting: (M,) whether the move is at feed rather than rapid.
    """

    time: Array
    programmed: Array
    possible: Array
    planned: Array
    limit: Array
    limits: tuple[str, ...]
    row: Array
    cutting: Array

    def __post_init__(self) -> None:
        numbers = dict.fromkeys(("time", "programmed", "possible", "planned"), _NUMBER)
        rows: dict[str, RowType] = {"limit": (np.int64, ()), "row": (np.int64, ()), "cutting": (np.bool_, ())}
        freeze(self, len(self.time), numbers | rows)


@dataclass(frozen=True)
class SpindleTurns:
    """The spindle as an axis: S knots of a motion, all but the first of each thread.

    At the first knot of a thread, where the spindle becomes an axis, it is at 0 turns and at rest. Between two knots it
    follows the cubic of both, as the struts do.

    Attributes:
        knot: (S,) knots, strictly increasing.
        angle: (S,) turns, positive clockwise seen from the spindle.
        speed: (S,) turns/s.
    """

    knot: Array
    angle: Array
    speed: Array

    def __post_init__(self) -> None:
        freeze(self, len(self.knot), {"knot": (np.int64, ()), "angle": _NUMBER, "speed": _NUMBER})

    def __len__(self) -> int:
        return len(self.knot)

    def slice(self, first: int, last: int) -> SpindleTurns:
        """The turns of a part of the motion, with knots counted from its first."""
        rows = (self.knot > first) & (self.knot <= last)
        return SpindleTurns(self.knot[rows] - first, self.angle[rows], self.speed[rows])


NO_TURNS = SpindleTurns(np.zeros(0), np.zeros(0), np.zeros(0))
"""For a motion without threads."""


@dataclass(frozen=True)
class StrutMotion:
    """Columns of M knots in time.

    Attributes:
        time_ms: (M,) whole milliseconds since the start, strictly increasing; dwells do not count.
        length: (M, 6) joint-to-joint strut lengths in mm.
        speed: (M, 6) their rates in mm/s.
        events: by knot: the motion stops at knot r, the event takes place, the motion resumes.
        turns: the spindle at the knots of threads; none by default.
    """

    time_ms: Array
    length: Array
    speed: Array
    events: tuple[Event, ...]
    turns: SpindleTurns = NO_TURNS

    def __post_init__(self) -> None:
        freeze(self, len(self.time_ms), STRUT_COLUMNS)

    def __len__(self) -> int:
        return len(self.time_ms)

    def cubics(self, rows: Array) -> tuple[Array, Array, Array, Array, Array]:
        """Cubics that start at the given knots, in the form of ``geometry.curves``.

        Args:
            rows: (N,) the knots, without the last.

        Returns:
            Lengths and speeds at the start, lengths and speeds at the end, (N, 6) each in mm and mm/s; and the
            durations, (N,) in s.
        """
        after = rows + 1
        duration = (self.time_ms[after] - self.time_ms[rows]) / 1000
        return self.length[rows], self.speed[rows], self.length[after], self.speed[after], duration
