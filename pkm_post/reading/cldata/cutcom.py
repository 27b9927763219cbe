# SPDX-License-Identifier: LGPL-2.1-or-later
"""CUTCOM: start and end of cutter compensation, and what the file states about its points there.

Enters: statements and comments. Leaves: records in the course, evaluated once all points are known: see
``contour_data``.
"""

from __future__ import annotations

from pkm_post.reading.cldata.course import Course, Cutcom, Said
from pkm_post.reading.cldata.feeds import shown
from pkm_post.reading.cldata.statements import Statement

_SIDES = {"LEFT": 1.0, "RIGHT": -1.0}
_PLANES = {"XYPLAN": 2, "ZXPLAN": 1, "YZPLAN": 0}
_REGISTERS = {"ADJUST", "LENGTH", "OSETNO"}
"""Words before the number of an offset register of the control, which does not affect the path."""
_KNOWN = {*_SIDES, *_PLANES, *_REGISTERS, "OFF", "ON", "PLANE"}
_GEOMETRY_TYPES = {"OUTPUT_ON_CENTER": "centre", "OUTPUT_ON_PROFILE": "contour"}
_HEADERS = {"CENTRE": "centerline data", "CONTOUR": "contact contour data"}


def cutcom(course: Course, row: int, statement: Statement) -> None:
    """CUTCOM/LEFT or RIGHT[,plane][,register], CUTCOM/OFF; CUTCOM/ON keeps the active state."""
    words = statement.words
    sides = [_SIDES[word] for word in words if word in _SIDES]
    if not words or not set(words) <= _KNOWN or len(sides) > 1:
        course.tell("L401", row, f"CUTCOM/{shown(statement)}")
        return
    if sides or "OFF" in words:
        plane = next((_PLANES[word] for word in words if word in _PLANES), None)
        side = sides[0] if sides else 0.0
        course.cutcoms.append(Cutcom(row, side, plane, course.tool, _radius(course), course.points_said))


def _radius(course: Course) -> float:
    """Radius of the active tool: from the user, else from the file."""
    given = course.options.tools.get(course.tool)
    return (given.diameter if given and given.diameter > 0 else course.diameter) / 2


def geometry_type(course: Course, row: int, statement: Statement) -> None:
    """CUTCOM_GEOMETRY_TYPE/OUTPUT_ON_CENTER or OUTPUT_ON_PROFILE, a comment of Creo."""
    kind = next((word for word in statement.words if word in _GEOMETRY_TYPES), None)
    course.points_said = Said(_GEOMETRY_TYPES[kind], kind, row) if kind else None


def points_are(course: Course, row: int, statement: Statement) -> None:
    """The comments ``$$ centerline data`` and ``$$ contact contour data`` in the header of a tool path of NX."""
    kind = next((word for word in statement.words if word in _HEADERS), "")
    if kind:
        course.points_said = Said(kind.lower(), f"$$ {_HEADERS[kind]}", row)
