# SPDX-License-Identifier: LGPL-2.1-or-later
"""Limits: speed and acceleration limits along the path at each station, from arrays only.

For a quantity y(s) of the path with derivatives y', y'' by path length and the speed v = s': its rate is y' v and its
acceleration y' v' + y'' v^2. Enters: y', y'' of every limited quantity, with its limits. Leaves: at each station the
highest v^2 and the highest |v'|. This module is independent of the machine: struts, tip and axis are plain columns.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array, norm

PLANNED_SHARE = 0.6
"""Share of each acceleration limit that is planned: the cubic that a controller runs across a switch from full
acceleration to full braking reaches 5/3 of it at its end (shown in docs/planning.md and in the tests)."""
_FOR_CURVATURE = 0.5
"""Share of the planned acceleration that the curvature of the path may use; the rest accelerates and brakes."""
_NEGLIGIBLE = 1e-12
"""Derivatives below this impose no limit; keeps the quotients finite."""
_STEEPEST = 1e6
"""mm/s^2: stands for no limit where no limited quantity moves; keeps the sums of the profile finite."""


@dataclass(frozen=True)
class Bounded:
    """A vector along the path with limits on the magnitude of its rate, acceleration and jerk.

    Attributes:
        first: (M, C) derivatives by path length.
        second: (M, C) second derivatives.
        speed: limit of the rate, infinite where there is none.
        acceleration: limit of the acceleration, infinite where there is none.
        each: whether the limits apply to every column (struts), or to the norm of the vector (tip).
        jerk: limit of the jerk, infinite where there is none.
    """

    first: Array
    second: Array
    speed: float
    acceleration: float
    each: bool
    jerk: float = np.inf

    def sizes(self) -> tuple[Array, Array]:
        """Magnitudes of first and second derivative, by column (M, C) or of the vector (M, 1).

        The second derivative is the maximum over a station and its two neighbours: between two stations both it and v^2
        change, and their product may exceed that at either.
        """
        if self.each:
            return np.abs(self.first), _of_neighbours(np.abs(self.second))
        return norm(self.first)[:, None], _of_neighbours(norm(self.second)[:, None])


def limits(feed: Array, bounded: Iterable[Bounded]) -> tuple[Array, Array]:
    """Highest speed squared and highest acceleration along the path at each station, (M,) each.

    The rate y' v is limited by the largest y' of a station and its two neighbours: between two stations neither v^2 nor
    y' exceeds the larger of its end values, so the limit holds throughout, even if both maxima coincide.

    Args:
        feed: (M,) programmed speed by path length.
        bounded: the quantities with limits of their own.
    """
    bounded = tuple(bounded)
    square = feed**2
    for item in bounded:
        first, second = item.sizes()
        square = _least(square, item.speed, _of_neighbours(first), 2)
        square = _least(square, _FOR_CURVATURE * PLANNED_SHARE * item.acceleration, second, 1)
    along = np.full(len(feed), _STEEPEST)
    for item in bounded:
        if np.isfinite(item.acceleration):
            first, second = item.sizes()
            left = PLANNED_SHARE * item.acceleration - second * square[:, None]
            along = np.minimum(along, of_columns(np.minimum, left / np.maximum(first, _NEGLIGIBLE)))
    return square, along


def rough_limits(feed: Array, bounded: Iterable[Bounded]) -> tuple[Array, Array]:
    """Speeds squared and accelerations along the path that are allowed on the whole of each segment, (N,) each.

    Neither exceeds those of ``limits`` anywhere on the segment: each term of the acceleration has a fixed share.

    Args:
        feed: (N,) programmed speed by path length.
        bounded: the quantities with limits of their own; ``first`` and ``second`` bound the magnitudes, (N, 1).
    """
    square, along = feed**2, np.full(len(feed), _STEEPEST)
    for item in bounded:
        planned = PLANNED_SHARE * item.acceleration
        square = _least(square, item.speed, item.first, 2)
        square = _least(square, _FOR_CURVATURE * planned, item.second, 1)
        along = _least(along, (1 - _FOR_CURVATURE) * planned, item.first, 1)
    return square, along


def of_columns(function: Callable[[Array, Array], Array], columns: Array) -> Array:
    """The minimum or maximum of each row, (M,), for few columns; many times faster than numpy's reduction of rows."""
    return functools.reduce(function, columns.T)


def _of_neighbours(size: Array) -> Array:
    """The maximum of each row and the rows before and after it."""
    padded = np.concatenate([size[:1], size, size[-1:]])
    return np.maximum(np.maximum(padded[:-2], padded[2:]), size)


def _least(square: Array, limit: float, size: Array, power: int) -> Array:
    if not np.isfinite(limit):
        return square
    worst = np.maximum(of_columns(np.maximum, size), _NEGLIGIBLE)
    return np.minimum(square, (limit / worst) ** power)
