# SPDX-License-Identifier: LGPL-2.1-or-later
"""Calls: macro calls by G65 and G66, running and missing subprograms, rows of jump targets.

Input: the words of a block, in their order. Output: the arguments by the letters of specification I, or I, J and K of
specification II, which may occur ten times each: the first ones are #4 to #6, the second ones #7 to #9 and so on. The
control distinguishes them by the words used; of two values for a variable the later one counts [Fanuc, custom macro,
argument specification; B-63684EN, 16.7.1]. And the state of one call level, for the interpreter's stack.
"""

from __future__ import annotations

import math
import re
from bisect import bisect_right
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from pkm_post.model import Array
from pkm_post.reading.gcode.macro_variables import LOCAL
from pkm_post.reading.gcode.parameters import ExecutionFault, Parameters, whole_number
from pkm_post.reading.gcode.statements import MacroCall

_FIRST = {"A": 1, "B": 2, "C": 3, "D": 7, "E": 8, "F": 9, "H": 11, "M": 13, "Q": 17, "R": 18, "S": 19, "T": 20,
          "U": 21, "V": 22, "W": 23, "X": 24, "Y": 25, "Z": 26}  # fmt: skip
"""Variables of specification I, except I, J and K, which both specifications have."""
_REPEATED, _FIRST_OF_REPEATED, _SETS = "IJK", 4, 10


@dataclass(frozen=True)
class Call:
    """A call of a macro.

    Attributes:
        label: number of the program.
        passes: number of passes.
        arguments: (33,) values of the local variables, NaN where vacant.
        modal: whether it follows every move (G66).
        text: for diagnostics.
    """

    label: str
    passes: int
    arguments: list[float]
    modal: bool
    text: str


def call_of(statement: MacroCall, parameters: Parameters) -> Call:
    """Compute a call.

    Raises:
        ExecutionFault: its words are invalid, or cannot be computed.
    """
    values = [(letter, value.value(parameters), value.column) for letter, value in statement.words]
    code = next(value for letter, value, _ in values if letter == "G" and value in (65, 66))
    words = {letter: value for letter, value, _ in values if letter in "PL"}
    number, passes = whole_number(words.get("P", math.nan)), whole_number(words.get("L", 1.0))
    text = f"G{code:g}" + "".join(f" {letter}{value:.10g}" for letter, value in words.items())
    codes = [value for letter, value, _ in values if letter == "G"]
    if number is None or number < 0 or passes is None or passes < 0 or len(codes) > 1:
        raise ExecutionFault("G316", text if len(codes) == 1 else f"{text} beside another G code")
    given = [each for each in values if each[0] not in "GPLN"]
    return Call(str(number), passes, _arguments(given), code == 66, text)


def _arguments(words: Sequence[tuple[str, float, int]]) -> list[float]:
    """The values of #1 to #33, NaN where vacant."""
    values, before, number = [math.nan] * LOCAL, "", 0
    for letter, value, column in words:
        if letter in _REPEATED:
            number += letter <= before  # I, J and K of one set come in this order
            before = letter
            if number >= _SETS:
                raise ExecutionFault("G315", f"{letter} in the {number + 1}th set of I, J and K", column)
            variable = _FIRST_OF_REPEATED + len(_REPEATED) * number + _REPEATED.index(letter)
        elif letter in _FIRST:
            variable = _FIRST[letter]
        else:
            raise ExecutionFault("G316", f"{letter} is no argument of a macro", column)
        values[variable - 1] = value
    return values


_SEQUENCE_NUMBER = re.compile(rb"^[ \t]*(?:/[ \t]*(?:\d[ \t]*)?)*([N:])[ \t]*0*(\d+)", re.MULTILINE | re.IGNORECASE)
"""N, or : of Siemens, at the beginning of a block, behind switches of block delete such as ``/`` and ``/2``."""


def rows_of_sequence_numbers(text: bytes, line: Array, kind: str = "N") -> dict[str, list[int]]:
    """Rows by sequence number, in order; of a number without a block the row after it.

    The text has line feeds; ``line``, (N,), is that of each row; ``kind`` is "N", or ":" of Siemens's main blocks.
    """
    rows: dict[str, list[int]] = {}
    start = number = 0
    for found in _SEQUENCE_NUMBER.finditer(text):
        number += text.count(b"\n", start, found.start())
        start = found.start()
        if found[1].decode().upper() == kind:
            rows.setdefault(found[2].decode(), []).append(int(np.searchsorted(line, number + 1)))
    return rows


class SequenceNumbers:
    """Targets of jumps to sequence numbers, which are read from the text when the first one is needed.

    The text has line feeds; ``line``, (N,), is that of each row; ``programs`` are the first rows of all programs.
    """

    def __init__(self, text: bytes, line: Array, programs: Iterable[int]) -> None:
        self._text, self._line, self._begins = text, line, sorted(programs)

    @cached_property
    def _rows(self) -> dict[str, list[int]]:
        return rows_of_sequence_numbers(self._text, self._line)

    def target(self, label: str, row: int, jump: str) -> int:
        """The next row with that number, or else the first one of the same program [Fanuc].

        Raises:
            ExecutionFault: the program has none; ``jump`` is the text of the jump.
        """
        index = bisect_right(self._begins, row)
        first, end = [0, *self._begins, len(self._line)][index : index + 2]
        targets = [target for target in self._rows.get(label, []) if first <= target < end]
        if not targets:
            raise ExecutionFault("G320", f"{jump}: no block N{label} in this program")
        return next((target for target in targets if target > row), targets[0])


class MissingProgram(ExecutionFault):  # noqa: N818 - it is no error of the program
    """A call of a missing subprogram, which may be added.

    Attributes:
        labels: number or name, in all readings of the call.
        row: of the call.
    """

    def __init__(self, labels: tuple[str, ...], row: int, found: str) -> None:
        super().__init__("G309", found)
        self.labels, self.row = labels, row


@dataclass
class Level:
    """A running subprogram.

    Attributes:
        return_row: return row.
        first_row: first row, for the next pass.
        passes: remaining passes after this one; only M98 has more than one.
        by_m98: whether M98 or a macro call called it, so M99 ends it rather than ``endsub``.
        call: the macro call, with the arguments of each pass.
        repeats: remaining passes of every active ``repeat``.
    """

    return_row: int
    first_row: int
    passes: int = 0
    by_m98: bool = False
    call: Call | None = None
    repeats: dict[int, int] = field(default_factory=dict)
