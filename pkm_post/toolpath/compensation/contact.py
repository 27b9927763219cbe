# SPDX-License-Identifier: LGPL-2.1-or-later
"""Contact: tool tips at which the corner of a cutter touches a surface, and their shift for another cutter.

Two functions. One takes contact points, surface normals and tool axes, and returns tool tips. The other takes the
normals and axes along the path of one cutter, and returns the shift of its tips for another one. One row per block, in
one frame, in mm. The paper states the formula for an upright tool and the centre of the corner circle; here the tool
may be tilted, and the result is the tip, which is what a program contains.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from pkm_post.model import Diagnostic, Place
from pkm_post.toolpath.compensation.corner import corner_shift
from pkm_post.toolpath.compensation.cutter import Cutter
from pkm_post.toolpath.compensation.sideways import Array

_UNNAMED = Place("contact points")


def tip_from_contact(
    points: ArrayLike, normals: ArrayLike, axes: ArrayLike, cutter: Cutter, place: Place = _UNNAMED
) -> tuple[Array | None, tuple[Diagnostic, ...]]:
    """Tool tips at which the cutter touches the surface at the contact points.

    tip = P + r n + e m - f k, with m = unit(n - (n.k) k) the direction from the contact to the tool axis. The corner
    touches where sin b <= n.k <= cos a. Where n is parallel to k the whole bottom touches and m is free: it is carried
    over from the row before; at the start of the path it is the direction of travel.

    Args:
        points: (N, 3) contact points P in mm, in order of travel.
        normals: (N, 3) surface normals n there, towards the tool, of any length.
        axes: (N, 3) tool axes k from the tip towards the spindle, of any length.
        cutter: the cutter.
        place: what diagnostics name; the row number, from 1, becomes their line.

    Returns:
        The tips (N, 3) in mm, or None when a row cannot be compensated; and the diagnostics: N101 to N106.

    Raises:
        ValueError: the arrays are not all of one shape (N, 3).

    Source: [paper eq. 7], which is the case k = z with tip + R1 k = T.
    """
    contact, n, k = _rows("tip_from_contact", points, normals, axes)
    sizes = (cutter.corner_radius, cutter.radial_offset, cutter.axial_offset)
    shift, diagnostics = corner_shift(contact, n, k, sizes, (cutter,), _by_row(place))
    return (None if shift is None else contact + shift), diagnostics


def tip_shift(
    normals: ArrayLike,
    axes: ArrayLike,
    nominal: Cutter,
    actual: Cutter,
    points: ArrayLike | None = None,
    place: Place = _UNNAMED,
) -> tuple[Array | None, tuple[Diagnostic, ...]]:
    """Shift of tips computed for the nominal cutter, with which the actual cutter touches the same surface.

    tip' - tip = (r2 - r1) n + (e2 - e1) m - (f2 - f1) k, with m as in ``tip_from_contact``.

    Args:
        normals: (N, 3) surface normals at the contacts, towards the tool, of any length.
        axes: (N, 3) tool axes, of any length.
        nominal: the cutter the tips were computed for: r1, e1, f1.
        actual: the cutter in the spindle: r2, e2, f2.
        points: (N, 3) tips or contact points in order of travel, mm; they give the direction of travel where a path
            begins with n parallel to k.
        place: what diagnostics name; the row number, from 1, becomes their line.

    Returns:
        The shifts (N, 3) in mm, or None when a row has none; and the diagnostics: N101 to N106.

    Raises:
        ValueError: the arrays are not all of one shape (N, 3).
    """
    travelled = np.zeros(np.shape(normals)) if points is None else points
    way, n, k = _rows("tip_shift", travelled, normals, axes)
    return corner_shift(way, n, k, size_changes(nominal, actual), (nominal, actual), _by_row(place))


def size_changes(nominal: Cutter, actual: Cutter) -> tuple[float, float, float]:
    """Changes of r, e and f from one cutter to another, in mm."""
    return (
        actual.corner_radius - nominal.corner_radius,
        actual.radial_offset - nominal.radial_offset,
        actual.axial_offset - nominal.axial_offset,
    )


def _by_row(place: Place) -> Callable[[int], Place]:
    return lambda row: replace(place, line=row + 1)


def _rows(caller: str, *columns: ArrayLike) -> list[Array]:
    arrays = [np.asarray(column, dtype=np.float64) for column in columns]
    shapes = {array.shape for array in arrays}
    if len(shapes) != 1 or arrays[0].ndim != 2 or arrays[0].shape[1] != 3:
        raise ValueError(f"{caller}: expected {len(arrays)} arrays (N, 3), got {sorted(shapes)}")
    return arrays
