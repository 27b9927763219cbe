# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tool cubics: cubics of tip, axis and spin between two poses, and the drift of the strut cubics from them.

The controller plays cubics of strut lengths. Between the same two poses the tool has cubics of its own, with the same
positions and rates at both ends: the plan is compared with these, without kinematics. The rest is the drift of the
strut cubics L from the tool cubics. L is the cubic with the ends of l, the lengths along the tool cubics, so with x for
the elapsed share of the duration and M for the maximum of |l''''| by x,

    |L - l| <= 16 x^2 (1 - x)^2 M / 384

While the attitude is constant, l is the distance of a cubic from a fixed point. With V, A, J for the maxima of the
cubic's derivatives by x and d for the shortest strut, the fourth derivative of l^2 gives

    M <= (3 A^2 + 4 V J) / d + 12 V^2 A / d^2 + 3 V^4 / d^3

and the inverse Jacobian maps that to the tip: by at most 1 / s for a platform whose least singular value is s, and by
the lever of the tool. Where the attitude moves, the drift is measured at a quarter, a half and three quarters: it is
x^2 (1 - x)^2 q(x), with a q that varies over a long interval and may be zero in the middle.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from pkm_post.geometry import Array, dot_columns, hermite_powers, length_of
from pkm_post.machine.kinematics.inverse import ToolPoses
from pkm_post.machine.kinematics.rates import least_joint_distance
from pkm_post.machine.kinematics.strut_cubics import KnotState, max_strut_acceleration, max_strut_speed, tool_deviation
from pkm_post.model import Machine

ROUNDED_SHARE = 0.99
"""Share of the accelerations of struts and tip available to cubics: rounding lengths to six decimals adds up to 0.7 %
where an interval is 1 ms."""
_STEPS = 3
"""Newton steps to the best fit: the first leaves a relative error of some hundredths, each further one squares it."""
DRIFT_SHARES = np.array([0.25, 0.5, 0.75])
"""Shares of the duration at which the drift is measured."""
_BUMP = 16 * (DRIFT_SHARES * (1 - DRIFT_SHARES)) ** 2
_ROOM = 1.1
"""Allowance for a drift that is larger between the measured shares."""
_MAX_SLOPE = 16 / np.sqrt(27)
"""Highest slope of 16 x^2 (1 - x)^2."""
_CURVED = 32.0
"""Largest second derivative of 16 x^2 (1 - x)^2, at both ends."""


@dataclass(frozen=True)
class ToolCubics:
    """N cubics by the elapsed share of the duration.

    Attributes:
        powers: (4, C, N) coefficients of the powers of the share. The first three of the C columns are the tip, mm;
            where the attitude moves, axis (3) and spin follow.
    """

    powers: Array

    @classmethod
    def from_ends(cls, first: Array, rate: Array, last: Array, last_rate: Array, duration: Array) -> ToolCubics:
        """Build cubics from their ends: positions and rates by time, (C, N) each, and durations, (N,) s."""
        return cls(hermite_powers(first, rate, last, last_rate, duration))

    def __getitem__(self, rows: Array) -> ToolCubics:
        return ToolCubics(np.take(self.powers, rows, axis=2))

    def at(self, share: Array | float) -> Array:
        """Positions at one share of each, (C, N)."""
        place, begin, square, cube = self.powers
        found = cube * share
        for power in (square, begin):
            found += power
            found *= share
        found += place
        return np.asarray(found)

    def fastest_at(self, share: Array) -> Array:
        """Largest first derivative of the tip by the share at some shares of each, (M, N), (N,) mm."""
        _, begin, square, cube = self.powers[:, :3, None]
        return np.asarray(length_of(*(begin + share * (2 * square + 3 * share * cube))).max(axis=0))

    def nearest(self, place: Array, by_tip: Array, by_axis: Array, share: Array, most: Array) -> Array:
        """Shares of the duration at which the tool fits given places best, (N,), by Newton's method.

        The best fit has the least sum of squares of the deviations of tip and axis, each by its tolerance: tip and
        axis move in step along the path.

        Args:
            place: (3, N) or (6, N) tips, and axes where the attitude moves.
            by_tip: (N,) weight of the tip, 1/mm.
            by_axis: (N,) weight of the axis, 1/rad.
            share: (N,) shares to start from.
            most: (N,) by which a share may change.
        """
        weight = np.stack([*3 * [by_tip], *(len(place) - 3) * [by_axis]])
        at, begin, square, cube = (power[: len(place)] * weight for power in self.powers)
        at = at - place * weight
        least, largest = np.maximum(share - most, 0.0), np.minimum(share + most, 1.0)
        for _ in range(_STEPS):
            off = at + share * (begin + share * (square + share * cube))
            rate = begin + share * (2 * square + 3 * share * cube)
            bend = 2 * square + 6 * share * cube
            steep = np.square(rate).sum(axis=0) + np.maximum((off * bend).sum(axis=0), 0.0)
            step = np.divide((off * rate).sum(axis=0), steep, out=np.zeros(len(share)), where=steep > 0)
            share = np.clip(share - step, least, largest)
        return share

    def sizes(self) -> tuple[Array, Array, Array]:
        """Maxima of first, second and third derivative of the tip by the share, (N,) mm each."""
        _, begin, square, cube = self.powers[:, :3]
        middle, bend = begin + square, square + 3 * cube
        return (
            _fastest(begin, middle, middle + bend),
            2 * np.maximum(length_of(*square), length_of(*bend)),
            6 * length_of(*cube),
        )

    def turn(self) -> Array:
        """Maximum of the first derivative of the tool axis by the share, (N,) rad; zero if the attitude is constant."""
        if self.powers.shape[1] == 3:
            return np.zeros(self.powers.shape[2])
        _, begin, square, cube = self.powers[:, 3:6]
        middle = begin + square
        return _fastest(begin, middle, middle + square + 3 * cube)


class Demand(NamedTuple):
    """Drift and dynamic load of strut cubics in N intervals.

    Attributes:
        tip: (N,) drift of the tip, mm.
        axis: (N,) drift of the tool axis, rad.
        tip_speed: (N,) highest speed of the tip, mm/s.
        limits: (N,) highest share of a limit: speed and acceleration of a strut, acceleration of the tip, turning rate
            of the tool axis.
    """

    tip: Array
    axis: Array
    tip_speed: Array
    limits: Array

    def with_rows(self, rows: Array, other: Demand) -> Demand:
        """Copy with another demand in some rows."""
        columns = [column.copy() for column in self]
        for column, changed in zip(columns, other, strict=True):
            column[rows] = changed
        return Demand(*columns)


def bounded_demand(machine: Machine, tool_length: float, cubics: ToolCubics, duration: Array) -> Demand:
    """Upper bound of the demand while the attitude is constant.

    Infinite for a screw without a key, and without a shortest strut or a limit of singular poses.

    Args:
        machine: the geometry and the limits; the path keeps the allowed distance from singular poses.
        tool_length: gauge length, mm.
        cubics: N of them.
        duration: (N,) s.
    """
    speed, bend, jerk = cubics.sizes()
    shortest = least_joint_distance(machine)
    if machine.screw_lead != 0.0 or min(shortest, machine.least_singular_value) <= 0:
        return Demand(*np.full((4, len(duration)), np.inf))
    turn = speed / shortest
    fourth = (3 * bend**2 + 4 * speed * jerk + 12 * bend * speed * turn) / shortest + 3 * speed * turn**3
    lever = (machine.spindle_nose + tool_length) / machine.characteristic_length
    gain = np.sqrt(6) * np.hypot(1.0, lever) / machine.least_singular_value
    acceleration = (bend + speed * turn + fourth / 12) / duration**2
    tip_acceleration = (bend + gain * fourth / 12) / duration**2
    by_limit = (
        speed / duration / machine.strut_speed,
        acceleration / (ROUNDED_SHARE * machine.strut_acceleration),
        tip_acceleration / (ROUNDED_SHARE * machine.tip_acceleration),
    )
    drift = gain * fourth / 384
    return Demand(drift, np.zeros(len(duration)), (speed + _MAX_SLOPE * drift) / duration, np.maximum.reduce(by_limit))


def measured_demand(
    machine: Machine, first: KnotState, last: KnotState, cubics: ToolCubics, inside: ToolPoses, duration: Array
) -> Demand:
    """Demand of strut cubics, with the drift measured at ``DRIFT_SHARES``.

    Args:
        first: N knots.
        last: N knots.
        cubics: N of them.
        inside: 3 N tool poses of the cubics at these shares, interval by interval.
        duration: (N,) s.
    """
    found = tool_deviation(machine, first, last, inside, duration, DRIFT_SHARES)
    tip, axis = _ROOM * found.tip.max(axis=1), _ROOM * found.axis.max(axis=1)
    tip_bump, axis_bump = (_ROOM * (one / _BUMP).max(axis=1) for one in (found.tip, found.axis))
    speed, bend, _ = cubics.sizes()
    by_limit = (
        max_strut_speed(first, last, duration) / machine.strut_speed,
        max_strut_acceleration(first, last, duration) / (ROUNDED_SHARE * machine.strut_acceleration),
        (bend + _CURVED * tip_bump) / duration**2 / (ROUNDED_SHARE * machine.tip_acceleration),
        (cubics.turn() + _MAX_SLOPE * axis_bump) / duration / machine.axis_speed,
    )
    return Demand(tip, axis, (speed + _MAX_SLOPE * tip_bump) / duration, np.maximum.reduce(by_limit))


def _fastest(begin: Array, middle: Array, end: Array) -> Array:
    """Maximum of a derivative with these Bezier coefficients, (N,).

    Its square is a polynomial of degree four: at most its largest Bezier coefficient.
    """
    inner = (2 * dot_columns(middle, middle) + dot_columns(begin, end)) / 3
    hull = dot_columns(begin, begin), dot_columns(begin, middle), inner, dot_columns(middle, end), dot_columns(end, end)
    return np.asarray(np.sqrt(np.maximum.reduce(hull)))
