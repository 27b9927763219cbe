# SPDX-License-Identifier: LGPL-2.1-or-later
"""Contact: tool tips at which the corner of a cutter touches a surface, and their shift for another cutter.

The tip is at P + r n + e m - f k, with P the contact point, n the surface normal, k the tool axis and m the unit vector
across the axis from the contact towards it: m = unit(n - (n.k) k). A change of the sizes by (r, e, f) shifts the tip by
the same formula. Near n = k the direction m depends on the last digits of the normal, and at n = k it is undefined: the
cutter then keeps its direction. One row per block, in one frame, in mm. The paper states the formula for an upright
tool and the centre of the corner circle; here the tool may be tilted, and the result is the tip.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from pkm_post.geometry import across, dot, norm, unit_or_nan
from pkm_post.model import Array, Diagnostic, Diagnostics, Place
from pkm_post.toolpath.compensation.cutter import Cutter

_PARALLEL = 1e-6
"""Below this sine of the angle between normal and axis, the normal does not define the side of the cutter."""
_NEARLY_PARALLEL = 0.02
"""Below this sine, an error of the normal by 5e-5 (four decimals) turns m by more than 0.14 degrees."""
_HALF_WINDOW = 5
"""Rows before and after a row whose normals are averaged with its own."""
_SMOOTHING_COST = 1e-4
"""Largest gouge in mm by the averaged direction; where it would be deeper, m is not averaged."""
_ROUNDED = 1e-6
"""Tolerance of the cosine at the limits of the corner: normals have six decimals."""
_SHOWN = 50
"""Rows reported individually per fault; further ones are only counted."""
LARGEST_JUMP = 0.1
"""Jump of the tip, in mm from one row to the next, above which a free direction m is reported."""
_UNNAMED = Place("contact points")
Sizes = tuple[float, float, float]


def tip_from_contact(
    points: ArrayLike, normals: ArrayLike, axes: ArrayLike, cutter: Cutter, place: Place = _UNNAMED
) -> tuple[Array | None, Diagnostics]:
    """Tool tips at which the cutter touches the surface at the contact points.

    tip = P + r n + e m - f k, with m = unit(n - (n.k) k) the direction from the contact to the tool axis. The corner
    touches where sin b <= n.k <= cos a. Where n is parallel to k the whole bottom touches and m is free: it is carried
    over from the row before; at the start of the path it is the direction of travel.

    Args:
        points: (N, 3) contact points P in mm, in order of travel.
        normals: (N, 3) surface normals n there, towards the tool, of any length.
        axes: (N, 3) tool axes k from the tip towards the spindle, of any length.
        cutter: the cutter.
        place: place for diagnostics; the row number, from 1, becomes their line.

    Returns:
        The tips (N, 3) in mm, or None when a row cannot be compensated; and the diagnostics: N101 to N106.

    Raises:
        TypeError: the cutter is none.
        ValueError: the arrays are not all of one shape (N, 3).

    Source: [paper eq. 7], which is the case k = z with tip + R1 k = T.

    Example:
        >>> cutter = pkm.Cutter(corner_radius=4.0, radial_offset=4.0, axial_offset=4.0)  # a bull nose, 16 mm across
        >>> tips, faults = pkm.tip_from_contact([[0, 0, 0]], [[1, 0, 0]], [[0, 0, 1]], cutter)
        >>> tips, faults
        (array([[ 8.,  0., -4.]]), ())
    """
    if not isinstance(cutter, Cutter):
        raise TypeError(f"tip_from_contact: cutter: expected Cutter, got {type(cutter).__name__}")
    contact, n, k = _rows(points, normals, axes)
    sizes = (cutter.corner_radius, cutter.radial_offset, cutter.axial_offset)
    shift, diagnostics = tip_offsets(contact, n, k, sizes, (cutter,), lambda row: replace(place, line=row + 1))
    return (None if shift is None else contact + shift), diagnostics


def size_changes(nominal: Cutter, actual: Cutter) -> tuple[float, float, float]:
    """Changes of r, e and f from one cutter to another, in mm."""
    return (
        actual.corner_radius - nominal.corner_radius,
        actual.radial_offset - nominal.radial_offset,
        actual.axial_offset - nominal.axial_offset,
    )


def _rows(*columns: ArrayLike) -> list[Array]:
    try:
        arrays = [np.asarray(column, dtype=np.float64) for column in columns]
    except (TypeError, ValueError) as fault:
        raise ValueError(f"tip_from_contact: expected {len(columns)} arrays (N, 3) of numbers: {fault}") from fault
    shapes = {array.shape for array in arrays}
    if len(shapes) != 1 or arrays[0].ndim != 2 or arrays[0].shape[1] != 3:
        raise ValueError(f"tip_from_contact: expected {len(arrays)} arrays (N, 3), got {sorted(shapes)}")
    return arrays


def tip_offsets(
    points: Array,
    normals: Array,
    axes: Array,
    sizes: Sizes,
    cutters: tuple[Cutter, ...],
    place_of: Callable[[int], Place],
) -> tuple[Array | None, Diagnostics]:
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
    m, near = radial_directions(points, n, k, e) if e else (None, np.zeros(len(points), dtype=np.bool_))
    undercut, too_flat = finite & (cosine < steepest - _ROUNDED), finite & (cosine > flattest + _ROUNDED)
    sideless = finite & ~too_flat & np.isnan(m).any(axis=1) if m is not None else near
    faults = (
        *_row_faults("N101", place_of, ~finite, points, normals, axes),
        *_row_faults("N102", place_of, undercut, n, k),
        *_row_faults("N103", place_of, sideless, n, k),
        *_row_faults("N104", place_of, too_flat, n, k),
    )
    if faults:
        return None, tuple(sorted(faults, key=lambda item: item.place.line))
    shift = r * n - f * k
    if m is None:
        return shift, ()
    shift += e * m
    return shift, _jumps(m, cosine, near, e, place_of)


def _jumps(m: Array, cosine: Array, near: Array, e: float, place_of: Callable[[int], Place]) -> Diagnostics:
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


def _row_faults(code: str, place_of: Callable[[int], Place], marked: Array, *shown: Any) -> list[Diagnostic]:
    """One diagnostic per marked row, with the numbers of that row."""
    rows = np.flatnonzero(marked).tolist()
    faults = []
    for count, row in enumerate(rows[:_SHOWN], start=1):
        found = " ".join(f"{number + 0.0:.6g}" for column in shown for number in column[row])
        more = f", and {len(rows) - _SHOWN} rows more" if count == _SHOWN < len(rows) else ""
        faults.append(Diagnostic(code, place_of(row), found + more))
    return faults


def radial_directions(points: Array, n: Array, k: Array, radial_offset: float) -> tuple[Array, Array]:
    """Directions m, NaN in rows where no rule gives one.

    The normal decides. Where it is parallel to the axis, m of the last row that has one is projected again; before the
    first of these it is the direction of travel. Where normal and axis are nearly parallel, m is averaged over
    neighbours, provided that the cutter gouges by no more than 0.1 um.

    Args:
        points: (N, 3) points in the order of travel, mm.
        n: (N, 3) unit normals.
        k: (N, 3) unit tool axes.
        radial_offset: e, or the change of e, in mm: the factor of m.

    Returns:
        m (N, 3), and the rows (N,) where normal and axis are nearly, but not, parallel.
    """
    sideways = across(n, k)
    sine = norm(sideways)
    with np.errstate(invalid="ignore", divide="ignore"):
        parallel, near = sine < _PARALLEL, (sine >= _PARALLEL) & (sine < _NEARLY_PARALLEL)
        m = sideways / np.where(parallel, np.nan, sine)[:, None]
    if near.any():
        m[near] = _averaged(sideways, sine, m, k, radial_offset)[near]
    if np.isnan(m).any():
        m = _filled(points, m, k)
    return m, near


def _averaged(sideways: Array, sine: Array, m: Array, k: Array, radial_offset: float) -> Array:
    """Directions of the mean of neighbouring normals, where the gouge is small enough."""
    mean = unit_across(_moving_sum(np.nan_to_num(sideways)), k)
    cost = abs(radial_offset) * sine * (1.0 - dot(mean, m))
    return np.where((cost <= _SMOOTHING_COST)[:, None], mean, m)


def _moving_sum(rows: Array) -> Array:
    """Sums over each row and its neighbours, (N, 3)."""
    sums = np.vstack([np.zeros((1, 3)), np.cumsum(rows, axis=0)])
    index = np.arange(len(rows))
    return sums[np.minimum(index + _HALF_WINDOW + 1, len(rows))] - sums[np.maximum(index - _HALF_WINDOW, 0)]


def _filled(points: Array, m: Array, k: Array) -> Array:
    """Directions with missing rows filled: the first rule that yields one counts."""
    along_path = unit_across(_travel(points), k)
    m[:1] = np.where(np.isnan(m[:1]), along_path[:1], m[:1])
    known = ~np.isnan(m).any(axis=1)
    latest_known = np.maximum.accumulate(np.where(known, np.arange(len(m)), 0))
    for fallback in (unit_across(m[latest_known], k), along_path):
        m = np.where(np.isnan(m), fallback, m)
    return m


def _travel(points: Array) -> Array:
    """Directions of travel from the point before to the point after, (N, 3), of any length, zero for a lone point."""
    if len(points) < 2:
        return np.zeros_like(points)
    with np.errstate(invalid="ignore"):
        return np.asarray(np.gradient(points, axis=0), dtype=np.float64)


def unit_across(vectors: Array, k: Array) -> Array:
    """Unit vectors (N, 3) of the components normal to k; NaN where the vectors are parallel to it."""
    direction = unit_or_nan(vectors)
    return unit_or_nan(across(direction, k), _PARALLEL)
