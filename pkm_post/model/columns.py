# SPDX-License-Identifier: LGPL-2.1-or-later
"""Columns: validation and freezing of the arrays of frozen dataclasses.

A table of blocks is a dataclass whose array fields share their first dimension. Input: such a dataclass and, by field
name, the shape of one row and the type. Output: the same object with read-only arrays of the required type: contiguous,
or one row broadcast to all. A column that is already read-only is shared between tables, not copied, since it cannot
change.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from pkm_post.model.checkpoint import checkpoint

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, DTypeLike

RowType = tuple["DTypeLike", tuple[int, ...]]
Array = np.ndarray[Any, np.dtype[Any]]


def freeze(table: Any, rows: int, columns: dict[str, RowType]) -> None:
    """Convert the array fields of a frozen dataclass and make them read-only.

    Args:
        table: the dataclass instance, still in its ``__post_init__``.
        rows: the required length of every column.
        columns: numpy type and row shape of each field, ``()`` for a plain column.

    Raises:
        ValueError: a column has a wrong shape.
    """
    for name, (dtype, row_shape) in columns.items():
        checkpoint()
        column = np.asarray(getattr(table, name))
        if column.shape != (rows, *row_shape):
            raise ValueError(f"{type(table).__name__}.{name}: expected {(rows, *row_shape)}, got {column.shape}")
        object.__setattr__(table, name, _frozen(column, dtype))


def _frozen(column: Array, dtype: DTypeLike) -> Array:
    if column.dtype == dtype and column.strides[0] == 0 and _cannot_change(column):
        return column
    if is_uniform(column) and len(column):
        return uniform(column[0], len(column), dtype)
    column = np.asarray(column, dtype=dtype)
    if column.flags.c_contiguous and _cannot_change(column):
        return column
    return read_only(np.array(column, order="C"))


class ColumnBuilder:
    """A column built piece by piece; it takes the memory of one row while all are equal."""

    def __init__(self, rows: int) -> None:
        """Start a column of this many rows."""
        self._rows = rows
        self._column: Array | None = None

    def put(self, first: int, piece: Array) -> None:
        """Store rows; pieces come in order and without gaps."""
        if self._column is None:
            self._column = np.broadcast_to(np.array(piece[:1], order="C"), (self._rows, *piece.shape[1:]))
        if len(piece) and is_uniform(self._column) and not _all_equal(self._column[:1], piece):
            checkpoint()
            self._column = np.array(self._column, order="C")
            checkpoint()
        if not is_uniform(self._column):
            self._column[first : first + len(piece)] = piece

    def whole(self) -> Array:
        """The complete column, read-only."""
        if self._column is None:
            raise ValueError("expected a column with at least one piece, got none")
        return read_only(self._column)


def _all_equal(one: Array, rows: Array) -> bool:
    """Whether all rows equal a column of one row, bit for bit: NaN equals itself, and -0 differs from 0."""
    bits = np.ascontiguousarray(rows[:1] if is_uniform(rows) else rows).view(np.uint8)
    return bool((bits.reshape(-1, one.nbytes) == np.ascontiguousarray(one).view(np.uint8).reshape(1, -1)).all())


def pieces(rows: int, at_once: int) -> Iterator[slice]:
    """Yield slices of this many rows, in order, with a checkpoint before each; one empty slice if there are none."""
    for first in range(0, max(rows, 1), at_once):
        checkpoint()
        yield slice(first, min(first + at_once, rows))


def batches(rows: Array, at_once: int) -> Iterator[Array]:
    """Yield an array in pieces of this many rows, in order; none if it is empty."""
    return (rows[first : first + at_once] for first in range(0, len(rows), at_once))


def batches_of_work(work: Array, at_once: int) -> list[Array]:
    """Rows with work to do, in order, in batches of about this much work."""
    rows = np.flatnonzero(work)
    number = np.cumsum(work[rows]) // at_once
    return np.split(rows, np.flatnonzero(np.diff(number)) + 1) if len(rows) else []


def in_pieces(rows: int, at_once: int, compute: Callable[[slice], Sequence[Array]]) -> tuple[Array, ...]:
    """Compute columns piece by piece, since intermediate results take more memory than the columns.

    Args:
        rows: of the columns.
        at_once: rows of a piece, except the last one.
        compute: columns of some rows, each row independent of the others.
    """
    columns: list[ColumnBuilder] = []
    for part in pieces(rows, at_once):
        piece = compute(part)
        columns = columns or [ColumnBuilder(rows) for _ in piece]
        for column, values in zip(columns, piece, strict=True):
            column.put(part.start, values)
    return tuple(column.whole() for column in columns)


def forward_fill(rows: Array, values: Array, before: float, count: int) -> Array:
    """Forward-fill a column: the last value given up to each row, (count,).

    Args:
        rows: (k,) rows with a given value, non-decreasing.
        values: (k,) the given values.
        before: the value before the first one.
        count: number of rows.
    """
    if len(rows) == count:
        return values
    first = values[0] if len(rows) and rows[0] == 0 else before
    if (values == first).all():
        return uniform(first, count, values.dtype)
    return np.repeat(np.append(values.dtype.type(before), values), np.diff(rows, prepend=0, append=count))


def fill_gaps(column: Array, before: float) -> Array:
    """Each value, or the last one above it where it is NaN, (n,); ``before`` above the first."""
    rows = np.flatnonzero(~np.isnan(column))
    return forward_fill(rows, column[rows], before, len(column))


def read_only(column: Array) -> Array:
    """Make the array read-only and return it; the array must have no other writer."""
    column.flags.writeable = False
    return column


def _cannot_change(column: Array) -> bool:
    """Whether the array and all its bases are read-only."""
    owner: object = column
    while isinstance(owner, np.ndarray) and not owner.flags.writeable:
        owner = owner.base
    return owner is None


def uniform(row: ArrayLike, rows: int, dtype: DTypeLike | None = None) -> Array:
    """A read-only column with equal rows, in the memory of one of them.

    Args:
        row: the value of each row, () or (m,).
        rows: number of rows.
        dtype: of the column.
    """
    return _repeated(np.array(row, dtype=dtype), rows)


def _repeated(row: Array, rows: int) -> Array:
    """A read-only column of equal rows; ``numpy.broadcast_to`` takes twice as long."""
    one = read_only(np.asarray(row, order="C"))
    return np.ndarray((rows, *one.shape), one.dtype, one, strides=(0, *one.strides))


def shifted(first: ArrayLike, column: Array) -> Array:
    """Shift a column by one row: the first row is new, the last one is dropped; uniform columns stay compact."""
    row = np.asarray(first, dtype=column.dtype)
    if is_uniform(column) and len(column) and row.tobytes() == column[0].tobytes():
        return column
    return np.concatenate([row[None], column[:-1]])


def is_uniform(column: Array) -> bool:
    """Whether a column is known to be uniform, without comparing its rows."""
    return len(column) < 2 or column.strides[0] == 0


def select_rows(column: Array, rows: Array) -> Array:
    """Select rows of a column; a uniform one stays compact, as ``numpy.take`` would expand it."""
    if is_uniform(column) and len(column):
        return _repeated(column[0], len(rows))
    return np.take(column, rows, axis=0)


def joined(columns: Sequence[Array]) -> Array:
    """The rows of some columns one after the other; a single column is not copied."""
    return columns[0] if len(columns) == 1 else np.concatenate(columns)


def distinct(values: Array) -> Array:
    """The distinct values of a column, ascending; ``numpy.unique`` would import masked arrays."""
    ordered = np.sort(values, axis=None)
    new = np.ones(len(ordered), dtype=np.bool_)
    new[1:] = ordered[1:] != ordered[:-1]
    return np.asarray(ordered[new])


def is_among(column: Array, numbers: Iterable[int]) -> Array:
    """Whether each integer is among some numbers, (N,); ``numpy.isin`` imports masked arrays for short columns."""
    return np.isin(column, np.fromiter(numbers, dtype=np.int64), kind="table")


def find_rows(ascending: Array, rows: Array) -> tuple[Array, Array]:
    """Find ``rows``, (N,), in ``ascending``, (M,): indices of the matches in both, (K,) each."""
    if not len(ascending):
        return ascending, ascending
    at = np.minimum(np.searchsorted(ascending, rows), len(ascending) - 1)
    found = np.flatnonzero(ascending[at] == rows)
    return found, at[found]


def intervals_at(ends: Array, values: Array | float) -> Array:
    """Intervals between ascending ends, (M,), in which values lie; at an end that which begins there."""
    return np.clip(np.searchsorted(ends, values, side="right") - 1, 0, len(ends) - 2)


def map_rows(function: Callable[[Array], Array], column: Array) -> Array:
    """Apply a function of rows to a column, computed once where all rows are equal."""
    checkpoint()
    if is_uniform(column) and len(column):
        return uniform(function(column[:1])[0], len(column))
    return function(column)


def map_row_pairs(function: Callable[[Array, Array], Array], left: Array, right: Array) -> Array:
    """Apply a function to each pair of rows, computed once where all pairs are equal."""
    checkpoint()
    if is_uniform(left) and is_uniform(right) and len(left):
        return uniform(function(left[:1], right[:1])[0], len(left))
    return function(left, right)
