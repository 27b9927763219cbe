# SPDX-License-Identifier: LGPL-2.1-or-later
"""Scan: convert text to statements, fast for repetitive files.

Enters: logical lines. Leaves: the table of statements, and the lexical and syntax faults. Every number is replaced by a
marker; the rest of a line is its shape. The grammar of record parses one real line of each shape, and the numbers of
all lines are converted at once. So no line is accepted unless the grammar accepts its shape, and statements need no
individual parsing.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from pkm_post.model import Array
from pkm_post.reading.cldata.faults import Faults, fault_of
from pkm_post.reading.cldata.lines import JOINT, LONGEST_LINE, MARK, Lines
from pkm_post.reading.cldata.statements import Form, Statements, form_of
from pkm_post.reading.grammar import STATEMENT, Fault

if TYPE_CHECKING:
    from lark import UnexpectedInput

LONGEST = 20000
"""Characters of a statement, not counting numbers."""
DEEPEST = 20
"""Nesting depth of parentheses in a statement."""

_NUMBER = re.compile(r"(?<![\w.+-])[+-]?(?:[0-9]++\.?[0-9]*+|\.[0-9]++)(?:[Ee][+-]?[0-9]++)?+(?![\w.+-])")
_STRING = re.compile(r"'[^'\n]*'|\"[^\"\n]*\"")
_HIDDEN_DIGITS = str.maketrans({str(digit): chr(0xE000 + digit) for digit in range(10)})
_BLANKS = f" \t{JOINT}"


def scan(lines: Lines, faults: Faults) -> Statements:
    """Scan logical lines to statements.

    Args:
        lines: the text.
        faults: collects its faults.
    """
    lines = _without_long_ones(lines, faults)
    body = _without_quoted_numbers("\n".join(lines.text))
    shapes = _NUMBER.sub(MARK, body).split("\n")
    known: dict[str, int] = {}
    shape = np.array([known.setdefault(one, len(known)) for one in shapes], dtype=np.int64)
    first = np.unique(shape, return_index=True)[1].tolist()
    parsed = [parsed_line(text, lines.text[line]) for text, line in zip(known, first, strict=True)]
    marks = np.array([text.count(MARK) for text in known], dtype=np.int64)[shape]
    good = np.array([isinstance(one, Form) for one in parsed], dtype=np.bool_)
    filled = np.array([bool(text.strip(_BLANKS)) for text in known], dtype=np.bool_)
    for line in np.flatnonzero((~good & filled)[shape]).tolist():
        faults.add_line(lines, line, lambda text: _fault_again(text))
    return _table(lines, _values(body), shape, marks, parsed, good)


def _without_long_ones(lines: Lines, faults: Faults) -> Lines:
    """Blank the lines that became too long when joined."""
    too_long = [index for index, text in enumerate(lines.text) if len(text) > LONGEST_LINE]
    if not too_long:
        return lines
    kept = list(lines.text)
    for index in too_long:
        found = f"{len(kept[index])} characters in {kept[index].count(JOINT) + 1} lines, at most {LONGEST_LINE}"
        faults.add("L104", (int(lines.number[index]), 0), found)
        kept[index] = ""
    return replace(lines, text=kept)


def parsed_line(shape: str, text: str) -> Form | Fault | UnexpectedInput | None:
    """The form of a line, its fault, or None if it is empty."""
    if not shape.strip(_BLANKS):
        return None
    if len(shape) > LONGEST:
        return Fault("L104", 0, f"{len(text)} characters")
    if shape.count("(") > DEEPEST:
        return Fault("L205", text.index("("), f"{shape.count('(')} parentheses, at most {DEEPEST}")
    tree = STATEMENT.parse(text)
    return tree if isinstance(tree, Exception) else form_of(tree)


def _fault_again(text: str) -> Fault:
    """The fault of one line of an invalid shape."""
    result = parsed_line(_NUMBER.sub(MARK, _without_quoted_numbers(text)), text)
    if isinstance(result, Fault):
        return result
    if result is None or isinstance(result, Form):
        raise ValueError(f"expected a faulty statement, got {text!r}")
    return fault_of(text, result)


def _without_quoted_numbers(text: str) -> str:
    """Hide digits in quotes: quoted text contains no numbers."""
    return _STRING.sub(lambda found: found[0].translate(_HIDDEN_DIGITS), text)


def _values(body: str) -> Array:
    """All numbers of a text, (K,)."""
    numbers = _NUMBER.findall(body)
    return np.fromstring(" ".join(numbers), sep=" ") if numbers else np.empty(0)


def _table(
    lines: Lines, values: Array, shape: Array, marks: Array, parsed: Sequence[object], good: Array
) -> Statements:
    """The table of the lines that are statements."""
    rows = np.flatnonzero(good[shape])
    used = np.repeat(good[shape], marks)
    forms = tuple(one for one in parsed if isinstance(one, Form))
    return Statements(
        forms=forms,
        form=(np.cumsum(good) - 1)[shape[rows]],
        index=rows,
        number_start=np.concatenate([[0], np.cumsum(marks[rows])]).astype(np.int64),
        numbers=values[used],
        lines=lines,
    )
