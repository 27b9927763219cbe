# SPDX-License-Identifier: LGPL-2.1-or-later
"""Macro calls: the program, the passes and the local variables of G65 and G66.

Input: the words of the block, in their order. Output: the arguments by the letters of specification I, or I, J and K
of specification II, which may occur ten times each: the first ones are #4 to #6, the second ones #7 to #9 and so on.
The control distinguishes them by the words used; of two values for a variable the later one counts [Fanuc, custom
macro, argument specification; B-63684EN, 16.7.1].
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

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
