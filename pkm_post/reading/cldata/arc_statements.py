# SPDX-License-Identifier: LGPL-2.1-or-later
"""Arcs that end at the next point: CIRCLE and CYLNDR with 6, 7 or 11 values and TIMES, also in comments, and MOVARC.

Enters: a statement. Leaves: an arc, as written. docs/cl-data.md lists the forms.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from pkm_post.geometry import arc_sweep, cross, dot, norm
from pkm_post.model import Array
from pkm_post.reading.cldata.feeds import shown
from pkm_post.reading.cldata.points import NO_DIRECTION, place
from pkm_post.reading.cldata.state import Arc, ArcData, Course, Point, Vector
from pkm_post.reading.cldata.statements import Statement

MOST_TURNS = 10000
GOOD_FIT = 5e-4
"""Tolerated difference of start and end radius, mm: files have at least four decimals."""
BAD_FIT = 0.05
"""Upper limit of this difference, mm."""
CLOSE = 1e-3
"""mm below which two points of a circle coincide: one digit above the rounding of files with four decimals."""

_MOVARC = {"CENTER": 3, "AXIS": 3, "RADIUS": 1, "ANGLE": 1}
_COUNTS = {"CIRCLE": (6, 7, 11), "CYLNDR": (7,)}
_SQUARE_ON = 1e-6
"""Cosine below which a direction does not determine the sense of rotation."""


def circle(course: Course, row: int, statement: Statement) -> None:
    """CIRCLE/x,y,z,i,j,k[,r[,t,f,d,e]][,TIMES,n], CYLNDR/x,y,z,i,j,k,r: the next GOTO is its end point."""
    items = list(statement.items)
    turns = 0.0
    if len(items) > 2 and items[-2] == "TIMES" and isinstance(items[-1], float):
        turns = items[-1] - 1
        del items[-2:]
    values = [item for item in items if isinstance(item, float)]
    counts = _COUNTS[statement.word]
    if len(values) != len(items) or len(values) not in counts:
        expected = ", ".join(map(str, counts[:-1])) + " or " if len(counts) > 1 else ""
        course.tell("L402", row, f"{statement.word}/{shown(statement)}, expected {expected}{counts[-1]} values")
        return
    if not 0 <= turns <= MOST_TURNS or turns != int(turns):
        course.tell("L403", row, f"TIMES,{turns + 1:g}")
        return
    radius = values[6] if len(values) > 6 else math.nan
    course.arcs.append((row, Arc(tuple(values[:3]), tuple(values[3:6]), radius, turns=int(turns))))


def commented(course: Course, row: int, statement: Statement) -> None:
    """$$ CIRCLE/x,y,z,i,j,k,r: the following points may lie on this circle."""
    values = statement.numbers
    if course.dialect.pted and len(values) == 7 and math.hypot(*values[3:6]) > NO_DIRECTION and values[6] > 0:
        course.circles.append((row, Arc(tuple(values[:3]), tuple(values[3:6]), values[6], shorter=True)))


def movarc(course: Course, row: int, statement: Statement) -> None:
    """MOVARC/x,y,z,i,j,k,r[,ANGLE,a] and MOVARC/CENTER,x,y,z,AXIS,i,j,k,RADIUS,r[,ANGLE,a]."""
    found = _by_word(statement)
    if found is None or not {"CENTER", "AXIS"} <= found.keys():
        course.tell("L402", row, f"MOVARC/{shown(statement)}, expected x,y,z,i,j,k,r,ANGLE,a")
        return
    angle = math.radians(abs(found["ANGLE"][0])) if "ANGLE" in found else math.nan
    if angle > 2 * math.pi * (1 + 1e-9):
        course.tell("L401", row, f"MOVARC by {math.degrees(angle):g} degrees")
        return
    radius = found.get("RADIUS", (math.nan,))[0]
    course.arcs.append((row, Arc(found["CENTER"], found["AXIS"], radius, angle)))


def _by_word(statement: Statement) -> dict[str, Vector] | None:
    """The values by their preceding word; without words in the order centre, axis, radius."""
    numbers = statement.numbers
    if statement.items and isinstance(statement.items[0], float) and len(numbers) in (7, 8):
        expected = [*numbers[:7], "ANGLE", numbers[7]] if len(numbers) == 8 else numbers
        if list(statement.items) != expected:
            return None
        parts = {"CENTER": numbers[:3], "AXIS": numbers[3:6], "RADIUS": numbers[6:7], "ANGLE": numbers[7:]}
        return {name: tuple(values) for name, values in parts.items() if values}
    found: dict[str, list[float]] = {}
    for item in statement.items:
        if isinstance(item, str) and item in _MOVARC and item not in found:
            found[item] = []
        elif isinstance(item, float) and found:
            found[next(reversed(found))].append(item)
        else:
            return None
    if any(len(values) != _MOVARC[name] for name, values in found.items()):
        return None
    return {name: tuple(values) for name, values in found.items()}


def way_of(tangent: Array, axis: Array, radius: Array) -> float:
    """Sense of rotation about the axis of a direction at a point: 1 right-handed, -1 left-handed, 0 neither.

    Args:
        tangent: (3,) the direction, of any length.
        axis: (3,) of the circle.
        radius: (3,) from the centre to the point.
    """
    round_about = cross(axis, radius)
    along = float(dot(tangent, round_about))
    size = float(norm(tangent) * norm(round_about))
    return float(np.sign(along)) if abs(along) > _SQUARE_ON * size else 0.0


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
