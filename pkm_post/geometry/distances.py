# SPDX-License-Identifier: LGPL-2.1-or-later
"""Distances: distances between segments, boxes, cylinders and points, batch first.

Boxes are axis-aligned. Cylinders are solid, with flat ends, along z: points are transformed into the frame of the
cylinder first. Touching or overlapping bodies are at distance 0. Lengths in mm. All leading dimensions are broadcast.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from pkm_post.geometry.vectors import Array, dot, norm

_HALVINGS = 24
"""Bisections reduce a strut of a metre to 60 nm; the distance is more accurate than that."""


def segment_to_segment(start: Array, end: Array, other_start: Array, other_end: Array) -> Array:
    """Distances of segments between their ends, (..., 3) to (...); the closest points are clamped [Ericson2005].

    For almost parallel segments, within 1e-8 rad, any pair of facing points may be taken as the closest; the error is
    at most this angle times their length.
    """
    d, e, r = end - start, other_end - other_start, start - other_start
    dd, ee, de, dr, er = dot(d, d), dot(e, e), dot(d, e), dot(d, r), dot(e, r)
    s = _share(de * er - dr * ee, dd * ee - de * de)
    t = _share(de * s + er, ee)
    s = _share(de * t - dr, dd)
    return norm(r + s[..., None] * d - t[..., None] * e)


def point_to_segment(point: Array, start: Array, end: Array) -> Array:
    """Distances of points (..., 3) from segments between ``start`` and ``end`` (..., 3)."""
    e, r = end - start, point - start
    return norm(r - _share(dot(e, r), dot(e, e))[..., None] * e)


def _share(dividend: Array, divisor: Array) -> Array:
    """Quotients between 0 and 1."""
    return np.asarray(np.minimum(np.maximum(_quotient(dividend, divisor), 0.0), 1.0))


def point_to_cylinder(point: Array, radius: Array | float, low: Array | float, high: Array | float) -> Array:
    """Distances of points (..., 3) from cylinders about the z axis, from z = ``low`` to ``high``."""
    outward = np.hypot(point[..., 0], point[..., 1]) - radius
    along = np.maximum(low - point[..., 2], point[..., 2] - high)
    return np.hypot(np.maximum(outward, 0.0), np.maximum(along, 0.0))


def segment_to_box(start: Array, end: Array, lowest: Array, highest: Array) -> Array:
    """Distances of segments from boxes, (...), by their ends and by the lowest and highest corners, (..., 3) each."""

    def away(point: Array) -> Array:
        return point - np.clip(point, lowest, highest)

    return norm(away(_nearest(start, end, away)))


def segment_to_cylinder(
    start: Array, end: Array, radius: Array | float, low: Array | float, high: Array | float
) -> Array:
    """Distances of segments from cylinders about the z axis, (...); arguments as in ``nearest_to_cylinder``."""
    return norm(_from_cylinder(nearest_to_cylinder(start, end, radius, low, high), radius, low, high))


def nearest_to_cylinder(
    start: Array, end: Array, radius: Array | float, low: Array | float, high: Array | float
) -> Array:
    """The points of segments that are nearest to cylinders, (..., 3).

    The ends of the segments, (..., 3), are in the frame of the cylinder, whose axis is z, from ``low`` to ``high``.
    """
    return _nearest(start, end, lambda point: _from_cylinder(point, radius, low, high))


def _from_cylinder(point: Array, radius: Array | float, low: Array | float, high: Array | float) -> Array:
    """Vectors from the nearest point of each cylinder to points, (..., 3)."""
    out = np.hypot(point[..., 0], point[..., 1])
    share = np.maximum(_quotient(out - radius, out), 0.0)
    z = point[..., 2]
    return np.stack([share * point[..., 0], share * point[..., 1], z - np.clip(z, low, high)], axis=-1)


def _nearest(start: Array, end: Array, away: Callable[[Array], Array]) -> Array:
    """The point of each segment that is nearest to a convex body, (..., 3), by bisection.

    Half the squared distance is convex along the segment, and its slope is away . direction, where ``away`` is the
    vector from the nearest point of the body to a point.
    """
    way = end - start
    shape = np.broadcast_shapes(start.shape, end.shape, away(start).shape)[:-1]
    low, high, along = np.zeros(shape), np.ones(shape), np.broadcast_to(way, (*shape, 3))
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        rising = dot(away(start + middle[..., None] * way), along) > 0
        low, high = np.where(rising, low, middle), np.where(rising, middle, high)
    # Where the slope never changes sign, the nearest point is an end, and must be exact to the last digit.
    share = np.where(high == 1.0, 1.0, low)
    return start + share[..., None] * way


def _quotient(dividend: Array, divisor: Array) -> Array:
    """Quotients, 0 where the divisor is not above 0."""
    quotient = np.zeros(np.broadcast(dividend, divisor).shape)
    return np.divide(dividend, divisor, out=quotient, where=divisor > 0)
