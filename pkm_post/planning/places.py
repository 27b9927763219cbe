# SPDX-License-Identifier: LGPL-2.1-or-later
"""Places: where intervals of a motion are checked: at the joints of the path, and between them.

The interpolated motion deviates most from the plan near a joint, or near the middle between two of them. Enters: times
of the joints, and intervals of time. Leaves: instants, ordered by interval, with the segments they belong to.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from pkm_post.geometry import Array, expand_counts

_ROUNDING = 1e-9
"""Tolerance on a number of gaps, so that rounding does not add one."""


@dataclass(frozen=True)
class Places:
    """M instants in N intervals, ordered by interval.

    Attributes:
        row: (M,) the interval.
        share: (M,) elapsed share of the duration of the interval.
        time: (M,) s.
        segment: (M,) the segment of the path at that time; at a joint the one before it.
    """

    row: Array
    share: Array
    time: Array
    segment: Array

    def most(self, values: Array, count: int) -> Array:
        """The maximum of values at the places, (M,), for each of ``count`` intervals; 0 where there is no place."""
        most, first = np.zeros(count), np.flatnonzero(np.diff(self.row, prepend=-1))
        if len(first):
            most[self.row[first]] = np.maximum.reduceat(values, first)
        return most


@dataclass(frozen=True)
class Intervals:
    """N intervals of a motion.

    Attributes:
        start: (N,) whole ms.
        end: (N,) whole ms.
        first: (N,) the segment on which it begins.
        last: (N,) the segment on which it ends.
    """

    start: Array
    end: Array
    first: Array
    last: Array

    @classmethod
    def of(cls, joint_time: Array, start: Array, end: Array) -> Intervals:
        """The intervals between whole ms, (N,) each, on a path that passes the ends of its segments at times in s."""
        first = np.searchsorted(joint_time, start / 1000, side="right")
        return cls(start, end, first, np.searchsorted(joint_time, end / 1000))

    def __getitem__(self, rows: Array | slice) -> Intervals:
        return Intervals(*(getattr(self, field.name)[rows] for field in fields(self)))

    def __len__(self) -> int:
        return len(self.start)

    @property
    def duration(self) -> Array:
        """(N,) s."""
        return np.asarray((self.end - self.start) / 1000)

    def at_joints(self, joint_time: Array) -> Places:
        """The joints inside the intervals."""
        row, number = expand_counts(self.last - self.first)
        joint = self.first[row] + number
        return self._places(row, joint_time[joint], joint)

    def between_joints(self, joint_time: Array, gaps: int) -> Places:
        """At least one place on each segment; with the joints, no gap exceeds 1 / ``gaps`` of the interval."""
        row, number = expand_counts(self.last - self.first + 1)
        segment = self.first[row] + number
        begin = np.where(number > 0, joint_time[segment - 1], (self.start / 1000)[row])
        way = np.minimum(joint_time[segment], (self.end / 1000)[row]) - begin
        parts = np.maximum(2, np.ceil(gaps * way / self.duration[row] - _ROUNDING).astype(np.int64))
        piece, number = expand_counts(parts - 1)
        time = begin[piece] + way[piece] * ((number + 1) / parts[piece])
        return self._places(row[piece], time, segment[piece])

    def _places(self, row: Array, time: Array, segment: Array) -> Places:
        return Places(row, (time - (self.start / 1000)[row]) / self.duration[row], time, segment)
