# SPDX-License-Identifier: LGPL-2.1-or-later
"""Columns of written values: rounded values, and the rows on which they change.

Enters and leaves: columns by program row.
"""

from __future__ import annotations

import numpy as np

from pkm_post.model import Array, EventKind, Kind, Program


def rounded(values: Array, decimals: int) -> Array:
    """Values as they will be read back; adding zero makes -0 positive."""
    return np.round(values, decimals) + 0.0


def changed(values: Array, before: float) -> Array:
    """Mask of rows whose value differs from the previous row, (N,); ``before`` precedes the first."""
    other: Array = np.append(before, values[:-1])[: len(values)] != values
    return other


def newly_said(values: Array, given: Array, restart: Array) -> Array:
    """Mask of given rows whose value differs from the last given one, or that are first after a restart, (N,)."""
    rows = np.flatnonzero(given)
    new = np.ones(len(rows), dtype=np.bool_)
    new[1:] = (values[rows[1:]] != values[rows[:-1]]) | (restart[rows[1:]] != restart[rows[:-1]])
    return scattered(rows, new, len(values))


def scattered(rows: Array, values: Array, count: int) -> Array:
    """A column of ``count`` rows with the values on the given rows, zero elsewhere."""
    column = np.zeros(count, dtype=values.dtype)
    column[rows] = values
    return column


def tool_changes(program: Program) -> Array:
    """Number of tool changes before each row, (N,)."""
    rows = [event.row for event in program.events if event.kind is EventKind.TOOL_CHANGE]
    return np.searchsorted(np.sort(np.array(rows, dtype=np.int64)), np.arange(len(program)), "right")


def cutting(program: Program) -> Array:
    """Mask of rows with a feed, (N,): row 0 is reached by a rapid move, whatever its kind."""
    has_feed: Array = program.kind != Kind.RAPID
    has_feed[:1] = False
    return has_feed
