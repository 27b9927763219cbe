# SPDX-License-Identifier: LGPL-2.1-or-later
"""Swallowed: elements of a contour that the tool is too large for, any number in a row.

Takes elements; returns the offsets of the remaining ones, joined. An element is swallowed when its joints shorten it by
more than its length, or when the tool does not fit into its arc. It is removed and its neighbours are joined, until no
swallowed element is left. Of several swallowed neighbours, the one that a growing tool would swallow first is removed
first: this often saves the others. mm.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array, cross, dot
from pkm_post.toolpath.compensation.contour import Elements, Role
from pkm_post.toolpath.compensation.joints import MOST_BETWEEN, Joint, joints
from pkm_post.toolpath.compensation.meetings import SAME
from pkm_post.toolpath.compensation.options import OffsetOptions

_UNMET = 1e30
"""mm: missing length of elements that do not meet their neighbours; more than any joint takes."""


@dataclass(frozen=True)
class Offsets:
    """The offsets of M elements.

    Attributes:
        kept: (M,) whether the element remains.
        kind: (M,) ``Joint`` before the element.
        start: (M, 3) start of its offset, from its programmed start.
        end: (M, 3) end of its offset, from its programmed end.
        between: (M, 4, 3) points added before it, from its programmed start; NaN where unused.
        length: (M,) remaining length, mm; 0 for leads.
    """

    kept: Array
    kind: Array
    start: Array
    end: Array
    between: Array
    length: Array


def offsets_of(elements: Elements, options: OffsetOptions) -> Offsets:
    """Offsets of the elements, without those that are swallowed."""
    count = len(elements)
    beside = elements.offset[:, None] * cross(elements.normal[:, 1], elements.tangent[:, 1])
    offsets = Offsets(
        kept=np.ones(count, dtype=np.bool_),
        kind=np.full(count, Joint.LEAD),
        start=np.zeros((count, 3)),
        end=beside.copy(),
        between=np.full((count, MOST_BETWEEN, 3), np.nan),
        length=np.zeros(count),
    )
    # Linked list of the remaining elements; number ``count`` follows the last one.
    before, after = np.arange(count + 1) - 1, np.arange(count) + 1
    rounded = np.full(count + 1, options.corners == "arc")
    second = np.flatnonzero(elements.role != Role.START)
    while len(second):
        joined = second[second < count]
        _join(elements, offsets, before[joined], joined, options, rounded[joined])
        # A program may end without a cancel row.
        offsets.end[before[count]] = beside[before[count]]
        _measure(elements, offsets, np.concatenate([before[second], joined]))
        swallowed = np.flatnonzero(offsets.kept & ~(offsets.length >= -SAME))
        second = _sharpened(offsets, after, swallowed, options)
        rounded[second] = False
        if not len(second):
            goes = _first_to_go(elements, offsets, before, after, swallowed)
            offsets.kept[goes] = False
            after[before[goes]], before[after[goes]] = after[goes], before[goes]
            second = after[goes]
    return offsets


def _sharpened(offsets: Offsets, after: Array, swallowed: Array, options: OffsetOptions) -> Array:
    """Rounded joints of swallowed elements that become sharp: extended to its corner, an element may survive."""
    if options.swallowed == "refuse":
        return swallowed[:0]
    beside = np.union1d(swallowed, after[swallowed])
    beside = beside[beside < len(offsets.kind)]
    return beside[offsets.kind[beside] == Joint.ARC]


def _join(
    elements: Elements, offsets: Offsets, first: Array, second: Array, options: OffsetOptions, rounded: Array
) -> None:
    """Write the joints of pairs of elements into the offsets."""
    joined = joints(elements, first, second, options, rounded)
    offsets.kind[second], offsets.between[second] = joined.kind, joined.between
    offsets.end[first], offsets.start[second] = joined.first, joined.last


def _measure(elements: Elements, offsets: Offsets, rows: Array) -> None:
    """Write the remaining lengths of elements into the offsets."""
    rows = rows[elements.role[rows] == Role.CUT]
    offsets.length[rows] = _lengths(elements, offsets, rows)


def _lengths(elements: Elements, offsets: Offsets, rows: Array) -> Array:
    """Remaining length of elements, mm, (n,): negative where they are reversed; NaN where a joint does not meet."""
    start, end = offsets.start[rows], offsets.end[rows]
    straight = dot(elements.end[rows] + end - elements.start[rows] - start, elements.tangent[rows, 1])
    spoke, normal, turn = elements.spoke[rows], elements.normal[rows], elements.turn[rows]
    lost = _angle(spoke[:, 0], spoke[:, 0] + start, normal[:, 0]) - _angle(spoke[:, 1], spoke[:, 1] + end, normal[:, 1])
    sweep = elements.sweep[rows] - turn * lost
    radius = np.min(elements.radius_left[rows], axis=1)
    curved = np.where(sweep > 2 * np.pi + SAME, np.nan, sweep * np.maximum(radius, 0.0))
    curved = np.where(radius < -SAME, -np.inf, curved)
    return np.where(turn != 0, curved, straight)


def _angle(before: Array, after: Array, normal: Array) -> Array:
    """Angles from one spoke to another, to the left, (n,)."""
    return np.arctan2(dot(normal, cross(before, after)), dot(before, after))


def _first_to_go(elements: Elements, offsets: Offsets, before: Array, after: Array, swallowed: Array) -> Array:
    """Swallowed elements that shrink to nothing before their neighbours do."""
    if not len(swallowed):
        return swallowed
    share = np.full(len(elements) + 1, np.inf)
    cut = np.flatnonzero(elements.role == Role.CUT)
    share[cut] = offsets.length[cut] / elements.length[cut]
    # A joint that does not meet outranks a negative length, for the shorter element of both; a too tight arc outranks
    # both.
    unmet = cut[np.isnan(share[cut])]
    share[unmet] = -_UNMET / elements.length[unmet]
    share = share[np.stack([before[swallowed], swallowed, after[swallowed]])]
    return swallowed[(share[1] < share[0]) & (share[1] <= share[2])]
