# SPDX-License-Identifier: LGPL-2.1-or-later
"""Contact: the tool tip that makes the corner of a cutter touch a surface.

Contact points, surface normals and tool axes enter, one row per block; tool tips leave, in the same frame, in mm. The
paper gives the rule for an upright tool and measures to the centre of the corner circle; here the tool may lean, and
the tip is what a program carries.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from pkm_post.compensation.cutter import Cutter
from pkm_post.geometry import dot, norm
from pkm_post.model import Diagnostic, Place

Array = np.ndarray[Any, np.dtype[np.float64]]

_PARALLEL = 1e-6
"""Below this sine of the angle between normal and axis, the normal does not say to which side the cutter lies."""

_UNDERCUT = 1e-6
"""A cosine this far below zero is still a wall parallel to the axis: normals come with six decimals."""

_UNNAMED = Place("contact points")


def tip_from_contact(
    points: ArrayLike, normals: ArrayLike, axes: ArrayLike, cutter: Cutter, place: Place = _UNNAMED
) -> tuple[Array | None, tuple[Diagnostic, ...]]:
    """Tool tips whose cutter touches the surface at the contact points.

    tip = P + r n + e m - f k, with m = unit(n - (n.k) k) the direction from the contact to the tool axis.
    Where n is parallel to k the whole bottom touches and m is free: it is carried on from the row before, at the
    start of the path it is the direction of travel.

    Args:
        points: (N, 3) contact points P in mm, in the order they are travelled.
        normals: (N, 3) surface normals n there, towards the tool, of any length.
        axes: (N, 3) tool axes k from the tip towards the spindle, of any length.
        cutter: the corner of the cutter.
        place: what diagnostics name; the row number, from 1, becomes their line.

    Returns:
        The tips (N, 3) in mm, or None when a row cannot be compensated; and the diagnostics.

    Raises:
        ValueError: the arrays are not all of one shape (N, 3).

    Source: [paper eq. 7], which is the case k = z with tip + R1 k = T.
    """
    contact, given_normals, given_axes = (np.asarray(column, dtype=np.float64) for column in (points, normals, axes))
    shapes = {contact.shape, given_normals.shape, given_axes.shape}
    if len(shapes) != 1 or contact.ndim != 2 or contact.shape[1] != 3:
        raise ValueError(f"tip_from_contact: expected three arrays (N, 3), got {sorted(shapes)}")
    n, k = _unit(given_normals), _unit(given_axes)
    cosine = dot(n, k)
    m = _towards_axis(contact, n, k)
    finite = np.isfinite(contact).all(axis=1) & np.isfinite(cosine)
    sideless = finite & np.isnan(m).any(axis=1) & (cutter.radial_offset > 0.0)
    diagnostics = (
        *_refuse("N101", place, ~finite, np.hstack([contact, given_normals, given_axes])),
        *_refuse("N102", place, finite & (cosine < -_UNDERCUT), np.hstack([n, k])),
        *_refuse("N103", place, sideless, np.hstack([n, k])),
    )
    if diagnostics:
        return None, tuple(sorted(diagnostics, key=lambda item: item.place.line))
    sideways = cutter.radial_offset * m if cutter.radial_offset > 0.0 else 0.0
    return contact + cutter.corner_radius * n + sideways - cutter.axial_offset * k, ()


def _towards_axis(points: Array, n: Array, k: Array) -> Array:
    """Directions m at right angles to the axes, (N, 3): the first rule that gives one decides; NaN where none does."""
    m = _unit_across(n, k)
    if not np.isnan(m).any():
        return m
    along_path = _unit_across(_travel(points), k)
    m[:1] = np.where(np.isnan(m[:1]), along_path[:1], m[:1])
    known = ~np.isnan(m).any(axis=1)
    latest_known = np.maximum.accumulate(np.where(known, np.arange(len(m)), 0))
    carried = _unit_across(m[latest_known], k)
    for fallback in (carried, along_path):
        m = np.where(np.isnan(m), fallback, m)
    return m


def _travel(points: Array) -> Array:
    """Directions of travel from the point before to the point after, (N, 3), of any length, zero for a lone point."""
    if len(points) < 2:
        return np.zeros_like(points)
    with np.errstate(invalid="ignore"):
        return np.asarray(np.gradient(points, axis=0), dtype=np.float64)


def _unit(vectors: Array) -> Array:
    """Vectors scaled to unit length; NaN where one has no direction."""
    length = norm(vectors)[:, None]
    unit: Array = vectors / np.where((length > 0.0) & np.isfinite(length), length, np.nan)
    return unit


def _unit_across(vectors: Array, k: Array) -> Array:
    """Unit vectors of what the vectors have at right angles to k; NaN where they are parallel to it."""
    direction = _unit(vectors)
    across = direction - dot(direction, k)[:, None] * k
    length = norm(across)[:, None]
    unit: Array = across / np.where(length > _PARALLEL, length, np.nan)
    return unit


def _refuse(code: str, place: Place, marked: np.ndarray[Any, np.dtype[np.bool_]], shown: Array) -> list[Diagnostic]:
    """One diagnostic for every row that is marked, with the numbers of that row."""
    return [
        Diagnostic(code, replace(place, line=int(row) + 1), " ".join(f"{number:.6g}" for number in shown[row]))
        for row in np.flatnonzero(marked)
    ]
