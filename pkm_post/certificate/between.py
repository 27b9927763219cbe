# SPDX-License-Identifier: LGPL-2.1-or-later
"""Between: bounds of a smooth motion between sampled instants.

Enters: a quantity of three columns at even instants of intervals. Leaves: its largest deviation, between neighbouring
instants, from the straight line between its two values. With f'' its second derivative and h the time between
instants, that is h^2 / 8 max |f''|; f'' follows from second differences, which are h^2 f'' if f is a cubic.
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry import Array, length_of

_ROOM = 1.1
"""Margin for the error of second differences, as a cubic motion of the struts is not exactly cubic for the tool."""


def bow(columns: Array) -> Array:
    """Largest deviation of (3, M, N) columns from the chords between neighbours of M >= 4 even instants, (N,)."""
    second = np.diff(columns, 2, axis=1)
    # f'' of a cubic is linear: extrapolate it to both ends, which have no second difference
    onward = length_of(*(second[:, -1] - second[:, 0])) / (second.shape[1] - 1)
    return np.asarray(_ROOM / 8 * (length_of(*second).max(axis=0) + onward))


def arch(columns: Array, bend: Array | float) -> Array:
    """Largest deviation of a curve of curvature ``bend`` from chords as long as the steps of the columns, (N,)."""
    step = np.square(np.diff(columns, axis=1)).sum(axis=0).max(axis=0)
    return np.asarray(_ROOM / 8 * step * bend)
