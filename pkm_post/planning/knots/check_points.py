# SPDX-License-Identifier: LGPL-2.1-or-later
"""Check points: the intervals of a motion, and the instants at which it is compared with its plan.

Input: starts and ends of intervals in whole ms, and the times at which the path passes its joints, s. Output: the
joints inside each interval, and places between them that leave no wide gap.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import NamedTuple

import numpy as np

from pkm_post.geometry import Array, expand_counts

_ROUNDING = 1e-9
"""Tolerance on a number of gaps, so that rounding does not add one."""


@dataclass(frozen=True)
class Intervals:
    """N intervals of a motion.

    Attributes:
        start: (N,) whole ms.
        end: (N,) whole ms.
        first: (N,) segment at the start.
        last: (N,) segment at the end.
    """

    start: Array
    end: Array
    first: Array
    last: Array

    @classmethod
    def of(cls, joint_time: Array, start: Array, end: Array) -> Intervals:
        """Intervals between whole ms, (N,) each; ``joint_time``: when the path passes its segment ends, s."""
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

    def most_points(self, gaps: int, widest: float) -> Array:
        """Upper bound, fairly tight, on the number of places between joints, (N,)."""
        return np.asarray(self.last - self.first + np.maximum(gaps, np.ceil(self.duration / widest)))

    def at_joints(self, joint_time: Array, most: int | None = None) -> CheckPoints:
        """The joints inside the intervals; at most ``most`` of each, evenly spread."""
        inside = self.last - self.first
        count = inside if most is None else np.minimum(inside, most)
        row, number = expand_counts(count)
        joint = self.first[row] + (number if most is None else (2 * number + 1) * inside[row] // (2 * count[row]))
        return self._points(row, joint_time[joint], joint)

    def at_other_joints(self, joint_time: Array, most: int) -> CheckPoints:
        """The joints that ``at_joints`` leaves out; every interval has more than ``most``."""
        inside = self.last - self.first
        row, number = expand_counts(inside)
        other, begin = np.ones(len(row), dtype=np.bool_), np.cumsum(inside) - inside
        for one in range(most):
            other[begin + (2 * one + 1) * inside // (2 * most)] = False
        row, joint = row[other], (self.first[row] + number)[other]
        return self._points(row, joint_time[joint], joint)

    def between_joints(self, joint_time: Array, gaps: int, widest: float = np.inf) -> CheckPoints:
        """At least one place on each segment; with the joints, no gap exceeds 1 / ``gaps`` of the interval.

        Args:
            joint_time: (J,) s, times of the joints of the path.
            gaps: least number of even gaps in an interval.
            widest: s, widest gap.
        """
        row, number = expand_counts(self.last - self.first + 1)
        segment = self.first[row] + number
        begin = np.where(number > 0, joint_time[segment - 1], (self.start / 1000)[row])
        way = np.minimum(joint_time[segment], (self.end / 1000)[row]) - begin
        parts = np.maximum(2, np.ceil(way / np.minimum(self.duration / gaps, widest)[row] - _ROUNDING).astype(np.int64))
        piece, number = expand_counts(parts - 1)
        time = begin[piece] + way[piece] * ((number + 1) / parts[piece])
        return self._points(row[piece], time, segment[piece])

    def beside_joints(self, joint_time: Array, margin: Array, gaps: int) -> tuple[Array, Array, Array]:
        """The segments executed in the intervals, without what is near their joints, at even places of each.

        Args:
            joint_time: (J,) s, times of the joints of the path.
            margin: (N,) s, left out before and after a joint; below 0 included beyond it.
            gaps: number of gaps between the places.

        Returns:
            Segments, (S,); the interval of each; and the times of the places after its start, (gaps + 1, S) s.
        """
        row, number = expand_counts(self.last - self.first + 1)
        segment, start = self.first[row] + number, (self.start / 1000)[row]
        until, margin = (self.end / 1000)[row], margin[row]
        begin = np.where(number > 0, np.maximum(joint_time[segment - 1] + margin, start), start)
        end = np.where(segment < self.last[row], np.minimum(joint_time[segment] - margin, until), until)
        long = np.flatnonzero(begin < end)
        row, begin, end = row[long], begin[long] - start[long], end[long] - start[long]
        return segment[long], row, begin + (end - begin) * np.linspace(0, 1, gaps + 1)[:, None]

    def _points(self, row: Array, time: Array, segment: Array) -> CheckPoints:
        duration = self.duration[row]
        return CheckPoints(row, (time - (self.start / 1000)[row]) / duration, time, segment, duration)


class CheckPoints(NamedTuple):
    """M instants in N intervals, ordered by interval.

    Attributes:
        row: (M,) the interval.
        share: (M,) elapsed share of the interval.
        time: (M,) s.
        segment: (M,) segment of the path at that time; at a joint the earlier one.
        duration: (M,) s, of the interval.
    """

    row: Array
    share: Array
    time: Array
    segment: Array
    duration: Array

    def maximum(self, values: Array, count: int) -> Array:
        """Maximum of values at the points, (M,), in each of ``count`` intervals; 0 for intervals without points."""
        maximum, first = np.zeros(count), np.flatnonzero(np.diff(self.row, prepend=-1))
        if len(first):
            maximum[self.row[first]] = np.maximum.reduceat(values, first)
        return maximum


class KnownIntervals:
    """Cache of findings, keyed by interval number."""

    def __init__(self) -> None:
        """Start empty."""
        self._number, self._found = np.empty(0, dtype=np.int64), np.empty((2, 0))

    def of(self, number: Array) -> Array:
        """Both findings for each interval, (2, N); NaN if unknown."""
        at, known = self._located(number)
        found = np.full((2, len(number)), np.nan)
        found[:, known] = self._found[:, at[known]]
        return found

    def put(self, number: Array, found: Array) -> None:
        """Store findings, (2, N), for distinct intervals."""
        at, known = self._located(number)
        self._found[:, at[known]] = found[:, known]
        new = np.flatnonzero(~known)
        new = new[np.argsort(number[new])]
        self._number = np.insert(self._number, at[new], number[new])
        self._found = np.insert(self._found, at[new], found[:, new], axis=1)

    def _located(self, number: Array) -> tuple[Array, Array]:
        """Sorted positions of intervals, (N,), and whether they are stored, (N,)."""
        at = np.searchsorted(self._number, number)
        known = np.zeros(len(at), dtype=np.bool_)
        inside = np.flatnonzero(at < len(self._number))
        known[inside] = self._number[at[inside]] == number[inside]
        return at, known
