# SPDX-License-Identifier: LGPL-2.1-or-later
"""Compass search: the maximum of a nonsmooth function of a few variables, such as a worst case.

Takes a function and a start; returns the point found. All directions are tried at once, with steps that grow after a
success and shrink after a failure: coordinate directions, and random ones, since on a ridge no coordinate direction may
lead up. The same input gives the same result. [Kolda2003]
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from pkm_post.geometry import Array

_AT_RANDOM = 24
_SEED = 1
_MOST_STEPS = 2000


def compass_search(height: Callable[[Array], Array], start: Array, first_step: Array, last_step: Array) -> Array:
    """Climb from a start to a point that no small step improves, (D,).

    Args:
        height: maps points (P, D) to their heights (P,).
        start: (D,) start point.
        first_step: (D,) initial steps by coordinate; zero for fixed ones.
        last_step: (D,) steps at which the search ends.
    """
    random = np.random.default_rng(_SEED)
    free = np.flatnonzero(first_step)
    at, best, scale = start, float(height(start[None])[0]), 1.0
    for _ in range(_MOST_STEPS):
        if (scale * first_step <= last_step).all():
            break
        directions = random.normal(size=(_AT_RANDOM, len(free)))
        directions /= np.linalg.norm(directions, axis=1, keepdims=True)
        steps = np.zeros((2 * len(free) + _AT_RANDOM, len(start)))
        steps[:, free] = np.vstack([np.eye(len(free)), -np.eye(len(free)), directions])
        tried = at + scale * first_step * steps
        heights = height(tried)
        highest = int(np.argmax(heights))
        if heights[highest] > best:
            at, best, scale = tried[highest], float(heights[highest]), min(2 * scale, 1.0)
        else:
            scale /= 2
    return at
