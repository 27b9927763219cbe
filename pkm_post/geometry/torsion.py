# SPDX-License-Identifier: LGPL-2.1-or-later
"""Torsion: the turn of a frame about its own z axis, beyond the shortest rotation that takes it there.

Rmin(z -> k) = I + [v] + [v]^2 / (1 + kz), v = z x k, is the rotation without torsion. [Bonev2002]
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry.vectors import Array, dot


def untwisted(axis: Array) -> tuple[Array, Array]:
    """The x and y axes of the frame that the shortest rotation takes from upright to unit axes, (N, 3) each.

    Args:
        axis: (N, 3) unit axes, none of them pointing straight down.

    Raises:
        ValueError: an axis points straight down, where the shortest rotation is not unique.
    """
    lean = 1 + axis[:, 2]
    if np.any(lean < 1e-9):
        raise ValueError("expected tool axes above the horizontal plane, got one that points straight down")
    half = axis + [0.0, 0.0, 1.0]
    x = [1.0, 0.0, 0.0] - (axis[:, 0] / lean)[:, None] * half
    y = [0.0, 1.0, 0.0] - (axis[:, 1] / lean)[:, None] * half
    return x, y


def torsion(axis: Array, x: Array) -> Array:
    """The turn about unit axes that takes the x axis without torsion to directions, (N,) rad within half a turn.

    Args:
        axis: (N, 3) unit axes.
        x: (N, 3) directions of any length; what they have along the axes does not count.
    """
    straight, across = untwisted(axis)
    angle: Array = np.arctan2(dot(x, across), dot(x, straight))
    return angle
