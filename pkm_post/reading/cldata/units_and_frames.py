# SPDX-License-Identifier: LGPL-2.1-or-later
"""Length unit and frames: UNITS, MSYS, CSYS, CATIA's matrix, ORIGIN, TRANS and TRACUT.

UNITS defines the length unit. Without it the unit of the feeds applies, or a comment that names the units; if these
disagree or are absent, the unit is unknown.

Input: statements. Output: 4 x 4 matrices that transform points of the file, in mm, to the work frame, which is the
first machining frame of the file, or the frame those are defined in: matrix = TRANS @ ORIGIN @ inverse(first) @ active
@ LAST @ COPY @ TRACUT. TRACUT and COPY change the path before a post-processor reads it, in the order of ANSI APT, or
of CATIA, where the copies come first [ICAM]; ORIGIN and TRANS are words for the post-processor.
"""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np

from pkm_post.model import Array
from pkm_post.reading.cldata.state import LengthUnit, ReaderState
from pkm_post.reading.cldata.statements import Statement, Statements
from pkm_post.reading.units import UNITS

_UNIT_WORDS: dict[str, str] = {"MM": "mm", "INCHES": "inch", "INCH": "inch", "IN": "inch"}
"""Operands of UNITS."""
_IN_MATRIX = 12
"""Numbers in three rows of four."""
_MCSYS = ["NUM", "POINT", "VECTOR", "VECTOR"]
_IN_SETUP = ("MCS", "MCSYS")
"""Machining frames in the coordinates of the set-up, which is the work frame [Autodesk posts]."""
_LAST = "TRACUT/LAST"
_FEED_UNITS: dict[str, str] = {
    **dict.fromkeys(("MMPM", "MMPR"), "mm"),
    **dict.fromkeys(("IPM", "IPR", "FPM", "FPR"), "inch"),
}
_WITH_FEEDS = ("FEDRAT", "CYCLE")
_UNITS_COMMENT = re.compile(
    r"^[ \t]*(?:\$\$|PPRINT\b|REMARK\b)[^\n]*\bUNITS?\b[ \t]*[:=/]?[ \t]*"
    r"(MM|MILLIMET(?:ER|RE)S?|IN|INCH|INCHES)[ \t.]*$",
    re.MULTILINE | re.IGNORECASE,
)
_AXIS_TOLERANCE = 1e-3
"""Tolerance of frame axes from unit length and right angles."""


def length_unit(statements: Statements, text: str) -> LengthUnit:
    """Determine the length unit of a file from its statements before FINI, and its text with comments."""
    end = next(iter(statements.rows_of("FINI")), len(statements))
    feeds = _first_words(statements, _WITH_FEEDS, _FEED_UNITS, end)
    stated = _first_words(statements, ("UNITS", "UNIT"), _UNIT_WORDS, end)
    if stated:
        row, name = min((row, name) for name, (row, _) in stated.items())
        other = next((words for unit, (_, words) in feeds.items() if unit != name), "")
        return LengthUnit(name, stated[name][1], stated=True, contradiction=other)
    votes = {name: words for name, (_, words) in feeds.items()}
    for comment in _UNITS_COMMENT.finditer(text):
        name = "mm" if comment[1].upper().startswith("M") else "inch"
        votes.setdefault(name, f"the comment in line {text.count(chr(10), 0, comment.start()) + 1}")
    if len(votes) == 1:
        return LengthUnit(*next(iter(votes.items())))
    words = " and ".join(votes.values()) or "no feed in MMPM or IPM"
    return LengthUnit("", f"there is no UNITS, and {words}")


def _first_words(
    statements: Statements, majors: tuple[str, ...], table: dict[str, str], end: int
) -> dict[str, tuple[int, str]]:
    """By unit, the first statement before a row that contains one of its words, and the words."""
    first: dict[str, tuple[int, str]] = {}
    for index, template in enumerate(statements.templates):
        items = template.items if template.word in majors else ()
        words = [item for item in items if isinstance(item, str) and item in table]
        for row in np.flatnonzero(statements.template == index)[:1].tolist() if words else []:
            unit, line = table[words[0]], statements.place(row)[0]
            if row < end and row < first.get(unit, (end, ""))[0]:
                first[unit] = row, f"{template.word}/{words[0]} in line {line}"
    return first


def units(state: ReaderState, row: int, statement: Statement) -> None:
    """UNITS/MM or INCHES; an option takes precedence."""
    name = _UNIT_WORDS.get(next(iter(statement.words), ""))
    if name is None or len(statement.items) > 1:
        state.report_items(row, statement, "MM or INCHES")
        return
    if state.options.units is None:
        state.unit, state.scale = name, UNITS[name]
        state.scales.append((row, state.scale))


def machining_frame(state: ReaderState, row: int, statement: Statement) -> None:
    """A machining frame, in the notation of its word."""
    matrix = _machining_matrix(state, row, statement)
    if matrix is None or not _is_rigid(state, row, statement, matrix):
        return
    if statement.word in state.dialect.frames:
        if statement.word in _IN_SETUP:
            state.work_from_file = np.eye(4)
        matrix[:3, 3] *= state.scale
        state.machining_frame = matrix
        _record_frame(state, row)
    elif statement.word == "CSYS":
        state.axes.append((row, tuple(matrix[:3, 2].tolist())))


def _machining_matrix(state: ReaderState, row: int, statement: Statement) -> Array | None:
    """The matrix of a frame: MSYS/origin, X axis, Y axis; MCSYS; MCS/X, Y and Z axis, origin; others three rows."""
    if statement.word == "MCSYS":
        return _mcsys(state, row, statement)
    values = state.expect_values(row, statement, 9 if statement.word == "MSYS" else _IN_MATRIX)
    if not values:
        return None
    if statement.word == "MCS":
        return _from_rows(np.reshape(values, (4, 3)).T.ravel().tolist())
    return _from_axes(values) if statement.word == "MSYS" else _from_rows(values)


def _mcsys(state: ReaderState, row: int, statement: Statement) -> Array | None:
    """MCSYS/NUM,n,POINT,origin,VECTOR,X axis,VECTOR,Y axis; n is the work offset, of which there is one."""
    numbers = statement.numbers
    if statement.words != _MCSYS or len(numbers) != 10:
        state.report_items(row, statement, "NUM,n,POINT,x,y,z,VECTOR,i,j,k,VECTOR,i,j,k")
        return None
    _check_offset(state, row, statement)
    return _from_axes(numbers[1:])


def zero(state: ReaderState, row: int, statement: Statement) -> None:
    """ZERO/n: the number of a work offset [Autodesk posts]."""
    if state.expect_values(row, statement, 1):
        _check_offset(state, row, statement)


def _check_offset(state: ReaderState, row: int, statement: Statement) -> None:
    """Refuse a second work offset, named by the first number of a statement: its place is not known."""
    word, number = statement.word, statement.numbers[0]
    first = state.statements.statement(state.statements.rows_of(word)[0]).numbers
    if first and first[0] != number:
        state.report("L401", row, f"{word} with the work offset {number:g} after {first[0]:g}")


def origin(state: ReaderState, row: int, statement: Statement) -> None:
    """ORIGIN/x,y,z[,X axis, Z axis]: the machine origin in point coordinates; NOMORE and OFF end it."""
    if _ends_transform(state, row, statement, statement.word):
        return
    values = state.expect_values(row, statement, 3, 9)
    if not values:
        return
    z, x = np.array(values[6:9] or (0, 0, 1.0)), np.array(values[3:6] or (1.0, 0, 0))
    matrix = _from_axes([*values[:3], *x, *np.cross(z, x)])
    if _is_rigid(state, row, statement, matrix):
        matrix[:3, 3] *= state.scale
        state.transforms["ORIGIN"] = np.linalg.inv(matrix)
        _record_frame(state, row)


def trans(state: ReaderState, row: int, statement: Statement) -> None:
    """TRANS/x,y,z, TRANS/three rows of four, and TRACUT and TRACUT/LAST likewise; NOMORE and OFF end their own word."""
    name = statement.word
    if name == "TRACUT" and statement.items[:1] == ("LAST",):
        name, statement = _LAST, replace(statement, items=statement.items[1:])
    if _ends_transform(state, row, statement, name):
        return
    values = state.expect_values(row, statement, 3, 12)
    if not values:
        return
    matrix = np.eye(4) if len(values) == 3 else _from_rows(values)
    if len(values) == 3:
        matrix[:3, 3] = values
    _set_transform(state, row, statement, name, matrix)


def _ends_transform(state: ReaderState, row: int, statement: Statement, name: str) -> bool:
    """Whether NOMORE or OFF ends the transform of a word here."""
    ends = statement.items in (("NOMORE",), ("OFF",))
    if ends:
        state.transforms.pop(name, None)
        _record_frame(state, row)
    return ends


def path_index(state: ReaderState, row: int, statement: Statement) -> None:
    """INDEX/n: where the path of COPY/n begins; it moves nothing."""
    if len(statement.values) != 1:
        state.report_items(row, statement, "a number")


def copy_matrix(state: ReaderState, row: int, statement: Statement) -> None:
    """The matrix of a copy, three rows of four; the word may also occur in a file."""
    if len(statement.values) != _IN_MATRIX:
        state.report_items(row, statement, "three rows of four numbers")
        return
    _set_transform(state, row, replace(statement, word="COPY"), "COPY", _from_rows(statement.values))


def _set_transform(state: ReaderState, row: int, statement: Statement, name: str, matrix: Array) -> None:
    """Set the transform of a word from here on, with its translation as written; report one that is not rigid."""
    if _is_rigid(state, row, statement, matrix):
        matrix[:3, 3] *= state.scale
        state.transforms[name] = matrix
        _record_frame(state, row)


def trntyp(state: ReaderState, row: int, statement: Statement) -> None:
    """TRNTYP/WORLD,0,...: the points are in one frame; no other type, and none that is moved, is supported."""
    if statement.words != ["WORLD"] or any(statement.numbers):
        state.report("L401", row, f"TRNTYP/{statement.items_text()}")


def _record_frame(state: ReaderState, row: int) -> None:
    """Record that the active frames transform points from here on."""
    eye = np.eye(4)
    local = eye if state.machining_frame is None else state.machining_frame
    if state.work_from_file is None and state.machining_frame is not None:
        state.work_from_file = eye if state.options.frame == "absolute" else np.linalg.inv(local)
    to_work = eye if state.work_from_file is None else state.work_from_file
    first, second = ("TRACUT", "COPY") if state.dialect.name == "catia" else ("COPY", "TRACUT")
    given = [state.transforms.get(name, eye) for name in ("TRANS", "ORIGIN", _LAST, first, second)]
    state.frames.append((row, np.linalg.multi_dot([*given[:2], to_work, local, *given[2:]])))


def _from_rows(values: list[float]) -> Array:
    matrix = np.eye(4)
    matrix[:3] = np.reshape(values, (3, 4))
    return matrix


def _from_axes(values: list[float]) -> Array:
    """Matrix from origin, X axis and Y axis."""
    matrix = np.eye(4)
    origin, x, y = np.reshape(values, (3, 3))
    matrix[:3] = np.stack([x, y, np.cross(x, y), origin], axis=1)
    return matrix


def _is_rigid(state: ReaderState, row: int, statement: Statement, matrix: Array) -> bool:
    """Whether the matrix is a rigid transform; report if not."""
    rotation = matrix[:3, :3]
    square = np.abs(rotation).max() < 2 and np.abs(rotation @ rotation.T - np.eye(3)).max() <= _AXIS_TOLERANCE
    if square and np.linalg.det(rotation) > 0:
        return True
    state.report("L403", row, f"{statement.word}: the axes are not square, of unit length and right-handed")
    return False
