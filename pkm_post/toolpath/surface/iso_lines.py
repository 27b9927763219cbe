# SPDX-License-Identifier: LGPL-2.1-or-later
"""Iso-parametric passes: lines of constant v, or one spiral that runs through all of them.

Takes the values of v; returns a course in (u, v).
"""

from __future__ import annotations

import numpy as np

from pkm_post.toolpath.surface.course import Course
from pkm_post.toolpath.surface.surface import Array, Span


def lines(u: Span, v: Array, nodes: int) -> Course:
    """Passes along the whole range of u, each at a constant v.

    Args:
        u: range of the parameter along the passes.
        v: (P,) values of v of the passes.
        nodes: number of points of each pass.
    """
    number = np.repeat(np.arange(len(v)), nodes)
    return Course.of(np.tile(np.linspace(u.first, u.last, nodes), len(v)), v[number], number)


def spiral(u: Span, v: Array, nodes: int) -> Course:
    """One pass: a full turn at the first v, a spiral from each v to the next, and a full turn at the last v.

    Args:
        u: range of the parameter around the surface, closed.
        v: (P,) values of v of the turns.
        nodes: number of points of each turn.
    """
    turn = np.arange((len(v) + 1) * (nodes - 1) + 1) / (nodes - 1)
    place = np.interp(np.clip(turn - 1.0, 0.0, None), np.arange(len(v)), v)
    return Course.of(u.first + turn * u.width, place, np.zeros(len(turn), dtype=np.int64))
