# SPDX-License-Identifier: LGPL-2.1-or-later
"""Meetings: intersections of two offset lines or arcs.

Takes two offset curves, as rows of lines or circles in one plane, measured from the programmed end of the first;
returns points, (J, 3), NaN where the two do not intersect. Of two intersections the one nearest to the programmed joint
is returned, which is the first on the second curve and the last on the first. mm.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array, cross, dot

SAME = 1e-6
"""mm within which two offset lines coincide."""

NO_TURN = 1e-5
"""Sine of the turn at a joint below which the path continues straight on, or straight back."""


@dataclass(frozen=True)
class Curves:
    """Offset curves at a joint, J rows.

    Attributes:
        point: (J, 3) the end of the radius vector, on the curve.
        tangent: (J, 3) unit direction of travel there.
        centre: (J, 3) centre of the circle; NaN for lines.
        radius: (J,) radius of the circle, NaN for lines.
        arc: (J,) whether it is a circle.
    """

    point: Array
    tangent: Array
    centre: Array
    radius: Array
    arc: Array


def meetings(first: Curves, second: Curves, normal: Array) -> Array:
    """Intersections of the curves of each row, (J, 3).

    Args:
        first: the curves that end at the joint.
        second: those that begin there.
        normal: (J, 3) normal of the plane.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        lines = _line_line(first, second, normal)
        on_first = first.point + _along(first, second)[:, None] * first.tangent
        on_second = second.point + _along(second, first)[:, None] * second.tangent
        circles = _circle_circle(first, second, normal)
    points = np.where(second.arc[:, None], on_first, lines)
    return np.where(first.arc[:, None], np.where(second.arc[:, None], circles, on_second), points)


def _line_line(first: Curves, second: Curves, normal: Array) -> Array:
    """Intersections of lines, (J, 3): p1 + x t1 = p2 + y t2, times n x t2, gives x."""
    across_second = cross(normal, second.tangent)
    apart = dot(second.point - first.point, across_second)
    slope = dot(first.tangent, across_second)
    one_line = (np.abs(slope) < NO_TURN) & (np.abs(apart) < SAME) & (dot(first.tangent, second.tangent) > 0)
    way = np.where(np.abs(slope) < NO_TURN, np.where(one_line, 0.0, np.nan), apart / slope)
    return first.point + way[:, None] * first.tangent


def _along(line: Curves, circle: Curves) -> Array:
    """Distance along lines from their point to circles, (J,): the shorter of both."""
    spoke = line.point - circle.centre
    half = dot(spoke, line.tangent)
    excess = dot(spoke, spoke) - circle.radius**2
    # This form avoids cancellation in the shorter distance.
    farther = -half - np.where(half < 0, -1.0, 1.0) * np.sqrt(half**2 - excess)
    return np.where(farther == 0, 0.0, excess / farther)


def _circle_circle(first: Curves, second: Curves, normal: Array) -> Array:
    """Intersections of two circles lie on their radical line, across the line of centres."""
    between = second.centre - first.centre
    distance = np.sqrt(dot(between, between))
    towards = between / distance[:, None]
    along = (distance**2 + (first.radius - second.radius) * (first.radius + second.radius)) / (2 * distance)
    aside = np.sqrt((first.radius - along) * (first.radius + along))[:, None] * cross(normal, towards)
    foot = first.centre + along[:, None] * towards
    nearer = np.where(dot(foot, aside) > 0, -1.0, 1.0)
    return foot + nearer[:, None] * aside
