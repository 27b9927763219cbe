# SPDX-License-Identifier: LGPL-2.1-or-later
"""Played path: the tool path of a played program, its backward motion, and its deviation of spin, without a plan.

Input: a strut motion as read back, the gauge length in use at each knot, the trajectory with its ruler, and when each
joint is passed. Output: tool poses at the knots by forward kinematics, each starting from the previous one, with their
rates; between two knots tip, axis and spin are approximated by cubics. The certificate is not measured on these cubics
(``tool_states``). Units: mm, s, rad.

Backward motion: a tool that moves back and forth on the path stays within all tolerances, so its progress is checked
separately. The reference, the best-fitting programmed pose, may itself move backward by as much as the tolerance.

Spin: it does not affect the cut, so tip and axis do not show its deviation; cones, singular poses and strut lengths
depend on it. The programmed spin is that of the best-fitting programmed pose. The allowed deviation is the sum of

* the change of spin when that pose moves within the tolerances;
* the axis tolerance between two rests where the spin changes: a smooth curve may be off by so much in spin as well;
* the rounding of a joint, over less than half of the shorter of its two segments: with the change D of the spin's
  rate by path length, half width d and the distance x from the joint D 2 d (v^3 - v^4 / 2), v = (d - x) / 2 d;
  between two knots the largest of that in their interval, and at a joint between them over d of all of its way.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.certificate.deviation import TrajectoryRuler
from pkm_post.geometry import (
    Array,
    dot,
    hermite_accelerations,
    hermite_column_speeds,
    hermite_columns,
    hermite_powers,
    norm,
    torsion_free_axes,
)
from pkm_post.machine import attitude_rates, forward_along_path, jacobian_of_tip, solve_regular
from pkm_post.model import Machine, Motion, StrutMotion, Trajectory, in_pieces, pieces
from pkm_post.toolpath import ToolPose

_ADVANCE_SHARES = np.linspace(0.125, 1.0, 8)[:, None]
"""Shares of each interval at which it is evaluated, besides those at which it may turn back."""
_AT_START = 1e-6
"""Share of an interval that counts as its start: the tool cannot go back there."""
_SPIN_SHARES = np.array([[0.0], [0.25], [0.5], [0.75], [1.0]])
"""Shares of each interval at which the spin is compared, besides those at which it is farthest from its chord."""
_ROUNDED = 0.45
"""Share of the shorter segment at a joint over which it may be rounded."""
_AT_ONCE = 8192


@dataclass(frozen=True)
class PlayedPath:
    """Columns of K + 1 knots: rows of tip in mm, tool axis, and spin in rad.

    Attributes:
        place: (7, K + 1) with the tool of the interval that ends at the knot.
        rate: (7, K + 1) by time.
        start: (7, K) at the start of each interval, with the tool of that interval.
        time: (K + 1,) s.
        tool_length: (K + 1,) of the tool of the interval that ends at the knot, mm.
        struts: the program, read back.
    """

    place: Array
    rate: Array
    start: Array
    time: Array
    tool_length: Array
    struts: StrutMotion

    @classmethod
    def of(
        cls, struts: StrutMotion, tool_length: Array, trajectory: Trajectory, machine: Machine
    ) -> tuple[PlayedPath | None, int]:
        """The tool path of a program; or None, and the first knot that small steps from the start cannot reach."""
        poses = forward_along_path(machine, struts.length, tool_length, ToolPose.at_start(trajectory))
        if not poses.converged.all():
            return None, int(np.argmin(poses.converged))
        spin = _spin(poses.rotation, trajectory.start_spin)
        jacobian = jacobian_of_tip(machine, poses.tip, poses.axis, spin, tool_length)
        twist, regular = solve_regular(jacobian, struts.speed)
        if not regular.all():
            return None, int(np.argmin(regular))
        swing, spun = attitude_rates(poses.axis, twist[:, 3:])
        place = np.vstack([poses.tip.T, poses.axis.T, spin])
        start = place[:, :-1].copy()
        start[:3] -= np.diff(tool_length) * start[3:6]
        rate = np.vstack([twist[:, :3].T, swing.T, spun])
        return cls(place, rate, start, struts.time_ms / 1000, tool_length, struts), 0

    def at(self, interval: Array, share: Array) -> Array:
        """Tip, axis and spin at shares, (M, 1) or (M, N), of N intervals, (7, M, N)."""
        return hermite_columns(*self._ends(interval), share)

    def rates_at(self, interval: Array, share: Array) -> tuple[Array, Array]:
        """First and second derivatives by time at a share of each of N intervals, (7, N) each."""
        p0, v0, p1, v1, duration = self._ends(interval)
        begin, end = (one.T for one in hermite_accelerations(p0.T, v0.T, p1.T, v1.T, duration))
        return hermite_column_speeds(p0, v0, p1, v1, duration, share[None])[:, 0], begin + (end - begin) * share

    def turns_back(self, interval: Array, ruler: TrajectoryRuler) -> Array:
        """Shares at which the way along the chord of N intervals is longest and shortest, (2, N); 1 where nowhere.

        Tip and axis count by their tolerances. The start belongs to the interval before, which may have another tool.
        """
        p0, v0, p1, v1, duration = (column[:6] if column.ndim > 1 else column for column in self._ends(interval))
        weight = np.repeat([1 / ruler.tip_tolerance.min(), 1 / ruler.axis_tolerance], 3)[:, None] ** 2
        _, linear, square, cube = (hermite_powers(p0, v0, p1, v1, duration) * (weight * (p1 - p0))).sum(axis=1)
        return _extremes(linear, square, cube)

    def spin_leaves_chord(self, interval: Array) -> Array:
        """Shares at which the spin of N intervals is farthest ahead of its chord and behind it, (2, N); 1 as above."""
        p0, v0, p1, v1, duration = (column[6] if column.ndim > 1 else column for column in self._ends(interval))
        _, linear, square, cube = hermite_powers(p0, v0, p1, v1, duration)
        return _extremes(linear - (p1 - p0), square, cube)

    def _ends(self, interval: Array) -> tuple[Array, Array, Array, Array, Array]:
        after = interval + 1
        duration = self.time[after] - self.time[interval]
        return self.start[:, interval], self.rate[:, interval], self.place[:, after], self.rate[:, after], duration


def _extremes(linear: Array, square: Array, cube: Array) -> Array:
    """Shares inside N intervals at which linear x + square x^2 + cube x^3 is extreme, (2, N); 1 where nowhere."""
    root = np.sqrt(np.maximum(square**2 - 3 * cube * linear, 0.0))
    steep = -square - np.where(square < 0, -root, root)  # of both solutions the one without cancellation
    shares = np.ones((2, len(linear)))
    np.divide(steep, 3 * cube, out=shares[0], where=cube != 0)
    np.divide(linear, steep, out=shares[1], where=steep != 0)
    return np.where((shares > _AT_START) & (shares < 1.0), shares, 1.0)


def _spin(rotation: Array, start: float) -> Array:
    """The continuous spin of platforms along their path, (N,), starting near ``start``."""
    x, y = torsion_free_axes(np.ascontiguousarray(rotation[:, :, 2]))
    spin = np.unwrap(np.arctan2(dot(rotation[:, :, 0], y), dot(rotation[:, :, 0], x)))
    return np.asarray(spin + 2 * np.pi * np.round((start - spin[0]) / (2 * np.pi)))


def largest_backward_motion(path: PlayedPath, ruler: TrajectoryRuler, passed: Array) -> tuple[float, float]:
    """Largest backward motion of the tool, where 1 is the tolerance; and its time, s."""
    rows = np.arange(len(path.time) - 1)
    parts = [_along(path, rows[part], ruler, passed) for part in pieces(len(rows), _AT_ONCE)]
    time, along, slack = np.concatenate(parts, axis=1)
    back = (np.maximum.accumulate(along) - along) / slack
    worst = int(np.argmax(back))
    return float(back[worst]), float(time[worst])


def _along(path: PlayedPath, rows: Array, ruler: TrajectoryRuler, passed: Array) -> Array:
    """Times in intervals; progress of the tool, in segments; and the tolerance of that progress, (3, M)."""
    even = np.broadcast_to(_ADVANCE_SHARES, (len(_ADVANCE_SHARES), len(rows)))
    shares = np.sort(np.vstack([even, path.turns_back(rows, ruler)]), axis=0)
    place = path.at(rows, shares).transpose(0, 2, 1).reshape(7, -1)
    begin, end = path.time[rows], path.time[rows + 1]
    time = (begin + (end - begin) * shares).T.ravel()
    segment = np.minimum(np.searchsorted(passed, time), len(passed) - 1)
    tip, axis = place[:3].T, (place[3:6] / norm(place[3:6].T)).T
    share, slack = ruler.share_of(tip, axis, segment)
    # a pose may fit both ends of a turn that is closed: that counts which belongs to the time
    later = time > (passed[segment] + np.append(0.0, passed)[segment]) / 2
    share = np.where(ruler.fits_end(tip, axis, segment, later), later, share)
    return np.stack([time, segment + share, slack])


def spin_deviation(
    path: PlayedPath, trajectory: Trajectory, machine: Machine, ruler: TrajectoryRuler, passed: Array
) -> Array:
    """Deviation of the spin about each knot from the programmed one, (K + 1,) mm of a strut.

    Args:
        path: path of the program.
        trajectory: the programmed trajectory.
        machine: the geometry.
        ruler: ruler of the trajectory.
        passed: (N,) s, when the end of each segment is passed.
    """
    allowed, rows = _Allowed(trajectory, ruler), np.arange(len(path.time) - 1)
    off = np.concatenate([_off(path, rows[part], allowed, passed) for part in pieces(len(rows), _AT_ONCE)])
    lever = _lever(path, machine)
    by_interval = off * np.maximum(lever[:-1], lever[1:])
    return np.maximum(np.append(by_interval, 0.0), np.append(0.0, by_interval))


def planned_spin_deviation(motion: Motion, trajectory: Trajectory, machine: Machine, ruler: TrajectoryRuler) -> Array:
    """Deviation of a plan's spin at its knots from the programmed one, (K + 1,) mm of a strut.

    With the spin, a strut changes by no more than the distance of its platform joint from the tool axis.
    """
    lever = np.hypot(*machine.platform_joints[:, :2].T).max()
    allowed, last = _Allowed(trajectory, ruler), len(trajectory) - 1

    def off(rows: slice) -> tuple[Array]:
        segment = np.minimum(np.searchsorted(motion.joint_time, motion.time_ms[rows] / 1000), last)
        return (lever * allowed.outside(motion.tip[rows], motion.axis[rows], motion.spin[rows], segment),)

    return in_pieces(len(motion), _AT_ONCE, off)[0]


def _off(path: PlayedPath, rows: Array, allowed: _Allowed, passed: Array) -> Array:
    """Largest excess of the spin in intervals over its allowed range, (M,) rad."""
    even = np.broadcast_to(_SPIN_SHARES, (len(_SPIN_SHARES), len(rows)))
    shares = np.sort(np.vstack([even, path.spin_leaves_chord(rows)]), axis=0)
    place = path.at(rows, shares).reshape(7, -1)
    begin, end = path.time[rows], path.time[rows + 1]
    time = (begin + (end - begin) * shares).ravel()
    # an interval that begins at a joint belongs to the next segment
    first = np.tile(np.searchsorted(passed, begin, side="right"), len(shares))
    segment = np.clip(np.maximum(np.searchsorted(passed, time), first), 0, len(passed) - 1)
    axis = (place[3:6] / norm(place[3:6].T)).T
    outside = allowed.outside(place[:3].T, axis, place[6], segment, len(shares))
    return np.asarray(outside.reshape(len(shares), -1).max(axis=0))


class _Allowed:
    """The spins that a trajectory allows."""

    def __init__(self, trajectory: Trajectory, ruler: TrajectoryRuler) -> None:
        self._ruler = ruler
        self._before = np.append(trajectory.start_spin, trajectory.spin[:-1])
        self._turn = trajectory.spin - self._before
        self._extent = np.where(
            trajectory.length > 0, trajectory.length, np.maximum(trajectory.angle, np.abs(self._turn))
        )
        rate = self._turn / self._extent
        rests = trajectory.exact_stop[:-1]
        self._change = np.concatenate([[0.0], np.where(rests, 0.0, np.abs(np.diff(rate))), [0.0]])
        width = _ROUNDED * np.minimum(self._extent[:-1], self._extent[1:])
        self._width = np.concatenate([[1.0], width, [1.0]])
        stretch = np.cumsum(np.append(0, rests))
        self._of_curve = np.where(np.bincount(stretch, self._turn != 0)[stretch] > 0, ruler.axis_tolerance, 0.0)

    def outside(self, tip: Array, axis: Array, spin: Array, segment: Array, instants: int = 1) -> Array:
        """Excess of spins over the allowed range at their poses, (M,) rad.

        With several instants of each interval, all firsts before all seconds, those between its knots may be off by
        the rounding anywhere in it, and by that of its joints over the whole of it: one cubic leads through it, and
        plans place knots by tip and axis. A pose that fits both ends of a closed turn may have the spin of either.
        """
        share, slack = self._ruler.share_of(tip, axis, segment)
        off = self._outside(share, slack, tip, spin, segment, instants)
        if off.any():
            closed = [self._ruler.fits_end(tip, axis, segment, np.full(len(tip), end)) for end in (False, True)]
            other = np.where(np.logical_and(*closed), np.rint(1 - share), share)
            off = np.minimum(off, self._outside(other, slack, tip, spin, segment, instants))
        return off

    def _outside(self, share: Array, slack: Array, tip: Array, spin: Array, segment: Array, instants: int) -> Array:
        """The same at shares of the segments."""
        turn = self._turn[segment]
        still = np.isinf(slack)  # a pure turn about the tool axis allows any spin in between
        ahead = np.clip((spin - self._before[segment]) / np.where(turn == 0, 1.0, turn), 0.0, 1.0)
        expected = self._before[segment] + turn * np.where(still, ahead, share)
        distance = share * self._extent[segment], (1 - share) * self._extent[segment]
        before, after = self._rounding(segment, distance[0]), self._rounding(segment + 1, distance[1])
        rounding = before + after
        by_instant, of = rounding.reshape(instants, -1), segment.reshape(instants, -1)
        ends = tip.reshape(instants, -1, 3)[[0, -1]]
        way = norm(ends[1] - ends[0])  # a cubic may round over all of it
        rounds = (before.reshape(of.shape) > 0) | (of > of[0]), after.reshape(of.shape) > 0
        wide = (rounds[side] * self._change[of + side] * np.maximum(self._width[of + side], way) for side in (0, 1))
        by_instant[1:-1] = np.maximum(by_instant, 3 / 16 * sum(wide)).max(axis=0)
        most = np.abs(turn) * np.where(still, 0.0, slack) + rounding + self._of_curve[segment]
        return np.maximum(np.abs(spin - expected) - most, 0.0)

    def _rounding(self, joint: Array, distance: Array) -> Array:
        """Change of the spin by the rounding of a joint, at a distance from it."""
        width = self._width[joint]
        v = np.clip((width - distance) / (2 * width), 0.0, 0.5)
        return np.asarray(self._change[joint] * 2 * width * v**3 * (1 - v / 2))


def _lever(path: PlayedPath, machine: Machine) -> Array:
    """Largest change of a strut length with the spin at each knot, (K + 1,) mm per rad."""
    tip, axis = path.place[:3].T, path.place[3:6].T
    jacobian = jacobian_of_tip(machine, tip, axis, path.place[6], path.tool_length)
    return np.asarray(np.abs((jacobian[:, :, 3:] @ axis[..., None])[..., 0]).max(axis=1))
