# SPDX-License-Identifier: LGPL-2.1-or-later
"""Lexing of many lines at once: every number becomes one mark, and what is left of a line is its shape.

Enters: the bytes of whole lines, comments blanked. Leaves: the shape of each line, and the text of the numbers with
blanks in the place of everything else. Work is done per byte with tables and per number with numpy, never per line.

In a shape letters are upper case and blanks are gone. The digits of G and M codes stay, as they decide what a block
means; they and line numbers are no numbers then.
"""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from pkm_post.model.program import Array

MARK = b"\x01"
"""Stands for a number in a shape."""

BLANK = 0x20
_NUMERIC = b"+-.0123456789"
_BLANKS = b" \t\f\v"
_MEANT = b"\nABCDEFGHIJKLMNOPQRSTUVWXYZ/%#=[]<>*_" + _NUMERIC + _BLANKS  # parentheses left by comments are faults


def _table(of: Callable[[int], int]) -> bytes:
    return bytes(of(byte) for byte in range(256))


def _in_shape(byte: int) -> int:
    upper = ord(chr(byte).upper()) if byte < 128 else byte
    if upper not in _MEANT:
        return ord("?")
    return MARK[0] if byte in _NUMERIC else BLANK if byte in _BLANKS else upper


_SHAPE = _table(_in_shape)
_NUMBER = _table(lambda byte: byte if byte in _NUMERIC else BLANK)
_IS_NUMERIC = _table(lambda byte: byte in _NUMERIC)
_STAYS = _table(lambda byte: byte not in _NUMERIC + _BLANKS)
_IS_CODE, _IS_LINE_NUMBER = (np.isin(np.arange(256), [ord(letter) for letter in letters]) for letters in ("GM", "N"))

_RUN = re.compile(rb"[-+.\d]+")
_WELL_FORMED = re.compile(rb"[+-]?(?:\d+\.?\d*|\.\d+)")


@dataclass
class Lexed:
    """Lines taken apart.

    Attributes:
        shapes: the shape of each line.
        numbers: the bytes of the numbers, writable; blanks elsewhere.
        suspicious: whether a line number has more than digits; it is not among the numbers and must be looked at.
    """

    shapes: list[bytes]
    numbers: Array
    suspicious: bool


def lex(text: bytes) -> Lexed:
    """Take lines apart.

    Args:
        text: whole lines without comments, each with its line feed.
    """
    raw, numeric = (np.frombuffer(source, np.uint8) for source in (text, text.translate(_IS_NUMERIC)))
    shape, numbers, stays = (
        np.frombuffer(bytearray(text.translate(table)), np.uint8) for table in (_SHAPE, _NUMBER, _STAYS)
    )
    starts = np.flatnonzero(numeric[1:] > numeric[:-1]) + 1
    if numeric[0]:
        starts = np.concatenate([[0], starts])
    before = _before(shape, starts)
    codes = _runs(starts[_IS_CODE[before]], numeric)
    line_numbers = _runs(starts[_IS_LINE_NUMBER[before]], numeric)
    stays[starts] = 1
    stays[codes] = 1
    shape[codes] = raw[codes]
    numbers[codes] = BLANK
    numbers[line_numbers] = BLANK
    suspicious = bool((raw[line_numbers] < ord("0")).any())
    return Lexed(shape[stays.view(bool)].tobytes().split(b"\n")[:-1], numbers, suspicious)


def malformed_lines(text: bytes) -> Array:
    """Numbers, from 0, of the lines that hold a run of digits, points and signs that is no number."""
    wrong = [run.start() for run in _RUN.finditer(text) if not _WELL_FORMED.fullmatch(run[0])]
    ends = np.flatnonzero(np.frombuffer(text, np.uint8) == ord("\n"))
    return np.unique(np.searchsorted(ends, np.array(wrong, np.int64)))


def read_numbers(numbers: Array, promised: int) -> Array | None:
    """The values of all numbers, or nothing when some number is malformed.

    A malformed one is read as two (1.2.3, 1-2) or not at all (1.., --1), so it never passes.

    Args:
        numbers: bytes of numbers and blanks.
        promised: how many numbers there are.
    """
    if promised == 0:  # numpy reads one number from a text without any
        return np.empty(0)
    with warnings.catch_warnings():
        warnings.simplefilter("error", DeprecationWarning)  # what numpy before 2.4 has for an error
        try:
            values = np.fromstring(numbers.tobytes(), sep=" ")
        except (ValueError, DeprecationWarning):
            return None
    return values if len(values) == promised else None


def _before(shape: Array, starts: Array) -> Array:
    """For each number the last byte before it that is no blank; a line feed before the first byte of the text."""
    before = np.where(starts > 0, shape[starts - 1], ord("\n"))
    if (before == BLANK).any():
        last = np.maximum.accumulate(np.where(shape != BLANK, np.arange(len(shape)), -1))[starts - 1]
        before = np.where((starts > 0) & (last >= 0), shape[last], ord("\n"))
    return before


def _runs(starts: Array, numeric: Array) -> Array:
    """Offsets of all bytes of the numbers that start at given offsets."""
    offsets = [starts]
    while len(offsets[-1]):
        following = offsets[-1] + 1
        offsets.append(following[numeric[following] != 0])
    return np.concatenate(offsets)
