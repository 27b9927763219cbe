# SPDX-License-Identifier: LGPL-2.1-or-later
"""Coverage: whether copies of a program lie all round an axis, and where two lie on each other.

Programs enter, with an axis or a plane; angles in rad and distances in mm leave. Only what is cut counts. The sector of
a program is the smallest one that holds its cut; a program that is cut in two places apart counts as one that is cut
between them as well.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from pkm_post.geometry import norm, unit
from pkm_post.geometry.vectors import Array, cross, dot
from pkm_post.model import Program
from pkm_post.placement.passes import chords

ROUND = 2 * np.pi
_ON_AXIS = 1e-6
"""mm: a point this near to the axis has no angle."""
_ON_PLANE = 1e-5
"""mm: less than this between a cut and its mirror image is nothing; points of saved documents have six decimals."""
MEET = 1e-4
"""rad: sectors nearer than this meet; points of saved documents have six decimals."""


@dataclass(frozen=True)
class Sector:
    """Where a program cuts about an axis, in rad.

    Attributes:
        start: angle at which it begins, 0 to 2 pi, from a direction that belongs to the axis.
        width: how far it goes on, right-handed about the axis; 0 to 2 pi.
        spacing: its widest angle without a cut, such as that from pass to pass.
    """

    start: float
    width: float
    spacing: float


@dataclass(frozen=True)
class Coverage:
    """What sectors make together, in rad.

    Attributes:
        covered: angle in which one or more of them lie.
        overlap: angle in which two or more of them lie.
        gap: widest angle in which none lies.
        spacing: widest angle without a cut within one of them.
    """

    covered: float
    overlap: float
    gap: float
    spacing: float

    @property
    def tiles(self) -> bool:
        """Whether they lie all round, with no wider gap than within each of them, and none on another."""
        return self.gap <= self.spacing + MEET and self.overlap <= MEET


def sector(program: Program, point: ArrayLike, axis: ArrayLike) -> Sector | None:
    """The sector in which a program cuts; None where it cuts nothing, or on the axis alone.

    Args:
        program: cutter locations in {C}.
        point: (3,) a point of the axis, mm.
        axis: (3,) direction of the axis.

    Raises:
        ValueError: the axis has no direction.
    """
    begin, width = _spans(program, np.asarray(point, dtype=np.float64), unit(np.asarray(axis, dtype=np.float64)))
    if not len(begin):
        return None
    # Three times round, so that the holes of the middle turn are those of the circle.
    start = np.concatenate([begin - ROUND, begin, begin + ROUND])
    order = np.argsort(start)
    end = np.maximum.accumulate((start + np.tile(width, 3))[order])
    hole = np.maximum(start[order][1:] - end[:-1], 0.0)
    inside = (end[:-1] >= 0) & (end[:-1] < ROUND)
    holes, ends = hole[inside], end[:-1][inside]
    if not np.any(holes > 0):
        return Sector(0.0, ROUND, 0.0)
    largest = int(np.argmax(holes))
    rest = np.delete(holes, largest)
    return Sector(
        start=float((ends[largest] + holes[largest]) % ROUND),
        width=float(ROUND - holes[largest]),
        spacing=float(rest.max(initial=0.0)),
    )


def _spans(program: Program, point: Array, axis: Array) -> tuple[Array, Array]:
    """Where each straight piece of the cut begins, 0 to 2 pi, and by how much it goes on, (n,) each."""
    first = unit(cross(axis, np.eye(3)[np.argmin(np.abs(axis))]))
    second = cross(axis, first)
    ends = [each - point for each in chords(program)]
    radius = [norm(each - dot(each, axis)[:, None] * axis) for each in ends]
    angle = [np.arctan2(each @ second, each @ first) for each in ends]
    on_axis = [each < _ON_AXIS for each in radius]
    one, other = (np.where(on_axis[side], angle[1 - side], angle[side]) for side in (0, 1))
    turn = (other - one + np.pi) % ROUND - np.pi
    # A line straight through the axis is at two angles, and at none between.
    through = np.pi - np.abs(turn) < MEET
    known = ~(on_axis[0] & on_axis[1])
    begin = np.concatenate([np.where(through | (turn > 0), one, one + turn)[known], other[known & through]])
    width = np.concatenate([np.where(through, 0.0, np.abs(turn))[known], np.zeros(int((known & through).sum()))])
    return begin % ROUND, width


def coverage(sectors: Sequence[Sector]) -> Coverage:
    """What sectors about one axis make together.

    Raises:
        ValueError: there is none.
    """
    if not sectors:
        raise ValueError("coverage: expected one sector or more, got none")
    start = np.array([each.start for each in sectors])
    width = np.array([each.width for each in sectors])
    bounds = np.unique(np.concatenate([start % ROUND, (start + width) % ROUND]))
    length = np.diff(np.append(bounds, bounds[0] + ROUND))
    middle = bounds + length / 2
    times = np.sum((middle[:, None] - start) % ROUND < width, axis=1)
    covered, overlap = float(length[times >= 1].sum()), float(length[times >= 2].sum())
    return Coverage(covered, overlap, _longest(length, times == 0), max(each.spacing for each in sectors))


def _longest(length: Array, empty: Array) -> float:
    """The longest run of empty pieces round the circle."""
    if np.all(empty):
        return float(ROUND)
    turned = -int(np.argmin(empty))
    length, empty = np.roll(length, turned), np.roll(empty, turned)
    total = np.cumsum(np.where(empty, length, 0.0))
    longest: float = np.max(total - np.maximum.accumulate(np.where(empty, 0.0, total)))
    return float(longest)


def beside_plane(program: Program, point: ArrayLike, normal: ArrayLike) -> tuple[float, float]:
    """Distance in mm between a cut and its mirror image, and the depth to which they lie on each other; one is zero.

    Args:
        program: cutter locations in {C}; without a cut both are zero.
        point: (3,) a point of the plane of the mirror, mm.
        normal: (3,) its normal.

    Raises:
        ValueError: the normal has no direction.
    """
    starts, ends = chords(program)
    away = (np.concatenate([starts, ends]) - np.asarray(point, dtype=np.float64)) @ unit(np.asarray(normal, float))
    if not len(away):
        return 0.0, 0.0
    least, most = float(away.min()), float(away.max())
    apart, both = 2 * max(least, -most), 2 * min(most, -least)
    return apart if apart > _ON_PLANE else 0.0, both if both > _ON_PLANE else 0.0
