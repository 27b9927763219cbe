# SPDX-License-Identifier: LGPL-2.1-or-later
import numpy as np
import pytest

from pkm_post.geometry.cells import grid_cells
from pkm_post.geometry.vectors import distinct_with_rows, take_rows, unit_or_nan


def test_numbers_and_rows_give_what_was_given():
    numbers = np.random.default_rng(4).integers(1000, 1100, 500)
    there, row = distinct_with_rows(numbers)
    np.testing.assert_array_equal(there, np.unique(numbers))
    np.testing.assert_array_equal(there[row], numbers)


def test_one_number_alone():
    there, row = distinct_with_rows(np.array([7]))
    assert there.tolist() == [7]
    assert row.tolist() == [0]


def test_rows_are_taken_with_their_numbers_as_columns_in_memory():
    vectors = np.random.default_rng(5).normal(size=(40, 3))
    rows = np.array([3, 3, 39, 0])
    found = take_rows(vectors, rows)
    np.testing.assert_array_equal(found, vectors[rows])
    assert found.T.flags.c_contiguous


@pytest.mark.parametrize("about", [1, 7, 200, 5000])
def test_every_row_is_in_one_cell_and_cells_are_small(about):
    rng = np.random.default_rng(1)
    points = np.column_stack([rng.uniform(0, 100, (3000, 2)), rng.normal(0, 1, 3000)])
    found = grid_cells(points, about)
    assert np.array_equal(np.sort(np.concatenate(found)), np.arange(3000))
    assert all(np.all(np.diff(rows) > 0) for rows in found)
    side = 100 / max(1, round(np.sqrt(3000 / about)))
    assert all(np.all(np.ptp(points[rows], axis=0) <= side * 1.001) for rows in found)
    assert about / 4 < np.mean([len(rows) for rows in found]) <= max(4 * about, 1)


def test_no_points_and_points_in_one_place():
    assert grid_cells(np.zeros((0, 3)), 10) == []
    assert [rows.tolist() for rows in grid_cells(np.ones((40, 3)), 10)] == [list(range(40))]


def test_directions_of_vectors_without_one_are_nan():
    vectors = np.array([[0, 3, 4], [0, 0, 0], [1e-10, 0, 0], [np.inf, 1, 0], [np.nan, 1, 0]])
    known = [[0, 0.6, 0.8], [1, 0, 0]]
    np.testing.assert_allclose(unit_or_nan(vectors)[[0, 2]], known)
    assert np.isnan(unit_or_nan(vectors)[[1, 3, 4]]).all()
    assert np.isnan(unit_or_nan(vectors, 1e-9)[1:]).all()
