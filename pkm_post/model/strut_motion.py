# SPDX-License-Identifier: LGPL-2.1-or-later
"""StrutMotion: six strut lengths and speeds by time, as played by a controller.

Between two knots each strut follows the unique cubic with the lengths and speeds of both (position-velocity-time,
PVT: a cubic Hermite).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.model.columns import RowType, freeze
from pkm_post.model.event import Event
from pkm_post.model.program import Array

STRUT_COLUMNS: dict[str, RowType] = {
    "time_ms": (np.int64, ()),
    "length": (np.float64, (6,)),
    "speed": (np.float64, (6,)),
}


@dataclass(frozen=True)
class StrutMotion:
    """Columns of M knots in time.

    Attributes:
        time_ms: (M,) whole milliseconds since the start, strictly increasing; dwells do not count.
        length: (M, 6) joint-to-joint strut lengths in mm.
        speed: (M, 6) their rates in mm/s.
        events: by knot: the motion rests at knot r, the event takes place, the motion continues.
    """

    time_ms: Array
    length: Array
    speed: Array
    events: tuple[Event, ...]

    def __post_init__(self) -> None:
        freeze(self, len(self.time_ms), STRUT_COLUMNS)

    def __len__(self) -> int:
        return len(self.time_ms)

    def cubics(self, rows: Array) -> tuple[Array, Array, Array, Array, Array]:
        """Cubics that begin at some knots, in the form of ``geometry.curves``.

        Args:
            rows: (N,) the knots; none of them is the last.

        Returns:
            Lengths and speeds at the beginning, lengths and speeds at the end, (N, 6) each in mm and mm/s; and the
            durations, (N,) in s.
        """
        after = rows + 1
        duration = (self.time_ms[after] - self.time_ms[rows]) / 1000
        return self.length[rows], self.speed[rows], self.length[after], self.speed[after], duration
