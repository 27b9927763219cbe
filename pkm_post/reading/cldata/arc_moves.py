# SPDX-License-Identifier: LGPL-2.1-or-later
"""Arc moves: arcs with their own end point: ARCDAT with ARCMOV, GOCLW and GOCCLW, CW and CCW, HELICAL.

Enters: a statement. Leaves: an arc and its end point, as written. Clockwise is as seen against the written axis
(ARCMOV), or against the tool axis, from the holder to the tip (the others).
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from pkm_post.geometry import arc_sweep, norm
from pkm_post.model import Array
from pkm_post.reading.cldata.arcs import BAD_FIT, CLOSE, MOST_TURNS, NO_DIRECTION, way_of
from pkm_post.reading.cldata.course import Arc, ArcData, Course, Point
from pkm_post.reading.cldata.feeds import shown
from pkm_post.reading.cldata.place import place
from pkm_post.reading.cldata.statements import Statement

_WAYS = {"CLW": -1.0, "CCLW": 1.0, "GOCLW": -1.0, "GOCCLW": 1.0, "CW": -1.0, "CCW": 1.0}


def arcslp(course: Course, row: int, statement: Statement) -> None:
    """ARCSLP/depth directly before ARCDAT: the arc rises or falls by the depth; other uses are refused."""
    after = course.statements.word(row + 1) if row + 1 < len(course.statements) else ""
    if len(statement.values) != 1 or after != "ARCDAT":
        course.tell("L401", row, f"ARCSLP/{shown(statement)}, other than a depth before ARCDAT")
        return
    course.slope = abs(statement.values[0])


def arcdat(course: Course, row: int, statement: Statement) -> None:
    """ARCDAT/x,y,z,i,j,k,r: the circle of the next ARCMOV."""
    rise, course.slope = course.slope, 0.0
    values = _counted(course, row, statement, 7)
    if values:
        tell_unused(course)
        course.arc_data = ArcData(row, Arc(tuple(values[:3]), tuple(values[3:6]), values[6]), rise)


def tell_unused(course: Course) -> None:
    """Report an ARCDAT without ARCMOV."""
    if course.arc_data is not None:
        course.tell("L414", course.arc_data.row, "ARCDAT")


def _counted(course: Course, row: int, statement: Statement, *counts: int) -> list[float]:
    """The values of a statement; empty, with a fault, if their number is wrong."""
    values = statement.values
    if len(values) in counts:
        return values
    course.tell("L402", row, f"{statement.word}/{shown(statement)}, expected {' or '.join(map(str, counts))} values")
    return []


def arcmov(course: Course, row: int, statement: Statement) -> None:
    """ARCMOV/CLW or CCLW,x,y,z,angle: along the circle of ARCDAT to the point, by an angle in degrees."""
    data, course.arc_data = course.arc_data, None
    match statement.items:
        case ["CLW" | "CCLW" as word, float(x), float(y), float(z), float(angle)] if data is not None:
            start = place(course, row, "ARCMOV")
            if start is not None:
                arc = replace(data.arc, way=_WAYS[word])
                _arcmov(course, row, arc, data.rise, start, np.array([x, y, z]), math.radians(angle))
        case _:
            course.tell("L402", row, f"ARCMOV/{shown(statement)}, expected CLW or CCLW,x,y,z,angle behind ARCDAT")


def _arcmov(course: Course, row: int, arc: Arc, rise: float, start: Array, end: Array, angle: float) -> None:
    """Add an arc if its end point, angle and rise are consistent."""
    size = float(norm(np.array(arc.axis)))
    if size < NO_DIRECTION:
        course.tell("L408", row, "an axis without direction")
        return
    axis = arc.way * np.array(arc.axis) / size
    along = float((end - start) @ axis)
    if norm(end - start - along * axis) * course.scale < CLOSE:
        end = start + along * axis
    sweep = float(arc_sweep(start, end, np.array(arc.centre), axis))
    turns = round((angle - sweep) / (2 * math.pi))
    apart = abs(angle - sweep - 2 * math.pi * turns) * arc.radius
    if not 0 <= turns <= MOST_TURNS or apart * course.scale > BAD_FIT:
        told = f"{math.degrees(angle):.6g} degrees as written, {math.degrees(sweep):.6g} to the end point"
        course.tell("L408", row, told)
    elif abs(abs(along) - rise) * course.scale > BAD_FIT:
        course.tell("L408", row, f"it rises by {abs(along):.6g}, ARCSLP says {rise:.6g}")
    else:
        finish(course, row, replace(arc, turns=turns), end)


def gocclw(course: Course, row: int, statement: Statement) -> None:
    """GOCLW and GOCCLW/centre,axis,radius,end: 10 values."""
    values = _counted(course, row, statement, 10)
    if values:
        arc = Arc(tuple(values[:3]), tuple(values[3:6]), values[6], way=_WAYS[statement.word], seen_from_tool=True)
        finish(course, row, arc, np.array(values[7:]))


def ccw(course: Course, row: int, statement: Statement) -> None:
    """CW and CCW/axis,start,centre,end,radius: 13 values."""
    values = _counted(course, row, statement, 13)
    start = place(course, row, statement.word) if values else None
    if start is None:
        return
    if norm(start - np.array(values[3:6])) * course.scale > BAD_FIT:
        course.tell("L408", row, f"{statement.word} does not start where the tool is")
        return
    arc = Arc(tuple(values[6:9]), tuple(values[:3]), values[12], way=_WAYS[statement.word], seen_from_tool=True)
    finish(course, row, arc, np.array(values[9:12]))


def helical(course: Course, row: int, statement: Statement) -> None:
    """HELICAL/centre, start tangent, axis, pitch, radius[, angle, height, turns], end: 14 or 17 values."""
    values = _counted(course, row, statement, 14, 17)
    start = place(course, row, "HELICAL") if values else None
    if start is None:
        return
    centre, tangent, axis = np.reshape(values[:9], (3, 3))
    end = np.array(values[-3:])
    size = float(norm(axis))
    way = way_of(tangent, axis, start - centre)
    if size < NO_DIRECTION or not way:
        course.tell("L408", row, "HELICAL: its tangent and axis do not say how it turns")
        return
    pitches = abs(float((end - start) @ axis) / (size * values[9])) if values[9] else 0.0
    sweep = float(arc_sweep(start, end, centre, way * axis / size))
    turns = max(pitches - sweep / (2 * math.pi), 0.0)
    if turns > MOST_TURNS:
        course.tell("L403", row, f"{turns:g} turns")
        return
    finish(course, row, Arc(tuple(values[:3]), tuple(values[6:9]), values[10], way=way, turns=round(turns)), end)


def finish(course: Course, row: int, arc: Arc, end: Array) -> None:
    """Record an arc with its end point."""
    course.arcs.append((row, arc))
    course.points.append((row, Point(tuple(end.tolist()))))
