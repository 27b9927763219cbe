# SPDX-License-Identifier: LGPL-2.1-or-later
"""Queries: single lines, numbers and bits that a controller reports.

Input: a session and the name of a variable or an element. Output: a line, a number or bits.
"""

from __future__ import annotations

import math
import re
from decimal import Decimal

from pkm_post.control.link.errors import LinkLostError, PmacError
from pkm_post.control.link.session import Session

_REAL = re.compile(r"[-+]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][-+]?[0-9]+)?")
_HEXADECIMAL = re.compile("[0-9A-Fa-f]+")


def parse_number(text: str) -> float:
    """A number as a controller writes it: no underscores, no ``nan``, nothing beyond the range of its numbers.

    Raises:
        ValueError: the text is something else.
    """
    text = text.strip()
    value = float(text) if _REAL.fullmatch(text) else math.nan
    if not math.isfinite(value):
        raise ValueError(f"expected a number, got {text!r}")
    return value


def parse_bits(text: str, digits: int) -> int:
    """Status bits as a controller writes them: hexadecimal digits, on a Turbo PMAC after ``$`` if it is set so.

    Raises:
        ValueError: there are other characters, or the number of digits differs.
    """
    text = text.strip().removeprefix("$")
    if len(text) != digits or not _HEXADECIMAL.fullmatch(text):  # int() takes signs and underscores
        raise ValueError(f"expected {digits} hexadecimal digits, got {text!r}")
    return int(text, 16)


Definition = tuple[Decimal, str, Decimal]
"""Scale, axis and offset of a motor, in counts."""
_KEPT = Decimal("1e-9")
"""Share of a number up to which a controller rounds it: 36 bits on a Turbo PMAC, shown with eleven digits."""


def is_definition(got: Definition | None, wanted: Definition) -> bool:
    """Whether a controller's axis definition is the wanted one, but for the digits that it does not keep."""
    if got is None or got[1] != wanted[1]:
        return False
    pairs = (got[0], wanted[0]), (got[2], wanted[2])
    return all(abs(one - other) <= _KEPT * abs(other) for one, other in pairs)


def query_line(session: Session, query: str) -> str:
    """The answer of a query, which must be one line.

    Raises:
        PmacError: the answer has more lines, or none.
    """
    answer = session.query(query)
    if len(answer) != 1:
        raise PmacError(f"{query}: expected one line, got {len(answer)}")
    return answer[0].strip()


def read_number(session: Session, name: str) -> float:
    """The value of a variable or an element: an I-variable as the statement ``I5193=$2000`` [TurboPMAC, I9].

    Raises:
        LinkLostError: the answer is not a number.
    """
    answer = query_line(session, name).removeprefix(f"{name}=")
    try:
        return parse_bits(answer, min(len(answer), 7) - 1) if answer.startswith("$") else parse_number(answer)
    except ValueError as fault:
        raise LinkLostError(f"{name}: {fault}") from None
