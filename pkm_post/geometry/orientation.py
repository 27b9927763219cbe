# SPDX-License-Identifier: LGPL-2.1-or-later
"""Orientation: great circles between unit vectors, and torsion of frames about their z axes.

A direction k near c is written as the tangent vector a at c (a . c = 0) whose length is the angle between them:
k = cos|a| c + sin|a| a/|a|. Great circles through c are the straight lines a = s w. Arrays are (..., 3).

Torsion is the rotation of a frame about its own z axis, beyond the shortest rotation that tilts it:
Rmin(z -> k) = I + [v] + [v]^2 / (1 + kz), v = z x k, is the rotation without torsion. [Bonev2002]
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry.vectors import Array, cross, dot, length_of, norm

_SERIES_BELOW = 1e-4
"""Squared angle in rad^2 below which power series replace quotients that suffer cancellation."""


def angle_between(left: Array, right: Array) -> Array:
    """Angles between unit vectors in rad, accurate near 0 and near pi."""
    x, y, z = left[..., 0], left[..., 1], left[..., 2]
    u, v, w = right[..., 0], right[..., 1], right[..., 2]
    sine = np.sqrt(np.square(y * w - z * v) + np.square(z * u - x * w) + np.square(x * v - y * u))
    return np.asarray(np.arctan2(sine, x * u + y * v + z * w))


def turned_angles(before: Array, after: Array) -> Array:
    """Angles between unit vectors (N, 3), (N,) rad: exactly 0 where they are equal, and computed only elsewhere."""
    x, y, z = (after != before).T
    turns = x | y | z
    angle = np.zeros(len(after))
    angle[turns] = angle_between(before[turns], after[turns])
    return angle


def towards(start: Array, end: Array) -> Array:
    """Tangent vectors at ``start`` that lead to ``end``: direction of the great circle times the angle.

    Both are unit vectors, (..., 3), and not opposite.
    """
    cosine = dot(start, end)[..., None]
    sideways = end - cosine * start
    sine = norm(sideways)
    angle = np.arctan2(sine, cosine[..., 0])
    ratio = np.divide(angle, sine, out=np.ones_like(angle), where=sine > 0)
    return ratio[..., None] * sideways


def along(start: Array, tangent: Array) -> Array:
    """Unit vectors reached from ``start`` along ``tangent``; inverse of ``towards``."""
    angle = length_of(tangent[..., 0], tangent[..., 1], tangent[..., 2])[..., None]
    ratio = np.divide(np.sin(angle), angle, out=np.ones_like(angle), where=angle > 0)
    return np.asarray(np.cos(angle) * start + ratio * tangent)


def along_rates(start: Array, tangent: Array, rate: Array, second_rate: Array) -> tuple[Array, Array, Array]:
    """A direction that moves with its tangent vector, with first and second derivative.

    With q = |a|^2, f(q) = cos sqrt(q), g(q) = sin sqrt(q) / sqrt(q): k = f c + g a, f' = -g/2, g' = (f - g)/2q,
    g'' = -(g/2 + 3 g')/2q; the rest is the chain rule.

    Args:
        start: (..., 3) unit vectors c.
        tangent: (..., 3) tangent vectors a at c.
        rate: (..., 3) first derivatives of a.
        second_rate: (..., 3) second derivatives of a.

    Returns:
        k, its first and its second derivative, each (..., 3).
    """
    q = dot(tangent, tangent)
    f, g, g1, g2 = (value[..., None] for value in _cosine_and_quotients(q))
    q1 = 2 * dot(tangent, rate)[..., None]
    q2 = 2 * (dot(rate, rate) + dot(tangent, second_rate))[..., None]
    direction = f * start + g * tangent
    first = -g / 2 * q1 * start + g1 * q1 * tangent + g * rate
    second = (
        -(g1 * q1**2 + g * q2) / 2 * start + (g2 * q1**2 + g1 * q2) * tangent + 2 * g1 * q1 * rate + g * second_rate
    )
    return direction, first, second


def _cosine_and_quotients(q: Array) -> tuple[Array, Array, Array, Array]:
    """f, g, g', g'' of the docstring above, by series where q is small."""
    small = q < _SERIES_BELOW
    safe = np.where(small, 1.0, q)
    angle = np.sqrt(q)
    f = np.cos(angle)
    g = np.where(small, 1 - q / 6 + q**2 / 120, np.sin(angle) / np.sqrt(safe))
    g1 = np.where(small, -1 / 6 + q / 60 - q**2 / 1680, (f - g) / (2 * safe))
    g2 = np.where(small, 1 / 60 - q / 840 + q**2 / 30240, -(g / 2 + 3 * g1) / (2 * safe))
    return f, g, g1, g2


_STRAIGHT_DOWN = 1e-9
"""Threshold of 1 + kz."""
_ALMOST_DOWN = np.pi / 2 - 1e-3
"""Half of the largest tilt with a bound of the turn; a platform does not come close to it."""


def tilt(axis: Array) -> Array:
    """Angles of unit axes (N, 3) from upright, (N,) rad."""
    return np.arctan2(np.hypot(axis[:, 0], axis[:, 1]), axis[:, 2])


def largest_tilt(before: Array, after: Array) -> Array:
    """Largest angles from upright on the great circles from unit axes to others, (N, 3) each, (N,) rad."""
    normal = cross(before, after)
    falls_and_rises = (cross(normal, before)[:, 2] < 0) & (cross(normal, after)[:, 2] > 0)
    lean = np.minimum(np.abs(normal[:, 2]) / np.maximum(norm(normal), np.finfo(float).tiny), 1.0)
    return np.where(falls_and_rises, np.pi / 2 + np.arccos(lean), np.maximum(tilt(before), tilt(after)))


def turn_by_tilt(highest: Array) -> Array:
    """Largest rotation of a frame about its z axis per radian of rotation of this axis, (N,).

    A frame without torsion turns by w = k x k' + tau k with |tau| <= tan(tilt / 2) |k'|.

    Args:
        highest: (N,) rad, the largest tilt.
    """
    return np.tan(np.minimum(highest / 2, _ALMOST_DOWN))


def torsion_free_axes(axis: Array) -> tuple[Array, Array]:
    """The x and y axes of the frame that the shortest rotation takes from upright to unit axes, (N, 3) each.

    Args:
        axis: (N, 3) unit axes, none of them pointing straight down.

    Raises:
        ValueError: an axis points straight down, where the shortest rotation is not unique.
    """
    x, y = np.empty((2, 3, len(axis)))
    write_frames(x, y, axis.T, np.zeros(len(axis)))
    return x.T, y.T


def write_frames(x: Array, y: Array, axis: Array, spin: Array) -> None:
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
    straight, across = torsion_free_axes(axis)
    return np.arctan2(dot(x, across), dot(x, straight))
