# SPDX-License-Identifier: LGPL-2.1-or-later
"""Subpath: the part of a trajectory between two places within its segments, as programmed.

A line becomes a shorter line, an arc an arc of the same circle or helix, the tool axis stays on its great circle. So
what is played between two places can be compared with what was programmed there.

Enters: a trajectory, rows, and shares of them from 0 to 1. Leaves: a trajectory.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from pkm_post.control.player.sections import rows_of
from pkm_post.geometry import Array
from pkm_post.model import Trajectory
from pkm_post.toolpath import Segments


@dataclass(frozen=True)
class PathPoint:
    """A place on a trajectory.

    Attributes:
        row: of the segment.
        share: of the segment, from 0 at its start to 1 at its end.
    """

    row: int
    share: float


def subpath(trajectory: Trajectory, start: PathPoint, end: PathPoint) -> Trajectory:
    """The part between two places.

    Args:
        trajectory: one without events.
        start: where it begins.
        end: a place behind it.
    """
    rows = rows_of(trajectory, start.row, end.row + 1)
    share = np.ones(len(rows))
    share[-1] = end.share
    share[0] -= start.share
    tip, axis, spin = _poses(rows, np.array([0, len(rows) - 1]), np.array([start.share, end.share]))
    tips, axes, spins = np.array(rows.tip), np.array(rows.axis), np.array(rows.spin)
    tips[-1], axes[-1], spins[-1] = tip[1], axis[1], spin[1]
    return replace(
        rows,
        tip=tips,
        axis=axes,
        spin=spins,
        sweep=rows.sweep * share,
        length=rows.length * share,
        angle=rows.angle * share,
        start_tip=tip[0],
        start_axis=axis[0],
        start_spin=float(spin[0]),
    )


def _poses(rows: Trajectory, segment: Array, share: Array) -> tuple[Array, Array, Array]:
    """Tips (K, 3), axes (K, 3) and spins (K,) at shares of segments, as programmed."""
    segments = Segments.of(rows)
    u = share * segments.extent[segment]
    tip, axis, spin = (at(segment, u)[0] for at in (segments.tip_at, segments.axis_at, segments.spin_at))
    return tip, axis, spin
