# SPDX-License-Identifier: LGPL-2.1-or-later
"""Stiffness map: the least stiffness of the tool tip at poses, such as those of a job.

Takes a machine whose file states the stiffness of its struts. Units: mm, N/mm.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array
from pkm_post.machine.kinematics.inverse import ToolPoses
from pkm_post.machine.kinematics.stiffness import principal_stiffness
from pkm_post.machine.spin.normalised_margins import normalised_margins
from pkm_post.model import Machine

_PER_MICRON = 1e-3


@dataclass(frozen=True)
class StiffnessMap:
    """Columns of N poses.

    Attributes:
        tip: (N, 3) tool tip in {M}, mm.
        stiffness: (N, 3) in the principal directions, softest first, N/mm; zero where the pose is singular.
        softest: (N, 3) unit vector of the softest direction in {M}.
        reached: (N,) whether stroke and joints allow the pose, on the side of home of any singular one.
    """

    tip: Array
    stiffness: Array
    softest: Array
    reached: Array

    @property
    def least(self) -> Array:
        """(N,) stiffness in the softest direction, N/mm; NaN where the machine does not reach."""
        return np.where(self.reached, self.stiffness[:, 0], np.nan)

    def as_csv(self) -> str:
        """The map as text with a header, one line per pose, in mm and N/um; empty where the machine does not reach."""
        head = "x_mm,y_mm,z_mm,softest_N_per_um,middle_N_per_um,stiffest_N_per_um,softest_x,softest_y,softest_z"
        values = (self.stiffness * _PER_MICRON).tolist()
        rows = zip(self.tip.tolist(), values, (self.softest).tolist(), self.reached.tolist(), strict=True)
        lines = (
            ",".join([*(f"{each:g}" for each in tip), *(_cells(value, along) if reached else [""] * 6)])
            for tip, value, along, reached in rows
        )
        return "\n".join([head, *lines, ""])


def _cells(stiffness: list[float], direction: list[float]) -> list[str]:
    return [*(f"{each:.1f}" for each in stiffness), *(f"{each:z.3f}" for each in direction)]


def stiffness_map(machine: Machine, pose: ToolPoses) -> StiffnessMap:
    """Map the stiffness of the tip.

    Args:
        machine: with ``strut_stiffness``.
        pose: tips (N, 3), axes (N, 3), spins (N,) and gauge lengths (N,).

    Raises:
        ValueError: the machine file states no stiffness.
    """
    values, softest = principal_stiffness(machine, pose)
    reached: Array = np.all(normalised_margins(machine, *pose) >= 0.0, axis=1)
    return StiffnessMap(pose[0], values, softest, reached)


def table_poses(machine: Machine, height: float, tool_length: float, step: float) -> ToolPoses:
    """Poses of an upright tool over the whole table, on a grid.

    Args:
        machine: its base joints give the extent of the grid.
        height: of the tool tip in {M}, mm.
        tool_length: gauge length, mm.
        step: distance of neighbours along x and y, mm.

    Raises:
        ValueError: the step is not positive.
    """
    if not step > 0.0:
        raise ValueError(f"step: expected a length above 0, got {step}")
    reach = float(np.abs(machine.base_joints[:, :2]).max())
    line = step * np.arange(-np.floor(reach / step), np.floor(reach / step) + 1)
    x, y = (each.ravel() for each in np.meshgrid(line, line, indexing="ij"))
    count = len(x)
    tip = np.column_stack([x, y, np.full(count, height)])
    return ToolPoses(tip, np.tile([0.0, 0.0, 1.0], (count, 1)), np.zeros(count), np.full(count, tool_length))
