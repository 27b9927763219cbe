# SPDX-License-Identifier: LGPL-2.1-or-later
import numpy as np

from pkm_post.geometry.gather import among, taken


def test_numbers_and_rows_give_what_was_given():
    numbers = np.random.default_rng(4).integers(1000, 1100, 500)
    there, row = among(numbers)
    np.testing.assert_array_equal(there, np.unique(numbers))
    np.testing.assert_array_equal(there[row], numbers)


def test_one_number_alone():
    there, row = among(np.array([7]))
    assert there.tolist() == [7]
    assert row.tolist() == [0]


def test_rows_are_taken_with_their_numbers_as_columns_in_memory():
    vectors = np.random.default_rng(5).normal(size=(40, 3))
    rows = np.array([3, 3, 39, 0])
    found = taken(vectors, rows)
    np.testing.assert_array_equal(found, vectors[rows])
    assert found.T.flags.c_contiguous
