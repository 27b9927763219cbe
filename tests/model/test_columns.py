# SPDX-License-Identifier: LGPL-2.1-or-later
"""Columns of tables: read-only, shared where they may be, and kept once where all rows are the same."""

from dataclasses import dataclass

import numpy as np
import pytest

from pkm_post.model.columns import (
    ColumnBuilder,
    freeze,
    in_pieces,
    is_among,
    is_uniform,
    map_row_pairs,
    map_rows,
    pieces,
    read_only,
    select_rows,
    shifted,
    uniform,
)


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
    points = read_only(POINT.copy())
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

    np.testing.assert_array_equal(map_rows(double, uniform(3, rows)), np.full(rows, 6))
    assert calls == [min(rows, 1)]
    np.testing.assert_array_equal(map_rows(double, POINT), 2 * POINT)


def test_another_shape_is_refused():
    with pytest.raises(ValueError, match=r"Table.point: expected \(3, 2\), got \(3, 3\)"):
        Table([1, 2, 3], np.zeros((3, 3)))


@pytest.mark.parametrize("at_once", [1, 7, 1000, 1001])
def test_pieces_cover_all_rows_in_order(at_once):
    found = [np.arange(1000)[rows] for rows in pieces(1000, at_once)]
    assert max(map(len, found)) == min(at_once, 1000)
    assert np.concatenate(found).tolist() == list(range(1000))
    assert [(rows.start, rows.stop) for rows in pieces(0, at_once)] == [(0, 0)]


@pytest.mark.parametrize("at_once", [1, 7, 1000, 1001])
def test_columns_in_pieces_are_those_of_all_rows(at_once):
    numbers = np.random.default_rng(1).normal(size=(1000, 3))

    def of(rows):
        some = numbers[rows]
        return some**2, np.ones(len(some)), np.full((len(some), 3), np.nan)

    square, same, missing = in_pieces(1000, at_once, of)
    np.testing.assert_array_equal(square, numbers**2)
    assert square.flags.c_contiguous and not is_uniform(square)
    np.testing.assert_array_equal(same, np.ones(1000))
    np.testing.assert_array_equal(missing, np.full((1000, 3), np.nan))
    assert is_uniform(same) and is_uniform(missing)
    assert not any(column.flags.writeable for column in (square, same, missing))


@pytest.mark.parametrize("at_once", [1, 7, 1000])
@pytest.mark.parametrize("row", [0, 6, 7, 999])
def test_one_other_row_is_kept_wherever_it_is(at_once, row):
    column = np.zeros(1000)
    column[row] = -0.0
    (found,) = in_pieces(1000, at_once, lambda rows: (column[rows],))
    assert found.tobytes() == column.tobytes()


def test_no_rows_are_a_column_without_rows():
    (found,) = in_pieces(0, 7, lambda rows: (np.ones((4, 3))[rows],))
    assert found.shape == (0, 3)
    with pytest.raises(ValueError, match="at least one piece"):
        ColumnBuilder(3).whole()


def test_rows_of_a_uniform_column_take_no_memory():
    few = select_rows(uniform([1.0, 2.0], 10**9), np.array([5, 7, 9]))
    assert few.tolist() == [[1.0, 2.0]] * 3 and is_uniform(few)
    assert select_rows(POINT, np.array([2, 0])).tolist() == POINT[[2, 0]].tolist()


def test_a_shifted_column_begins_with_the_row_before():
    assert shifted([7.0, 8.0], POINT).tolist() == [[7.0, 8.0], [0.0, 1.0], [2.0, 3.0]]
    same = uniform([7.0, 8.0], 10**9)
    assert shifted([7.0, 8.0], same) is same
    assert shifted([9.0, 8.0], uniform([7.0, 8.0], 3)).tolist() == [[9.0, 8.0], [7.0, 8.0], [7.0, 8.0]]


def test_functions_of_two_uniform_columns_are_computed_once():
    long = uniform(2.0, 10**9)
    assert is_uniform(map_row_pairs(np.subtract, long, long))
    assert map_row_pairs(np.subtract, uniform(2.0, 3), np.arange(3.0)).tolist() == [2.0, 1.0, 0.0]


@pytest.mark.parametrize("numbers", [(), (5,), range(-3, 40, 7), {430, 435, 10}])
def test_numbers_are_found_among_others_as_by_numpy(numbers):
    column = np.random.default_rng(3).integers(-5, 500, 200).astype(np.int16)
    assert np.array_equal(is_among(column, numbers), np.isin(column, [*numbers]))
    assert is_among(column[:0], numbers).shape == (0,)
