# SPDX-License-Identifier: LGPL-2.1-or-later
"""Decimals: numbers as text in the form that the controller reads.

The controller reads plain decimals: digits, and a point with digits on both sides of it. It has no exponent form.
Input: a number of any unit. Output: the shortest such decimal that reads back as the same number. Or many numbers and
their count of decimals: characters as columns of bytes, without a Python object per number. These are rounded to
integers in units of the last decimal; each division by ten gives one column of digits. Numbers beyond the exact range
of doubles are printed by Python.
"""

from __future__ import annotations

from decimal import Decimal

import numpy as np

from pkm_post.model import Array


def exact(value: float | Decimal) -> Decimal:
    """The shortest decimal that reads back as ``value``, for arithmetic without binary rounding."""
    return value if isinstance(value, Decimal) else Decimal(repr(value))


def plain(value: float | Decimal) -> str:
    """Print a finite number without exponent, trailing zeros or negative zero."""
    decimal = exact(value)
    if not decimal.is_finite():
        raise ValueError(f"value: expected a finite number, got {value}")
    text = format(decimal, "f")
    if "." in text:
        text = text.rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


BLANK = b"\0"
"""Fills places without a character; removed when the columns are joined."""
_EXACT = 2**52
"""In units of the last decimal; below it the nearest double errs by less than half a unit and prints exactly."""


def round_values(values: Array, decimals: int) -> Array:
    """The numbers as printed; adding zero turns -0.0 into 0.0."""
    return np.round(values, decimals) + 0.0


def print_columns(values: Array, decimals: int) -> Array:
    """Print rounded numbers, zero without a sign.

    Args:
        values: (...), finite, at least one.
        decimals: digits after the point, at least one.

    Returns:
        (..., W) characters, with W those of the longest number; shorter ones contain blanks.
    """
    scaled = np.rint(values * 10.0**decimals)
    most = np.abs(scaled).max()
    if most < _EXACT:
        return _columns(scaled, int(most), decimals)
    texts = [f"{value:.{decimals}f}".encode("ascii") for value in round_values(values, decimals).ravel().tolist()]
    return np.array(texts)[:, None].view(np.uint8).reshape(*values.shape, -1)


def _columns(scaled: Array, most: int, decimals: int) -> Array:
    """Characters of integers in units of the last decimal, up to ``most``: sign, digits, point and decimals."""
    before_point = len(str(most // 10**decimals))
    columns = np.empty((1 + before_point + 1 + decimals, *scaled.shape), dtype=np.uint8)
    last = len(columns) - 1
    point = last - decimals
    columns[0] = np.where(scaled < 0, ord("-"), 0)
    columns[point] = ord(".")
    rest = np.abs(scaled).astype(np.min_scalar_type(most))  # narrow integers divide much faster
    for column in [*range(last, point, -1), *range(point - 1, 0, -1)]:
        above = rest // 10
        columns[column] = ord("0") + (rest - above * 10)
        if column < point - 1:
            columns[column] *= rest > 0  # no leading zeros
        rest = above
    return np.moveaxis(columns, 0, -1)
