# SPDX-License-Identifier: LGPL-2.1-or-later
"""One block: convert the parse tree of a line to a row.

Enters: the bytes of one line. Leaves: the content of a row of ``Blocks``, nothing for an empty line, or a fault. This
is the slow reference parser: the fast one calls it once per block shape, and for lines without a plain shape.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from pkm_post.reading.grammar import BLOCK, Fault

if TYPE_CHECKING:
    from lark import Token, Tree, UnexpectedInput

LONGEST_LINE = 10_000
"""Bytes. Longer lines are always rejected."""

DEEPEST_TREE = 100
"""Levels of an expression, so recursive tree traversal is safe."""

LARGEST_CODE = 9999.0

DIALECT_CODES: dict[str, tuple[int, ...]] = {"LN": (435, 10), "TRAORI": (435,), "TRAFOOF": (430,)}
"""Words of other dialects and the equivalent G codes, in tenths: G43.5 G1, G43.5 and G43."""


@dataclass
class Row:
    """Content of a block.

    Attributes:
        letters: the words in block order.
        values: their values.
        g: G codes in tenths.
        m: M codes.
        deleted: whether the block begins with the block delete character.
        tree: the parse tree if the block holds more than plain words; the other fields are then empty.
    """

    letters: list[str] = field(default_factory=list)
    values: list[float] = field(default_factory=list)
    g: list[int] = field(default_factory=list)
    m: list[int] = field(default_factory=list)
    deleted: bool = False
    tree: Tree[Token] | None = None

    def __bool__(self) -> bool:
        return bool(self.letters or self.g or self.m or self.tree)


class _Bad(Exception):  # noqa: N818 - it stays within this file
    """A fault that the grammar does not detect."""

    def __init__(self, code: str, token: Token, found: str = "") -> None:
        self.fault = Fault(code, token.start_pos or 0, found or f"'{token}'"[:40])


def read_row(line: bytes) -> Row | UnexpectedInput | Fault:
    """Read one line; an empty line gives a falsy row.

    Args:
        line: the line without its end.

    Raises:
        ImportError: lark is not installed.
    """
    if len(line) > LONGEST_LINE:
        return Fault("G104", 0, f"{len(line)} characters")
    tree = BLOCK.parse(line.decode("latin-1"))
    if isinstance(tree, Exception):
        return tree
    try:
        return _row_of(tree)
    except _Bad as bad:
        return bad.fault


def _row_of(tree: Tree[Token]) -> Row:
    row = Row()
    seen: set[str] = set()
    special = False
    for child in tree.children:
        if isinstance(child, str):
            row.deleted |= child.type == "DELETE"
            row.g.extend(dialect_codes(child))
        elif child.data in ("word", "named_word", "surface_word"):
            special |= not _add_word(row, child, seen)
        else:
            special |= child.data != "line_number"
    if special:
        return Row(deleted=row.deleted, tree=_checked(tree))
    return row


def dialect_codes(word: str) -> tuple[int, ...]:
    """The G codes, in tenths, equivalent to a terminal such as TRAORI(1)."""
    return DIALECT_CODES.get(word.split("(")[0].strip().upper(), ())


def _add_word(row: Row, word: Tree[Token], seen: set[str]) -> bool:
    """Add a word to the row; return whether it is plain, a name and a number."""
    name, value = word.children
    assert isinstance(name, str)  # in the grammar a word starts with a terminal
    letter = "".join(name.split()).upper()
    if letter in seen and letter not in "GM":
        raise _Bad("G202", name)
    seen.add(letter)
    if not isinstance(value, str):
        return False
    if letter == "G":
        row.g.append(_code(name, value, 10))
    elif letter == "M":
        row.m.append(_code(name, value, 1))
    else:
        row.letters.append(letter)
        row.values.append(_finite(value))
    return True


def _code(name: Token, value: Token, parts: int) -> int:
    """A G or M code as an integer multiple of 1 / ``parts``."""
    number = _finite(value) * parts
    code = round(number)
    if value[0] in "+-" or number > LARGEST_CODE or abs(number - code) > 1e-6:
        raise _Bad("G105", name, f"'{name}{value}'"[:40])
    return code


def _finite(token: Token) -> float:
    number = float(token)
    if not math.isfinite(number):
        raise _Bad("G103", token, f"a number of {len(token)} characters")
    return number


def _checked(tree: Tree[Token]) -> Tree[Token]:
    """Return the tree if it is not too deep and all its numbers are finite."""
    for token, depth in _leaves(tree):
        if depth > DEEPEST_TREE:
            raise _Bad("G211", token)
        if token.type == "NUMBER":
            _finite(token)
    return tree


def _leaves(tree: Tree[Token]) -> Iterator[tuple[Token, int]]:
    """The terminals of a tree, left to right, each with its depth."""
    waiting: list[tuple[Token | Tree[Token], int]] = [(tree, 0)]
    while waiting:
        branch, depth = waiting.pop()
        if isinstance(branch, str):
            yield branch, depth
        else:
            waiting.extend((child, depth + 1) for child in reversed(branch.children))
