# SPDX-License-Identifier: LGPL-2.1-or-later
"""Call levels: running and missing subprograms, and the rows of jump targets.

Input: a call. Output: the state of one call level, for the interpreter's stack.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field

import numpy as np

from pkm_post.model import Array
from pkm_post.reading.gcode.macro_calls import Call
from pkm_post.reading.gcode.parameters import ExecutionFault

_SEQUENCE_NUMBER = re.compile(rb"^[ \t]*(?:/[ \t]*(?:\d[ \t]*)?)*N[ \t]*0*(\d+)", re.MULTILINE | re.IGNORECASE)
"""N at the beginning of a block, behind switches of block delete such as ``/`` and ``/2``."""


def rows_of_sequence_numbers(text: bytes, line: Array) -> dict[str, list[int]]:
    """Rows by sequence number, in order; of a number without a block the row after it.

    Args:
        text: of the program, lines ended by line feeds.
        line: (N,) line of each row.
    """
    rows: dict[str, list[int]] = {}
    start = number = 0
    for found in _SEQUENCE_NUMBER.finditer(text):
        number += text.count(b"\n", start, found.start())
        start = found.start()
        rows.setdefault(found[1].decode(), []).append(int(np.searchsorted(line, number + 1)))
    return rows


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
