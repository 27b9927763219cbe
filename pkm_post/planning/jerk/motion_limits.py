# SPDX-License-Identifier: LGPL-2.1-or-later
"""Motion limits: limits of speed, acceleration and jerk at the ends of the cells of a speed spline.

A limit bounds one or more numbers p, each a weighted sum of the change of acceleration k, the acceleration a and the
speed squared x:

    kind            p                                  limit
    speed           x / X                              |p| <= 1
    acceleration    (y' a + y'' x) / A                 |p| <= 1
    jerk            (y' k + 3 y'' a + y''' x) / J      sqrt(x) |p| <= 1

for a quantity with the derivatives y', y'', y''' by path length. Units: mm, s.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from pkm_post.geometry import Array
from pkm_post.planning.speed_spline import CellEnds


class Limits(NamedTuple):
    """Limits of one kind at E ends of cells: R numbers p at each, a vector whose length has one bound.

    Attributes:
        ends: where they apply; an end with several limits appears several times.
        weights: (3, R, E) of k, a and x for each of R numbers, divided by the bound.
        jerk: whether |p| is bounded by 1 / sqrt(x) instead of 1.
        in_middle: whether p applies in the middle of the cell.
    """

    ends: CellEnds
    weights: Array
    jerk: bool
    in_middle: bool = False

    def use(self, values: Array) -> Array:
        """Use of each bound, (E,), for k, a and x at the ends, (3, E); above 1 it is broken."""
        k, a, x = self.weights
        size = np.sqrt(((k * values[0] + a * values[1] + x * values[2]) ** 2).sum(axis=0))
        return np.asarray(size * np.sqrt(values[2]) if self.jerk else size)

    def lowered(self, slower: Array) -> Limits:
        """Limits for a motion slowed down on each cell by a factor, (M - 1,)."""
        ends = self.ends
        if self.jerk:
            factor = slower[ends.cell] ** 3
        elif self.in_middle:
            factor = slower[ends.cell] ** 2
        else:
            factor = np.maximum(slower[ends.place], slower[ends.place - 1]) ** 2
        return self._replace(weights=self.weights * factor)

    def loosened(self, values: Array, rows: Array, by: float) -> Limits:
        """Relax selected rows, (E,), so that values, (3, E), keep within them with a share to spare."""
        factor = np.where(rows, np.maximum(self.use(values) * (1 + by), 1.0), 1.0)
        return self._replace(weights=self.weights / factor)
