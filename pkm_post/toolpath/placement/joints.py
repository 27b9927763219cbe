# SPDX-License-Identifier: LGPL-2.1-or-later
"""Joints: mismatch of copies of a program where one ends and the next begins.

Takes programs with their sectors about an axis; returns distances of tips in mm and angles of tool axes in rad.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import norm
from pkm_post.model import Program
from pkm_post.toolpath.placement.coverage import MEET, ROUND, Sector
from pkm_post.toolpath.placement.passes import passes


@dataclass(frozen=True)
class Joint:
    """Where two copies meet: distance of the tips in mm and angle of the tool axes in rad, the worst of all passes."""

    distance: float
    turn: float


def joints(programs: Sequence[Program], sectors: Sequence[Sector]) -> tuple[Joint, ...]:
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
    return tuple(joint(programs[one], programs[other]) for one, other in np.argwhere(meet).tolist())


def joint(one: Program, other: Program) -> Joint:
    """Mismatch of the passes of one copy and the same passes of another one at their nearest ends.

    Raises:
        ValueError: they have different numbers of passes, or none.
    """
    runs = [passes(program) for program in (one, other)]
    if len(runs[0]) != len(runs[1]) or not len(runs[0]):
        raise ValueError(f"joint: expected copies of one program, got {len(runs[0])} and {len(runs[1])} passes")
    rows = [run - 1 for run in runs]
    tips = [program.position[row] for program, row in zip((one, other), rows, strict=True)]
    axes = [program.tool_axis[row] for program, row in zip((one, other), rows, strict=True)]
    between = norm(tips[0][:, :, None] - tips[1][:, None, :]).reshape(-1, 4)
    chord = norm(axes[0][:, :, None] - axes[1][:, None, :]).reshape(-1, 4)
    # Of equally near ends, those with the smallest axis angle count: a closed pass has both ends in one place.
    nearest = np.argmin(np.round(between, 6) + chord * 1e-9, axis=1)[:, None]
    turn = 2 * np.arcsin(np.clip(np.take_along_axis(chord, nearest, axis=1) / 2, 0.0, 1.0))
    return Joint(float(np.take_along_axis(between, nearest, axis=1).max()), float(turn.max()))
