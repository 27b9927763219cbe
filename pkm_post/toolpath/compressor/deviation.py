# SPDX-License-Identifier: LGPL-2.1-or-later
"""Deviation: deviations of places on polylines from a curve, in tip, tool axis and spin.

The reference on the curve is the place nearest to the tip, to first order. Columns are (C, N): tip,
and tool axis and spin where these change. Units: mm, rad.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array, length_of
from pkm_post.toolpath.compressor.splines import AXIS, SPIN, TIP


@dataclass(frozen=True)
class Allowed:
    """Allowed deviations of the curve, in columns of N rows or places.

    Attributes:
        tip: (N,) mm.
        axis: (N,) rad, for tool axis and spin.
    """

    tip: Array
    axis: Array

    def __getitem__(self, rows: Array | slice) -> Allowed:
        return Allowed(self.tip[rows], self.axis[rows])


def deviation(point: Array, curve: Array, slope: Array) -> tuple[Array, Array]:
    """Deviations of points from the nearest places of a curve, (C, N); and how far ahead these are, (N,).

    Args:
        point: (C, N) points of polylines.
        curve: (C, N) places of the curve.
        slope: (C, N) its derivative there.
    """
    off = point - curve
    along, square = _dot(off[TIP], slope[TIP]), _dot(slope[TIP], slope[TIP])
    ahead = np.divide(along, square, out=np.zeros_like(along), where=square > 0)  # 0 where the tip turns back
    off -= ahead * slope
    if len(off[AXIS]):
        axis = curve[AXIS] / length_of(*curve[AXIS])
        off[AXIS] -= _dot(off[AXIS], axis) * axis
    return off, ahead


def by_allowed(off: Array, allowed: Allowed) -> tuple[Array, Array]:
    """Deviations of the tip, and of axis or spin, relative to those allowed, (N,) each."""
    tip = length_of(*off[TIP]) / allowed.tip
    if not len(off[AXIS]):
        return tip, np.zeros_like(tip)
    return tip, np.maximum(length_of(*off[AXIS]), np.abs(off[SPIN][0])) / allowed.axis


def _dot(left: Array, right: Array) -> Array:
    return np.asarray(left[0] * right[0] + left[1] * right[1] + left[2] * right[2])
