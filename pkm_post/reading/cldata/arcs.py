# SPDX-License-Identifier: LGPL-2.1-or-later
"""Arcs that end at the next point: CIRCLE and CYLNDR with 6, 7 or 11 values and TIMES, also in comments, and MOVARC.

Enters: a statement. Leaves: an arc, as written. docs/cl-data.md lists the forms.
"""

from __future__ import annotations

import math

import numpy as np

from pkm_post.geometry import cross, dot, norm
from pkm_post.model import Array
from pkm_post.reading.cldata.course import Arc, Course, Vector
from pkm_post.reading.cldata.feeds import shown
from pkm_post.reading.cldata.statements import Statement

MOST_TURNS = 10000
GOOD_FIT = 5e-4
"""Tolerated difference of start and end radius, mm: files have at least four decimals."""
BAD_FIT = 0.05
"""Upper limit of this difference, mm."""
NO_DIRECTION = 1e-9
"""Length below which a vector has no direction."""
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
