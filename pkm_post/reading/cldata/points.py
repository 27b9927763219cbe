# SPDX-License-Identifier: LGPL-2.1-or-later
"""Points: all GOTO at once, with FROM, GODLTA and the end points of self-contained arcs, in file order.

Input: the table of statements and the recorded state. Output: columns of points, in mm and in the work frame, with
unit tool axes.
"""

from __future__ import annotations

from bisect import bisect_left
from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import norm
from pkm_post.model import Array
from pkm_post.reading.cldata.copies import MATRIX
from pkm_post.reading.cldata.options import AXIS, CONTACT, NORMAL, POINT, Dialect, ReadOptions
from pkm_post.reading.cldata.state import Point, ReaderState
from pkm_post.reading.cldata.statements import Statement, Statements

ValueNames = dict[int, tuple[str, ...]]
"""Meanings of the values of each GOTO template."""
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
        contact: (P,) whether the position is a contact point, not the tool tip.
    """

    row: Array
    position: Array
    axis: Array
    normal: Array
    start: Array
    contact: Array


def goto(state: ReaderState, row: int, statement: Statement) -> None:
    """Report a GOTO outside the bulk: its values are not understood."""
    state.report_items(row, statement, "x,y,z or x,y,z,i,j,k, or others with --goto-values")


def numbers_only(state: ReaderState, row: int, statement: Statement) -> None:
    """Report a line of numbers that does not continue a GOTO."""
    follows = state.dialect.goto_continues and row > 0 and state.statements.word(row - 1) in ("GOTO", "")
    code, expected = ("L402", "x,y,z or x,y,z,i,j,k") if follows else ("L201", "a word")
    state.report(code, row, f"{statement.items_text()}, expected {expected}")


def from_or_godlta(state: ReaderState, row: int, statement: Statement) -> None:
    """FROM/x,y,z[,i,j,k]: the tool position; GODLTA/dx,dy,dz[,i,j,k]: an incremental move from it; GOHOME: a move."""
    at_home = statement.word == "GOHOME" and set(statement.items) <= {None}
    values = _home(state, row) if at_home else state.expect_values(row, statement, 3, 6)
    if not values:
        return
    if statement.word == "GOHOME" and _is_drilled(state, row):
        state.report("L422", row, "GOHOME")
        return
    position, axis = np.array(values[:3]), tuple(values[3:]) or None
    if statement.word == "GODLTA":
        start = tool_position(state, row, "GODLTA")
        if start is None:
            return
        position = start + position
    state.points.append((row, Point(tuple(position.tolist()), axis, start=statement.word == "FROM")))


def _home(state: ReaderState, row: int) -> list[float]:
    """The home position as if it were written in the current units and frame; empty, with a fault, if unknown."""
    zero = state.options.machine_zero
    if zero is None:
        state.report("L444", row, "GOHOME without a point")
        return []
    frame = state.frames[-1][1] if state.frames else np.eye(4)
    return (np.linalg.solve(frame, [*zero, 1.0])[:3] / state.scale).tolist()


def tool_position(state: ReaderState, row: int, word: str) -> Array | None:
    """The tool position before a statement with a major word, (3,); None, with a fault, if unknown."""
    before = int(state.gotos_before[row])
    goto_row = int(state.goto_rows[before - 1]) if before else -1
    special_row = state.points[-1][0] if state.points else -1
    if max(goto_row, special_row) < 0:
        state.report("L417", row, word)
        return None
    if _is_drilled(state, max(goto_row, special_row)) and not (word == "GODLTA" and _is_drilled(state, row)):
        state.report("L422", row, word)
        return None
    if goto_row > special_row and _is_contact(state, goto_row):
        state.report("L417", row, f"{word} after a contact point")
        return None
    if goto_row > special_row:
        written = _written_position(state, goto_row)
        # A coordinate beyond all numbers, as 1e999, is reported where it is written.
        return _in_current_frame(state, goto_row, written) if np.isfinite(written).all() else None
    return _in_current_frame(state, special_row, np.array(state.points[-1][1].position))


def _is_drilled(state: ReaderState, row: int) -> bool:
    """Whether an active cycle is executed at a row: not at FROM, which gives the tool position."""
    change = bisect_left(state.cycles, row, key=lambda one: one[0]) - 1
    is_from = any(at == row and point.start for at, point in state.points[-1:])
    return change >= 0 and state.cycles[change][1] is not None and not is_from


def _written_position(state: ReaderState, row: int) -> Array:
    """The point of a GOTO as written."""
    first, names = state.statements.number_start[row], _positions_named(_names_at(state, row))
    return np.array([state.statements.numbers[first + names.index(name)] for name in POINT])


def _is_contact(state: ReaderState, row: int) -> bool:
    """Whether the point of a GOTO is a contact point, whose tip is known once it is compensated."""
    return "x" not in _names_at(state, row)


def _names_at(state: ReaderState, row: int) -> tuple[str, ...]:
    """Meanings of the values of a GOTO."""
    first, end = state.statements.number_start[row : row + 2].tolist()
    return state.options.value_names(end - first) or POINT


def _positions_named(names: tuple[str, ...]) -> tuple[str, ...]:
    """Meanings of values with the contact point as the position, where there is no other."""
    return names if "x" in names else tuple(dict(zip(CONTACT, POINT, strict=True)).get(name, name) for name in names)


def _in_current_frame(state: ReaderState, row: int, position: Array) -> Array:
    """Convert a point written at a row to the current units and frame."""
    scale = state.scales[bisect_left(state.scales, row, key=lambda change: change[0]) - 1][1]
    index = bisect_left(state.frames, row, key=lambda change: change[0])
    if scale == state.scale and index == len(state.frames):
        return position
    now = state.frames[-1][1] if state.frames else np.eye(4)
    then = state.frames[index - 1][1] if index else np.eye(4)
    return np.linalg.solve(now, then @ np.append(position * scale, 1.0))[:3] / state.scale


def tlaxis(state: ReaderState, row: int, statement: Statement) -> None:
    """TLAXIS/i,j,k: the axis of points without their own."""
    values = state.expect_values(row, statement, 3)
    if values:
        state.axes.append((row, tuple(values)))


def multax(state: ReaderState, row: int, statement: Statement) -> None:
    """MULTAX: adds nothing to GOTO; MULTAX/OFF sets the tool axis vertical."""
    if "OFF" in statement.words:
        state.axes.append((row, (0.0, 0.0, 1.0)))


def bulk_rows(statements: Statements, options: ReadOptions, dialect: Dialect) -> tuple[Array, ValueNames]:
    """Mask of the GOTO rows that are processed in bulk, and the value meanings of their templates.

    Points without a major word are included where they continue a GOTO.
    """
    names = {
        index: value_names
        for index, template in enumerate(statements.templates)
        if template.word in ("GOTO", "")
        and template.only_numbers
        and (value_names := options.value_names(len(template.items)))
    }
    bulk: Array = np.isin(statements.template, list(names))
    bare = lines_of_numbers(statements)
    if bare.any():
        goto = np.maximum.accumulate(np.where(bare, -1, np.arange(len(bare))))
        bulk &= ~bare | (bulk[goto] & (goto >= 0) & dialect.goto_continues)
    return bulk, names


def lines_of_numbers(statements: Statements) -> Array:
    """Mask of rows with numbers only, (N,)."""
    without_word = np.array([template.word == "" for template in statements.templates], dtype=np.bool_)
    return without_word[statements.template]


def all_points(state: ReaderState, bulk: Array, names: ValueNames) -> Points:
    """All points of the file as written, in file order."""
    rows, values, contact = _bulk_values(state, bulk, names)
    special = [point for _, point in state.points]
    row = np.concatenate([rows, np.array([at for at, _ in state.points], dtype=np.int64)])
    order = np.argsort(row, kind="stable")
    nothing = (np.nan,) * 3
    more = np.array([(*one.position, *(one.axis or nothing), *nothing) for one in special]).reshape(-1, 9)
    columns = np.concatenate([values, more])[order]
    start, on_surface = np.zeros((2, len(row)), dtype=np.bool_)
    start[len(rows) :] = [one.start for one in special]
    on_surface[: len(rows)] = contact
    return Points(row[order], columns[:, :3], columns[:, 3:6], columns[:, 6:], start[order], on_surface[order])


def _bulk_values(state: ReaderState, bulk: Array, names: ValueNames) -> tuple[Array, Array, Array]:
    """Rows of GOTO statements, their position, axis and normal as (P, 9), and whether they are contact points."""
    statements = state.statements
    rows = np.flatnonzero(bulk)
    values, contact = np.full((len(rows), 9), np.nan), np.zeros(len(rows), dtype=np.bool_)
    column = {name: index for index, name in enumerate((*POINT, *AXIS, *NORMAL))}
    for template, value_names in names.items():
        mine = statements.template[rows] == template
        first = statements.number_start[rows[mine]]
        contact[mine] = "x" not in value_names
        for offset, name in enumerate(_positions_named(value_names)):
            if name in column:
                values[mine, column[name]] = statements.numbers[first + offset]
    return rows, values, contact


def active_index(row: Array, changes: list[int]) -> Array:
    """Index of the last change before each of (P,) rows, -1 if there is none."""
    return np.searchsorted(np.array(changes, dtype=np.int64), row, "left") - 1


def scale_at(state: ReaderState, row: Array) -> Array:
    """Mm per length unit at each of (P,) rows."""
    return np.array([scale for _, scale in state.scales])[active_index(row, [at for at, _ in state.scales])]


def resolve_points(state: ReaderState, points: Points) -> Array:
    """Convert points to mm, the work frame and unit axes, in place; return their frames, (P, 4, 4) or (1, 4, 4)."""
    points.position = points.position * scale_at(state, points.row)[:, None]
    points.axis = _modal_axes(state, points)
    given = np.flatnonzero(~np.isnan(points.normal[:, 0]))
    normal = points.normal[given]
    _normalise(state, points.row[given], normal, "normal")
    points.normal[given] = normal
    frames = np.array([np.eye(4), *(matrix for _, matrix in state.frames)])
    if len(frames) == 1:
        return frames
    frame: Array = frames[active_index(points.row, [row for row, _ in state.frames]) + 1]
    points.position = rotated(frame, points.position) + frame[:, :3, 3]
    points.axis = rotated(frame, points.axis)
    points.normal = rotated(frame, points.normal)
    return frame


def rotated(frames: Array, vectors: Array) -> Array:
    """Rotate vectors, (n, 3), by their frames, (n, 4, 4)."""
    return np.einsum("nij,nj->ni", frames[:, :3, :3], vectors)


def _modal_axes(state: ReaderState, points: Points) -> Array:
    """The unit axis of every point: its own, or the modal one; report each where it is written."""
    own = np.flatnonzero(~np.isnan(points.axis[:, 0]))
    row = np.concatenate([points.row[own], np.array([at for at, _ in state.axes], dtype=np.int64)])
    axes = np.concatenate([points.axis[own], np.array([v for _, v in state.axes]).reshape(-1, 3)])
    order = np.argsort(row, kind="stable")
    row, ordered = row[order], axes[order]
    _normalise(state, row, ordered, "axis")
    modal: Array = np.concatenate([[[0.0, 0.0, 1.0]], ordered])[np.searchsorted(row, points.row, "right")]
    axes[order] = ordered
    modal[own] = axes[: len(own)]  # several points may have one row
    if any(template.word == MATRIX for template in state.statements.templates):
        _report_copies_with_another_axis(state, points, own, modal)
    return modal


def _report_copies_with_another_axis(state: ReaderState, points: Points, own: Array, axes: Array) -> None:
    """Report copied points without an axis that would take that of the end of the path, not that of its start.

    ``own`` are the indices of points with an axis, ``axes``, (P, 3), the unit axes in force.
    """
    first, of = np.unique(state.statements.index[points.row], return_index=True, return_inverse=True)[1:]
    turned = norm(axes - axes[first[of]]) > NOT_UNIT
    turned[own] = False
    for index in np.flatnonzero(turned)[:1].tolist():
        found = f"a copy of a point without a tool axis, which was {_vector(axes[first[of[index]]])}"
        state.report("L401", int(points.row[index]), f"{found} and would be {_vector(axes[index])}")


def _normalise(state: ReaderState, row: Array, vectors: Array, name: str) -> None:
    """Normalise vectors in place; report those without direction and those far from unit length."""
    length = norm(vectors)
    for index in np.flatnonzero(length < NO_DIRECTION).tolist():
        state.report("L405", int(row[index]), f"{name} {_vector(vectors[index])}")
    odd = np.flatnonzero((np.abs(length - 1) > NOT_UNIT) & (length >= NO_DIRECTION)).tolist()
    if odd:
        more = f", and {len(odd) - 1} more" if len(odd) > 1 else ""
        found = f"{name} {_vector(vectors[odd[0]])} of length {length[odd[0]]:.6g}{more}"
        state.report("L406", int(row[odd[0]]), found)
    vectors /= np.where(length < NO_DIRECTION, 1.0, length)[:, None]


def _vector(vector: Array) -> str:
    return ",".join(f"{value:.7g}" for value in vector)
