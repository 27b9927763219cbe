# SPDX-License-Identifier: LGPL-2.1-or-later
"""Positions: absolute and relative words in a row become places.

Columns of words enter, NaN where a block has none; the coordinate after each block leaves, in the same unit. A word
sets the coordinate in absolute mode and adds to it in relative mode; between two words it stays.
"""

from __future__ import annotations

import numpy as np

from pkm_post.model.program import Array


def follow(words: Array, relative: Array, start: Array) -> tuple[Array, Array]:
    """The coordinates after each block, and whether they are known.

    Args:
        words: (n, m) values of m letters.
        relative: (n,) whether they are distances (G91).
        start: (m,) coordinates before.

    Returns:
        (n, m) coordinates, and (n, m) whether an absolute word has been given by then.
    """
    rows = np.arange(len(words))[:, None]
    given = ~np.isnan(words)
    values = np.where(given, words, 0.0)
    last = np.maximum.accumulate(np.where(given & ~relative[:, None], rows, -1), axis=0)
    known = last >= 0
    if not relative.any():
        return np.where(known, np.take_along_axis(values, last, axis=0), start), known
    travelled = np.cumsum(np.where(relative[:, None], values, 0.0), axis=0)
    base = np.where(known, np.take_along_axis(values - travelled, last, axis=0), start)
    return base + travelled, known
