# SPDX-License-Identifier: LGPL-2.1-or-later
"""Columns of tables: locked, shared where nobody can change them, and kept once where all rows are the same."""

from dataclasses import dataclass

import numpy as np
import pytest

from pkm_post.model.columns import by_row, freeze, is_uniform, locked, uniform


@dataclass(frozen=True)
class Table:
    """Two columns of three rows."""

    number: np.ndarray
    point: np.ndarray

    def __post_init__(self):
        freeze(self, 3, {"number": (np.int32, ()), "point": (np.float64, (2,))})


POINT = np.arange(6.0).reshape(3, 2)


def test_columns_have_their_type_and_are_read_only():
    table = Table([1, 2, 3], POINT.astype(np.float32))
    assert table.number.dtype == np.int32 and table.point.dtype == np.float64
    for column in (table.number, table.point):
        assert column.flags.c_contiguous
        with pytest.raises(ValueError, match="read-only"):
            column[0] = 7


def test_a_column_that_someone_may_change_is_copied():
    numbers, points = np.arange(3, dtype=np.int32), POINT.copy()
    seen = points.view()
    seen.flags.writeable = False
    table = Table(numbers, seen)
    numbers[0] = points[0, 0] = 9
    assert table.number[0] == 0
    assert table.point[0, 0] == 0


def test_a_column_that_nobody_can_change_is_shared():
    points = locked(POINT.copy())
    one = Table(np.arange(3), points)
    other = Table(np.arange(3), one.point[:])
    assert one.point is points
    assert np.shares_memory(other.point, points)


def test_rows_that_are_all_the_same_take_the_memory_of_one():
    row = np.array([1.0, 2.0])
    table = Table(uniform(5, 3, np.int64), np.broadcast_to(row, (3, 2)))
    row[0] = 9
    assert table.number.tolist() == [5, 5, 5] and table.number.dtype == np.int32
    assert table.point.tolist() == [[1.0, 2.0]] * 3
    assert is_uniform(table.number) and is_uniform(table.point)
    assert not is_uniform(POINT)


@pytest.mark.parametrize("rows", [0, 1, 5])
def test_a_function_of_rows_is_the_same_of_uniform_ones(rows):
    calls = []

    def double(column):
        calls.append(len(column))
        return 2 * column

    np.testing.assert_array_equal(by_row(double, uniform(3, rows)), np.full(rows, 6))
    assert calls == [min(rows, 1)]
    np.testing.assert_array_equal(by_row(double, POINT), 2 * POINT)


def test_another_shape_is_refused():
    with pytest.raises(ValueError, match=r"Table.point: expected \(3, 2\), got \(3, 3\)"):
        Table([1, 2, 3], np.zeros((3, 3)))
