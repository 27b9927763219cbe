# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rotating shape: a rotating tool as a function that is negative inside it.

The outline is a bottom line and a side line tangent to an arc, as in ``toolpath.Cutter``, and a flat top. Outside, the
values are distances, except near the edge of the top and near a point; they never change by more than the distance
between two places. Units: mm, rad.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array
from pkm_post.toolpath import Cutter


@dataclass(frozen=True)
class RotatingShape:
    """A tool about its axis.

    Attributes:
        centre: radius and height of the centre of the arc.
        corner: radius of the arc; 0 for a sharp corner.
        bottom_angle: rise of the bottom outwards.
        side_angle: angle of the side to the axis, positive where the tool widens upwards.
        top: height of its end above the tip.
    """

    centre: tuple[float, float]
    corner: float
    bottom_angle: float
    side_angle: float
    top: float

    @classmethod
    def of(cls, cutter: Cutter, top: float) -> RotatingShape:
        """The cutting part of a tool.

        Args:
            cutter: its outline.
            top: height of the cutting edges above the tip, mm.
        """
        centre = cutter.radial_offset, cutter.axial_offset
        return cls(centre, cutter.corner_radius, cutter.bottom_angle, cutter.side_angle, min(top, cutter.height))

    @property
    def widest(self) -> float:
        """Radius of the enclosing cylinder about the axis, mm."""
        radius = self.centre[0] + self.corner / max(math.cos(self.side_angle), 1e-9)
        return radius + max(math.tan(self.side_angle), 0.0) * self.top

    def level(self, radius: Array, height: Array) -> Array:
        """Values at distances from the axis and heights above the tip, of the shape of both; negative inside."""
        x, z = radius - self.centre[0], height - self.centre[1]
        if self.bottom_angle == 0.0 and self.side_angle == 0.0:
            to_bottom, to_side = -z, x
            corner = np.hypot(np.maximum(x, 0.0), np.minimum(z, 0.0)) + np.minimum(np.maximum(x, -z), 0.0)
        else:
            (sa, ca), (sb, cb) = ((math.sin(a), math.cos(a)) for a in (self.bottom_angle, self.side_angle))
            to_bottom, to_side = x * sa - z * ca, x * cb - z * sb
            beyond_both = (x * ca + z * sa > 0.0) & (x * sb + z * cb < 0.0)
            corner = np.where(beyond_both, np.hypot(x, z), np.maximum(to_bottom, to_side))
        value: Array = np.maximum(corner - self.corner, height - self.top)
        return value
