# SPDX-License-Identifier: LGPL-2.1-or-later
"""Between: what a smooth motion can do between the instants that are looked at.

Enters: a quantity of three columns at even instants of intervals. Leaves: how far it can be, between two neighbouring
instants, from the straight line between its two values. With f'' its second derivative and h the time from one instant
to the next that is h^2 / 8 max |f''|; f'' follows from second differences, which are h^2 f'' where f is a cubic.
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry.vectors import Array, length_of

_ROOM = 1.1
"""For what second differences of a motion that is a cubic of struts, but not quite one of the tool, leave out."""


def bow(columns: Array) -> Array:
    """Most by which (3, M, N) columns leave the chords between neighbours of M >= 4 even instants, (N,)."""
    second = np.diff(columns, 2, axis=1)
    # f'' of a cubic is linear: at both ends, where there is no second difference, it is one step further on
    onward = length_of(*(second[:, -1] - second[:, 0])) / (second.shape[1] - 1)
    return np.asarray(_ROOM / 8 * (length_of(*second).max(axis=0) + onward))


def arch(columns: Array, bend: Array | float) -> Array:
    """Most by which a curve of curvature ``bend`` leaves the chords of steps as long as those of the columns, (N,)."""
    step = np.square(np.diff(columns, axis=1)).sum(axis=0).max(axis=0)
    return np.asarray(_ROOM / 8 * step * bend)
