# SPDX-License-Identifier: LGPL-2.1-or-later
"""Arcs: the statements that say them, in the forms that CAM systems write.

A statement enters; an arc leaves, as written. Forms (docs/cl-data.md): CIRCLE with 6, 7 or 11 values and TIMES,
MOVARC with or without words, TLON,GOFWD with CIRCLE and LINE, HELICAL.
"""

from __future__ import annotations

import math

from pkm_post.cldata.course import Arc, Course, Point, Vector
from pkm_post.cldata.feeds import shown
from pkm_post.cldata.statements import Statement

MOST_TURNS = 10000
_MOVARC = {"CENTER": 3, "AXIS": 3, "RADIUS": 1, "ANGLE": 1}


def circle(course: Course, row: int, statement: Statement) -> None:
    """CIRCLE/x,y,z,i,j,k[,r[,t,f,d,e]][,TIMES,n]: the next GOTO is its end."""
    items = list(statement.items)
    turns = 0.0
    if len(items) > 2 and items[-2] == "TIMES" and isinstance(items[-1], float):
        turns = items[-1] - 1
        del items[-2:]
    values = [item for item in items if isinstance(item, float)]
    if len(values) != len(items) or len(values) not in (6, 7, 11):
        course.tell("L402", row, f"CIRCLE/{shown(statement)}, expected 6, 7 or 11 values")
        return
    if not 0 <= turns <= MOST_TURNS or turns != int(turns):
        course.tell("L403", row, f"TIMES,{turns + 1:g}")
        return
    radius = values[6] if len(values) > 6 else math.nan
    course.arcs.append((row, Arc(tuple(values[:3]), tuple(values[3:6]), radius, turns=int(turns))))


def movarc(course: Course, row: int, statement: Statement) -> None:
    """MOVARC/x,y,z,i,j,k,r[,ANGLE,a] and MOVARC/CENTER,x,y,z,AXIS,i,j,k,RADIUS,r[,ANGLE,a]."""
    found = _by_word(statement)
    if found is None or not {"CENTER", "AXIS"} <= found.keys():
        course.tell("L402", row, f"MOVARC/{shown(statement)}, expected x,y,z,i,j,k,r,ANGLE,a")
        return
    angle = math.radians(abs(found["ANGLE"][0])) if "ANGLE" in found else math.nan
    radius = found.get("RADIUS", (math.nan,))[0]
    course.arcs.append((row, Arc(found["CENTER"], found["AXIS"], radius, angle)))


def _by_word(statement: Statement) -> dict[str, Vector] | None:
    """The values by the word before them; without words in the order centre, axis, radius."""
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


def indirv(course: Course, row: int, statement: Statement) -> None:
    """INDIRV/i,j,k: the direction in which the next TLON,GOFWD starts."""
    if len(statement.numbers) != 3 or statement.words:
        course.tell("L402", row, f"INDIRV/{shown(statement)}, expected 3 values")
        return
    course.tangent = tuple(statement.numbers)


def tlon(course: Course, row: int, statement: Statement) -> None:
    """TLON,GOFWD/(CIRCLE/x,y,z,r),ON,(LINE/x1,y1,z1,x2,y2,z2): along the circle to the second point of the line.

    CIRCLE/CANON,x,y,z,i,j,k,r gives the axis too. INDIRV before it gives the sense.
    """
    parts = [item for item in statement.items if isinstance(item, Statement)]
    circles = [part for part in parts if part.word == "CIRCLE"]
    lines = [part for part in parts if part.word == "LINE" and len(part.numbers) == 6]
    arc = _canonical(circles[0], course.tangent) if len(circles) == 1 else None
    if arc is None or len(lines) != 1 or len(parts) != 2 or course.tangent is None:
        course.tell("L401", row, "TLON,GOFWD other than along a CIRCLE to a LINE, with INDIRV before it")
        return
    course.tangent = None
    course.arcs.append((row, arc))
    course.points.append((row, Point(tuple(lines[0].numbers[3:]))))


def _canonical(circle: Statement, tangent: Vector | None) -> Arc | None:
    values = circle.numbers
    if circle.words == ["CANON"] and len(values) == 7:
        return Arc(tuple(values[:3]), tuple(values[3:6]), values[6], tangent=tangent)
    if not circle.words and len(values) == 4:
        return Arc(tuple(values[:3]), (0.0, 0.0, 1.0), values[3], tangent=tangent)
    return None


def helical(course: Course, row: int, statement: Statement) -> None:
    """HELICAL/centre, start tangent, axis, pitch, radius[, angle, height, turns], end: 14 or 17 values."""
    values = statement.numbers
    if len(values) not in (14, 17) or statement.words:
        course.tell("L402", row, f"HELICAL of {len(values)} values, expected 14 or 17")
        return
    centre, tangent, axis, end = (tuple(values[index : index + 3]) for index in (0, 3, 6, len(values) - 3))
    size = math.hypot(*axis)
    rise = sum(direction * (last - first) for direction, last, first in zip(axis, end, centre, strict=True))
    turns = abs(rise / (size * values[9])) if values[9] and size else 0.0
    if turns > MOST_TURNS:
        course.tell("L403", row, f"{turns:g} turns")
        return
    turns = max(math.ceil(turns - 1e-6) - 1, 0)
    course.arcs.append((row, Arc(centre, axis, values[10], tangent=tangent, turns=turns)))
    course.points.append((row, Point(end)))
