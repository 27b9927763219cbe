# SPDX-License-Identifier: LGPL-2.1-or-later
"""Queries: single lines and numbers that a controller reports.

Input: a session and the name of a variable or an element. Output: a line or a number.
"""

from __future__ import annotations

import re

from pkm_post.control.link.errors import LinkLostError, PmacError
from pkm_post.control.link.session import Session

_REAL = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")


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
    """The value of a variable or an element of the controller.

    Raises:
        LinkLostError: the answer is not a number.
    """
    answer = query_line(session, name)
    if not _REAL.fullmatch(answer):
        raise LinkLostError(f"{name}: expected a number, got {answer!r}")
    return float(answer)
