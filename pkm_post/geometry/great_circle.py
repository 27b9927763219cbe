# SPDX-License-Identifier: LGPL-2.1-or-later
"""Great circles: shortest rotation of a unit vector from one direction to another.

A direction k near c is written as the tangent vector a at c (a . c = 0) whose length is the angle between them:
k = cos|a| c + sin|a| a/|a|. Great circles through c are the straight lines a = s w. Arrays are (..., 3).
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry.vectors import Array, dot, length_of, norm

_SERIES_BELOW = 1e-4
"""Squared angle in rad^2 below which power series replace quotients that suffer cancellation."""


def angle_between(left: Array, right: Array) -> Array:
    """Angles between unit vectors in rad, accurate near 0 and near pi."""
    x, y, z = left[..., 0], left[..., 1], left[..., 2]
    u, v, w = right[..., 0], right[..., 1], right[..., 2]
    sine = np.sqrt(np.square(y * w - z * v) + np.square(z * u - x * w) + np.square(x * v - y * u))
    return np.asarray(np.arctan2(sine, x * u + y * v + z * w))


def towards(start: Array, end: Array) -> Array:
    """Tangent vectors at ``start`` that lead to ``end``: direction of the great circle times the angle.

    Args:
        start: (..., 3) unit vectors.
        end: (..., 3) unit vectors, not opposite to ``start``.
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
