# SPDX-License-Identifier: LGPL-2.1-or-later
"""Frames: UNITS, MSYS, CSYS, CATIA's matrix, ORIGIN, TRANS and TRACUT.

Enters: statements. Leaves: 4 x 4 matrices that transform points of the file, in mm, to the work frame. That is the
first machining frame of the file, or the frame those are defined in: matrix = shift @ inverse(base) @ local.
"""

from __future__ import annotations

import numpy as np

from pkm_post.model import Array
from pkm_post.reading.cldata.feeds import shown
from pkm_post.reading.cldata.length_unit import UNIT_WORDS
from pkm_post.reading.cldata.options import UNITS
from pkm_post.reading.cldata.state import Course
from pkm_post.reading.cldata.statements import Statement

_SQUARE = 1e-3
"""Tolerance of frame axes from unit length and right angles."""


def units(course: Course, row: int, statement: Statement) -> None:
    """UNITS/MM or INCHES; an option takes precedence."""
    name = UNIT_WORDS.get(next(iter(statement.words), ""))
    if name is None:
        course.tell("L402", row, f"{statement.word}/{shown(statement)}, expected MM or INCHES")
        return
    if course.options.units is None:
        course.unit, course.scale = name, UNITS[name]
        course.scales.append((row, course.scale))


def frame(course: Course, row: int, statement: Statement) -> None:
    """MSYS/origin, X axis, Y axis; CSYS and CATIA0 as three rows of four."""
    values = statement.values
    expected = 9 if statement.word == "MSYS" else 12
    if len(values) != expected:
        course.tell("L402", row, f"{statement.word}/{shown(statement)}, expected {expected} values")
        return
    matrix = _from_axes(values) if statement.word == "MSYS" else _from_rows(values)
    if not _rigid(course, row, statement, matrix):
        return
    if statement.word in course.dialect.frames:
        matrix[:3, 3] *= course.scale
        course.local = matrix
        _put(course, row)
    elif statement.word == "CSYS":
        course.axes.append((row, tuple(matrix[:3, 2].tolist())))


def origin(course: Course, row: int, statement: Statement) -> None:
    """ORIGIN/x,y,z[,X axis, Z axis]: the machine origin in point coordinates."""
    values = statement.values
    if len(values) not in (3, 9):
        course.tell("L402", row, f"ORIGIN/{shown(statement)}, expected 3 or 9 values")
        return
    z, x = np.array(values[6:9] or (0, 0, 1.0)), np.array(values[3:6] or (1.0, 0, 0))
    matrix = _from_axes([*values[:3], *x, *np.cross(z, x)])
    if _rigid(course, row, statement, matrix):
        matrix[:3, 3] *= course.scale
        course.shift = np.linalg.inv(matrix)
        _put(course, row)


def trans(course: Course, row: int, statement: Statement) -> None:
    """TRANS/x,y,z, TRANS/three rows of four, and TRACUT likewise; NOMORE and OFF end it."""
    values = statement.values
    if not values and set(statement.words) & {"NOMORE", "OFF"}:
        course.shift = None
        _put(course, row)
        return
    if len(values) not in (3, 12):
        course.tell("L402", row, f"{statement.word}/{shown(statement)}, expected 3 or 12 values")
        return
    matrix = np.eye(4) if len(values) == 3 else _from_rows(values)
    if len(values) == 3:
        matrix[:3, 3] = values
    if _rigid(course, row, statement, matrix):
        matrix[:3, 3] *= course.scale
        course.shift = matrix
        _put(course, row)


def trntyp(course: Course, row: int, statement: Statement) -> None:
    """TRNTYP/WORLD,...: the points are in one frame; no other type is supported."""
    if "WORLD" not in statement.words:
        course.tell("L401", row, f"TRNTYP/{shown(statement)}")


def _put(course: Course, row: int) -> None:
    """Record that the active frames transform points from here on."""
    eye = np.eye(4)
    local = eye if course.local is None else course.local
    if course.work_from_given is None and course.local is not None:
        course.work_from_given = eye if course.options.frame == "absolute" else np.linalg.inv(local)
    matrix = local if course.work_from_given is None else course.work_from_given @ local
    course.frames.append((row, matrix if course.shift is None else course.shift @ matrix))


def _from_rows(values: list[float]) -> Array:
    matrix = np.eye(4)
    matrix[:3] = np.reshape(values, (3, 4))
    return matrix


def _from_axes(values: list[float]) -> Array:
    """Matrix from origin, X axis and Y axis."""
    matrix = np.eye(4)
    place, x, y = np.reshape(values, (3, 3))
    matrix[:3] = np.stack([x, y, np.cross(x, y), place], axis=1)
    return matrix


def _rigid(course: Course, row: int, statement: Statement, matrix: Array) -> bool:
    """Whether the matrix is a rigid transform; report if not."""
    turn = matrix[:3, :3]
    size = np.abs(turn).max()
    if size < 2 and np.abs(turn @ turn.T - np.eye(3)).max() <= _SQUARE and np.linalg.det(turn) > 0:
        return True
    course.tell("L403", row, f"{statement.word}: the axes are not square, of unit length and right-handed")
    return False
