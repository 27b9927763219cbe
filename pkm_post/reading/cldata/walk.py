# SPDX-License-Identifier: LGPL-2.1-or-later
"""Walk: dispatch the statements other than plain GOTO, in order, to the handlers of their words.

Enters: statements. Leaves: a course with the state that they set.
"""

from __future__ import annotations

import numpy as np

from pkm_post.model import Array
from pkm_post.reading.cldata.arc_moves import tell_unused
from pkm_post.reading.cldata.course import Course
from pkm_post.reading.cldata.ends import tell_open_end
from pkm_post.reading.cldata.statements import Statements
from pkm_post.reading.cldata.words import HANDLERS, PASSED_OVER, REFUSED, Handler

LARGEST = 1e9
"""Numbers beyond this are not plausible lengths, feeds or speeds."""


def walk(course: Course, bulk: Array) -> Array:
    """Process the statements that are not in the bulk.

    Args:
        course: is updated by them.
        bulk: (N,) mask of plain GOTO statements.

    Returns:
        (N,) mask of valid plain GOTO statements: those with plausible numbers before the end.
    """
    statements = course.statements
    possible = _possible(course)
    unknown: dict[str, list[int]] = {}
    for row in np.flatnonzero(~bulk & possible).tolist():
        word = statements.word(row)
        handler = _handler(course, word)
        if handler is not None:
            handler(course, row, statements.statement(row))
        elif word in REFUSED:
            course.tell("L401", row, word)
        elif word not in PASSED_OVER:
            unknown.setdefault(word, []).append(row)
        if course.ended:
            possible[row + 1 :] = False
            _tell_behind(course, row)
            break
    tell_unused(course)
    tell_open_end(course, PASSED_OVER)
    for word, rows in unknown.items():
        times = f", {len(rows)} times" if len(rows) > 1 else ""
        course.tell("L404", rows[0], f"{word[:60]}{times}")
    return bulk & possible


def _handler(course: Course, word: str) -> Handler | None:
    """The handler of a word, None if it has no meaning here."""
    # An INSERT that does not name a tool is text for the NC program, which a motion cannot represent.
    return HANDLERS.get(word) if word != "INSERT" or course.dialect.insert_is_tool else None


def _possible(course: Course) -> Array:
    """Mask of statements with plausible numbers; report the others."""
    statements: Statements = course.statements
    size = np.diff(statements.number_start)
    owner = np.repeat(np.arange(len(statements)), size)
    takes_text = np.array([form.takes_text for form in statements.forms], dtype=np.bool_)
    wrong = ~(np.abs(statements.numbers) <= LARGEST) & ~takes_text[statements.form[owner]]
    possible = np.ones(len(statements), dtype=np.bool_)
    for index in np.flatnonzero(wrong).tolist():
        row = int(owner[index])
        course.tell("L103", row, f"{statements.numbers[index]:g}")
        possible[row] = False
    return possible


def _tell_behind(course: Course, row: int) -> None:
    """Report statements after the end."""
    behind = len(course.statements) - row - 1
    if behind:
        course.tell("L415", row + 1, f"{behind} statements")
