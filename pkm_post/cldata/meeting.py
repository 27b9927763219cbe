# SPDX-License-Identifier: LGPL-2.1-or-later
"""Meeting: where a circle that is travelled from a start meets a plane.

Circle, start and check surface enter in mm; the end of the motion leaves in mm. Nothing here knows of statements.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from pkm_post.cldata.arcs import BAD_FIT, CLOSE, NO_DIRECTION, way_of
from pkm_post.cldata.course import Plane
from pkm_post.geometry.arcs import across
from pkm_post.geometry.vectors import cross, norm
from pkm_post.model.program import Array

SAME_DIRECTION = 1e-3
"""Sine of the angle between two directions that are taken for one."""


class Unmet(Exception):  # noqa: N818 - a fault of the input, which the statement tells
    """Why the circle does not meet the check surface."""


@dataclass(frozen=True)
class Guide:
    """A circle travelled from a start: the points are hub + cos(angle) u + sin(angle) v.

    Attributes:
        start: (3,) mm.
        hub: (3,) mm, the centre in the plane of the motion.
        axis: (3,) unit, as written.
        u: (3,) mm from the hub to the start.
        v: (3,) the direction of travel at the start, as long as u.
        way: 1 if it is travelled right-handed about the axis, -1 if left-handed.
    """

    start: Array
    hub: Array
    axis: Array
    u: Array
    v: Array
    way: float

    def point(self, angle: float) -> Array:
        """The point after an angle; after next to none the tool has been all the way round."""
        nearest = abs((angle + math.pi) % (2 * math.pi) - math.pi)
        if nearest * norm(self.u) < CLOSE:
            return self.start
        found: Array = self.hub + math.cos(angle) * self.u + math.sin(angle) * self.v
        return found

    def way_to(self, angle: float) -> float:
        """An angle in the order of travel: more than 0, a full turn for the start itself."""
        ahead = angle % (2 * math.pi)
        return ahead if ahead * norm(self.u) > CLOSE else 2 * math.pi


def guide(centre: Array, axis: Array, start: Array, tangent: Array) -> Guide:
    """The circle from its start on.

    Args:
        centre: (3,) mm.
        axis: (3,) of any length.
        start: (3,) mm.
        tangent: (3,) the direction in which the tool starts, roughly.

    Raises:
        Unmet: there is no circle, or the tangent does not say which way round.
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
    """The point where the circle crosses a plane for the first (1) or second (2) time.

    Raises:
        Unmet: it does not.
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
        Unmet: it is not.
    """
    farthest, along, reach = _facing(circle, plane)
    off = abs(abs(along) - reach)
    if off > BAD_FIT:
        raise Unmet(f"TANTO: the check surface is {off:.6g} mm off a tangent")
    return circle.point(farthest if along > 0 else farthest + math.pi)


def _facing(circle: Guide, plane: Plane) -> tuple[float, float, float]:
    """The angle at which the circle goes farthest across a plane, how far off the plane the hub is, and the radius."""
    across_plane = across(np.array(plane.normal), circle.axis)
    size = float(norm(across_plane))
    if size < SAME_DIRECTION:
        raise Unmet("the check surface is parallel to the circle")
    along = (plane.distance - float(np.array(plane.normal) @ circle.hub)) / size
    farthest = math.atan2(float(across_plane @ circle.v), float(across_plane @ circle.u))
    return farthest, along, float(norm(circle.u))


def ray_end(circle: Guide, line: Array, number: int) -> Array | None:
    """The end of a line that leads from the centre to a point of the circle, None for any other line.

    Args:
        circle: travelled.
        line: (2, 3) its points, mm.
        number: of the crossing that it must be, 0 if none is said.

    Raises:
        Unmet: it ends at another crossing or at another height.
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
