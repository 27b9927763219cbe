# SPDX-License-Identifier: LGPL-2.1-or-later
"""Columns: the check that every frozen dataclass of numpy arrays runs on itself.

A table of blocks is a dataclass whose array fields share their first dimension. Enters: such a dataclass
and, by field name, the shape of one row and the type. Leaves: the same object, its arrays of the promised type and
read-only: contiguous, or one row that stands for all of them. A column that is read-only already is shared between
tables and not copied, since nobody can change it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, DTypeLike

RowType = tuple[DTypeLike, tuple[int, ...]]
Array = np.ndarray[Any, np.dtype[Any]]


def freeze(table: Any, rows: int, columns: dict[str, RowType]) -> None:
    """Convert and lock the array fields of a frozen dataclass.

    Args:
        table: the dataclass instance, still in its ``__post_init__``.
        rows: the length that every column must have.
        columns: for each field its numpy type and the shape of one row, ``()`` for a plain column.

    Raises:
        ValueError: a column has another shape than promised.
    """
    for name, (dtype, row_shape) in columns.items():
        column = np.asarray(getattr(table, name))
        if column.shape != (rows, *row_shape):
            raise ValueError(f"{type(table).__name__}.{name}: expected {(rows, *row_shape)}, got {column.shape}")
        object.__setattr__(table, name, _kept(column, dtype))


def _kept(column: Array, dtype: DTypeLike) -> Array:
    if is_uniform(column) and len(column):
        return uniform(column[0], len(column), dtype)
    column = np.asarray(column, dtype=dtype)
    if column.flags.c_contiguous and _cannot_change(column):
        return column
    return locked(np.array(column, order="C"))


class Filled:
    """A column that is filled piece by piece; as long as all rows are alike it takes the memory of one."""

    def __init__(self, rows: int) -> None:
        """Of so many rows."""
        self._rows = rows
        self._column: Array | None = None

    def put(self, first: int, piece: Array) -> None:
        """Put rows where they belong; pieces come in order and leave no gap."""
        if self._column is None:
            self._column = np.broadcast_to(np.array(piece[:1], order="C"), (self._rows, *piece.shape[1:]))
        if len(piece) and is_uniform(self._column) and not _all_like(self._column[:1], piece):
            self._column = np.array(self._column, order="C")
        if not is_uniform(self._column):
            self._column[first : first + len(piece)] = piece

    def whole(self) -> Array:
        """The column, read-only."""
        if self._column is None:
            raise ValueError("expected a column with at least one piece, got none")
        return locked(self._column)


def _all_like(one: Array, rows: Array) -> bool:
    """Whether rows are those of a column of one row, bit for bit: NaN is like itself, and -0 is not like 0."""
    bits = np.ascontiguousarray(rows[:1] if is_uniform(rows) else rows).view(np.uint8)
    return bool((bits.reshape(-1, one.nbytes) == np.ascontiguousarray(one).view(np.uint8).reshape(1, -1)).all())


def pieces(rows: int, at_once: int) -> Iterator[slice]:
    """So many rows in pieces, in order; one piece without rows where there are none."""
    for first in range(0, max(rows, 1), at_once):
        yield slice(first, min(first + at_once, rows))


def in_pieces(rows: int, at_once: int, of: Callable[[slice], Sequence[Array]]) -> tuple[Array, ...]:
    """Columns that are computed piece by piece, since what is computed on the way takes more memory than they do.

    Args:
        rows: of the columns.
        at_once: rows of a piece, but for the last one.
        of: the columns of some rows, each row by itself.
    """
    columns: list[Filled] = []
    for part in pieces(rows, at_once):
        piece = of(part)
        columns = columns or [Filled(rows) for _ in piece]
        for column, values in zip(columns, piece, strict=True):
            column.put(part.start, values)
    return tuple(column.whole() for column in columns)


def locked(column: Array) -> Array:
    """The same array, read-only; for one that nobody else writes to."""
    column.flags.writeable = False
    return column


def _cannot_change(column: Array) -> bool:
    """Whether the array and all that it is a view of are read-only."""
    owner: object = column
    while isinstance(owner, np.ndarray) and not owner.flags.writeable:
        owner = owner.base
    return owner is None


def uniform(row: ArrayLike, rows: int, dtype: DTypeLike | None = None) -> Array:
    """A read-only column whose rows are all the same, in the memory of one of them.

    Args:
        row: the value of each row, () or (m,).
        rows: how many there are.
        dtype: of the column.
    """
    one = locked(np.array(row, dtype=dtype))
    return np.broadcast_to(one, (rows, *one.shape))


def shifted(first: ArrayLike, column: Array) -> Array:
    """A column moved on by one row: the first row is new, the last one goes; one row stands for all that are alike."""
    row = np.asarray(first, dtype=column.dtype)
    if is_uniform(column) and len(column) and row.tobytes() == column[0].tobytes():
        return column
    return np.concatenate([row[None], column[:-1]])


def is_uniform(column: Array) -> bool:
    """Whether a column is known to have the same row everywhere, without looking at the rows."""
    return len(column) < 2 or column.strides[0] == 0


def rows_of(column: Array, rows: Array) -> Array:
    """Some rows of a column; one that is uniform stays so, as ``numpy.take`` would write it out first."""
    if is_uniform(column) and len(column):
        return np.broadcast_to(column[0], (len(rows), *column.shape[1:]))
    return np.take(column, rows, axis=0)


def by_row(function: Callable[[Array], Array], column: Array) -> Array:
    """A function of each row by itself, computed once where all rows are the same.

    Args:
        function: from rows to as many rows.
        column: the rows.
    """
    if is_uniform(column) and len(column):
        return uniform(function(column[:1])[0], len(column))
    return function(column)


def both_by_row(function: Callable[[Array, Array], Array], left: Array, right: Array) -> Array:
    """The same of each row of two columns."""
    if is_uniform(left) and is_uniform(right) and len(left):
        return uniform(function(left[:1], right[:1])[0], len(left))
    return function(left, right)
