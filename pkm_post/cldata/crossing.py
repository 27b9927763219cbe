# SPDX-License-Identifier: LGPL-2.1-or-later
"""Crossing: the way of the tool from where it is to above the next hole, in rapid moves.

Places with their tool axes enter, two and two, mm and the work frame; the places leave between which the tool moves
sideways. It rises first, crosses, and goes down last: a hole is left along the axis it has, and entered along that of
the next.
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry.vectors import dot
from pkm_post.model.program import Array

LEAST_COSINE = 0.5
"""Between the axes of two holes: the tool rises up to twice as far as the next hole asks for, and no farther."""


def crossing(here: Array, here_axis: Array, top: Array, top_axis: Array) -> tuple[Array, Array]:
    """Where the tool leaves its place sideways, and where it arrives above the next hole.

    leave  = here + max(0, (top - here).k1 / k0.k1) k0
    arrive = top  + max(0, (here - top).k0 / k0.k1) k1

    Both lie on or above the plane through ``here`` across k0 and the plane through ``top`` across k1, hence so does
    the line between them: no move sideways passes below what the hole behind or the hole ahead needs.

    Args:
        here: (N, 3) where the tool is, high enough for the hole behind.
        here_axis: (N, 3) its unit axes there, k0.
        top: (N, 3) the lowest places above the next holes in which the tool may arrive.
        top_axis: (N, 3) its unit axes there, k1; k0.k1 is at least ``LEAST_COSINE``.

    Raises:
        ValueError: some axes are too far from each other.
    """
    cosine = dot(here_axis, top_axis)
    if (cosine < LEAST_COSINE).any():
        raise ValueError(f"axes with cosines of at least {LEAST_COSINE} expected, got {cosine.min()}")
    rise = np.maximum(0.0, dot(top - here, top_axis) / cosine)
    drop = np.maximum(0.0, dot(here - top, here_axis) / cosine)
    return here + rise[:, None] * here_axis, top + drop[:, None] * top_axis
