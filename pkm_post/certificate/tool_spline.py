# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tool spline: kinematic state at the knots, and the path of the tool in each interval as one cubic, with error bounds.

Input: a strut motion as read back, and the planned motion as start value. Output: planned strut lengths and speeds,
inverse Jacobians, and the intervals in which the Jacobian varies so little that the mean of both inverses can replace
that of any instant; tool poses and rates at the knots. Between two knots tip, axis and spin follow the cubics
with these ends, which need no kinematics: the rough pair of ``tool_states.states_by_kinematics``. The struts of such a
cubic differ slightly from those played; the difference at three instants gives the error of the cubic there, and a
bound for all other instants. Units: mm, s, rad.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from pkm_post.geometry import (
    Array,
    hermite_accelerations,
    hermite_column_speeds,
    hermite_columns,
    hermite_lengths,
    length_of,
)
from pkm_post.machine import ToolPoses, attitude_rates, displaced, map_to_tool, strut_lengths, strut_state
from pkm_post.model import Machine, Motion, StrutMotion, distinct, pieces

_MOST_CHANGE = 0.05
"""Relative change of the Jacobian allowed in an interval; the mean of the inverses then has an error of some 6e-4."""


class KnotKinematics(NamedTuple):
    """Columns of K + 1 knots.

    Attributes:
        length: (K + 1, 6) planned strut lengths, mm.
        speed: (K + 1, 6) mm/s.
        tip_inverse: (K + 1, 3, 6) upper halves of the inverse Jacobians, from struts to the tip.
        alike: (K,) whether the Jacobian changes little from one knot to the next, with the same tool.
    """

    length: Array
    speed: Array
    tip_inverse: Array
    alike: Array

    @classmethod
    def allocated(cls, motion: Motion) -> KnotKinematics:
        """Allocate columns for the knots of a plan, to be filled piece by piece."""
        length, speed = np.empty((2, len(motion), 6))
        return cls(length, speed, np.empty((len(motion), 3, 6)), np.diff(motion.tool_length) == 0)

    def fill(self, machine: Machine, motion: Motion, rows: slice) -> Array:
        """Fill in some knots and the intervals between them; return their inverse Jacobians of the tip, (N, 6, 6).

        Full inverses are only temporary; they would take most of the memory of a long program.
        """
        self.length[rows], self.speed[rows], jacobian = strut_state(machine, motion.poses(rows))
        inverse = _inverted(jacobian)
        self.tip_inverse[rows] = inverse[:, :3]
        between = slice(rows.start, rows.stop - 1)
        self.alike[between] &= _change(inverse[:-1], jacobian[1:], machine) < _MOST_CHANGE
        return inverse


def inverses_at(machine: Machine, motion: Motion, rows: Array) -> tuple[Array, Array]:
    """Inverse Jacobians of the tip at both ends of the intervals that begin at some knots, (N, 6, 6) each."""
    knots = distinct(np.concatenate([rows, rows + 1]))
    begin, end = np.searchsorted(knots, rows), np.searchsorted(knots, rows + 1)
    inverse = _inverted(strut_state(machine, motion.poses(knots))[2])
    return inverse[begin], inverse[end]


def _inverted(jacobian: Array) -> Array:
    """Inverses; NaN for singular matrices, which never count as alike."""
    try:
        return np.linalg.inv(jacobian)
    except np.linalg.LinAlgError:
        return np.full_like(jacobian, np.nan)


def _change(inverse: Array, jacobian: Array, machine: Machine) -> Array:
    """Difference of J1^-1 J2 from the identity, (N,), with turns in characteristic lengths."""
    scale = np.repeat([1.0, machine.characteristic_length], 3)
    change = (inverse @ jacobian - np.eye(6)) * (scale[:, None] / scale)
    return np.asarray(np.sqrt(np.square(change).sum(axis=(1, 2))))


_LOOKS = np.array([[0.25], [0.5], [0.75]])
"""Shares of an interval at which the difference is measured."""
_MOST = 1.6
"""An error x^2 (1 - x)^2 times a quadratic is at most 1.442 times its largest value at ``_LOOKS``."""
_FASTEST = 12.3
"""The same for its rate: at most 11.153 times that value by the duration."""
_BENDS = 356.0
"""The same for its second derivative: at most 323.56 by the square of the duration. All three have 10 % margin."""
_MAX_PLAN_DEVIATION = 1e-4
"""mm of deviation of a strut from its plan at a knot; beyond it, one linear step from the plan is too coarse."""
_STEP_MISSES = np.array([1e-9, 1e-9, 1e-4])[:, None]
"""mm, rad and mm/s: bounds on the error of such a step, and of speeds from the Jacobian before it."""
_TURN_MISSES = 2e-6
"""rad/s: the same for turning rates."""
_MAX_CUBIC_DEVIATION = 0.01
"""mm of a strut between cubic and program; beyond it, linear steps do not resolve the difference."""
_SMALL_TURN = 0.3
"""rad of the axis in an interval; beyond it, no bound is given."""
_AT_ONCE = 2048


class ToolSpline(NamedTuple):
    """Columns of K + 1 knots, or of the K intervals between them.

    Attributes:
        place: (7, K + 1) tip in mm, tool axis, spin in rad at the knots.
        rate: (7, K + 1) their rates by time.
        duration: (K,) s.
        missed: (3, K) error bounds of the cubics: tip in mm, axis in rad, velocity of the tip in mm/s; infinite where
            unknown.
    """

    place: Array
    rate: Array
    duration: Array
    missed: Array

    @classmethod
    def of(cls, machine: Machine, struts: StrutMotion, motion: Motion) -> tuple[ToolSpline, KnotKinematics]:
        """The cubics of a strut motion with the knots of a planned one; and the kinematic state at these."""
        knots, count = KnotKinematics.allocated(motion), len(struts) - 1
        place, rate = np.empty((2, 7, len(struts)))
        spline = cls(place, rate, np.diff(struts.time_ms) / 1000, np.full((3, count), np.inf))
        for piece in pieces(count, _AT_ONCE):
            rows = slice(piece.start, piece.stop + 1)  # includes the end of its last interval
            inverse = knots.fill(machine, motion, rows)
            spline.place[:, rows], spline.rate[:, rows], near = _at_knots(struts, motion, knots, rows, inverse)
            bounded = spline._bounded(knots, near, piece)
            ends = inverse[bounded - piece.start], inverse[bounded - piece.start + 1]
            spline.missed[:, bounded] = spline._missed(machine, struts, motion, ends, bounded)
        return spline, knots

    def _bounded(self, knots: KnotKinematics, near: Array, piece: slice) -> Array:
        """The intervals of a piece that have a bound; ``near`` has their knots, one more."""
        swing = length_of(*self.rate[3:6, piece.start : piece.stop + 1])
        turn = np.maximum(swing[:-1], swing[1:]) * self.duration[piece]
        return piece.start + np.flatnonzero(knots.alike[piece] & near[:-1] & near[1:] & (turn < _SMALL_TURN))

    def at(self, rows: Array, share: Array) -> tuple[Array, Array, Array]:
        """Tip, tool axis and spin on the cubics of N intervals.

        Args:
            rows: (N,) the intervals.
            share: (M, 1) or (M, N), shares of the intervals.

        Returns:
            (3, M, N) mm, (3, M, N) unit vectors, (M, N) rad.
        """
        place = hermite_columns(*self._ends(rows), share)
        return place[:3], place[3:6] / length_of(*place[3:6]), place[6]

    def velocity(self, rows: Array, share: Array) -> Array:
        """Velocity of the tip there, (3, M, N) mm/s."""
        p0, v0, p1, v1, duration = self._ends(rows)
        return hermite_column_speeds(p0[:3], v0[:3], p1[:3], v1[:3], duration, share)

    def rates(self, rows: Array) -> tuple[Array, Array]:
        """Turning rate of the tool axis, rad/s, and acceleration of the tip, mm/s^2, of N intervals.

        The acceleration of a cubic is largest at an end, its speed no more than the largest of its Bezier coefficients.
        The cubic of the axis is in the hull of its control points, so with a turn of g it is no shorter than
        cos(g / 2) - g^2 / 6 > 1 - 0.3 g^2, and the axis turns faster than it by no more than that.

        Returns:
            Values at the knots, and bounds on the excess at any time, (2, N) each; the latter infinite where unknown.
        """
        begin, begin_rate, end, end_rate, duration = self._ends(rows)
        both = hermite_accelerations(begin[:3].T, begin_rate[:3].T, end[:3].T, end_rate[:3].T, duration)
        acceleration = np.maximum(*(length_of(*one.T) for one in both))
        first, last = begin_rate[3:6], end_rate[3:6]
        middle = 3 * (end[3:6] - begin[3:6]) / duration - first - last
        at_knots = np.maximum(length_of(*first), length_of(*last))
        hull = np.maximum(at_knots, length_of(*middle))
        turn = hull * duration
        missed = self.missed[:, rows]
        off_tip, off_axis, _ = (missed - _STEP_MISSES) / [[_MOST], [_MOST], [_FASTEST]]
        step = 12 * _STEP_MISSES[0] / duration**2 + 6 * _STEP_MISSES[2] / duration
        more = (
            hull / np.maximum(1 - 0.3 * turn**2, 0.5) - at_knots + _FASTEST * off_axis / duration + _TURN_MISSES,
            _BENDS * off_tip / duration**2 + step,
        )
        return np.stack([at_knots, acceleration]), np.where(np.isfinite(missed[0]), np.stack(more), np.inf)

    def _ends(self, rows: Array) -> tuple[Array, Array, Array, Array, Array]:
        after, place, rate = rows + 1, self.place, self.rate
        return place[:, rows], rate[:, rows], place[:, after], rate[:, after], self.duration[rows]

    def _missed(
        self, machine: Machine, struts: StrutMotion, motion: Motion, inverses: tuple[Array, Array], rows: Array
    ) -> Array:
        """Column ``missed`` of N intervals, (3, N), from the inverse Jacobians at both ends of each."""
        if not len(rows):
            return np.empty((3, 0))
        tip, axis, spin = (columns.reshape(-1, _LOOKS.size * len(rows)) for columns in self.at(rows, _LOOKS))
        tool_length = np.tile(motion.tool_length[rows + 1], _LOOKS.size)
        needed = strut_lengths(machine, tip.T, axis.T, spin[0], tool_length).reshape(_LOOKS.size, -1, 6)
        residual = hermite_lengths(*struts.cubics(rows), _LOOKS.ravel()) - needed.transpose(1, 0, 2)
        twist = map_to_tool(*inverses, residual, _LOOKS.ravel())
        way, turn = (part.transpose(0, 2, 1).reshape(3, -1) for part in (twist[:3], twist[3:]))
        swing, _ = attitude_rates(axis.T, turn.T)
        off_tip, off_axis = (length_of(*part).reshape(_LOOKS.size, -1).max(axis=0) for part in (way, swing.T))
        missed = np.stack([_MOST * off_tip, _MOST * off_axis, _FASTEST * off_tip / self.duration[rows]]) + _STEP_MISSES
        return np.where(np.abs(residual).max(axis=(1, 2)) < _MAX_CUBIC_DEVIATION, missed, np.inf)


def _at_knots(
    struts: StrutMotion, motion: Motion, knots: KnotKinematics, rows: slice, inverse: Array
) -> tuple[Array, Array, Array]:
    """Places and rates at some knots, and where one linear step from the plan is accurate enough."""
    residual = struts.length[rows] - knots.length[rows]
    near = np.abs(residual).max(axis=1) < _MAX_PLAN_DEVIATION
    step, twist = (inverse @ np.stack([residual, struts.speed[rows]], axis=2)).transpose(2, 1, 0)
    planned = ToolPoses(motion.tip[rows], motion.axis[rows], motion.spin[rows], motion.tool_length[rows])
    pose = displaced(planned, np.where(near, step, 0.0))
    swing, spun = attitude_rates(pose.axis, twist[3:].T)
    return np.vstack([pose.tip.T, pose.axis.T, pose.spin]), np.vstack([twist[:3], swing.T, spun]), near
