# SPDX-License-Identifier: LGPL-2.1-or-later
"""Walk: the statements that are not plain GOTO, one after the other, each given to what its word means.

Statements enter; a course with all that they set leaves.
"""

from __future__ import annotations

from collections import Counter

import numpy as np

from pkm_post.cldata.course import Course
from pkm_post.cldata.statements import Statements
from pkm_post.cldata.words import HANDLERS, PASSED_OVER, REFUSED
from pkm_post.model.program import Array

LARGEST = 1e9
"""Numbers beyond this are no lengths, feeds or speeds of a machine."""


def walk(course: Course, bulk: Array) -> Array:
    """Read the statements that are not taken all at once.

    Args:
        course: takes what they say.
        bulk: (N,) which rows are plain GOTO statements.

    Returns:
        (N,) which plain GOTO statements count: those with possible numbers before the end.
    """
    statements = course.statements
    possible = _possible(course)
    unknown: Counter[str] = Counter()
    first: dict[str, int] = {}
    for row in np.flatnonzero(~bulk & possible).tolist():
        word = statements.forms[statements.form[row]].word
        handler = HANDLERS.get(word)
        if handler is not None:
            handler(course, row, statements.statement(row))
        elif word in REFUSED:
            course.tell("L401", row, word)
        elif word not in PASSED_OVER:
            unknown[word] += 1
            first.setdefault(word, row)
        if course.ended:
            possible[row + 1 :] = False
            _tell_behind(course, row)
            break
    for word, row in first.items():
        times = f", {unknown[word]} times" if unknown[word] > 1 else ""
        course.tell("L404", row, f"{word[:60]}{times}")
    return bulk & possible


def _possible(course: Course) -> Array:
    """Which statements have possible numbers; tells the others."""
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
    """Tell that there are statements behind the end."""
    behind = len(course.statements) - row - 1
    if behind:
        course.tell("L415", row + 1, f"{behind} statements")
