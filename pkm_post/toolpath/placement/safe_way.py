# SPDX-License-Identifier: LGPL-2.1-or-later
"""Safe route: from one pose to another over a height at and above which the tip is free.

The tool leaves along its axis, crosses above the height, and arrives along its axis. The caller ensures that the axes
rise. Units: mm, {M}.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array

FLATTEST = 0.1
"""Smallest z of a tool axis for a retract along it: 84 degrees from upright, where the path is ten times the height."""

_NO_MOVE = 1e-8
"""mm, rad, and difference of unit axes."""


@dataclass(frozen=True)
class ToolPose:
    """Current or target pose of a tool.

    Attributes:
        tip: (3,) in {M}, mm.
        axis: (3,) unit tool axis in {M}.
        spin: spin of the platform about it, rad; NaN where unspecified.
    """

    tip: Array
    axis: Array
    spin: float

    def rises_to(self, height: float) -> bool:
        """Whether the tool is at the height, or can be retracted to it along its axis."""
        return bool(self.tip[2] >= height or self.axis[2] >= FLATTEST)

    def is_at(self, other: ToolPose) -> bool:
        """Whether both poses are equal up to rounding."""
        apart = (*(self.tip - other.tip), *(self.axis - other.axis), self.spin - other.spin)
        return bool(np.abs(apart).max() < _NO_MOVE)

    def above(self, height: float) -> tuple[ToolPose, ...]:
        """The pose at the height, along the tool axis; empty where the tip is already that high.

        tip + (height - z) / k axis, with z of the tip and k of the axis along z.
        """
        rise = (height - self.tip[2]) / self.axis[2]
        return (ToolPose(self.tip + rise * self.axis, self.axis, self.spin),) if rise > 0.0 else ()


def safe_way(start: ToolPose, end: ToolPose, height: float) -> tuple[ToolPose, ...]:
    """The poses to pass through by straight moves, including the end.

    Args:
        start: current pose.
        end: target pose.
        height: z in {M} at and above which the tip is free.
    """
    return (*start.above(height), *end.above(height), end)


def columns(poses: list[ToolPose]) -> tuple[Array, Array, Array]:
    """Tips (N, 3), axes (N, 3) and spins (N,) of poses."""
    tips, axes = (np.array([getattr(pose, name) for pose in poses]).reshape(-1, 3) for name in ("tip", "axis"))
    return tips, axes, np.array([pose.spin for pose in poses])
