# SPDX-License-Identifier: LGPL-2.1-or-later
"""Guided arcs: TLON,GOFWD along a circle until the tool end reaches a check surface, a plane or a line.

Enters: statements. Leaves: arcs and their end points, as written. A preceding INDIRV or INDIRP gives the start
direction. The circle crosses a check plane twice: without a number the first crossing in the direction of travel
applies, with 2,INTOF the second. A line represents the plane through it along the circle axis; if it leads from the
centre to a point of the circle, as CATIA writes it, that point is the end point.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import across, cross, norm
from pkm_post.model import Array
from pkm_post.reading.cldata.arc_statements import BAD_FIT, CLOSE, finish, way_of
from pkm_post.reading.cldata.feeds import shown
from pkm_post.reading.cldata.points import NO_DIRECTION, place
from pkm_post.reading.cldata.state import Arc, Course, Plane
from pkm_post.reading.cldata.statements import Statement

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


_TOUCH = -1
"""Crossing number of a tangent check surface."""


def indirv(course: Course, row: int, statement: Statement) -> None:
    """INDIRV/i,j,k: the direction in which the next TLON,GOFWD starts."""
    if _three(course, row, statement):
        course.tangent = tuple(statement.numbers)


def indirp(course: Course, row: int, statement: Statement) -> None:
    """INDIRP/x,y,z: the next TLON,GOFWD starts towards this point."""
    if _three(course, row, statement):
        start = place(course, row, "INDIRP")
        course.tangent = None if start is None else tuple((np.array(statement.numbers) - start).tolist())


def _three(course: Course, row: int, statement: Statement) -> bool:
    if len(statement.values) == 3:
        return True
    course.tell("L402", row, f"{statement.word}/{shown(statement)}, expected 3 values")
    return False


def psis(course: Course, row: int, statement: Statement) -> None:
    """PSIS/(PLANE/a,b,c,d): the part surface, in which the following arcs must lie."""
    course.part_surface = _plane(statement.items[0], course.scale) if len(statement.items) == 1 else None
    if course.part_surface is None:
        course.tell("L401", row, f"PSIS/{shown(statement)}, other than a plane")


def autops(course: Course, row: int, statement: Statement) -> None:
    """AUTOPS: the part surface passes through the tool position."""
    course.part_surface = None


def tlon(course: Course, row: int, statement: Statement) -> None:
    """TLON,GOFWD/(circle),ON,[1 or 2,INTOF,](check surface) and TLON,GOFWD/(circle),TANTO,(check surface)."""
    tangent, course.tangent = course.tangent, None
    parts = _parts(statement)
    arc = _circle(parts[0]) if parts else None
    if parts is None or arc is None or tangent is None:
        expected = "(circle),ON or TANTO,(PLANE or LINE) behind INDIRV or INDIRP"
        course.tell("L401", row, f"TLON,GOFWD/{shown(statement)}, other than {expected}")
        return
    start = place(course, row, "TLON,GOFWD")
    if start is None:
        return
    try:
        centre, axis = np.array(arc.centre), np.array(arc.axis)
        circle = guide(centre * course.scale, axis, start * course.scale, np.array(tangent))
        _check_part_surface(course.part_surface, circle)
        end = _end(circle, parts[1], parts[2], course.scale)
    except Unmet as why:
        course.tell("L408", row, str(why))
        return
    written = start if end is circle.start else end / course.scale
    finish(course, row, Arc(arc.centre, arc.axis, arc.radius, way=circle.way), written)


def _parts(statement: Statement) -> tuple[Statement, int, Statement] | None:
    """The circle, the crossing number, 0 if not given, and the check surface; None for other forms."""
    number = 0
    match statement.items:
        case [Statement() as circle, "ON", Statement() as check]:
            pass
        case [Statement() as circle, "ON", (1.0 | 2.0) as given, "INTOF", Statement() as check]:
            number = int(given)
        case [Statement() as circle, "TANTO", Statement() as check]:
            number = _TOUCH
        case _:
            return None
    known = _line(check, 1.0) is not None or _plane(check, 1.0) is not None
    return (circle, number, check) if known else None


def _end(circle: Guide, number: int, check: Statement, scale: float) -> Array:
    """End point of the motion, (3,) mm."""
    line = _line(check, scale)
    if line is not None and number != _TOUCH:
        end = ray_end(circle, line, number)
        if end is not None:
            return end
    plane = _plane(check, scale) if line is None else plane_along(line, circle.axis)
    if plane is None:
        raise ValueError(f"expected a plane or a line, got {check}")
    return touching(circle, plane) if number == _TOUCH else crossing(circle, plane, number or 1)


def _check_part_surface(plane: Plane | None, circle: Guide) -> None:
    """Check that the part surface, if any, is the plane of the circle at the start point."""
    if plane is None:
        return
    normal = np.array(plane.normal)
    if norm(cross(normal, circle.axis)) > SAME_DIRECTION or abs(normal @ circle.start - plane.distance) > BAD_FIT:
        raise Unmet("PSIS is not the plane of the circle at the start")


def _circle(statement: Statement) -> Arc | None:
    """CIRCLE/x,y,z,r in the XY plane, CIRCLE or CYLNDR/[CANON,]x,y,z,i,j,k,r."""
    values = statement.numbers
    words = [item for item in statement.items if not isinstance(item, float)]
    if len(values) == 7 and statement.word in ("CIRCLE", "CYLNDR") and words in ([], ["CANON"]):
        return Arc(tuple(values[:3]), tuple(values[3:6]), values[6])
    if len(values) == 4 and statement.word == "CIRCLE" and not words:
        return Arc(tuple(values[:3]), (0.0, 0.0, 1.0), values[3])
    return None


def _line(statement: Statement, scale: float) -> Array | None:
    """LINE/x1,y1,z1,x2,y2,z2 as two points, (2, 3) mm, else None."""
    if statement.word == "LINE" and len(statement.values) == 6:
        return np.reshape(statement.values, (2, 3)) * scale
    return None


def _plane(statement: object, scale: float) -> Plane | None:
    """PLANE/[CANON,]a,b,c,d with ax + by + cz = d, PLANE/(POINT/x,y,z),PERPTO,(VECTOR/i,j,k), mm, else None."""
    match statement:
        case Statement("PLANE", [float(a), float(b), float(c), float(d)]):
            return plane_of(np.array([a, b, c]), d * scale)
        case Statement("PLANE", ["CANON", float(a), float(b), float(c), float(d)]):
            return plane_of(np.array([a, b, c]), d * scale)
        case Statement("PLANE", [Statement("POINT") as point, "PERPTO", Statement("VECTOR") as vector]):
            if len(point.values) == len(vector.values) == 3:
                normal = np.array(vector.values)
                return plane_of(normal, float(normal @ np.array(point.values)) * scale)
    return None
