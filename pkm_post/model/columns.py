# SPDX-License-Identifier: LGPL-2.1-or-later
"""Columns: the check that every frozen dataclass of numpy arrays runs on itself.

A table of blocks is a dataclass whose array fields share their first dimension. Enters: such a dataclass
and, by field name, the shape of one row and the type. Leaves: the same object, its arrays of the promised type and
read-only: contiguous, or one row that stands for all of them. A column that is read-only already is shared between
tables and not copied, since nobody can change it.
"""

from __future__ import annotations

from collections.abc import Callable
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


def is_uniform(column: Array) -> bool:
    """Whether a column is known to have the same row everywhere, without looking at the rows."""
    return len(column) < 2 or column.strides[0] == 0


def by_row(function: Callable[[Array], Array], column: Array) -> Array:
    """A function of each row by itself, computed once where all rows are the same.

    Args:
        function: from rows to as many rows.
        column: the rows.
    """
    if is_uniform(column) and len(column):
        return uniform(function(column[:1])[0], len(column))
    return function(column)
