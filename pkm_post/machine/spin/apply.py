# SPDX-License-Identifier: LGPL-2.1-or-later
"""Apply a spin policy to a trajectory.

Input: a trajectory as placed, with the spin of the part program or none. Output: the same trajectory with another spin,
in rad, or diagnostics where the policy leaves the spin undefined.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from pkm_post.geometry import Array, cross, norm, torsion
from pkm_post.machine.spin.policy import SpinPolicy, SpinRule
from pkm_post.model import Diagnostic, Diagnostics, Machine, Trajectory, tool_change_rows

if TYPE_CHECKING:
    from concurrent.futures import Executor

_NO_DIRECTION = 1e-6
"""Below this sine the tool axis is normal to the plane, which leaves the spin undefined."""


def spin_in_plane(axis: Array, heading: float, of_y: bool = False, near: float = 0.0) -> Array:
    """Spins that keep an axis of the platform parallel to a vertical plane, (N,) rad, without jumps by full turns.

    Args:
        axis: (N, 3) unit tool axes in {M}, in order along the path.
        heading: direction of the x axis of the platform when the tool is upright, rad from x towards y.
        of_y: whether the y axis of the platform stays parallel to the plane instead of the x axis.
        near: the first spin is within half a turn of it, rad.

    Returns:
        The spins; NaN where the tool axis is normal to the plane, which leaves the spin undefined.
    """
    cosine, sine = np.cos(heading), np.sin(heading)
    kept = cross(axis, np.array([cosine, sine, 0.0])) if of_y else cross(np.array([-sine, cosine, 0.0]), axis)
    x = cross(kept, axis) if of_y else kept
    spin = torsion(axis, x)
    spin[norm(kept) < _NO_DIRECTION] = np.nan
    known = np.flatnonzero(~np.isnan(spin))
    spin[known] = np.unwrap(np.append(near, spin[known]))[1:]
    return spin


_SAME = 1e-6
"""mm, and difference of unit axes: a tool this close to the tool-change pose is at it."""


def with_spin(
    trajectory: Trajectory, machine: Machine, policy: SpinPolicy, executor: Executor | None = None
) -> tuple[Trajectory | None, Diagnostics]:
    """The trajectory with the spin of a policy, or diagnostics where the policy leaves it undefined.

    At the tool-change pose the spin is that of the machine file, whatever the policy.

    Args:
        trajectory: at least one segment.
        executor: distributes the search; by default it runs in this process.
    """
    turned, diagnostics = _by_policy(trajectory, machine, policy, executor)
    return (None if turned is None else _as_tools_change(turned, machine)), diagnostics


def _as_tools_change(trajectory: Trajectory, machine: Machine) -> Trajectory:
    """The trajectory with the spin of the tool-change pose at tool changes."""
    pose = machine.tool_change
    if pose is None:
        return trajectory
    changes = [row for row in tool_change_rows(trajectory.events) if row > 0]
    off = np.hypot(norm(trajectory.nose_before(changes) - pose.nose), norm(trajectory.axis_at(changes) - pose.axis))
    spin = trajectory.spin.copy()
    spin[np.array(changes, dtype=np.intp)[off < _SAME] - 1] = pose.spin
    return replace(trajectory, spin=spin)


def _by_policy(
    trajectory: Trajectory, machine: Machine, policy: SpinPolicy, executor: Executor | None
) -> tuple[Trajectory | None, Diagnostics]:
    if policy.rule is SpinRule.FILE:
        return trajectory, ()
    if policy.rule is SpinRule.OPTIMISED:
        from pkm_post.machine.spin.optimise import optimise_spin

        untwisted = replace(trajectory, spin=np.zeros(len(trajectory)))
        return optimise_spin(untwisted, machine, policy, executor), ()
    if policy.rule is SpinRule.ZERO:
        return replace(trajectory, spin=np.zeros(len(trajectory))), ()
    of_y = policy.rule is SpinRule.Y_IN_PLANE
    spin = spin_in_plane(trajectory.axis, policy.heading, of_y, near=trajectory.start_spin)
    open_rows = np.flatnonzero(np.isnan(spin))
    if len(open_rows):
        found = f"spin {policy.rule.value}, {len(open_rows)} of {len(spin)} moves"
        return None, (Diagnostic("K120", trajectory.place(int(open_rows[0])), found),)
    return replace(trajectory, spin=spin), ()
