# SPDX-License-Identifier: LGPL-2.1-or-later
"""Played course: the tool path of a played program, from its strut lengths and speeds alone.

Enters: a strut motion as read back, the gauge length in use at each knot, and the start pose of the program. Leaves:
tool poses at the knots by forward kinematics, each starting from the previous one, with their rates; between two knots
tip, axis and spin are approximated by cubics. The certificate is not measured on these cubics (``tool_at``).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import (
    Array,
    dot,
    hermite_accelerations,
    hermite_column_speeds,
    hermite_columns,
    torsion_free_axes,
)
from pkm_post.machine import attitude_rates, forward_along_path, jacobian_of_tip, platform_rotation, solve_regular
from pkm_post.model import Machine, StrutMotion, Trajectory


@dataclass(frozen=True)
class PlayedCourse:
    """Columns of K + 1 knots: tip in mm, tool axis, spin in rad, one after the other.

    Attributes:
        place: (7, K + 1) with the tool of the interval before the knot.
        rate: (7, K + 1) by time.
        start: (7, K) at the start of each interval, with the tool of that interval.
        time: (K + 1,) s.
        tool_length: (K + 1,) of the tool of the interval before the knot, mm.
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
    ) -> tuple[PlayedCourse | None, int]:
        """The tool path of a program; or None, and the first knot that small steps from the start cannot reach."""
        begin = platform_rotation(trajectory.start_axis[None], np.array([trajectory.start_spin]))[0]
        found = forward_along_path(machine, struts.length, tool_length, trajectory.start_tip, begin)
        if not found.converged.all():
            return None, int(np.argmin(found.converged))
        spin = _spin(found.rotation, trajectory.start_spin)
        jacobian = jacobian_of_tip(machine, found.tip, found.axis, spin, tool_length)
        twist, regular = solve_regular(jacobian, struts.speed)
        if not regular.all():
            return None, int(np.argmin(regular))
        swing, spun = attitude_rates(found.axis, twist[:, 3:])
        place = np.vstack([found.tip.T, found.axis.T, spin])
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

    def _ends(self, interval: Array) -> tuple[Array, Array, Array, Array, Array]:
        after = interval + 1
        duration = self.time[after] - self.time[interval]
        return self.start[:, interval], self.rate[:, interval], self.place[:, after], self.rate[:, after], duration


def _spin(rotation: Array, start: float) -> Array:
    """The continuous spin of platforms along their path, (N,), starting near ``start``."""
    x, y = torsion_free_axes(np.ascontiguousarray(rotation[:, :, 2]))
    spin = np.unwrap(np.arctan2(dot(rotation[:, :, 0], y), dot(rotation[:, :, 0], x)))
    return np.asarray(spin + 2 * np.pi * np.round((start - spin[0]) / (2 * np.pi)))
