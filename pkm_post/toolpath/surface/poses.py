# SPDX-License-Identifier: LGPL-2.1-or-later
"""Poses: tool poses along a course, and tolerances of the straight moves between them. Units: mm, rad."""

from __future__ import annotations

import math
from dataclasses import dataclass

from pkm_post.toolpath.surface.course import Course
from pkm_post.toolpath.surface.surface import Array
from pkm_post.toolpath.surface.turning import Frame


@dataclass(frozen=True)
class Tolerances:
    """Allowed deviation of a straight move between its ends.

    Attributes:
        chord: distance of the cutter from the surface, above it or into it, and of the line between contact points from
            the path of the contact on the surface, mm.
        axis: angle of the tool axis from the one required by the rule, rad.
    """

    chord: float = 0.01
    axis: float = math.radians(0.1)

    def __post_init__(self) -> None:
        if not (self.chord > 0.0 and self.axis > 0.0):
            raise ValueError(f"Tolerances: expected both above 0, got {self}")


@dataclass(frozen=True)
class Poses:
    """Tool poses at N rows of a course.

    Attributes:
        course: the rows.
        point: (N, 3) contact points.
        normal: (N, 3) unit normals there.
        frame: directions of feed and tilt.
        axis: (N, 3) unit tool axes.
        tip: (N, 3) tool tips.
        clamped: (N,) whether the axis was clamped to its cone.
    """

    course: Course
    point: Array
    normal: Array
    frame: Frame
    axis: Array
    tip: Array
    clamped: Array
