# SPDX-License-Identifier: LGPL-2.1-or-later
"""Banded: symmetric positive definite systems with two diagonals on either side of the main one.

Two unknowns form one block, so the matrix is block tridiagonal. Cyclic reduction eliminates every second block at once
and leaves a block tridiagonal matrix of half the size, until a dense solver takes the rest. N unknowns take log2(N)
steps over columns instead of a loop over rows; positive definite matrices need no pivoting [Golub2013]. Input: the
lower band. Output: a factor that solves for any number of right-hand sides.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from pkm_post.geometry import Array

_FEW = 16
"""Most blocks for the dense solver: below this, steps over columns cost more than they save."""


class _Level(NamedTuple):
    """One step of the reduction: its odd-numbered blocks, (2, 2, K) each.

    Attributes:
        inverse: inverses of the diagonal blocks.
        before: inverse times the coupling to the previous block.
        after: inverse times the coupling to the next block; zero for the last one.
    """

    inverse: Array
    before: Array
    after: Array


class BandedFactor:
    """The factor of a banded matrix."""

    def __init__(self, band: Array) -> None:
        """Factor a matrix A.

        Args:
            band: (3, N); row d has A[j + d, j] in column j. Entries beyond the matrix are not read.
        """
        self._unknowns = band.shape[1]
        main, lower = _blocks(band)
        self._levels = []
        while main.shape[2] > _FEW:
            main, lower, level = _halved(main, lower)
            self._levels.append(level)
        self._last = np.linalg.inv(_dense(main, lower))

    def solve(self, right: Array) -> Array:
        """Solve A x = right for x, (N,) both."""
        padded = np.append(right, np.zeros(-self._unknowns % 2)).reshape(-1, 2).T
        odds = []
        for level in self._levels:
            odd, even = padded[:, 1::2], padded[:, ::2].copy()
            even[:, : odd.shape[1]] -= _transposed_times(level.before, odd)
            rest = even.shape[1] - 1
            even[:, 1:] -= _transposed_times(level.after[..., :rest], odd[:, :rest])
            odds.append(odd)
            padded = even
        found = (self._last @ padded.T.ravel()).reshape(-1, 2).T
        for level, odd in zip(self._levels[::-1], odds[::-1], strict=True):
            count, rest = odd.shape[1], found.shape[1] - 1
            inner = _times_vector(level.inverse, odd) - _times_vector(level.before, found[:, :count])
            inner[:, :rest] -= _times_vector(level.after[..., :rest], found[:, 1:])
            joined = np.empty((2, found.shape[1] + count))
            joined[:, ::2], joined[:, 1::2] = found, inner
            found = joined
        return found.T.ravel()[: self._unknowns]


def _blocks(band: Array) -> tuple[Array, Array]:
    """Diagonal blocks, (2, 2, K), and the blocks coupling each to its predecessor, (2, 2, K - 1)."""
    odd = band.shape[1] % 2
    band = np.concatenate([band, np.array([[1.0], [0.0], [0.0]])], axis=1) if odd else band
    if odd:
        band[1, -2] = band[2, -3:-1] = 0.0
    one, two = band[:, ::2], band[:, 1::2]
    main = np.stack([np.stack([one[0], one[1]]), np.stack([one[1], two[0]])])
    lower = np.stack([np.stack([one[2], two[1]]), np.stack([np.zeros_like(two[2]), two[2]])])
    return main, lower[..., :-1]


def _halved(main: Array, lower: Array) -> tuple[Array, Array, _Level]:
    """The block tridiagonal matrix of the even-numbered blocks, and the eliminated level."""
    odd, into, out = main[..., 1::2], lower[..., ::2], lower[..., 1::2]
    inverse = _inverse(odd)
    rest = out.shape[2]
    turned = np.zeros_like(odd)
    turned[..., :rest] = out.swapaxes(0, 1)
    level = _Level(inverse, _times(inverse, into), _times(inverse, turned))
    even = main[..., ::2].copy()
    even[..., : odd.shape[2]] -= _times(into.swapaxes(0, 1), level.before)
    even[..., 1:] -= _times(out, level.after[..., :rest])
    return even, -_times(out, level.before[..., :rest]), level


def _dense(main: Array, lower: Array) -> Array:
    count = main.shape[2]
    dense = np.zeros((count, 2, count, 2))
    row = np.arange(count)
    dense[row, :, row] = main.transpose(2, 0, 1)
    dense[row[1:], :, row[:-1]] = lower.transpose(2, 0, 1)
    dense[row[:-1], :, row[1:]] = lower.transpose(2, 1, 0)
    return dense.reshape(2 * count, 2 * count)


def _inverse(block: Array) -> Array:
    """Inverses of symmetric positive definite (2, 2, K) blocks."""
    determinant = block[0, 0] * block[1, 1] - block[0, 1] ** 2
    off = -block[0, 1] / determinant
    return np.stack([np.stack([block[1, 1] / determinant, off]), np.stack([off, block[0, 0] / determinant])])


def _times(left: Array, right: Array) -> Array:
    """Products of (2, 2, K) blocks."""
    return left[:, 0, None] * right[0] + left[:, 1, None] * right[1]


def _times_vector(left: Array, right: Array) -> Array:
    return left[:, 0] * right[0] + left[:, 1] * right[1]


def _transposed_times(left: Array, right: Array) -> Array:
    return left[0] * right[0] + left[1] * right[1]
