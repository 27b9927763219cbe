# SPDX-License-Identifier: LGPL-2.1-or-later
"""Blocks as text: format columns of words and codes as lines.

Rows with the same words and codes share one template. The templates of some thousand rows are joined and filled with
all their numbers at once, so no Python code runs per block. Every number has all its decimals, and so a point: some
controls read a number without one as thousandths.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterator, Mapping

import numpy as np

from pkm_post.model import Array
from pkm_post.writing.gcode.writer_codes import TEXTS, Codes
from pkm_post.writing.gcode.writer_words import Word

_CHUNK = 1 << 13
"""Rows formatted at a time."""


def block_texts(words: list[Word], codes: Codes, between: Mapping[int, str]) -> Iterator[str]:
    """The text of all blocks, in pieces.

    Args:
        words: in text order.
        codes: written before the words, with P after the path code and D after the compensation code.
        between: whole lines to insert before some rows.
    """
    columns = [codes.tolerance, codes.diameter, *words]
    templates, of_row = _templates(columns, codes)
    rows = sorted(between)
    for begin in range(0, len(of_row), _CHUNK):
        chunk = slice(begin, begin + _CHUNK)
        lines = templates[of_row[chunk]].tolist()
        for row in rows[bisect_left(rows, begin) : bisect_left(rows, begin + len(lines))]:
            lines[row - begin] = between[row].replace("%", "%%") + lines[row - begin]
        values = np.column_stack([word.values[chunk] for word in columns])
        said = np.column_stack([word.said[chunk] for word in columns])
        yield "".join(lines) % tuple(values[said].tolist())


def _templates(columns: list[Word], codes: Codes) -> tuple[Array, Array]:
    """The distinct templates, and the template index of each row, (N,)."""
    radices = [len(TEXTS[group]) for group in Codes.ORDER] + [2] * len(columns)
    digits = [getattr(codes, group) for group in Codes.ORDER] + [word.said for word in columns]
    key = np.zeros(len(codes.motion), dtype=np.int64)
    for radix, digit in zip(reversed(radices), reversed(digits), strict=True):
        key = key * radix + digit
    used, of_row = np.unique(key, return_inverse=True)
    return np.array([_template(int(one), radices, columns) for one in used], dtype=object), of_row


def _template(key: int, radices: list[int], columns: list[Word]) -> str:
    digits = []
    for radix in radices:
        key, digit = divmod(key, radix)
        digits.append(digit)
    code = {group: TEXTS[group][digit] for group, digit in zip(Codes.ORDER, digits, strict=False)}
    tolerance, diameter, *words = [
        f"{word.letter}%.{word.decimals}f" if said else ""
        for word, said in zip(columns, digits[len(Codes.ORDER) :], strict=True)
    ]
    parts = [code["plane"], code["side"], diameter, code["motion"], *words]
    if tolerance:  # on a separate line: other codes use P as well
        return f"{code['path']} {tolerance}\n" + _line(parts)
    return _line([code["path"], *parts])


def _line(parts: list[str]) -> str:
    return " ".join(part for part in parts if part) + "\n"
