# SPDX-License-Identifier: LGPL-2.1-or-later
"""Corner: shift of the tip of a cutter when the sizes of its corner change while it stays in contact.

The tip is at P + r n + e m - f k, with P the contact point. A change of the sizes by (r, e, f) shifts the tip by the
same formula; the full offset is the change from a cutter of zero size. Takes normals n, tool axes k and the points of
the path, one row per block; returns the shifts in mm, or diagnostics by row.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from pkm_post.geometry import dot, norm
from pkm_post.model import Diagnostic, Place
from pkm_post.toolpath.compensation.cutter import Cutter
from pkm_post.toolpath.compensation.sideways import Array, Flags, sideways, unit_or_nan

_ROUNDED = 1e-6
"""Tolerance of the cosine at the limits of the corner: normals have six decimals."""

_SHOWN = 50
"""Rows reported individually per fault; further ones are only counted."""

LARGEST_JUMP = 0.1
"""Jump of the tip, in mm from one row to the next, above which a free direction m is reported."""

Sizes = tuple[float, float, float]


def corner_shift(
    points: Array,
    normals: Array,
    axes: Array,
    sizes: Sizes,
    cutters: tuple[Cutter, ...],
    place_of: Callable[[int], Place],
) -> tuple[Array | None, tuple[Diagnostic, ...]]:
    """Tip shifts r n + e m - f k.

    Args:
        points: (N, 3) points in the order of travel, mm.
        normals: (N, 3) surface normals, of any length.
        axes: (N, 3) tool axes, of any length.
        sizes: r, e, f, or their changes, in mm.
        cutters: the cutters whose corner must be in contact.
        place_of: the place of a row, from 0, for diagnostics.

    Returns:
        The shifts (N, 3) in mm, or None when a row has none, and the diagnostics: N101 to N106.
    """
    r, e, f = sizes
    n, k = unit_or_nan(normals), unit_or_nan(axes)
    cosine = dot(n, k)
    finite = np.isfinite(points).all(axis=1) & np.isfinite(cosine)
    steepest = math.cos(min(cutter.corner_end for cutter in cutters))
    flattest = math.cos(max(cutter.corner_start for cutter in cutters))
    m, near = sideways(points, n, k, e) if e else (None, np.zeros(len(points), dtype=np.bool_))
    undercut, too_flat = finite & (cosine < steepest - _ROUNDED), finite & (cosine > flattest + _ROUNDED)
    sideless = finite & ~too_flat & np.isnan(m).any(axis=1) if m is not None else near
    faults = (
        *_told("N101", place_of, ~finite, points, normals, axes),
        *_told("N102", place_of, undercut, n, k),
        *_told("N103", place_of, sideless, n, k),
        *_told("N104", place_of, too_flat, n, k),
    )
    if faults:
        return None, tuple(sorted(faults, key=lambda item: item.place.line))
    shift = r * n - f * k
    if m is None:
        return shift, ()
    shift += e * m
    return shift, _jumps(m, cosine, near, e, place_of)


def _jumps(m: Array, cosine: Array, near: Flags, e: float, place_of: Callable[[int], Place]) -> tuple[Diagnostic, ...]:
    """Diagnostics of rows whose direction m depends on the last digits of the normal."""
    warnings = []
    if near.any():
        row, found = int(np.argmax(near)), f"{int(near.sum())} of {len(near)} rows, this the first"
        warnings.append(Diagnostic("N105", place_of(row), found))
    free = near | (cosine > 1.0 - _ROUNDED)
    jump = abs(e) * norm(np.diff(m, axis=0)) * (free[1:] | free[:-1])
    if len(jump) and np.max(jump) > LARGEST_JUMP:
        row = int(np.argmax(jump)) + 1
        warnings.append(Diagnostic("N106", place_of(row), f"by {np.max(jump):.4g} mm"))
    return tuple(warnings)


def _told(code: str, place_of: Callable[[int], Place], marked: Flags, *shown: Any) -> list[Diagnostic]:
    """One diagnostic per marked row, with the numbers of that row."""
    rows = np.flatnonzero(marked).tolist()
    told = []
    for count, row in enumerate(rows[:_SHOWN], start=1):
        found = " ".join(f"{number + 0.0:.6g}" for column in shown for number in column[row])
        more = f", and {len(rows) - _SHOWN} rows more" if count == _SHOWN < len(rows) else ""
        told.append(Diagnostic(code, place_of(row), found + more))
    return told
