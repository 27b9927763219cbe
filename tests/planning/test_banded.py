# SPDX-License-Identifier: LGPL-2.1-or-later
"""Banded systems against dense ones."""

import numpy as np
import pytest

from pkm_post.planning.jerk.banded import BandedFactor


def band_of(size, random):
    """A positive definite band and the dense matrix: L L^T with L of two diagonals below the main one."""
    dense = np.diag(random.uniform(1, 2, size))
    for below in (1, 2):
        dense += np.diag(random.normal(size=max(size - below, 0)), -below)[:size, :size]
    dense = dense @ dense.T
    band = np.full((3, size), np.nan)
    for d in range(3):
        band[d, : max(size - d, 0)] = np.diagonal(dense, -d)
    return band, dense


@pytest.mark.parametrize("size", [3, 4, 7, 31, 32, 33, 34, 35, 64, 65, 66, 67, 68, 129, 300])
def test_the_solution_against_a_dense_solver(size):
    band, dense = band_of(size, np.random.default_rng(size))
    band = np.nan_to_num(band, nan=7.0)  # what is beyond the matrix is not read
    right = np.random.default_rng(1).normal(size=(2, size))
    factor = BandedFactor(band)
    for one in right:
        expected = np.linalg.solve(dense, one)
        rounding = 1e-10 * np.abs(expected).max() * np.linalg.cond(dense) ** 0.5
        np.testing.assert_allclose(factor.solve(one), expected, rtol=0, atol=rounding)


@pytest.mark.parametrize("size", [1, 2])
def test_one_and_two_unknowns(size):
    band = np.array([[4.0, 3.0], [1.0, 9.0], [9.0, 9.0]])[:, :size]
    dense = np.array([[4.0, 1.0], [1.0, 3.0]])[:size, :size]
    right = np.arange(1.0, size + 1)
    np.testing.assert_allclose(BandedFactor(band).solve(right), np.linalg.solve(dense, right))
