# SPDX-License-Identifier: LGPL-2.1-or-later
"""Arcs to a check surface: TLON,GOFWD along a circle until the tool end reaches a check surface, a plane or a line.

Input: statements. Output: arcs and their end points, as written. A preceding INDIRV or INDIRP gives the start
direction. The circle intersects a check plane twice: without a number the first intersection in the direction of travel
applies, with 2,INTOF the second. A line represents the plane through it along the circle axis; if it leads from the
centre to a point of the circle, as CATIA writes it, that point is the end point.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import across, cross, norm
from pkm_post.model import Array
from pkm_post.reading.cldata.arc_statements import COINCIDENT, MAX_DEVIATION, add_arc, sense_of_rotation
from pkm_post.reading.cldata.points import NO_DIRECTION, tool_position
from pkm_post.reading.cldata.state import Arc, Plane, ReaderState
from pkm_post.reading.cldata.statements import Statement

_TANGENT = -1
"""Intersection number of a tangent check surface."""
_PARALLEL = 1e-3
"""Sine of the angle below which two directions count as parallel."""


class _NoIntersection(Exception):  # noqa: N818 - a fault of the input, reported with its statement
    """The circle does not meet the check surface; the message says why."""


@dataclass(frozen=True)
class _DirectedCircle:
    """A directed circle from a start point: the points are centre + cos(angle) u + sin(angle) v.

    Attributes:
        start: (3,) mm.
        centre: (3,) mm, in the plane of motion.
        axis: (3,) unit, as written.
        u: (3,) mm from the centre to the start.
        v: (3,) direction of travel at the start, of the length of u.
        sense: sense of rotation about the axis: 1 right-handed, -1 left-handed.
    """

    start: Array
    centre: Array
    axis: Array
    u: Array
    v: Array
    sense: float

    def point(self, angle: float) -> Array:
        """The point at an angle of travel; at about zero or a full turn, the start point itself."""
        nearest = abs((angle + math.pi) % (2 * math.pi) - math.pi)
        if nearest * norm(self.u) < COINCIDENT:
            return self.start
        return self.centre + math.cos(angle) * self.u + math.sin(angle) * self.v

    def travel_angle(self, angle: float) -> float:
        """Convert an angle to travel order: above 0, a full turn for the start point itself."""
        ahead = angle % (2 * math.pi)
        return ahead if ahead * norm(self.u) > COINCIDENT else 2 * math.pi


def indirv(state: ReaderState, row: int, statement: Statement) -> None:
    """INDIRV/i,j,k: the direction in which the next TLON,GOFWD starts."""
    values = state.expect_values(row, statement, 3)
    if values:
        state.tangent = tuple(values)


def indirp(state: ReaderState, row: int, statement: Statement) -> None:
    """INDIRP/x,y,z: the next TLON,GOFWD starts towards this point."""
    values = state.expect_values(row, statement, 3)
    if values:
        start = tool_position(state, row, "INDIRP")
        state.tangent = None if start is None else tuple((np.array(values) - start).tolist())


def psis(state: ReaderState, row: int, statement: Statement) -> None:
    """PSIS/(PLANE/a,b,c,d): the part surface, in which the following arcs must lie."""
    state.part_surface = _plane(statement.items[0], state.scale) if len(statement.items) == 1 else None
    if state.part_surface is None:
        state.report("L401", row, f"PSIS/{statement.items_text()}, other than a plane")


def autops(state: ReaderState, row: int, statement: Statement) -> None:
    """AUTOPS: the part surface passes through the tool position."""
    state.part_surface = None


def tlon(state: ReaderState, row: int, statement: Statement) -> None:
    """TLON,GOFWD/(circle),ON,[1 or 2,INTOF,](check surface) and TLON,GOFWD/(circle),TANTO,(check surface)."""
    tangent, state.tangent = state.tangent, None
    parts = _parts(statement)
    arc = _circle(parts[0]) if parts else None
    if parts is None or arc is None or tangent is None:
        expected = "(circle),ON or TANTO,(PLANE or LINE) after INDIRV or INDIRP"
        state.report("L401", row, f"TLON,GOFWD/{statement.items_text()}, other than {expected}")
        return
    start = tool_position(state, row, "TLON,GOFWD")
    if start is None:
        return
    try:
        centre, axis = np.array(arc.centre), np.array(arc.axis)
        circle = _directed_circle(centre * state.scale, axis, start * state.scale, np.array(tangent))
        _check_plane_of_circle("PSIS", state.part_surface, circle)
        if parts[2].items[:1] == ("PERPTO",):
            _check_plane_of_circle("PERPTO", _plane(parts[2].items[1], state.scale), circle)
        end = _end_point(circle, parts[1], parts[2], state.scale)
    except _NoIntersection as fault:
        state.report("L408", row, str(fault))
        return
    written = start if end is circle.start else end / state.scale
    add_arc(state, row, Arc(arc.centre, arc.axis, arc.radius, sense=circle.sense), written)


def _parts(statement: Statement) -> tuple[Statement, int, Statement] | None:
    """The circle, the intersection number, 0 if not given, and the check surface; None for other forms."""
    number = 0
    match statement.items:
        case [Statement() as circle, "ON", Statement() as check]:
            pass
        case [Statement() as circle, "ON", (1.0 | 2.0) as given, "INTOF", Statement() as check]:
            number = int(given)
        case [Statement() as circle, "TANTO", Statement() as check]:
            number = _TANGENT
        case _:
            return None
    known = _line(check, 1.0) is not None or _plane(check, 1.0) is not None
    return (circle, number, check) if known else None


def _end_point(circle: _DirectedCircle, number: int, check: Statement, scale: float) -> Array:
    """End point of the motion, (3,) mm."""
    line = _line(check, scale)
    if line is not None and number != _TANGENT:
        end = _radial_line_end(circle, line, number)
        if end is not None:
            return end
    plane = _plane(check, scale) if line is None else _plane_along(line, circle.axis)
    if plane is None:
        raise ValueError(f"expected a plane or a line, got {check}")
    return _tangent_point(circle, plane) if number == _TANGENT else _intersection(circle, plane, number or 1)


def _check_plane_of_circle(word: str, plane: Plane | None, circle: _DirectedCircle) -> None:
    """Check that the plane behind a word, if any, is that of the circle at the start point."""
    if plane is None:
        return
    normal = np.array(plane.normal)
    if norm(cross(normal, circle.axis)) > _PARALLEL or abs(normal @ circle.start - plane.distance) > MAX_DEVIATION:
        raise _NoIntersection(f"{word} is not the plane of the circle at the start")


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
    """LINE/x1,y1,z1,x2,y2,z2 or PLANE/PERPTO,(plane),(POINT/),(POINT/) as two points, (2, 3) mm, else None.

    That plane is perpendicular to the other one, which is that of the circle, so both are a line along its axis.
    """
    match statement:
        case Statement(
            "PLANE", ["PERPTO", Statement() as plane, Statement("POINT") as first, Statement("POINT") as last]
        ):
            values = [*first.values, *last.values] if _plane(plane, 1.0) is not None else []
        case _:
            values = statement.values if statement.word == "LINE" else []
    return np.reshape(values, (2, 3)) * scale if len(values) == 6 else None


def _plane(statement: object, scale: float) -> Plane | None:
    """PLANE/[CANON,]a,b,c,d with ax + by + cz = d, PLANE/(POINT/x,y,z),PERPTO,(VECTOR/i,j,k), mm, else None."""
    match statement:
        case Statement("PLANE", [float(a), float(b), float(c), float(d)]):
            return _plane_of(np.array([a, b, c]), d * scale)
        case Statement("PLANE", ["CANON", float(a), float(b), float(c), float(d)]):
            return _plane_of(np.array([a, b, c]), d * scale)
        case Statement("PLANE", [Statement("POINT") as point, "PERPTO", Statement("VECTOR") as vector]):
            if len(point.values) == len(vector.values) == 3:
                normal = np.array(vector.values)
                return _plane_of(normal, float(normal @ np.array(point.values)) * scale)
    return None


def _directed_circle(centre: Array, axis: Array, start: Array, tangent: Array) -> _DirectedCircle:
    """A circle with an axis of any length, directed by its approximate start direction; all (3,), mm.

    Raises:
        _NoIntersection: there is no circle, or the tangent does not determine the sense of rotation.
    """
    size = norm(axis)
    if size < NO_DIRECTION:
        raise _NoIntersection("an axis without direction")
    axis = axis / size
    u = across(start - centre, axis)
    if norm(u) < NO_DIRECTION:
        raise _NoIntersection("the tool is on the axis of the circle")
    sense = sense_of_rotation(tangent, axis, u)
    if not sense:
        raise _NoIntersection("INDIRV or INDIRP does not give the sense of rotation")
    return _DirectedCircle(start, start - u, axis, u, sense * cross(axis, u), sense)


def _intersection(circle: _DirectedCircle, plane: Plane, number: int) -> Array:
    """The first (1) or second (2) intersection of the circle with a plane.

    Raises:
        _NoIntersection: there is none.
    """
    farthest, along, reach = _farthest_point(circle, plane)
    if abs(along) - reach > COINCIDENT:
        raise _NoIntersection(f"the check surface is {abs(along) - reach:.6g} mm off the circle")
    half = math.acos(max(-1.0, min(1.0, along / reach)))
    angles = sorted(circle.travel_angle(angle) for angle in (farthest - half, farthest + half))
    return circle.point(angles[number - 1])


def _tangent_point(circle: _DirectedCircle, plane: Plane) -> Array:
    """The point where a plane is tangent to the circle.

    Raises:
        _NoIntersection: the plane is not tangent.
    """
    farthest, along, reach = _farthest_point(circle, plane)
    off = abs(abs(along) - reach)
    if off > MAX_DEVIATION:
        raise _NoIntersection(f"TANTO: the check surface is {off:.6g} mm off a tangent")
    return circle.point(farthest if along > 0 else farthest + math.pi)


def _farthest_point(circle: _DirectedCircle, plane: Plane) -> tuple[float, float, float]:
    """Angle of the circle point farthest along the plane normal, offset of the plane from the centre, and radius."""
    across_plane = across(np.array(plane.normal), circle.axis)
    size = float(norm(across_plane))
    if size < _PARALLEL:
        raise _NoIntersection("the check surface is parallel to the circle")
    along = (plane.distance - float(np.array(plane.normal) @ circle.centre)) / size
    farthest = math.atan2(float(across_plane @ circle.v), float(across_plane @ circle.u))
    return farthest, along, float(norm(circle.u))


def _radial_line_end(circle: _DirectedCircle, line: Array, number: int) -> Array | None:
    """The end point of a line, (2, 3) in mm, from the centre to a point of the circle, None for any other line.

    ``number`` is the required intersection, 0 if not given.

    Raises:
        _NoIntersection: the line ends at another intersection or at another height.
    """
    first, last = across(line - circle.centre, circle.axis)
    if max(float(norm(first)), abs(float(norm(last) - norm(circle.u)))) > MAX_DEVIATION:
        return None
    end: Array = circle.start if norm(last - circle.u) < COINCIDENT else line[1]
    if abs(float((end - circle.centre) @ circle.axis)) > MAX_DEVIATION:
        raise _NoIntersection("the LINE ends at another height than the tool has")
    if (
        number
        and norm(across(_intersection(circle, _plane_along(line, circle.axis), number) - end, circle.axis))
        > MAX_DEVIATION
    ):
        raise _NoIntersection(f"{number},INTOF is not where the LINE ends")
    return end


def _plane_along(line: Array, axis: Array) -> Plane:
    """The plane through a line, (2, 3) mm, along an axis.

    Raises:
        _NoIntersection: the line is parallel to the axis.
    """
    normal = cross(line[1] - line[0], axis)
    plane = _plane_of(normal, float(normal @ line[0]))
    if plane is None:
        raise _NoIntersection("the LINE has no direction across the axis of the circle")
    return plane


def _plane_of(normal: Array, distance: float) -> Plane | None:
    """The plane normal . point = distance, points in mm; None if the normal has no direction."""
    size = float(norm(normal))
    return Plane(tuple((normal / size).tolist()), distance / size) if size > NO_DIRECTION else None
