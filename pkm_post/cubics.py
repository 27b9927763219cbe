# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cubics: how well what the controller plays between two points follows the plan.

Enters: path, schedule and machine, then starts and ends of intervals in whole ms. Leaves: the worst of the deviations
of tip and axis, of the swing of the tip's speed, of the strut accelerations and of the change of the Jacobian, each by
what it may be.
"""

from __future__ import annotations

import numpy as np

from pkm_post.feed import Schedule, ToolPath, by_time, glimpse
from pkm_post.geometry.vectors import Array
from pkm_post.kinematics import Ends, Inside, change, steepest, stray
from pkm_post.model import Machine, Poses
from pkm_post.model.findings import Tolerances

_SHARE_OF_TOLERANCES = 0.4
"""What the controller's cubics may use; the rest is for corners, decimals, and what lies between the instants."""
_SPEED_SWING = 0.005
"""Part of the feed by which the controller's cubics may be faster than planned."""
_SHARES = np.sort(np.arange(1, 21) * (np.sqrt(5) - 1) / 2 % 1)
"""Spread by the golden ratio: even shares could keep step with the joints of the path and miss every one of them."""
_LOOKS = (_SHARES[4::5], np.delete(_SHARES, np.s_[4::5]))
"""Few shares first: most intervals that are too long are seen to be so at the first looks, and the rest is saved."""
_MOST_CHANGE = 0.13
"""Part by which the Jacobian may change in an interval: the tip's speed is then told to less than half a percent."""
_PLACES_AT_ONCE = 8192
"""Instants looked at in one pass: the working arrays of one pass stay in the processor's cache."""


def poses_at(path: ToolPath, schedule: Schedule, ms: Array) -> Poses:
    """Poses by time at whole ms, (N,)."""
    s, speed, acceleration = schedule.at(ms / 1000)
    return by_time(path.at(s), speed, acceleration)


class Cubics:
    """How well the controller's cubics follow the plan in one stretch; what was found at an end of one is kept."""

    def __init__(
        self, path: ToolPath, schedule: Schedule, machine: Machine, tolerances: Tolerances, marks: Array
    ) -> None:
        """Of a plan.

        Args:
            path: the path with rounded corners.
            schedule: when the tool is where.
            machine: the geometry and the limits of its struts.
            tolerances: what was asked for.
            marks: (K,) whole ms; the stretch is from the first to the last.
        """
        self._path, self._schedule, self._machine, self._tolerances = path, schedule, machine, tolerances
        self._first = marks[0]
        self._row = np.full(marks[-1] - marks[0] + 1, -1)
        self._known = Ends.of(machine, poses_at(path, schedule, marks[:0]))

    def error(self, start: Array, end: Array) -> Array:
        """What intervals of whole ms, (N,), make of what they may; more than 1 is too much.

        Of an interval that is too long it is what the first looks saw.
        """
        first, last = self._rows(start), self._rows(end)
        duration = (end - start) / 1000
        ends = self._known[first], self._known[last]
        worst = steepest(*ends, duration) / self._machine.strut_acceleration
        worst = np.maximum(worst, change(self._machine, *ends) / _MOST_CHANGE)
        for shares in _LOOKS:
            open_yet = np.flatnonzero(worst <= 1)
            for begin in range(0, len(open_yet), step := _PLACES_AT_ONCE // len(shares)):
                rows = open_yet[begin : begin + step]
                ends = self._known[first[rows]], self._known[last[rows]]
                worst[rows] = np.maximum(worst[rows], self._seen(start[rows] / 1000, duration[rows], *ends, shares))
        return worst

    def _seen(self, start: Array, duration: Array, first: Ends, last: Ends, shares: Array) -> Array:
        """The same at some shares of the intervals, leaving out the acceleration; start and duration in s."""
        s, speed, _ = self._schedule.at((start[:, None] + duration[:, None] * shares).ravel())
        seen = glimpse(self._path, s)
        attitude = self._path.attitude or (seen.axis, seen.spin, seen.tool_length)
        inside = Inside(seen.tip, *attitude, seen.pace * speed)
        found = stray(self._machine, first, last, inside, duration, shares)
        swing = _SPEED_SWING * self._path.feed[seen.segment].reshape(found.faster.shape)
        allowed = self._tip_tolerance_on(seen.segment).reshape(found.tip.shape)
        off = np.maximum(found.tip / allowed, found.axis / self._tolerances.axis) / _SHARE_OF_TOLERANCES
        worst: Array = np.maximum(off, found.faster / swing).max(axis=1)
        return worst

    def _tip_tolerance_on(self, segment: Array) -> Array:
        """How far the tip may be off on segments, (M,) mm: the program may ask for less, not allow more."""
        said, asked = self._path.tip_tolerance[segment], self._tolerances.tip
        return np.where(said > 0, np.minimum(said, asked), asked)

    def _rows(self, ms: Array) -> Array:
        """The rows of what is known at whole ms; what is not known yet is found out."""
        unknown = np.unique(ms[self._row[ms - self._first] < 0])
        if len(unknown):
            self._row[unknown - self._first] = len(self._known.length) + np.arange(len(unknown))
            self._known += Ends.of(self._machine, poses_at(self._path, self._schedule, unknown))
        return self._row[ms - self._first]
