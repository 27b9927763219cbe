# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pose path: tool poses in order, the motion between them, and bounds of platform point travel.

Cell i leads from row i - 1 to row i. Inside it the pose is known for any share of the cell, from 0 to 1, and tip, axis
and spin move uniformly with the share: the tip along a line or an arc, the axis along a great circle. Two numbers bound
the motion of any platform point in a cell: it moves by at most travel + turn * its distance from the tip.

The platform turns by w = k x k' + (psi' + tau) k, |tau| <= tan(tilt / 2) |k'| (``geometry.orientation``), so turn^2 =
angle^2 + (|spin| + tan(tilt / 2) angle)^2 with the highest tilt of the cell. Units: mm, rad.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array, along, angle_between, norm, tilt, towards, turn_by_tilt, turned_angles
from pkm_post.machine.kinematics.inverse import ToolPoses
from pkm_post.model import checkpoint, map_row_pairs, shifted, uniform


@dataclass(frozen=True)
class PosePath:
    """N poses and the cells between them; cell 0 has no extent.

    Attributes:
        tip: (N, 3) tool tips in {M}.
        axis: (N, 3) unit tool axes.
        spin: (N,) spins.
        tool_length: (N,) gauge lengths, also of the cell that ends at the row.
        travel: (N,) upper bound of the tip's path length in the cell.
        bend: (N,) largest second derivative of the tip by the share of the cell: 0 on lines, sweep^2 radius on arcs.
        angle: (N,) angle the tool axis turns in the cell.
        spin_change: (N,) change of the spin in the cell.
        inside: pose at shares (M,) of cells (M,).
    """

    tip: Array
    axis: Array
    spin: Array
    tool_length: Array
    travel: Array
    bend: Array
    angle: Array
    spin_change: Array
    inside: Callable[[Array, Array], ToolPoses]

    @classmethod
    def straight(cls, tip: Array, axis: Array, spin: Array, tool_length: Array) -> PosePath:
        """Build the path through poses with straight tip motion; arguments as in ``inverse``.

        Where the gauge length changes, the platform is at rest, and the tip of the new tool starts elsewhere.
        """
        start, axis_before, spin_before, length_before = (
            shifted(column[0], column) for column in (tip, axis, spin, tool_length)
        )
        change = map_row_pairs(np.subtract, spin, spin_before)
        longer = map_row_pairs(np.subtract, tool_length, length_before)
        if longer.any():
            start, changes = np.array(start, order="C"), np.flatnonzero(longer)
            start[changes] -= longer[changes, None] * axis_before[changes]

        def inside(cell: Array, share: Array) -> ToolPoses:
            beginning, part = axis_before[cell], share[:, None]
            turned = along(beginning, part * towards(beginning, axis[cell]))
            tips = start[cell] + part * (tip[cell] - start[cell])
            return ToolPoses(tips, turned, spin_before[cell] + share * change[cell], tool_length[cell])

        return cls(
            tip=tip,
            axis=axis,
            spin=spin,
            tool_length=tool_length,
            travel=norm(tip - start),
            bend=uniform(0.0, len(tip)),
            angle=map_row_pairs(turned_angles, axis_before, axis),
            spin_change=change,
            inside=inside,
        )

    def __len__(self) -> int:
        return len(self.tip)

    def rows(self, rows: slice | Array) -> ToolPoses:
        """The poses of some rows."""
        return ToolPoses(self.tip[rows], self.axis[rows], self.spin[rows], self.tool_length[rows])

    def half_tilt(self) -> Array:
        """Tangent of half the highest tilt in each cell, (N,)."""
        tilts = tilt(self.axis)
        checkpoint()
        return _half_tilt(np.concatenate([tilts[:1], tilts[:-1]]), tilts, self.angle)

    def turn(self) -> Array:
        """Upper bound of the platform rotation in each cell, (N,)."""
        if not self.angle.any():
            return np.abs(self.spin_change)
        checkpoint()
        return np.hypot(self.angle, np.abs(self.spin_change) + self.half_tilt() * self.angle)


def rotation_bound(start: Array, end: Array, spin_change: Array) -> Array:
    """Upper bound of the platform rotation while axis and spin move between two orientations, (M,).

    Args:
        start: (M, 3) unit tool axes.
        end: (M, 3) unit tool axes.
        spin_change: (M,)
    """
    angle = angle_between(start, end)
    return np.hypot(angle, np.abs(spin_change) + _half_tilt(tilt(start), tilt(end), angle) * angle)


def _half_tilt(at_start: Array, at_end: Array, angle: Array) -> Array:
    """Tangent of half the highest tilt on a great circle with known tilts at its ends."""
    return turn_by_tilt(np.maximum(at_start, at_end) + angle / 2)
