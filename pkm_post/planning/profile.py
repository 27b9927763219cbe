# SPDX-License-Identifier: LGPL-2.1-or-later
"""Profile: the fastest speed along the path, from rest to rest, within the limits.

With x = v^2 the acceleration along the path is half of dx/ds, so a bound on acceleration is a bound on the slope of x:
x_j <= x_i + 2 a_i (s_j - s_i). The largest such x under given ceilings is a running minimum of x - C with C the sum of
the slopes, once from the left and once from the right: look-ahead of any depth without a loop.
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry import Array
from pkm_post.model import pieces

_ROUNDING = 4 * np.finfo(np.float64).eps
"""Relative rounding error of sums of slopes and ceilings."""
_AT_ONCE = 1 << 14


def cell_times(s: Array, square: Array) -> Array:
    """Duration of each cell, (M - 1,) s: with v^2 linear in s, 2 ds / (v0 + v1).

    Args:
        s: (M,) path lengths, not decreasing.
        square: (M,) speed squared.
    """
    speed, times = np.sqrt(square), np.diff(s)
    times *= 2
    times /= speed[1:] + speed[:-1]
    return times


def speed_profile(s: Array, ceiling: Array, acceleration: Array) -> Array:
    """Highest speed squared at every station, (M,); between stations it is linear in s.

    Args:
        s: (M,) path lengths, not decreasing.
        ceiling: (M,) highest speed squared; 0 where the motion rests.
        acceleration: (M,) highest acceleration along the path.
    """
    climb, square = np.zeros(len(s)), np.empty(len(s))  # the only arrays of this length
    rise = np.minimum(acceleration[1:], acceleration[:-1], out=climb[1:])
    rise *= 2
    for rows in pieces(len(rise), _AT_ONCE):
        rise[rows] *= np.diff(s[rows.start : rows.stop + 1])
    np.cumsum(rise, out=rise)
    np.subtract(ceiling, climb, out=square)
    np.minimum.accumulate(square, out=square)
    square += climb
    square += climb
    np.minimum.accumulate(square[::-1], out=square[::-1])
    square -= climb
    # cancellation must not produce a standstill
    least = np.minimum(ceiling, _ROUNDING * (climb[-1] + ceiling.max()), out=climb)
    return np.clip(square, least, ceiling, out=square)
