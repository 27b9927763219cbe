# SPDX-License-Identifier: LGPL-2.1-or-later
"""Statements: one block of a Siemens program, compiled.

Input: the tokens of a line. Output: a ``Statement``: its labels, and either one jump, branch or loop, or the words,
names, calls and assignments of a block in order, not yet computed.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from pkm_post.reading.siemens.diagnostics import BlockFault
from pkm_post.reading.siemens.flow import FLOW, Flow
from pkm_post.reading.siemens.items import Item, item_of
from pkm_post.reading.siemens.scan import LONGEST_LINE
from pkm_post.reading.siemens.tokens import Cursor, tokens_of


@dataclass(frozen=True)
class Statement:
    """One block.

    Attributes:
        labels: before it.
        skipped: the skip levels that it begins with, as bits; ``/`` is ``/0``.
        items: in their order.
        flow: instead of items.
    """

    labels: tuple[str, ...] = ()
    skipped: int = 0
    items: tuple[Item, ...] = ()
    flow: Flow | None = field(default=None)


def statement_of(line: str) -> Statement:
    """Compile a line without its comment.

    Raises:
        BlockFault: the line is malformed.
    """
    if len(line) > LONGEST_LINE:
        raise BlockFault("G104", f"{len(line)} characters")
    cursor = Cursor(tokens_of(line))
    skipped = _skip_level(cursor)
    _block_number(cursor)
    skipped |= _skip_level(cursor)
    labels = []
    while cursor.peek().kind == "name" and cursor.peek().text not in FLOW and cursor.peek(1).text == ":":
        labels.append(cursor.next().text)
        cursor.next()
    first = cursor.peek()
    if first.kind == "name" and first.text in FLOW:
        flow = FLOW[cursor.next().text](cursor, first)
        if not cursor.at_end():
            raise BlockFault("G206", f"'{cursor.peek().text}'", cursor.peek().column)
        return Statement(tuple(labels), skipped, (), flow)
    items: list[Item] = []
    while not cursor.at_end():
        items.append(item_of(cursor))
    return Statement(tuple(labels), skipped, tuple(items))


def _skip_level(cursor: Cursor) -> int:
    """Read ``/`` or ``/0`` to ``/9``, as a bit; 0 if there is none."""
    if not cursor.takes("/"):
        return 0
    numbered = cursor.peek().kind == "number" and cursor.peek().text in map(str, range(10))
    return 1 << int(cursor.next().text) if numbered else 1


def _block_number(cursor: Cursor) -> None:
    """Read N10 or :10."""
    if cursor.peek().text in ("N", ":") and cursor.peek(1).kind == "number":
        cursor.next()
        cursor.next()
