# SPDX-License-Identifier: LGPL-2.1-or-later
"""Iso-parametric passes: lines of constant v, or one spiral that runs through all of them.

The values of v enter, a course in (u, v) leaves.
"""

from __future__ import annotations

import numpy as np

from pkm_post.surface_path.course import Course
from pkm_post.surface_path.surface import Array, Span


def lines(u: Span, v: Array, nodes: int) -> Course:
    """Passes along the whole range of u, each at one v.

    Args:
        u: range of the parameter along the passes.
        v: (P,) of the passes.
        nodes: how many points each gets.
    """
    number = np.repeat(np.arange(len(v)), nodes)
    return Course.of(np.tile(np.linspace(u.first, u.last, nodes), len(v)), v[number], number)


def spiral(u: Span, v: Array, nodes: int) -> Course:
    """One pass that goes round at the first v, winds on from each v to the next, and goes round at the last one.

    Args:
        u: range of the parameter round the surface, closed.
        v: (P,) of the turns.
        nodes: points of each turn.
    """
    turn = np.arange((len(v) + 1) * (nodes - 1) + 1) / (nodes - 1)
    place = np.interp(np.clip(turn - 1.0, 0.0, None), np.arange(len(v)), v)
    return Course.of(u.first + turn * u.width, place, np.zeros(len(turn), dtype=np.int64))
