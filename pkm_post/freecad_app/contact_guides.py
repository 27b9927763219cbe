# SPDX-License-Identifier: LGPL-2.1-or-later
"""Contact guides: the guide row of each row in a program of contact points, where some rows end on no face.

Takes a program of lines and rapid moves and its rows that touch the model; returns for each row a touching row, and the
cutting moves that should touch but do not. mm, z upwards.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from pkm_post.geometry import norm
from pkm_post.model import Kind, Program

Array = np.ndarray[Any, np.dtype[Any]]

_STEEP = 1e-6
"""A rapid move with less horizontal travel than this, in mm, is vertical."""


def guides(program: Program, touching: Array, lead_length: float) -> tuple[Array, Array]:
    """Find the row that each row moves with.

    Touching rows are their own guides. A feed move between a rapid move and a cut, up to ``lead_length`` along the
    path from it, is a lead and moves with the nearest row of that cut. Of the rapid moves after a cut the vertical
    ones move with the cut, and so does the first in any direction if more follow; all others move with the next cut.

    Args:
        program: lines and rapid moves, N rows.
        touching: (N,) which rows end on a face.
        lead_length: largest length of a lead, mm.

    Returns:
        The guides (N,), -1 for rows without one; and a mask of the feed moves that neither touch nor are leads, (N,).
    """
    row, rapid = np.arange(len(program)), (program.kind == Kind.RAPID) & ~touching
    before, after = _latest(touching), _next(touching)
    since, until = _latest(rapid), _next(rapid)
    way = np.cumsum(norm(np.diff(program.position, axis=0, prepend=program.position[:1])))
    leads_in = (after < until) & (before <= since) & (way[np.minimum(after, row[-1:])] - way <= lead_length)
    leads_out = (before > since) & (until <= after) & (way - way[np.maximum(before, 0)] <= lead_length)
    backwards = np.where(rapid, _leaves(program, rapid), leads_out) & (before >= 0)
    guide = np.where(backwards | (after == len(row)), before, after)
    astray = ~touching & ~rapid & ~leads_in & ~leads_out
    return np.where(touching, row, guide), astray


def _leaves(program: Program, rapid: Array) -> Array:
    """Mask of the rapid moves that belong to the preceding cut, (N,)."""
    row = np.arange(len(rapid))
    sideways = np.hypot(*np.diff(program.position[:, :2], axis=0, prepend=program.position[:1, :2]).T) > _STEEP
    turns = np.cumsum(rapid & sideways)
    last_cut = _latest(~rapid)
    first_of_several = (last_cut == row - 1) & np.append(rapid[1:], False)
    leaves: Array = (last_cut >= 0) & ((turns == turns[np.maximum(last_cut, 0)]) | first_of_several)
    return leaves


def _latest(marked: Array) -> Array:
    """Index of the last marked row up to each row, (N,), -1 if there is none."""
    latest: Array = np.maximum.accumulate(np.where(marked, np.arange(len(marked)), -1))
    return latest


def _next(marked: Array) -> Array:
    """Index of the first marked row from each row on, (N,), N if there is none."""
    following: Array = np.minimum.accumulate(np.where(marked, np.arange(len(marked)), len(marked))[::-1])[::-1]
    return following
