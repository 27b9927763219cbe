# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cutter: the shape of a rotating tool where its corner touches the part.

A tool enters, its corner circle leaves: the centres of the corner arc, turned about the tool axis, lie on a circle, and
the corner is the torus of that circle. One description serves ball, bull nose and flat end mills. The side above the
corner is a cylinder, the bottom inside it a plane at right angles to the axis. Lengths in mm.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from pkm_post.model import Tool


@dataclass(frozen=True)
class Cutter:
    """The corner of a cutter in the terms of the APT cutter r, e, f.

    Attributes:
        corner_radius: r, radius of the corner arc; 0 for a sharp corner.
        radial_offset: e, distance of the centre of the arc from the tool axis; 0 for a ball.
        axial_offset: f, height of the centre of the arc above the tool tip.
    """

    corner_radius: float
    radial_offset: float
    axial_offset: float

    def __post_init__(self) -> None:
        sizes = (self.corner_radius, self.radial_offset, self.axial_offset)
        if not all(math.isfinite(size) and size >= 0.0 for size in sizes):
            raise ValueError(f"Cutter: expected r, e, f finite and not negative, got {sizes}")
        if self.corner_radius + self.radial_offset == 0.0:
            raise ValueError("Cutter: expected a radius r + e above 0, got 0")

    @classmethod
    def of(cls, tool: Tool) -> Cutter:
        """The corner of a tool: r = R1, e = R - R1, f = R1.

        Args:
            tool: a tool of known diameter 2 R and corner radius R1, 0 <= R1 <= R.

        Raises:
            ValueError: the diameter is not above 0, or the corner radius is not within 0 and half of it.
        """
        radius = tool.diameter / 2.0
        if not (math.isfinite(radius) and radius > 0.0):
            raise ValueError(f"tool {tool.number}: expected a diameter above 0 mm, got {tool.diameter}")
        if not 0.0 <= tool.corner_radius <= radius:
            raise ValueError(
                f"tool {tool.number}: expected a corner radius from 0 to {radius} mm, got {tool.corner_radius}"
            )
        return cls(tool.corner_radius, radius - tool.corner_radius, tool.corner_radius)
