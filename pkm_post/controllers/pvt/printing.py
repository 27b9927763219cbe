# SPDX-License-Identifier: LGPL-2.1-or-later
"""Printing: many numbers printed at once, for the writer.

Enters: numbers of any unit, and with how many decimals they are printed. Leaves: their characters as columns of bytes,
place by place, so that no number is a Python object on its way. Numbers are rounded to whole numbers of their last
decimal, of which each division by ten gives one column of digits. Beyond what doubles hold so, Python prints them.
"""

from __future__ import annotations

import numpy as np

from pkm_post.model.program import Array

BLANK = b"\0"
"""Stands where a number has no character; who joins the columns takes it out."""
_EXACT = 2**52
"""Below so many last decimals the nearest double is off by less than half of one, and prints as the decimal."""


def rounded(values: Array, decimals: int) -> Array:
    """The numbers as they are printed; adding zero turns -0.0 into 0.0."""
    return np.round(values, decimals) + 0.0


def printed(values: Array, decimals: int) -> Array:
    """Print rounded numbers, zero without a sign.

    Args:
        values: (...), finite, at least one.
        decimals: digits behind the point, at least one.

    Returns:
        (..., W) characters, as many as the longest number has; the others have blanks among theirs.
    """
    scaled = np.rint(values * 10.0**decimals)
    most = np.abs(scaled).max()
    if most < _EXACT:
        return _columns(scaled, int(most), decimals)
    texts = [f"{value:.{decimals}f}".encode("ascii") for value in rounded(values, decimals).ravel().tolist()]
    return np.array(texts)[:, None].view(np.uint8).reshape(*values.shape, -1)


def _columns(scaled: Array, most: int, decimals: int) -> Array:
    """Whole numbers of the last decimal, none beyond ``most``: a sign, digits, the point and the decimals."""
    before_point = len(str(most // 10**decimals))
    columns = np.empty((1 + before_point + 1 + decimals, *scaled.shape), dtype=np.uint8)
    last = len(columns) - 1
    point = last - decimals
    columns[0] = np.where(scaled < 0, ord("-"), 0)
    columns[point] = ord(".")
    rest = np.abs(scaled).astype(np.min_scalar_type(most))  # narrow numbers are divided much faster
    for column in [*range(last, point, -1), *range(point - 1, 0, -1)]:
        above = rest // 10
        columns[column] = ord("0") + (rest - above * 10)
        if column < point - 1:
            columns[column] *= rest > 0  # no zeros in front
        rest = above
    return np.moveaxis(columns, 0, -1)
