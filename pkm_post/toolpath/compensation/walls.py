# SPDX-License-Identifier: LGPL-2.1-or-later
"""Walls: the elements of contours that bound the workpiece.

Takes elements; returns those the tool has to keep clear of. These are the cutting rows or, of a path that closes, those
of the closed part: elements before and after it, such as lead-in arcs, lie on the side of the tool, which passes over
them. mm.
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry import Array, across, norm
from pkm_post.toolpath.compensation.contour import Elements, Role
from pkm_post.toolpath.compensation.nearness import Segments, too_near

_ON = 2e-3
"""mm within which a point lies on an element: programs have three decimals."""

_MOST_BEFORE = 200
"""Most elements that lead onto the closed part."""


def cutting(elements: Elements) -> Array:
    """Numbers of the elements that may bound the workpiece, (W,)."""
    return np.flatnonzero((elements.role == Role.CUT) & ~elements.rapid)


def walls_of(elements: Elements, segments: Segments, owner: Array, contours: Array) -> Array:
    """Flags of the elements of some contours that bound the workpiece, (M,).

    A closed part begins at a point to which the path later returns, in a corner or along an element. Of the closed
    parts longer than half of the path the shortest counts: the path may start where it ends.

    Args:
        elements: the elements of all contours.
        segments: the cutting ones as straight segments in the planes of their contours.
        owner: (S,) the element of each segment.
        contours: numbers of the requested contours.
    """
    cut = cutting(elements)
    way = np.append(0.0, np.cumsum(elements.length[cut]))
    begin, end = (np.searchsorted(elements.contour[cut], elements.contour[cut], side) for side in ("left", "right"))
    half = (way[end] - way[begin]) / 2
    index = np.arange(len(cut))
    early = (way[:-1] - way[begin] < half) & (index - begin < _MOST_BEFORE)
    asked = np.flatnonzero(early & np.isin(elements.contour[cut], contours))
    first, back = _come_back(elements, segments, owner, cut[asked])
    first, back = np.searchsorted(cut, first), np.searchsorted(cut, back)
    length = way[back + 1] - way[first]
    closes = np.flatnonzero((back >= first) & (length > half[first]))
    closes = closes[np.lexsort((length[closes], elements.contour[cut[first[closes]]]))]
    _, shortest = np.unique(elements.contour[cut[first[closes]]], return_index=True)
    walls = np.zeros(len(elements), dtype=np.bool_)
    walls[cut] = True
    for number in closes[shortest].tolist():
        walls[cut[begin[first[number]] : first[number]]] = False
        walls[cut[back[number] + 1 : end[first[number]]]] = False
    return walls


def _come_back(elements: Elements, segments: Segments, owner: Array, first: Array) -> tuple[Array, Array]:
    """Pairs of elements, (P,) each: the second passes over the start point of the first, seen in the plane."""
    begins = segments.rows(np.searchsorted(owner, first))
    count = len(first)
    points = Segments(
        start=begins.start,
        end=begins.start,
        low=np.full(count, -np.inf),
        high=np.full(count, np.inf),
        clearance=np.full(count, 2 * _ON),
        first=begins.first,
        last=begins.last,
        within=np.zeros(count),
    )
    point, segment, _ = too_near(points, segments, _ON)
    first, second = first[point], owner[segment]
    normal = elements.normal[second, 0]
    from_start, from_end = (
        norm(across(elements.start[first] - ends[second], normal)) for ends in (elements.start, elements.end)
    )
    # An element that begins there does not return there, unless it is a full circle.
    comes = (from_end < _ON) | (from_start >= _ON)
    return first[comes], second[comes]
