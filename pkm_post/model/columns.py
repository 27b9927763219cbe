# SPDX-License-Identifier: LGPL-2.1-or-later
"""Columns: the check that every frozen dataclass of numpy arrays runs on itself.

A table of blocks is a dataclass whose array fields share their first dimension. Enters: such a dataclass
and, by field name, the shape of one row and the type. Leaves: the same object, its arrays of the promised type,
contiguous and read-only, so that a column can be shared between steps without being copied.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import DTypeLike

RowType = tuple[DTypeLike, tuple[int, ...]]


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
        column = np.array(getattr(table, name), dtype=dtype, order="C")
        if column.shape != (rows, *row_shape):
            raise ValueError(f"{type(table).__name__}.{name}: expected {(rows, *row_shape)}, got {column.shape}")
        column.flags.writeable = False
        object.__setattr__(table, name, column)
