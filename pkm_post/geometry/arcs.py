# SPDX-License-Identifier: LGPL-2.1-or-later
"""Circular arcs and helices: sweep and points. Every arc turns right-handed about its unit axis."""

from __future__ import annotations

import numpy as np

from pkm_post.geometry.vectors import Array, cross, dot, norm

_SAME_DIRECTION = 1e-9
"""Angle in rad below which start and end count as the same point of the circle: a full circle."""


def arc_sweep(start: Array, end: Array, centre: Array, axis: Array) -> Array:
    """Sweep angles of arcs from start to end, 0 < sweep <= 2 pi; a full circle where both have the same direction.

    Args:
        start: (..., 3) start points.
        end: (..., 3) end points; for a helix shifted along the axis.
        centre: (..., 3) points on the axis.
        axis: (..., 3) unit axes.
    """
    first = across(start - centre, axis)
    last = across(end - centre, axis)
    sweep = np.arctan2(dot(cross(first, last), axis), dot(first, last))
    return np.where(sweep <= _SAME_DIRECTION, sweep + 2 * np.pi, sweep)


def arc_points(start: Array, centre: Array, axis: Array, angle: Array, rise: Array) -> Array:
    """Points of an arc that has turned by ``angle`` and risen by ``rise`` along the axis since ``start``.

    Args:
        start: (..., 3) start points.
        centre: (..., 3) points on the axis.
        axis: (..., 3) unit axes.
        angle: (...) rad.
        rise: (...) mm.
    """
    radius = across(start - centre, axis)
    turned = np.cos(angle)[..., None] * radius + np.sin(angle)[..., None] * cross(axis, radius)
    return start - radius + turned + rise[..., None] * axis


def across(vectors: Array, axis: Array) -> Array:
    """The components of (..., 3) vectors across the unit axes."""
    return vectors - dot(vectors, axis)[..., None] * axis


def arc_length(start: Array, end: Array, centre: Array, axis: Array) -> Array:
    """Lengths of arcs and helices, mm, with the mean of start and end radius."""
    radius = (norm(across(start - centre, axis)) + norm(across(end - centre, axis))) / 2
    return np.hypot(radius * arc_sweep(start, end, centre, axis), dot(end - start, axis))
