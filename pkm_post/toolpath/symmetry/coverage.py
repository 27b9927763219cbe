# SPDX-License-Identifier: LGPL-2.1-or-later
"""Coverage: whether copies of a program surround an axis, where two overlap, and how well they meet at seams.

Takes programs, with an axis or a plane; returns angles in rad and distances in mm. Only cuts count. The sector of a
program is the smallest one that contains its cuts; the space between two separate cuts counts as cut as well.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from pkm_post.geometry import Array, across, cross, norm, unit
from pkm_post.model import Program
from pkm_post.toolpath.symmetry.passes import cut_chords, pass_rows

ROUND = 2 * np.pi
_ON_AXIS = 1e-6
"""mm: a point this close to the axis has no angle."""
_ON_PLANE = 1e-5
"""mm: smaller distances between a cut and its mirror image count as zero; points of saved documents have six
decimals."""
MEET = 1e-4
"""rad: sectors closer than this meet; points of saved documents have six decimals."""


@dataclass(frozen=True)
class Sector:
    """Sector about an axis in which a program cuts, in rad.

    Attributes:
        start: angle at which it begins, 0 to 2 pi, from a fixed direction of the axis.
        width: its extent, right-handed about the axis; 0 to 2 pi.
        spacing: its widest angle without a cut, such as that from pass to pass.
    """

    start: float
    width: float
    spacing: float


@dataclass(frozen=True)
class AngularCoverage:
    """Union of sectors, in rad.

    Attributes:
        covered: angle covered by at least one of them.
        overlap: angle covered by at least two of them.
        gap: widest angle covered by none.
        spacing: widest angle without a cut within one of them.
    """

    covered: float
    overlap: float
    gap: float
    spacing: float

    @property
    def tiles(self) -> bool:
        """Whether they surround the axis, without overlap and with no gap wider than those within them."""
        return self.gap <= self.spacing + MEET and self.overlap <= MEET


@dataclass(frozen=True)
class Seam:
    """Where two copies meet: distance of the tips in mm and angle of the tool axes in rad, the worst of all passes."""

    distance: float
    turn: float


def sector(program: Program, point: ArrayLike, axis: ArrayLike) -> Sector | None:
    """The sector in which a program cuts; None where it cuts nothing, or only on the axis.

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
    # Three turns: the gaps of the middle turn are those of the circle.
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
    """Start, 0 to 2 pi, and extent of each straight piece of the cut, (n,) each."""
    first = unit(cross(axis, np.eye(3)[np.argmin(np.abs(axis))]))
    second = cross(axis, first)
    ends = [each - point for each in cut_chords(program)]
    radius = [norm(across(each, axis)) for each in ends]
    angle = [np.arctan2(each @ second, each @ first) for each in ends]
    on_axis = [each < _ON_AXIS for each in radius]
    one, other = (np.where(on_axis[side], angle[1 - side], angle[side]) for side in (0, 1))
    turn = (other - one + np.pi) % ROUND - np.pi
    # A line through the axis has two angles and none between.
    through = np.pi - np.abs(turn) < MEET
    known = ~(on_axis[0] & on_axis[1])
    begin = np.concatenate([np.where(through | (turn > 0), one, one + turn)[known], other[known & through]])
    width = np.concatenate([np.where(through, 0.0, np.abs(turn))[known], np.zeros(int((known & through).sum()))])
    return begin % ROUND, width


def coverage(sectors: Sequence[Sector]) -> AngularCoverage:
    """The union of sectors about one axis.

    Raises:
        ValueError: there are no sectors.
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
    return AngularCoverage(covered, overlap, _longest(length, times == 0), max(each.spacing for each in sectors))


def _longest(length: Array, empty: Array) -> float:
    """The longest run of empty pieces around the circle."""
    if np.all(empty):
        return float(ROUND)
    turned = -int(np.argmin(empty))
    length, empty = np.roll(length, turned), np.roll(empty, turned)
    total = np.cumsum(np.where(empty, length, 0.0))
    longest: float = np.max(total - np.maximum.accumulate(np.where(empty, 0.0, total)))
    return float(longest)


def mirror_gap(program: Program, point: ArrayLike, normal: ArrayLike) -> tuple[float, float]:
    """Distance in mm between a cut and its mirror image, and the depth of their overlap; one is zero.

    Args:
        program: cutter locations in {C}; without a cut both are zero.
        point: (3,) a point of the mirror plane, mm.
        normal: (3,) its normal.

    Raises:
        ValueError: the normal has no direction.
    """
    starts, ends = cut_chords(program)
    away = (np.concatenate([starts, ends]) - np.asarray(point, dtype=np.float64)) @ unit(np.asarray(normal, float))
    if not len(away):
        return 0.0, 0.0
    least, most = float(away.min()), float(away.max())
    apart, both = 2 * max(least, -most), 2 * min(most, -least)
    return apart if apart > _ON_PLANE else 0.0, both if both > _ON_PLANE else 0.0


def seams(programs: Sequence[Program], sectors: Sequence[Sector]) -> tuple[Seam, ...]:
    """Mismatch of the copies that begin where another one ends.

    Args:
        programs: copies of one program.
        sectors: their sectors. Copies farther apart than the passes within them do not meet.

    Raises:
        ValueError: the programs have different numbers of passes.
    """
    start, width, spacing = (
        np.array([getattr(each, name) for each in sectors]) for name in ("start", "width", "spacing")
    )
    hole = (start - (start + width)[:, None] + np.pi) % ROUND - np.pi
    meet = np.abs(hole) <= np.maximum(spacing, spacing[:, None]) + MEET
    np.fill_diagonal(meet, False)
    return tuple(seam(programs[one], programs[other]) for one, other in np.argwhere(meet).tolist())


def seam(one: Program, other: Program) -> Seam:
    """Mismatch of the passes of one copy and the same passes of another one at their nearest ends.

    Raises:
        ValueError: they have different numbers of passes, or none.
    """
    runs = [pass_rows(program) for program in (one, other)]
    if len(runs[0]) != len(runs[1]) or not len(runs[0]):
        raise ValueError(f"seam: expected copies of one program, got {len(runs[0])} and {len(runs[1])} passes")
    rows = [run - 1 for run in runs]
    tips = [program.position[row] for program, row in zip((one, other), rows, strict=True)]
    axes = [program.tool_axis[row] for program, row in zip((one, other), rows, strict=True)]
    between = norm(tips[0][:, :, None] - tips[1][:, None, :]).reshape(-1, 4)
    chord = norm(axes[0][:, :, None] - axes[1][:, None, :]).reshape(-1, 4)
    # Of equally near ends, those with the smallest axis angle count: a closed pass has both ends in one place.
    nearest = np.argmin(np.round(between, 6) + chord * 1e-9, axis=1)[:, None]
    turn = 2 * np.arcsin(np.clip(np.take_along_axis(chord, nearest, axis=1) / 2, 0.0, 1.0))
    return Seam(float(np.take_along_axis(between, nearest, axis=1).max()), float(turn.max()))
