# SPDX-License-Identifier: LGPL-2.1-or-later
"""Corners: geometry where one element of a contour ends and the next begins, before the joint is chosen.

Takes pairs of elements; returns directions, the turn between them and the radius vectors. A radius vector is r = d n x
t, with n the normal of the plane, t the direction of travel and d the signed offset [paper eq. 10, 11]. mm.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array, across, cross, dot
from pkm_post.toolpath.compensation.contour import Elements


@dataclass(frozen=True)
class Corners:
    """Geometry at J joints.

    Attributes:
        normal: (J, 3) normal of the plane.
        tangent_first: (J, 3) direction of the first element at its end.
        tangent_second: (J, 3) direction of the second at its start.
        sine: (J,) sine of the turn from first to second, positive to the left.
        cosine: (J,) cosine of that turn.
        gap: (J, 3) from the end of the first to the start of the second in the plane; zero unless elements were
            removed.
        beside_first: (J, 3) radius vector of the first element.
        beside_second: (J, 3) radius vector of the second.
        stepped: (J, 3) radius vector of the first element with the offset of the second.
        resized: (J,) whether the offset changes in size.
    """

    normal: Array
    tangent_first: Array
    tangent_second: Array
    sine: Array
    cosine: Array
    gap: Array
    beside_first: Array
    beside_second: Array
    stepped: Array
    resized: Array

    def rows(self, chosen: Array) -> Corners:
        """The chosen rows."""
        return Corners(**{name: column[chosen] for name, column in vars(self).items()})


def corners_of(elements: Elements, first: Array, second: Array) -> Corners:
    """The corners between pairs of elements.

    Args:
        elements: the elements of all contours.
        first: (J,) the elements that end there.
        second: (J,) those that begin there.
    """
    normal = elements.normal[first, 1]
    tangents = elements.tangent[first, 1], elements.tangent[second, 0]
    left_first, left_second = (cross(normal, tangent) for tangent in tangents)
    before, after = elements.offset[first][:, None], elements.offset[second][:, None]
    gap = across(elements.start[second] - elements.end[first], normal)
    return Corners(
        normal=normal,
        tangent_first=tangents[0],
        tangent_second=tangents[1],
        sine=dot(normal, cross(*tangents)),
        cosine=dot(*tangents),
        gap=np.where((second == first + 1)[:, None], 0.0, gap),
        beside_first=before * left_first,
        beside_second=after * left_second,
        stepped=after * left_first,
        resized=np.abs(before - after)[:, 0] > 0,
    )
