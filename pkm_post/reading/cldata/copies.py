# SPDX-License-Identifier: LGPL-2.1-or-later
"""Copies: repeat the statements between INDEX and COPY, each time further translated or rotated.

Input: the table of statements. Output: a table in which each COPY is replaced by its copies; a statement ``_COPY``
with a matrix, three rows of four as written, precedes each of them, and one with the unit matrix ends them.

COPY/n,...,k follows a path that starts at INDEX/n and has been run once. It makes k copies, the last one moved by the
k-th power of its matrix [aptos]. A path that contains copies is repeated with them; if their matrices do not commute,
CAM systems differ in the order of application [ICAM], and the COPY is refused.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from pkm_post.model import Array
from pkm_post.reading.cldata.diagnostics import StatementDiagnostics
from pkm_post.reading.cldata.statements import Statement, Statements, Template

MATRIX = "_COPY"
"""Word of the statements with the matrix of a copy."""
MOST_STATEMENTS = 10_000_000
"""Statements of a file with all its copies."""

_MOTIONS = frozenset({"GOTO", "FROM", "GOHOME", "GODLTA", "ARCMOV", "GOCLW", "GOCCLW", "CW", "CCW", "HELICAL"})
_UNITS = ("UNITS", "UNIT")
_PLACED_BY = ((_UNITS, False), (("TRACUT",), False), (("TRACUT",), True), (("MSYS", "CSYS", "CATIA0"), False))
"""Words of which one is in force, and decides where the points after it are before they are copied; whether LAST."""
_SAME = 1e-6
"""Tolerance of equal matrices, in units of the file."""
_PLANES = {"XYROT": (0, 1), "YZROT": (1, 2), "ZXROT": (2, 0)}
"""Rotations, each with the axis it turns and the axis it turns that to."""
_FORMS = "n,SAME,k, n,TRANSL,x,y,z,k, n,XYROT, YZROT or ZXROT,degrees,k, or n,MODIFY,three rows of four,k"
_VALUES = {"SAME": 0, "TRANSL": 3, "MODIFY": 12, **dict.fromkeys(_PLANES, 1)}
"""Number of values between the word and the number of copies."""


def with_copies(statements: Statements, faults: StatementDiagnostics) -> Statements:
    """Replace each COPY by its copies, or drop one that is not understood, with a fault; the table itself if none."""
    copies = statements.rows_of("COPY")
    if not copies:
        return statements
    begins, parts, done = statements.rows_of("INDEX"), list[_Part](), 0
    for row in copies:
        parts.append(np.arange(done, row))
        done = row + 1
        parts += _copies_at(statements, row, begins, parts, faults)
    parts.append(np.arange(done, len(statements)))
    return _table(statements, parts)


_Part = Array | tuple[int, Array]
"""Rows of the file, or a matrix (4, 4) with the row of its statement."""


def _copies_at(
    statements: Statements, row: int, begins: list[int], before: list[_Part], faults: StatementDiagnostics
) -> list[_Part]:
    """The copies of one COPY; none, with a fault, if it is not understood.

    ``begins`` are the rows of all INDEX, ``before`` the parts up to the COPY.
    """
    statement, place = statements.statement(row), statements.place(row)
    read = _matrix_and_count(statement)
    if read is None:
        faults.add("L402", place, f"COPY/{statement.items_text()}, expected {_FORMS}")
        return []
    matrix, count = read
    mine = _begins_of(statements, row, begins)
    if len(mine) != 1:
        found = f"COPY/{statement.items_text()} after {len(mine)} INDEX/{statement.numbers[0]:g}, expected one"
        faults.add("L402", place, found)
        return []
    path = _path_after(before, mine[0])
    inner = [part for part in path if isinstance(part, tuple)]
    if any(_begins_of(statements, other, begins)[0] < mine[0] or not _commute(made, matrix) for other, made in inner):
        found = f"COPY/{statement.items_text()} with another COPY after its INDEX, whose order matters"
        faults.add("L401", place, found)
        return []
    if _begins_with_godlta(statements, path):
        faults.add("L401", place, f"COPY/{statement.items_text()} of a path that begins with GODLTA")
        return []
    changed = _changed_within(statements, mine[0], row)
    if changed:
        faults.add("L401", place, f"COPY/{statement.items_text()} of a path that begins before another {changed}")
        return []
    if count * sum(1 if isinstance(part, tuple) else len(part) for part in path) > MOST_STATEMENTS:
        faults.add("L403", place, f"COPY/{statement.items_text()}: more than {MOST_STATEMENTS} statements")
        return []
    power, parts = np.eye(4), list[_Part]()
    for _ in range(count):
        power = matrix @ power
        parts.append((row, power))
        parts += [(part[0], power @ part[1]) if isinstance(part, tuple) else part for part in path]
    return [*parts, (row, np.eye(4))]


def _begins_of(statements: Statements, row: int, begins: list[int]) -> list[int]:
    """The INDEX statements before a COPY that have its number."""
    number = statements.statement(row).items[:1]
    return [begin for begin in begins if begin < row and statements.statement(begin).items == number]


def _path_after(parts: list[_Part], begin: int) -> list[_Part]:
    """The parts after an INDEX."""
    at = next(index for index, part in enumerate(parts) if isinstance(part, np.ndarray) and begin in part)
    first = parts[at]
    return [first[first > begin], *parts[at + 1 :]] if isinstance(first, np.ndarray) else []


def _begins_with_godlta(statements: Statements, path: list[_Part]) -> bool:
    """Whether the first motion of a path is an increment: APT copies its end point [aptos], other systems may not."""
    words = (statements.word(row) for part in path if isinstance(part, np.ndarray) for row in part.tolist())
    return next((word for word in words if word in _MOTIONS), "") == "GODLTA"


def _changed_within(statements: Statements, begin: int, end: int) -> str:
    """The word of a unit or frame that changes behind the first motion of a path, whose copies it would change."""
    motion = next((row for row in range(begin + 1, end) if statements.word(row) in _MOTIONS), end)
    for group, is_last in _PLACED_BY:
        rows = [row for word in group for row in statements.rows_of(word) if row < end]
        rows = [row for row in rows if ("LAST" in statements.statement(row).items) is is_last]
        before, within = [row for row in rows if row < begin], [row for row in rows if row > begin]
        if group is _UNITS and not before:  # what precedes the first one is in its unit as well
            before = within[:1]
        if within and min(within) > motion:
            last = _in_force(statements, max(within))
            if last != (_in_force(statements, max(before)) if before else ()):
                return statements.word(max(within))
    return ""


def _in_force(statements: Statements, row: int) -> tuple[object, ...]:
    """What a statement of a unit or frame sets, () where it ends one."""
    items = statements.statement(row).items
    return () if {"NOMORE", "OFF"} & set(items) else items


def _commute(one: Array, other: Array) -> bool:
    """Whether two matrices may be applied in either order."""
    return bool(np.allclose(one @ other, other @ one, rtol=0.0, atol=_SAME))


def _matrix_and_count(statement: Statement) -> tuple[Array, int] | None:
    """The matrix of a COPY, (4, 4), and the number of copies; None if its items are not understood."""
    word = statement.items[1] if len(statement.items) > 1 else None
    numbers = statement.numbers
    if not isinstance(word, str) or len(numbers) != len(statement.items) - 1:
        return None
    if len(numbers) != _VALUES.get(word, -1) + 2 or numbers[-1] != int(numbers[-1]) or numbers[-1] < 1:
        return None
    matrix, values = np.eye(4), numbers[1:-1]
    if word == "TRANSL":
        matrix[:3, 3] = values
    elif word == "MODIFY":
        matrix[:3] = np.reshape(values, (3, 4))
    elif word in _PLANES:
        first, second = _PLANES[word]
        cosine, sine = math.cos(math.radians(values[0])), math.sin(math.radians(values[0]))
        matrix[first, first] = matrix[second, second] = cosine
        matrix[second, first], matrix[first, second] = sine, -sine
    return matrix, int(numbers[-1])


def _table(statements: Statements, parts: list[_Part]) -> Statements:
    """The table of some parts, in order."""
    kind, size = len(statements.templates), np.diff(statements.number_start)
    template, index = [statements.template[:0]], [statements.index[:0]]
    counts, numbers = [size[:0]], [statements.numbers[:0]]
    for part in parts:
        if isinstance(part, tuple):
            row, matrix = part
            template.append(np.array([kind]))
            index.append(statements.index[row : row + 1])
            counts.append(np.array([matrix[:3].size]))
            numbers.append(matrix[:3].ravel())
        elif len(part):
            first, last = statements.number_start[part[0]], statements.number_start[part[-1] + 1]
            template.append(statements.template[part])
            index.append(statements.index[part])
            counts.append(size[part])
            numbers.append(statements.numbers[first:last])
    return replace(
        statements,
        templates=(*statements.templates, Template(MATRIX, (float,) * 12)),
        template=np.concatenate(template),
        index=np.concatenate(index),
        number_start=np.concatenate([[0], np.cumsum(np.concatenate(counts))]).astype(np.int64),
        numbers=np.concatenate(numbers),
    )
