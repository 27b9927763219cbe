# SPDX-License-Identifier: LGPL-2.1-or-later
"""Lexer for many lines at once: each number becomes a marker, and the rest of a line is its shape.

Enters: the bytes of whole lines, comments blanked. Leaves: the shape of each line, and the offsets of the numbers. Work
is done per byte with tables and per number with numpy, never per line.

In a shape letters are upper case and blanks are removed. The digits of G and M codes stay, because they determine the
meaning of a block, as do those before an equals sign, as in A3=0.5; these and line numbers do not count as numbers.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from pkm_post.model import Array

MARK = b"\x01"
"""Marker of a number in a shape."""

_BLANK = 0x20
_NUMERIC = b"+-.0123456789"
_BLANKS = b" \t\f\v"
_MEANT = b"\nABCDEFGHIJKLMNOPQRSTUVWXYZ/%#=[]<>*_" + _NUMERIC + _BLANKS  # leftover parentheses are faults


def _table(of: Callable[[int], int]) -> bytes:
    return bytes(of(byte) for byte in range(256))


def _in_shape(byte: int) -> int:
    upper = ord(chr(byte).upper()) if byte < 128 else byte
    if upper not in _MEANT:
        return ord("?")
    return MARK[0] if byte in _NUMERIC else _BLANK if byte in _BLANKS else upper


_SHAPE = _table(_in_shape)
_IS_NUMERIC = _table(lambda byte: byte in _NUMERIC)
_STAYS = _table(lambda byte: byte not in _NUMERIC + _BLANKS)
_KEYWORDS = (b"LN", b"TRA")
"""Prefixes of multi-letter words. Where one occurs, blanks after letters stay: L N is not LN."""
_IS_CODE, _IS_LINE_NUMBER = (np.isin(np.arange(256), [ord(letter) for letter in letters]) for letters in ("GM", "N"))


@dataclass
class Lexed:
    """Lexed lines.

    Attributes:
        shapes: the shape of each line.
        starts: (n,) offset of each number except codes and line numbers.
        ends: (n,) end offset of each number.
        suspicious: offsets within line numbers that contain non-digits; these are not in the shape.
    """

    shapes: list[bytes]
    starts: Array
    ends: Array
    suspicious: Array


def lex(text: bytes) -> Lexed:
    """Lex lines.

    Args:
        text: whole lines without comments, each with its line feed.
    """
    raw, numeric = (np.frombuffer(source, np.uint8) for source in (text, text.translate(_IS_NUMERIC)))
    shape, stays = (np.frombuffer(bytearray(text.translate(table)), np.uint8) for table in (_SHAPE, _STAYS))
    edges = np.flatnonzero(numeric[1:] != numeric[:-1]) + 1
    if numeric[0]:
        edges = np.concatenate([[0], edges])
    starts, ends = edges[::2], edges[1::2]
    before = _before(shape, starts)
    is_code, is_line_number = _IS_CODE[before] | (raw[ends] == ord("=")), _IS_LINE_NUMBER[before]
    codes, line_numbers = (_runs(starts[some], numeric) for some in (is_code, is_line_number))
    stays[starts] = 1
    stays[codes] = 1
    shape[codes] = raw[codes]
    shapes = shape[stays.view(bool)].tobytes()
    if any(keyword in shapes for keyword in _KEYWORDS):
        parted = (shape[1:] == _BLANK) & (shape[:-1] >= ord("A")) & (shape[:-1] <= ord("Z"))
        stays[1:] |= parted
        shapes = shape[stays.view(bool)].tobytes()
    plain = ~(is_code | is_line_number)
    return Lexed(
        shapes=shapes.split(b"\n")[:-1],
        starts=starts[plain],
        ends=ends[plain],
        suspicious=line_numbers[raw[line_numbers] < ord("0")],
    )


def _before(shape: Array, starts: Array) -> Array:
    """The last non-blank byte before each number; a line feed at the start of the text."""
    before = np.where(starts > 0, shape[starts - 1], ord("\n"))
    if (before == _BLANK).any():
        last = np.maximum.accumulate(np.where(shape != _BLANK, np.arange(len(shape)), -1))[starts - 1]
        before = np.where((starts > 0) & (last >= 0), shape[last], ord("\n"))
    return before


def _runs(starts: Array, numeric: Array) -> Array:
    """Offsets of all bytes of the numbers at the given start offsets."""
    offsets = [starts]
    while len(offsets[-1]):
        following = offsets[-1] + 1
        offsets.append(following[numeric[following] != 0])
    return np.concatenate(offsets)
