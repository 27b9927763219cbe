# SPDX-License-Identifier: LGPL-2.1-or-later
"""Engagement: width of passes for a scallop height, and the gap that a moving cutter leaves.

Takes contact normals, tool axes, feed directions and the curvature of the surface across the feed; returns widths. All
in mm and 1/mm.
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry import dot, norm
from pkm_post.toolpath.compensation import Cutter
from pkm_post.toolpath.surface.surface import Array, unit_or_nan

_FLAT_ON_IT = 1e-9
"""Sine of the angle between axis and normal below which the bottom of the cutter lies on the surface."""


def effective_radius(normal: Array, axis: Array, feed: Array, cutter: Cutter) -> Array:
    """Radii of the profile that a moving cutter leaves, across its feed, at the contact point, (N,).

    The cutter swept along t leaves its silhouette along t. The curvature of a silhouette is the Gaussian curvature
    divided by the normal curvature along t. The corner has curvatures 1/r along its meridian and 1/(r + e / sin gamma)
    around the axis, so the radius is (r + e / sin gamma) cos^2 beta + r sin^2 beta.

    Args:
        normal: (N, 3) unit normals.
        axis: (N, 3) unit tool axes at angles gamma from them.
        feed: (N, 3) unit tangents t at angles beta from the meridian through the contact.
        cutter: corner radius r, at radius e from the axis.

    Returns:
        The radii; infinite where the flat bottom lies on the surface.

    Source: [Koenderink1984].
    """
    r, e = cutter.corner_radius, cutter.radial_offset
    if e == 0.0:
        return np.full(len(normal), r)
    across = axis - dot(axis, normal)[:, None] * normal
    sine = norm(across)
    meridian = np.nan_to_num(unit_or_nan(across))
    along_meridian = np.square(dot(meridian, feed))
    with np.errstate(divide="ignore"):
        wide = np.where(sine > _FLAT_ON_IT, e * along_meridian / np.maximum(sine, _FLAT_ON_IT), np.inf)
    return wide + r


def scallop_width(radius: Array, curvature: Array, height: float) -> Array:
    """Distances of neighbouring passes along the surface for a scallop height, (N,).

    On a circle of curvature c the profiles of radius R, half a pass to each side, meet at the height h where
    sin^2(c L / 4) = c^2 (2 R h - h^2) / (4 (1 + c R) (1 + c h)). On a plane L = 2 sqrt(2 R h - h^2).

    Args:
        radius: (N,) radius of the cutter profile, R; where h exceeds R, the pass is 2 R wide.
        curvature: (N,) curvature of the surface across the feed, c, positive where it is convex.
        height: scallop height, h.

    Returns:
        The distances L; NaN where the profile does not fit into a concave area, 1 + c R <= 0.
    """
    shallow = np.minimum(height, radius)
    square = np.maximum(2.0 * radius * shallow - np.square(shallow), 0.0)
    fit = (1.0 + curvature * radius) * (1.0 + curvature * shallow)
    fits = (1.0 + curvature * radius > 0.0) & (1.0 + curvature * shallow > 0.0)
    share = np.square(curvature) * square / (4.0 * np.where(fits, fit, np.nan))
    sine = np.sqrt(np.minimum(share, 1.0))
    turn = np.where(sine > 0.0, np.arcsin(sine) / np.where(sine > 0.0, sine, 1.0), 1.0)
    width: Array = 2.0 * np.sqrt(square / np.where(fits, fit, np.nan)) * turn
    return width


def pass_width(normal: Array, axis: Array, feed: Array, curvature: Array, cutter: Cutter, height: float) -> Array:
    """Distances of neighbouring passes for a scallop height with a tilted cutter, (N,).

    The profile of a tilted cutter is round near the contact and rises no steeper than its flat bottom. The larger of
    both widths applies, limited to the width of the bottom with the corner up to that height.

    Args:
        normal: (N, 3) unit normals.
        axis: (N, 3) unit tool axes.
        feed: (N, 3) unit tangents.
        curvature: (N,) curvature of the surface across the feed, positive where it is convex.
        cutter: the corner of the cutter.
        height: scallop height.

    Returns:
        The distances; NaN where the cutter does not fit into a concave area.
    """
    r, e = cutter.corner_radius, cutter.radial_offset
    low = min(height, r)
    widest = 2.0 * e + 2.0 * np.sqrt(2.0 * r * low - low * low)
    radius = np.minimum(effective_radius(normal, axis, feed, cutter), 1e6 * (r + e))
    width = np.minimum(scallop_width(radius, curvature, height), widest)
    if e == 0.0:
        return width
    sine = norm(axis - dot(axis, normal)[:, None] * normal)
    bottom = np.minimum(height * dot(axis, normal) / np.maximum(sine, _FLAT_ON_IT), 2.0 * e)
    wider: Array = np.where((curvature >= 0.0) & (bottom > width), bottom, width)
    return wider


def gap(tip: Array, axis: Array, point: Array, normal: Array, cutter: Cutter) -> Array:
    """Distances from the tangent planes of the surface to the lowest point of the cutter above them, (N,).

    Negative where the cutter goes below the plane and gouges the surface.

    Args:
        tip: (N, 3) tool tips.
        axis: (N, 3) unit tool axes.
        point: (N, 3) points of the surface.
        normal: (N, 3) unit normals.
        cutter: the corner of the cutter.
    """
    centre = tip + cutter.axial_offset * axis
    reach = norm(normal - dot(normal, axis)[:, None] * axis)
    distance: Array = dot(centre - point, normal) - cutter.radial_offset * reach - cutter.corner_radius
    return distance
