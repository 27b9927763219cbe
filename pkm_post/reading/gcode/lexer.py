# SPDX-License-Identifier: LGPL-2.1-or-later
"""Lexer: the patterns and numbers of many lines at once, and the block layout of each pattern.

Input: the bytes of whole lines, comments blanked. Output: the pattern of each line: the line with a marker for each
number, and the offsets of the numbers. Work is done per byte with tables and per number with numpy, not per line.
Real programs have some ten to hundred patterns, so a million blocks take some hundred parses. Patterns of plain words
are parsed here: importing lark and making its tables take longer than a short program. Lark parses all others.

In a pattern letters are upper case and blanks are removed. The digits of G and M codes are kept: they determine the
meaning of a block, as do those before an equals sign, as in A3=0.5, and of a switch of block delete, as in /2; these
and line numbers do not count as numbers.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from pkm_post.model import Array
from pkm_post.reading.gcode.blocks import LARGEST_CODE, MACRO_CALLS, Block, switch_bits

_MARK = b"\x01"
"""Marker of a number in a pattern."""

_BLANK = 0x20
_NUMERIC = b"+-.0123456789"
_BLANKS = b" \t\f\v"
_MEANT = b"\nABCDEFGHIJKLMNOPQRSTUVWXYZ/%#=[]<>*_@^:" + _NUMERIC + _BLANKS  # leftover parentheses are faults


def _byte_table(of: Callable[[int], int]) -> bytes:
    return bytes(of(byte) for byte in range(256))


def _in_pattern(byte: int) -> int:
    upper = ord(chr(byte).upper()) if byte < 128 else byte
    if upper not in _MEANT:
        return ord("?")
    return _MARK[0] if byte in _NUMERIC else _BLANK if byte in _BLANKS else upper


_PATTERN = _byte_table(_in_pattern)
_IS_NUMERIC = _byte_table(lambda byte: byte in _NUMERIC)
_STAYS = _byte_table(lambda byte: byte not in _NUMERIC + _BLANKS)
_KEYWORDS = (b"LN", b"TRA")
"""Prefixes of multi-letter words. Where one occurs, blanks after letters are kept: L N is not LN."""
_IS_CODE, _IS_LINE_NUMBER = (np.isin(np.arange(256), [ord(letter) for letter in letters]) for letters in ("GM/", "N:"))


@dataclass
class Lexed:
    """Lexed lines.

    Attributes:
        patterns: the pattern of each line.
        starts: (n,) offset of each number except codes and line numbers.
        ends: (n,) end offset of each number.
        suspicious: offsets within line numbers that contain non-digits; these are not in the pattern.
    """

    patterns: list[bytes]
    starts: Array
    ends: Array
    suspicious: Array


def lex(text: bytes) -> Lexed:
    """Lex whole lines without comments, each with its line feed."""
    raw, numeric = (np.frombuffer(source, np.uint8) for source in (text, text.translate(_IS_NUMERIC)))
    pattern, stays = (np.frombuffer(bytearray(text.translate(table)), np.uint8) for table in (_PATTERN, _STAYS))
    edges = np.flatnonzero(numeric[1:] != numeric[:-1]) + 1
    if numeric[0]:
        edges = np.concatenate([[0], edges])
    starts, ends = edges[::2], edges[1::2]
    before = _before(pattern, starts)
    is_code, is_line_number = _IS_CODE[before] | (raw[ends] == ord("=")), _IS_LINE_NUMBER[before]
    codes, line_numbers = (_runs(starts[some], numeric) for some in (is_code, is_line_number))
    stays[starts] = 1
    stays[codes] = 1
    pattern[codes] = raw[codes]
    patterns = pattern[stays.view(bool)].tobytes()
    if any(keyword in patterns for keyword in _KEYWORDS):
        parted = (pattern[1:] == _BLANK) & (pattern[:-1] >= ord("A")) & (pattern[:-1] <= ord("Z"))
        stays[1:] |= parted
        patterns = pattern[stays.view(bool)].tobytes()
    plain = ~(is_code | is_line_number)
    return Lexed(
        patterns=patterns.split(b"\n")[:-1],
        starts=starts[plain],
        ends=ends[plain],
        suspicious=line_numbers[raw[line_numbers] < ord("0")],
    )


def line_starts(text: bytes) -> Array:
    """Offsets of the lines of a text, and its length, for lines that all have a line feed."""
    return np.append(0, np.flatnonzero(np.frombuffer(text, np.uint8) == ord("\n")) + 1)


def lines_at(offsets: Array, line_start: Array) -> Array:
    """The lines, from 0, that contain the given offsets."""
    return np.searchsorted(line_start, offsets, side="right") - 1


def _before(pattern: Array, starts: Array) -> Array:
    """The last non-blank byte before each number; a line feed at the start of the text."""
    before = np.where(starts > 0, pattern[starts - 1], ord("\n"))
    if (before == _BLANK).any():
        last = np.maximum.accumulate(np.where(pattern != _BLANK, np.arange(len(pattern)), -1))[starts - 1]
        before = np.where((starts > 0) & (last >= 0), pattern[last], ord("\n"))
    return before


def _runs(starts: Array, numeric: Array) -> Array:
    """Offsets of all bytes of the numbers at the given start offsets."""
    offsets = [starts]
    while len(offsets[-1]):
        following = offsets[-1] + 1
        offsets.append(following[numeric[following] != 0])
    return np.concatenate(offsets)


PARSED_ALONE = 0
"""Pattern of lines that are parsed one by one: those that lark rejects, and those with more than plain words."""

EMPTY = 1
"""Pattern of empty lines."""


class CodeLists:
    """A list of integers for each of S patterns, stored in one column.

    Attributes:
        count: (S,) length of each list.
    """

    def __init__(self, lists: list[list[int]]) -> None:
        self.count = np.array([len(one) for one in lists])
        self._start = np.cumsum(self.count) - self.count
        self._all = np.array([number for one in lists for number in one], np.int32)

    def of(self, patterns: Array) -> tuple[Array, Array]:
        """The concatenated lists of a column of patterns, and the length of each."""
        count = self.count[patterns]
        if not len(self._all):
            return self._all, count
        first = np.repeat(self._start[patterns] - (np.cumsum(count) - count), count)
        numbers: Array = self._all[first + np.arange(len(first))]
        return numbers, count


@dataclass(frozen=True)
class PatternTable:
    """Layout of the blocks of each pattern, as columns of S patterns.

    Attributes:
        filled: (S,) whether the block is not empty.
        deleted: (S,) switches of block delete at its beginning, as bits.
        count: (S,) count of its numbers.
        places: by letter, (S,) index of its number, from 0; -1 where absent.
        g: G codes in tenths.
        m: M codes.
    """

    filled: Array
    deleted: Array
    count: Array
    places: dict[str, Array]
    g: CodeLists
    m: CodeLists


_WORD = re.compile(rb"([GM])(\d+\.?\d*|\.\d+)|([A-MP-Z@^])\x01")
_PLAIN = re.compile(rb"%|(/|(?:/[1-9])*)(?:N\x01)?((?:" + _WORD.pattern + rb")*)")
"""``block`` of the grammar without blanks, where each word is a letter and a number."""


_MACRO_CALLS = {round(10 * code) for code in MACRO_CALLS}
"""In blocks with these, words are arguments."""


def plain_block(pattern: bytes) -> Block | None:
    """The block of a pattern of plain words, as lark parses it; None for all others, and for possible faults."""
    found = _PLAIN.fullmatch(pattern)
    if found is None:
        return None
    block = Block(deleted=switch_bits(int(switch or 1) for switch in (found[1] or b"").split(b"/")[1:]))
    for kind, number, letter in _WORD.findall(found[2] or b""):
        if kind:
            codes, parts = (block.g, 10) if kind == b"G" else (block.m, 1)
            value = float(number) * parts
            codes.append(round(min(value, LARGEST_CODE)))
            if abs(value - codes[-1]) > 1e-6 or value > LARGEST_CODE or (kind == b"G" and float(number) in MACRO_CALLS):
                return None
        elif letter in b"GM" or letter.decode() in block.words:
            return None
        else:
            block.words[letter.decode()] = 1.0
    return None if {*block.g} & _MACRO_CALLS else block


class Patterns(dict[bytes, int]):
    """Indices of patterns; looking up a new pattern parses it."""

    def __init__(self) -> None:
        super().__init__()
        self._blocks = [Block(), Block()]
        self._table_of = _table_of(self._blocks)

    def __missing__(self, pattern: bytes) -> int:
        number = PARSED_ALONE
        if b"[" not in pattern:  # a code in brackets contains a marker, and a lone number in brackets counts as plain
            plain = plain_block(pattern)
            block = plain if plain is not None else _parsed(pattern)
            if block is not None and block.tree is None:
                number = len(self._blocks)
                self._blocks.append(block)
        self[pattern] = number
        return number

    def table(self) -> PatternTable:
        """The layouts of all patterns so far."""
        if len(self._table_of.filled) < len(self._blocks):
            self._table_of = _table_of(self._blocks)
        return self._table_of


def _parsed(pattern: bytes) -> Block | None:
    """The block of a pattern with more than plain words, None where the grammar has no such block."""
    from pkm_post.reading.gcode.parse import parse_line

    block = parse_line(pattern.replace(_MARK, b" 1 "))
    return block if isinstance(block, Block) else None


def _table_of(blocks: list[Block]) -> PatternTable:
    return PatternTable(
        filled=np.array([bool(block) for block in blocks]),
        deleted=np.array([block.deleted for block in blocks], np.int16),
        count=np.array([len(block.words) for block in blocks]),
        places={letter: _places(letter, blocks) for letter in sorted(set().union(*(block.words for block in blocks)))},
        g=CodeLists([block.g for block in blocks]),
        m=CodeLists([block.m for block in blocks]),
    )


def _places(letter: str, blocks: list[Block]) -> Array:
    return np.array([list(block.words).index(letter) if letter in block.words else -1 for block in blocks])
