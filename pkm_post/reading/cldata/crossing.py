# SPDX-License-Identifier: LGPL-2.1-or-later
"""Crossing: the rapid moves of the tool from its position to above the next hole.

Enters: pairs of positions with tool axes, mm and the work frame. Leaves: start and end points of the lateral move. The
tool retracts first, traverses, and descends last: it leaves a hole along its axis, and enters the next along that of
the next.
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry import dot
from pkm_post.model import Array

LEAST_COSINE = 0.5
"""Cosine between the axes of two holes: it limits the retract to twice the height that the next hole requires."""


def crossing(here: Array, here_axis: Array, top: Array, top_axis: Array) -> tuple[Array, Array]:
    """Start point of the lateral move, and its end point above the next hole.

    leave  = here + max(0, (top - here).k1 / k0.k1) k0
    arrive = top  + max(0, (here - top).k0 / k0.k1) k1

    Both lie on or above the plane through ``here`` normal to k0 and the plane through ``top`` normal to k1, hence so
    does the line between them: no lateral move passes below the height that either hole requires.

    Args:
        here: (N, 3) tool position, high enough for the previous hole.
        here_axis: (N, 3) its unit axes there, k0.
        top: (N, 3) lowest permitted positions above the next holes.
        top_axis: (N, 3) its unit axes there, k1; k0.k1 is at least ``LEAST_COSINE``.

    Raises:
        ValueError: the angle between some axes is too large.
    """
    cosine = dot(here_axis, top_axis)
    if (cosine < LEAST_COSINE).any():
        raise ValueError(f"axes with cosines of at least {LEAST_COSINE} expected, got {cosine.min()}")
    rise = np.maximum(0.0, dot(top - here, top_axis) / cosine)
    drop = np.maximum(0.0, dot(here - top, here_axis) / cosine)
    return here + rise[:, None] * here_axis, top + drop[:, None] * top_axis
