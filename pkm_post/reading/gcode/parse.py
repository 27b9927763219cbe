# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parse: one line to a block, by the grammar of record.

Input: the bytes of one line. Output: a ``Block``, an empty one for an empty line, or a fault. This is the slow
reference parser: the scan calls it once per line pattern, and for lines without a plain pattern.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from pkm_post.reading.gcode.blocks import LARGEST_CODE, LONGEST_LINE, MACRO_CALLS, Block
from pkm_post.reading.grammar import BLOCK, LineFault

if TYPE_CHECKING:
    from lark import Token, Tree, UnexpectedInput

_DEEPEST_TREE = 100
"""Levels of an expression, so recursive tree traversal is safe."""

MAY_BE_REPEATED = "IJK"
"""Arguments of a macro that may be repeated in a block."""

DIALECT_CODES: dict[str, tuple[int, ...]] = {"LN": (435, 10), "TRAORI": (435,), "TRAFOOF": (430,)}
"""Words of other dialects and the equivalent G codes, in tenths: G43.5 G1, G43.5 and G43."""


class _InvalidBlock(Exception):  # noqa: N818 - it stays within this file
    """A fault that the grammar does not detect."""

    def __init__(self, code: str, token: Token, found: str = "") -> None:
        self.fault = LineFault(code, token.start_pos or 0, found or f"'{token}'"[:40])


def parse_line(line: bytes) -> Block | UnexpectedInput | LineFault:
    """Parse one line without its end.

    Raises:
        ImportError: lark is not installed.
    """
    if len(line) > LONGEST_LINE:
        return LineFault("G104", 0, f"{len(line)} characters")
    tree = BLOCK.parse(line.decode("latin-1"))
    if isinstance(tree, Exception):
        return tree
    try:
        return _block_of(tree)
    except _InvalidBlock as invalid:
        return invalid.fault


def _block_of(tree: Tree[Token]) -> Block:
    block = Block()
    seen: set[str] = set()
    special = is_macro_call(tree)
    repeated = MAY_BE_REPEATED if special else "GM"
    block.deleted, children = _leading_switches(tree)
    for child in children:
        if isinstance(child, str):
            special |= child.type == "DELETE"
            block.g.extend(dialect_codes(child))
        elif child.data in ("word", "named_word", "surface_word"):
            special |= not _add_word(block, child, seen, repeated)
        else:
            special |= child.data != "line_number"
    if special:
        return Block(deleted=block.deleted, tree=_checked(tree))
    return block


def _leading_switches(tree: Tree[Token]) -> tuple[int, list[Tree[Token] | Token]]:
    """The switches of block delete at the beginning of a block, as bits, and what follows them."""
    bits, children = 0, list(tree.children)
    while children and switch_of(children):
        bits |= 1 << switch_of(children)
        children = children[2 if len(children) > 1 and _is(children[1], "SWITCH") else 1 :]
    return bits, children


def switch_of(children: Sequence[Tree[Token] | Token]) -> int:
    """The switch of block delete that some children of a block begin with, 0 if none; ``/`` is ``/1`` [Fanuc]."""
    if not _is(children[0], "DELETE"):
        return 0
    return int(str(children[1])) if len(children) > 1 and _is(children[1], "SWITCH") else 1


def _is(child: Tree[Token] | Token, kind: str) -> bool:
    return isinstance(child, str) and child.type == kind


def dialect_codes(word: str) -> tuple[int, ...]:
    """The G codes, in tenths, equivalent to a terminal such as TRAORI(1)."""
    return DIALECT_CODES.get(word.split("(")[0].strip().upper(), ())


def is_macro_call(tree: Tree[Token]) -> bool:
    """Whether a block has G65 or G66, which make its words arguments."""
    words = (child.children for child in tree.children if not isinstance(child, str) and child.data == "word")
    return any(str(name) in "Gg" and isinstance(value, str) and float(value) in MACRO_CALLS for name, value in words)


def _add_word(block: Block, word: Tree[Token], seen: set[str], repeated: str) -> bool:
    """Add a word to the block; return whether it is plain, a name and a number."""
    name, value = word.children
    assert isinstance(name, str)  # in the grammar a word starts with a terminal
    letter = "".join(name.split()).upper()
    if letter in seen and letter not in repeated:
        raise _InvalidBlock("G202", name)
    seen.add(letter)
    if not isinstance(value, str):
        return False
    if letter == "G":
        block.g.append(_code(name, value, 10))
    elif letter == "M":
        block.m.append(_code(name, value, 1))
    else:
        block.words[letter] = _finite(value)
    return True


def _code(name: Token, value: Token, parts: int) -> int:
    """A G or M code as an integer multiple of 1 / ``parts``."""
    number = _finite(value) * parts
    code = round(number)
    if value[0] in "+-" or number > LARGEST_CODE or abs(number - code) > 1e-6:
        raise _InvalidBlock("G105", name, f"'{name}{value}'"[:40])
    return code


def _finite(token: Token) -> float:
    number = float(token)
    if not math.isfinite(number):
        raise _InvalidBlock("G103", token, f"a number of {len(token)} characters")
    return number


def _checked(tree: Tree[Token]) -> Tree[Token]:
    """Return the tree if it is not too deep and all its numbers are finite."""
    for token, depth in _leaves(tree):
        if depth > _DEEPEST_TREE:
            raise _InvalidBlock("G211", token)
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
