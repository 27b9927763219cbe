# SPDX-License-Identifier: LGPL-2.1-or-later
"""Blends: how far before and after a joint of two segments the path leaves them to round the corner.

A joint whose direction changes by D (unit tangents by path length) is rounded over the half width d on both sides
with the cubic step W(v) = 3 v^2 - 2 v^3, v = (x + d) / 2d: the rounded path starts and ends with the curvature of its
segments, and its deviation at the joint is |D| times the integral of W up to the joint, 3/16 d |D|. Where extended arcs
diverge beyond that change of direction, the path follows them with the quintic step S(v) = 10 v^3 - 15 v^4 + 6 v^5,
whose second derivative is also zero at both ends. The tool axis is rounded in step with the tip, in the tangent plane
of the sphere at the joint. Enters: changes at the joints, lengths, tolerances. Leaves: half widths.
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry import Array

OFFSET = 3 / 16
"""Deviation at the joint per half width and change of direction."""
_BOW = 0.0134
"""Deviation per half width squared and change of curvature: the maximum of (2v - 1)^2 S(v) / 2 before the joint."""
_NEGLIGIBLE = 1e-12
"""Changes below this impose no limit; keeps the quotients finite."""
_BEND = 0.5
"""rad: the most that an arc is extended; beyond it, the two segments of a joint no longer approximate each other."""
_SHARE = 0.45
"""Share of the shorter neighbour that a blend may use; two blends on one segment never meet."""


def half_widths(
    tip_change: Array,
    curvature_change: Array,
    curvature: Array,
    axis_change: Array,
    neighbour: Array,
    tip: Array | float,
    axis: float,
) -> Array:
    """Half widths of the blends that stay within the tolerances, (N,) in path length.

    Args:
        tip_change: (N,) magnitude of the change of the tip's tangent at each joint.
        curvature_change: (N,) magnitude of the change of the tip's curvature vector, 1/mm.
        curvature: (N,) the higher curvature of the two segments, 1/mm.
        axis_change: (N,) magnitude of the change of the tool axis' rate, rad by path length.
        neighbour: (N,) length of the shorter of the two segments; 0 where the motion stops.
        tip: tolerance of the tip, mm; a number, or (N,).
        axis: tolerance of the tool axis, rad.
    """
    # Solves corner * d + bow * d^2 = tolerance; this form of the root is also exact for bow = 0.
    corner, bow = OFFSET * np.maximum(tip_change, _NEGLIGIBLE), _BOW * curvature_change
    by_tip = 2 * tip / (corner + np.sqrt(corner**2 + 4 * bow * tip))
    by_axis = axis / (OFFSET * np.maximum(axis_change, _NEGLIGIBLE))
    by_bend = _BEND / np.maximum(curvature, _NEGLIGIBLE)
    return np.minimum.reduce([by_tip, by_axis, by_bend, _SHARE * neighbour])


def step(x: Array, half_width: Array) -> tuple[Array, Array, Array]:
    """The integral of W, W itself and W' at distances x from the joint, -d <= x <= d, (N,) each."""
    width = 2 * half_width
    v = (x + half_width) / width
    return (
        width * v**3 * (1 - v / 2),
        v**2 * (3 - 2 * v),
        6 * v * (1 - v) / width,
    )


def smooth_step(x: Array, half_width: Array) -> tuple[Array, Array, Array]:
    """S, S' and S'' at distances x from the joint, -d <= x <= d, (N,) each."""
    width = 2 * half_width
    v = (x + half_width) / width
    return (
        v**3 * (10 - v * (15 - 6 * v)),
        30 * (v * (1 - v)) ** 2 / width,
        60 * v * (1 - v) * (1 - 2 * v) / width**2,
    )
