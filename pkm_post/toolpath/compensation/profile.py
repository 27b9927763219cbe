# SPDX-License-Identifier: LGPL-2.1-or-later
"""Profile: distances of points from the solid of a cutter.

Takes a cutter, and points as their radius from the tool axis and their level above the tip, in mm; returns signed
distances, negative inside. The solid is convex: bottom cone, corner torus and side cone, capped by a plane at its
height.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array
from pkm_post.toolpath.compensation.cutter import Cutter


@dataclass(frozen=True)
class Profile:
    """The outline of a cutter in the half-plane of radius and level: line, arc, line, and a line across the top.

    Attributes:
        foot: level where the outline leaves the axis.
        start: angle from the axis to the normal of the bottom and of the start of the arc.
        end: angle from the axis to the normal of the end of the arc and of the side.
        radius: radius of the arc.
        centre: centre of the arc: radius and level.
        top: level of the top.
    """

    foot: float
    start: float
    end: float
    radius: float
    centre: tuple[float, float]
    top: float

    @classmethod
    def of(cls, cutter: Cutter, tallest: float) -> Profile:
        """The outline of a cutter.

        Args:
            cutter: the cutter.
            tallest: height in mm above which nothing matters; it caps cutters of unknown height.
        """
        r, e, f = cutter.corner_radius, cutter.radial_offset, cutter.axial_offset
        foot = f - r * math.cos(cutter.corner_start) if e < 0.0 else 0.0
        ends_at = f - r * math.cos(cutter.corner_end)
        top = min(cutter.height, max(tallest, ends_at))
        if cutter.side_angle < 0.0:  # the side converges upwards
            top = min(top, ends_at - (e + r * math.sin(cutter.corner_end)) / math.tan(cutter.side_angle))
        return cls(foot, cutter.corner_start, cutter.corner_end, r, (e, f), top)

    def corner(self, angle: float) -> tuple[float, float]:
        """The point of the arc whose normal is at this angle to the axis: radius and level."""
        return self.centre[0] + self.radius * math.sin(angle), self.centre[1] - self.radius * math.cos(angle)

    def distance(self, radius: Array, level: Array) -> Array:
        """Signed distances of points to the solid, negative inside, of the shape of the arguments.

        Args:
            radius: distances from the tool axis, not negative.
            level: heights above the tip.
        """
        bottom, to_bottom = _line(radius, level - self.foot, self.start, 0.0, self._bottom_length)
        from_end = radius - self.corner(self.end)[0], level - self.corner(self.end)[1]
        side, to_side = _line(*from_end, self.end, 0.0, self._side_length)
        above = level - self.top
        to_top = np.hypot(np.maximum(radius - self._top_radius, 0.0), above)
        x, z = radius - self.centre[0], level - self.centre[1]
        from_centre = np.hypot(x, z)
        at_corner = (x * math.cos(self.start) + z * math.sin(self.start) >= 0.0) & (
            x * math.cos(self.end) + z * math.sin(self.end) <= 0.0
        )
        to_corner = np.where(at_corner, np.abs(from_centre - self.radius), np.inf)
        nearest = np.minimum(np.minimum(to_bottom, to_side), np.minimum(to_top, to_corner))
        inside = (bottom < 0.0) & (side < 0.0) & (above < 0.0) & (~at_corner | (from_centre < self.radius))
        signed: Array = np.where(inside, -nearest, nearest)
        return signed

    @property
    def reach(self) -> float:
        """Distance from the tip to the farthest point of the solid, mm."""
        return max(math.hypot(self._top_radius, self.top), math.hypot(*self.corner(self.end)))

    @property
    def _bottom_length(self) -> float:
        return math.hypot(self.corner(self.start)[0], self.corner(self.start)[1] - self.foot)

    @property
    def _side_length(self) -> float:
        return max(0.0, (self.top - self.corner(self.end)[1]) / math.sin(self.end))

    @property
    def _top_radius(self) -> float:
        return self.corner(self.end)[0] + self._side_length * math.cos(self.end)


def _line(x: Array, z: Array, angle: float, first: float, last: float) -> tuple[Array, Array]:
    """Signed distances of points from a line through the origin, and from its segment between two lengths.

    The normal of the line is at the angle to the axis, down and out; the line runs out and up.
    """
    along = x * math.cos(angle) + z * math.sin(angle)
    outside = x * math.sin(angle) - z * math.cos(angle)
    return outside, np.hypot(outside, along - np.clip(along, first, last))
