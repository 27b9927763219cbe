# SPDX-License-Identifier: LGPL-2.1-or-later
"""Points: all GOTO at once, with FROM, GODLTA and the end points of self-contained arcs, in file order.

Enters: the table of statements and the records of the course. Leaves: columns of points, in mm and in the work frame,
with unit tool axes.
"""

from __future__ import annotations

from bisect import bisect_left
from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import norm
from pkm_post.model import Array
from pkm_post.reading.cldata.feeds import shown
from pkm_post.reading.cldata.options import AXIS, NORMAL, POINT, Dialect, ReadOptions
from pkm_post.reading.cldata.state import Course, Point
from pkm_post.reading.cldata.statements import Statement, Statements


def place(course: Course, row: int, asker: str) -> Array | None:
    """The tool position before a statement, (3,); None, with a fault, if unknown.

    Args:
        course: with all preceding statements read.
        row: the requesting statement.
        asker: its name, for messages.
    """
    before = int(course.gotos_before[row])
    goto_row = int(course.goto_rows[before - 1]) if before else -1
    special_row = course.points[-1][0] if course.points else -1
    if max(goto_row, special_row) < 0:
        course.tell("L417", row, asker)
        return None
    if _drilled(course, max(goto_row, special_row)) and not (asker == "GODLTA" and _drilled(course, row)):
        course.tell("L422", row, asker)
        return None
    if goto_row > special_row:
        return _carried(course, goto_row, _written(course, goto_row))
    return _carried(course, special_row, np.array(course.points[-1][1].position))


def _drilled(course: Course, row: int) -> bool:
    """Whether an active cycle is executed at a row: not at FROM, which gives the tool position."""
    change = bisect_left(course.cycles, row, key=lambda one: one[0]) - 1
    starts = any(at == row and point.start for at, point in course.points[-1:])
    return change >= 0 and course.cycles[change][1] is not None and not starts


def _written(course: Course, row: int) -> Array:
    """The point of a GOTO as written."""
    first, end = course.statements.number_start[row : row + 2].tolist()
    names = course.options.value_names(end - first) or POINT
    return np.array([course.statements.numbers[first + names.index(name)] for name in POINT])


def _carried(course: Course, row: int, position: Array) -> Array:
    """Convert a point written at a row to the current units and frame."""
    scale = course.scales[bisect_left(course.scales, row, key=lambda change: change[0]) - 1][1]
    index = bisect_left(course.frames, row, key=lambda change: change[0])
    if scale == course.scale and index == len(course.frames):
        return position
    now = course.frames[-1][1] if course.frames else np.eye(4)
    then = course.frames[index - 1][1] if index else np.eye(4)
    carried: Array = np.linalg.solve(now, then @ np.append(position * scale, 1.0))[:3] / course.scale
    return carried


ValueNames = dict[int, tuple[str, ...]]
"""Meanings of the values of each GOTO form."""
NO_DIRECTION = 1e-9
"""Length below which a vector has no direction."""
NOT_UNIT = 1e-3
"""Deviation from unit length above which a vector is reported."""


@dataclass
class Points:
    """Columns of P points.

    Attributes:
        row: (P,) their statements.
        position: (P, 3).
        axis: (P, 3) unit tool axis.
        normal: (P, 3) unit surface normal, NaN where absent.
        start: (P,) whether the point is the tool position, not a target.
    """

    row: Array
    position: Array
    axis: Array
    normal: Array
    start: Array


def goto(course: Course, row: int, statement: Statement) -> None:
    """Report a GOTO outside the bulk: its values are not understood."""
    course.tell("L402", row, f"GOTO/{shown(statement)}, expected x,y,z or x,y,z,i,j,k")


def bare(course: Course, row: int, statement: Statement) -> None:
    """Report a line of numbers that does not continue a GOTO."""
    follows = course.dialect.pted and row > 0 and course.statements.word(row - 1) in ("GOTO", "")
    code, expected = ("L402", "x,y,z or x,y,z,i,j,k") if follows else ("L201", "a word")
    course.tell(code, row, f"{shown(statement)}, expected {expected}")


def single(course: Course, row: int, statement: Statement) -> None:
    """FROM/x,y,z[,i,j,k]: the tool position; GODLTA/dx,dy,dz[,i,j,k]: an incremental move from it."""
    values = statement.values
    if len(values) not in (3, 6):
        course.tell("L402", row, f"{statement.word}/{shown(statement)}, expected 3 or 6 values")
        return
    position, axis = np.array(values[:3]), tuple(values[3:]) or None
    if statement.word == "GODLTA":
        start = place(course, row, "GODLTA")
        if start is None:
            return
        position = start + position
    course.points.append((row, Point(tuple(position.tolist()), axis, start=statement.word == "FROM")))


def tlaxis(course: Course, row: int, statement: Statement) -> None:
    """TLAXIS/i,j,k: the axis of points without their own."""
    if len(statement.values) != 3:
        course.tell("L402", row, f"TLAXIS/{shown(statement)}, expected 3 values")
    else:
        course.axes.append((row, tuple(statement.values)))


def multax(course: Course, row: int, statement: Statement) -> None:
    """MULTAX: adds nothing to GOTO; MULTAX/OFF sets the tool axis vertical."""
    if "OFF" in statement.words:
        course.axes.append((row, (0.0, 0.0, 1.0)))


def bulk_rows(statements: Statements, options: ReadOptions, dialect: Dialect) -> tuple[Array, ValueNames]:
    """Mask of the GOTO rows that are processed in bulk, and the value meanings of their forms.

    Points without a major word are included where they continue a GOTO.
    """
    names = {
        index: found
        for index, form in enumerate(statements.forms)
        if form.word in ("GOTO", "") and form.plain and (found := options.value_names(len(form.items)))
    }
    bulk: Array = np.isin(statements.form, list(names))
    bare = without_word(statements)
    if bare.any():
        goto = np.maximum.accumulate(np.where(bare, -1, np.arange(len(bare))))
        bulk &= ~bare | (bulk[goto] & (goto >= 0) & dialect.pted)
    return bulk, names


def without_word(statements: Statements) -> Array:
    """Mask of rows with numbers only, (N,)."""
    rows: Array = np.array([form.word == "" for form in statements.forms], dtype=np.bool_)[statements.form]
    return rows


def all_points(course: Course, bulk: Array, names: ValueNames) -> Points:
    """All points of the file as written, in file order."""
    rows, values = _bulk_values(course, bulk, names)
    special = [point for _, point in course.points]
    row = np.concatenate([rows, np.array([at for at, _ in course.points], dtype=np.int64)])
    order = np.argsort(row, kind="stable")
    nothing = (np.nan,) * 3
    more = np.array([(*one.position, *(one.axis or nothing), *nothing) for one in special]).reshape(-1, 9)
    columns = np.concatenate([values, more])[order]
    start = np.zeros(len(row), dtype=np.bool_)
    start[len(rows) :] = [one.start for one in special]
    return Points(row[order], columns[:, :3], columns[:, 3:6], columns[:, 6:], start[order])


def _bulk_values(course: Course, bulk: Array, names: ValueNames) -> tuple[Array, Array]:
    """Rows of GOTO statements, and their values as (P, 9): position, axis, normal."""
    statements = course.statements
    rows = np.flatnonzero(bulk)
    values = np.full((len(rows), 9), np.nan)
    column = {name: index for index, name in enumerate((*POINT, *AXIS, *NORMAL))}
    for form, value_names in names.items():
        mine = statements.form[rows] == form
        first = statements.number_start[rows[mine]]
        for offset, name in enumerate(value_names):
            if name in column:
                values[mine, column[name]] = statements.numbers[first + offset]
    return rows, values


def in_force(row: Array, changes: list[int]) -> Array:
    """Index of the last change before each of (P,) rows, -1 if there is none."""
    index: Array = np.searchsorted(np.array(changes, dtype=np.int64), row, "left") - 1
    return index


def resolve(course: Course, points: Points) -> Array:
    """Convert points to mm, the work frame and unit axes, in place; return their frames, (P, 4, 4) or (1, 4, 4)."""
    scales = np.array([scale for _, scale in course.scales])
    points.position = points.position * scales[in_force(points.row, [row for row, _ in course.scales])][:, None]
    points.axis = _modal_axes(course, points)
    _unit(course, points.row, points.axis, "axis")
    given = np.flatnonzero(~np.isnan(points.normal[:, 0]))
    normal = points.normal[given]
    _unit(course, points.row[given], normal, "normal")
    points.normal[given] = normal
    frames = np.array([np.eye(4), *(matrix for _, matrix in course.frames)])
    if len(frames) == 1:
        return frames
    frame: Array = frames[in_force(points.row, [row for row, _ in course.frames]) + 1]
    points.position = np.einsum("nij,nj->ni", frame[:, :3, :3], points.position) + frame[:, :3, 3]
    points.axis = np.einsum("nij,nj->ni", frame[:, :3, :3], points.axis)
    points.normal = np.einsum("nij,nj->ni", frame[:, :3, :3], points.normal)
    return frame


def _modal_axes(course: Course, points: Points) -> Array:
    """The axis of every point: its own, or the modal one."""
    own = np.flatnonzero(~np.isnan(points.axis[:, 0]))
    row = np.concatenate([[-1], points.row[own], np.array([at for at, _ in course.axes], dtype=np.int64)])
    said = np.concatenate([[[0.0, 0.0, 1.0]], points.axis[own], np.array([v for _, v in course.axes]).reshape(-1, 3)])
    order = np.argsort(row, kind="stable")
    axes: Array = said[order][np.searchsorted(row[order], points.row, "right") - 1]
    return axes


def _unit(course: Course, row: Array, vectors: Array, name: str) -> None:
    """Normalise vectors in place; report those without direction and those far from unit length."""
    length = norm(vectors)
    for index in np.flatnonzero(length < NO_DIRECTION).tolist():
        course.tell("L405", int(row[index]), f"{name} {_vector(vectors[index])}")
    odd = np.flatnonzero((np.abs(length - 1) > NOT_UNIT) & (length >= NO_DIRECTION)).tolist()
    if odd:
        more = f", and {len(odd) - 1} more" if len(odd) > 1 else ""
        course.tell("L406", int(row[odd[0]]), f"{name} {_vector(vectors[odd[0]])} of length {length[odd[0]]:.6g}{more}")
    vectors /= np.where(length < NO_DIRECTION, 1.0, length)[:, None]


def _vector(vector: Array) -> str:
    return ",".join(f"{value:.7g}" for value in vector)
