# SPDX-License-Identifier: LGPL-2.1-or-later
"""How far tool poses are from a stretch of a trajectory: of its segments the one counts that a pose fits best."""

import numpy as np


def deviation_from_any(ruler, tip, axis, first, last):
    """Deviations of tip (mm) and axis (rad) from one of the segments first to last, (N,) each.

    The better fit is the one whose larger deviation, each by its tolerance, is smaller.
    """
    best, score = np.full((2, len(tip)), np.inf), np.full(len(tip), np.inf)
    for further in range(int((last - first).max()) + 1):
        off_tip, off_axis, tip_tolerance = ruler.deviation_from(tip, axis, np.minimum(first + further, last))
        fit = np.maximum(off_tip / tip_tolerance, off_axis / ruler.axis_tolerance)
        better = fit < score
        best[:, better], score[better] = np.stack([off_tip, off_axis])[:, better], fit[better]
    return best[0], best[1]
