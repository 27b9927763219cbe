# SPDX-License-Identifier: LGPL-2.1-or-later
"""Torsion: rotation of a frame about its own z axis, beyond the shortest rotation that tilts it.

Rmin(z -> k) = I + [v] + [v]^2 / (1 + kz), v = z x k, is the rotation without torsion. [Bonev2002]
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry.vectors import Array, dot

_STRAIGHT_DOWN = 1e-9
"""Threshold of 1 + kz."""
_ALMOST_DOWN = np.pi / 2 - 1e-3
"""Half of the largest tilt with a bound of the turn; a platform does not come close to it."""


def tilt(axis: Array) -> Array:
    """Angles of unit axes (N, 3) from upright, (N,) rad."""
    return np.arctan2(np.hypot(axis[:, 0], axis[:, 1]), axis[:, 2])


def turn_by_tilt(highest: Array) -> Array:
    """Largest rotation of a frame about its z axis per radian of rotation of this axis, (N,).

    A frame without torsion turns by w = k x k' + tau k with |tau| <= tan(tilt / 2) |k'|.

    Args:
        highest: (N,) rad, the largest tilt.
    """
    return np.tan(np.minimum(highest / 2, _ALMOST_DOWN))


def untwisted(axis: Array) -> tuple[Array, Array]:
    """The x and y axes of the frame that the shortest rotation takes from upright to unit axes, (N, 3) each.

    Args:
        axis: (N, 3) unit axes, none of them pointing straight down.

    Raises:
        ValueError: an axis points straight down, where the shortest rotation is not unique.
    """
    x, y = np.empty((2, 3, len(axis)))
    fill_frame(x, y, axis.T, np.zeros(len(axis)))
    return x.T, y.T


def fill_frame(x: Array, y: Array, axis: Array, spin: Array) -> None:
    """Write the x and y axes of frames as columns, (3, N).

    Args:
        x: where the x axes are written, (3, N).
        y: where the y axes are written, (3, N).
        axis: (3, N) the z axes, unit, none of them pointing straight down.
        spin: (N,) rad, the rotations about these, beyond the shortest rotations.

    Raises:
        ValueError: an axis points straight down, where the shortest rotation is not unique.
    """
    lean = 1 + axis[2]
    if np.any(lean < _STRAIGHT_DOWN):
        raise ValueError("expected tool axes that do not point straight down, got one that does")
    cosine, sine = np.cos(spin), np.sin(spin)
    for column, along, across in ((x, cosine, sine), (y, -sine, cosine)):
        down = along * axis[0] + across * axis[1]
        np.multiply(-down / lean, axis, out=column)
        column[0] += along
        column[1] += across
        column[2] = -down


def torsion(axis: Array, x: Array) -> Array:
    """The rotation about unit axes from the x axis without torsion to directions, (N,) rad within half a turn.

    Args:
        axis: (N, 3) unit axes.
        x: (N, 3) directions of any length; components along the axes are ignored.
    """
    straight, across = untwisted(axis)
    angle: Array = np.arctan2(dot(x, across), dot(x, straight))
    return angle
