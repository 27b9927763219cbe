# SPDX-License-Identifier: LGPL-2.1-or-later
"""Meeting: intersect a directed circle with a plane.

Enters: circle, start point and check surface in mm. Leaves: the end point of the motion in mm. Independent of
statements.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import across, cross, norm
from pkm_post.model import Array
from pkm_post.reading.cldata.arcs import BAD_FIT, CLOSE, NO_DIRECTION, way_of
from pkm_post.reading.cldata.course import Plane

SAME_DIRECTION = 1e-3
"""Sine of the angle below which two directions count as parallel."""


class Unmet(Exception):  # noqa: N818 - a fault of the input, which the statement tells
    """The circle does not meet the check surface; the message says why."""


@dataclass(frozen=True)
class Guide:
    """A directed circle from a start point: the points are hub + cos(angle) u + sin(angle) v.

    Attributes:
        start: (3,) mm.
        hub: (3,) mm, the centre in the plane of motion.
        axis: (3,) unit, as written.
        u: (3,) mm from the hub to the start.
        v: (3,) direction of travel at the start, of the length of u.
        way: sense of rotation about the axis: 1 right-handed, -1 left-handed.
    """

    start: Array
    hub: Array
    axis: Array
    u: Array
    v: Array
    way: float

    def point(self, angle: float) -> Array:
        """The point at an angle of travel; at about zero or a full turn, the start point itself."""
        nearest = abs((angle + math.pi) % (2 * math.pi) - math.pi)
        if nearest * norm(self.u) < CLOSE:
            return self.start
        found: Array = self.hub + math.cos(angle) * self.u + math.sin(angle) * self.v
        return found

    def way_to(self, angle: float) -> float:
        """Convert an angle to travel order: above 0, a full turn for the start point itself."""
        ahead = angle % (2 * math.pi)
        return ahead if ahead * norm(self.u) > CLOSE else 2 * math.pi


def guide(centre: Array, axis: Array, start: Array, tangent: Array) -> Guide:
    """Create a directed circle.

    Args:
        centre: (3,) mm.
        axis: (3,) of any length.
        start: (3,) mm.
        tangent: (3,) approximate start direction.

    Raises:
        Unmet: there is no circle, or the tangent does not determine the sense of rotation.
    """
    size = norm(axis)
    if size < NO_DIRECTION:
        raise Unmet("an axis without direction")
    axis = axis / size
    u = across(start - centre, axis)
    if norm(u) < NO_DIRECTION:
        raise Unmet("the tool is on the axis of the circle")
    way = way_of(tangent, axis, u)
    if not way:
        raise Unmet("INDIRV or INDIRP does not say which way round")
    return Guide(start, start - u, axis, u, way * cross(axis, u), way)


def crossing(circle: Guide, plane: Plane, number: int) -> Array:
    """The first (1) or second (2) crossing of the circle with a plane.

    Raises:
        Unmet: there is no crossing.
    """
    farthest, along, reach = _facing(circle, plane)
    if abs(along) - reach > CLOSE:
        raise Unmet(f"the check surface is {abs(along) - reach:.6g} mm off the circle")
    half = math.acos(max(-1.0, min(1.0, along / reach)))
    ways = sorted(circle.way_to(angle) for angle in (farthest - half, farthest + half))
    return circle.point(ways[number - 1])


def touching(circle: Guide, plane: Plane) -> Array:
    """The point where a plane is tangent to the circle.

    Raises:
        Unmet: the plane is not tangent.
    """
    farthest, along, reach = _facing(circle, plane)
    off = abs(abs(along) - reach)
    if off > BAD_FIT:
        raise Unmet(f"TANTO: the check surface is {off:.6g} mm off a tangent")
    return circle.point(farthest if along > 0 else farthest + math.pi)


def _facing(circle: Guide, plane: Plane) -> tuple[float, float, float]:
    """Angle of the circle point farthest along the plane normal, offset of the plane from the hub, and radius."""
    across_plane = across(np.array(plane.normal), circle.axis)
    size = float(norm(across_plane))
    if size < SAME_DIRECTION:
        raise Unmet("the check surface is parallel to the circle")
    along = (plane.distance - float(np.array(plane.normal) @ circle.hub)) / size
    farthest = math.atan2(float(across_plane @ circle.v), float(across_plane @ circle.u))
    return farthest, along, float(norm(circle.u))


def ray_end(circle: Guide, line: Array, number: int) -> Array | None:
    """The end point of a line from the centre to a point of the circle, None for any other line.

    Args:
        circle: directed circle.
        line: (2, 3) its points, mm.
        number: required crossing, 0 if not given.

    Raises:
        Unmet: the line ends at another crossing or at another height.
    """
    first, last = across(line - circle.hub, circle.axis)
    if max(float(norm(first)), abs(float(norm(last) - norm(circle.u)))) > BAD_FIT:
        return None
    end: Array = circle.start if norm(last - circle.u) < CLOSE else line[1]
    if abs(float((end - circle.hub) @ circle.axis)) > BAD_FIT:
        raise Unmet("the LINE ends at another height than the tool has")
    if number and norm(across(crossing(circle, plane_along(line, circle.axis), number) - end, circle.axis)) > BAD_FIT:
        raise Unmet(f"{number},INTOF is not where the LINE ends")
    return end


def plane_along(line: Array, axis: Array) -> Plane:
    """The plane through a line, (2, 3) mm, along an axis.

    Raises:
        Unmet: the line is parallel to the axis.
    """
    normal = cross(line[1] - line[0], axis)
    plane = plane_of(normal, float(normal @ line[0]))
    if plane is None:
        raise Unmet("the LINE has no direction across the axis of the circle")
    return plane


def plane_of(normal: Array, distance: float) -> Plane | None:
    """The plane normal . point = distance, points in mm; None if the normal has no direction."""
    size = float(norm(normal))
    return Plane(tuple((normal / size).tolist()), distance / size) if size > NO_DIRECTION else None
