# SPDX-License-Identifier: LGPL-2.1-or-later
"""Interior point: the fastest speed spline under limits, by Newton's method for all unknowns at once.

Minimised is the sum of w / sqrt(c) over the unknowns c of a ``SpeedSpline``, the time of the motion, under the limits
of ``motion_limits``. Those of speed and acceleration are convex. That of the jerk, |p| <= 1 / sqrt(x), has a convex
right side, so its tangent is on the safe side: that makes every step one of a convex problem, and successive steps a
sequential convex programme [Debrouwere2013]. Slacks start positive and need not fit; predictor and corrector are
Mehrotra's [Mehrotra1992]. The matrix of a step has two diagonals on either side, as only three unknowns count at a
place (``banded``).
"""

from __future__ import annotations

import functools
from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array
from pkm_post.model import checkpoint
from pkm_post.planning.banded import BandedFactor
from pkm_post.planning.motion_limits import Limits

_MOST_STEPS = 60
_LEAST_SLACK = 0.1
"""Slack at the start where a limit leaves less, or is broken."""
_FIRST_GAP = 1.0
"""Share of the time that the gap of optimality takes at the start."""
_OFF = 0.1
"""Share by which unknowns are taken to be off while the forces of limits are not in balance."""
_TO_BOUNDARY = 0.95
"""Share of the way to the nearest bound that a step goes."""
_LEAST_CENTRING = 1e-4
_STIFFENING = 1e-13
"""Relative addition to the main diagonal, which keeps rounding from making the matrix indefinite."""
_PAIRS = ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))
"""The six different entries of a symmetric 3 x 3 matrix."""


@dataclass(frozen=True)
class _SlacksAndMultipliers:
    """Slacks and multipliers of one set of limits, (E,) each."""

    slack: Array
    multiplier: Array


@dataclass(frozen=True)
class Solution:
    """What a search found.

    Attributes:
        unknowns: (N,)
        reached: whether they are the fastest; else the search gave up.
    """

    unknowns: Array
    reached: bool


@dataclass(frozen=True)
class _Rows:
    """A set of limits by the three unknowns that count at each of E ends.

    Attributes:
        unknown: (E,) the first of the three, counted from one before the first of all.
        weights: (3, R, E) by which the numbers grow with them.
        settled: (R, E) the numbers without them.
        square: (3, E) by which the speed squared grows with them, for limits of jerk, and
        square_settled: (E,) what it is without them; else None.
        products: (6, E) products of two of the weights, summed over the numbers, for each of ``_PAIRS``.
    """

    unknown: Array
    weights: Array
    settled: Array
    square: Array | None
    square_settled: Array | None
    products: Array

    @classmethod
    def of(cls, limits: Limits) -> _Rows:
        ends, of_state = limits.ends, limits.weights
        weights = np.stack([sum(of_state[i] * ends.basis[i, m] for i in range(3)) for m in range(3)])
        return cls(
            unknown=ends.unknown,
            weights=weights,
            settled=np.asarray(sum(of_state[i] * ends.settled[i] for i in range(3))),
            square=ends.basis[2] if limits.jerk else None,
            square_settled=ends.settled[2] if limits.jerk else None,
            products=np.stack([_summed(weights[m] * weights[n]) for m, n in _PAIRS]),
        )

    def near(self, padded: Array) -> tuple[Array, Array, Array]:
        """The values at these three unknowns, (E,) each, from those of all, with one more at both ends."""
        return padded[self.unknown], padded[self.unknown + 1], padded[self.unknown + 2]


@dataclass(frozen=True)
class _Linear:
    """A set of limits at the present unknowns.

    Attributes:
        rows: the limits.
        state: slacks and multipliers.
        room: (E,) what each limit leaves: (1 - p^2) / 2.
        slope: (3, E) of ``room`` by the three unknowns.
        factor: (E,) of the square of p: the speed squared for jerk, else 1.
    """

    rows: _Rows
    state: _SlacksAndMultipliers
    room: Array
    slope: Array
    factor: Array | float

    @classmethod
    def of(cls, rows: _Rows, state: _SlacksAndMultipliers | None, padded: Array, barrier: float) -> _Linear:
        near = rows.near(padded)
        numbers = rows.settled + _combined(rows.weights, near)
        factor: Array | float = 1.0
        if rows.square is not None:
            factor = rows.square_settled + _combined(rows.square, near)
        room = (1 - factor * _summed(numbers**2)) / 2
        slope = np.stack([-factor * _summed(numbers * weight) for weight in rows.weights])
        if rows.square is not None:
            slope -= 0.5 / factor * rows.square
        if state is None:
            slack = np.maximum(room, _LEAST_SLACK)
            state = _SlacksAndMultipliers(slack, barrier / slack)
        return cls(rows, state, room, slope, factor)

    def curvature(self) -> list[Array]:
        """Second derivatives by the three unknowns at each end, (E,) for each of ``_PAIRS``."""
        stiff, shared = self.state.multiplier / self.state.slack * self.slope, self.factor * self.state.multiplier
        return [stiff[m] * self.slope[n] + shared * self.rows.products[k] for k, (m, n) in enumerate(_PAIRS)]

    def moved(self, padded: Array) -> Array:
        """Change of the slacks with a step of the unknowns, (E,)."""
        return np.asarray(_combined(self.slope, self.rows.near(padded)) + self.room - self.state.slack)


def _combined(weights: Array, near: tuple[Array, Array, Array]) -> Array:
    return np.asarray(weights[0] * near[0] + weights[1] * near[1] + weights[2] * near[2])


def _summed(numbers: Array) -> Array:
    """Sums over the numbers of each limit, (E,) from (R, E)."""
    return np.asarray(functools.reduce(np.add, numbers))


def _padded(unknowns: Array) -> Array:
    return np.concatenate([[0.0], unknowns, [0.0]])


def fastest(
    weight: Array, limits: tuple[Limits, ...], unknowns: Array, enough: float, few_broken: float = 0.0
) -> Solution:
    """The fastest motion.

    Args:
        weight: (N,) length of path for which each unknown stands.
        limits: the limits.
        unknowns: (N,) where to begin, above 0; they may break limits.
        enough: gap of optimality at which to stop, and the most by which a limit may be broken, relative.
        few_broken: share of the limits that may be broken by more. The last few take as many steps as all the others.
    """
    count = sum(one.weights.shape[2] for one in limits)
    barrier = _FIRST_GAP * _time(weight, unknowns) / count
    rows = [_Rows.of(one) for one in limits]
    states: list[_SlacksAndMultipliers] | list[None] = [None] * len(limits)
    for _ in range(_MOST_STEPS):
        checkpoint()
        padded = _padded(unknowns)
        linear = [_Linear.of(one, state, padded, barrier) for one, state in zip(rows, states, strict=True)]
        gap = sum(float(one.state.slack @ one.state.multiplier) for one in linear)
        broken = sum(np.count_nonzero(one.room < -enough) for one in linear)
        balanced = gap + _imbalance(weight, linear, unknowns) <= enough * _time(weight, unknowns)
        if balanced and broken <= few_broken * count:
            return Solution(unknowns, reached=True)
        unknowns, states = _stepped(weight, linear, unknowns, gap / count, count)
    return Solution(unknowns, reached=False)


def _time(weight: Array, unknowns: Array) -> float:
    return float((weight / np.sqrt(unknowns)).sum())


def _imbalance(weight: Array, linear: list[_Linear], unknowns: Array) -> float:
    """What unknowns that are not in balance with their limits can cost, s, where they are off by a share."""
    left = _downhill(weight, unknowns) + _gathered(linear, [one.state.multiplier for one in linear], len(unknowns))
    return _OFF * float(np.abs(left * unknowns).sum())


def _downhill(weight: Array, unknowns: Array) -> Array:
    """How much the time goes down with each unknown, (N,)."""
    return np.asarray(0.5 * weight * unknowns**-1.5)


def _stepped(
    weight: Array, linear: list[_Linear], unknowns: Array, mean_gap: float, count: int
) -> tuple[Array, list[_SlacksAndMultipliers]]:
    """One step of predictor and corrector."""
    size = len(unknowns)
    band = _band(linear, size)
    band[0] += 0.75 * weight * unknowns**-2.5
    scale = 1 / np.sqrt(band[0])
    for d in range(3):
        band[d, : size - d] *= scale[d:] * scale[: size - d]
    band[0] += _STIFFENING
    factor = BandedFactor(band)
    downhill = _downhill(weight, unknowns)

    def step(pushes: list[Array]) -> tuple[Array, list[Array]]:
        """The change of the unknowns, and of the slacks, for right sides of the limits (E,)."""
        right = downhill + _gathered(linear, pushes, size)
        change = scale * factor.solve(scale * right)
        padded = _padded(change)
        return change, [one.moved(padded) for one in linear]

    still = [one.state.multiplier * (one.state.slack - one.room) / one.state.slack for one in linear]
    _, slacks = step(still)
    multipliers = [
        -one.state.multiplier * (1 + moved / one.state.slack) for one, moved in zip(linear, slacks, strict=True)
    ]
    centring = _centring(linear, slacks, multipliers, mean_gap, count)
    targets = [
        (centring * mean_gap - a * b) / one.state.slack for one, a, b in zip(linear, slacks, multipliers, strict=True)
    ]
    change, slacks = step([a + b for a, b in zip(still, targets, strict=True)])
    multipliers = [
        target - one.state.multiplier * (1 + moved / one.state.slack)
        for one, target, moved in zip(linear, targets, slacks, strict=True)
    ]
    primal, dual = (_TO_BOUNDARY * share for share in _shares(linear, slacks, multipliers))
    primal = min(primal, _TO_BOUNDARY * _reach(unknowns, change))
    states = [
        _SlacksAndMultipliers(one.state.slack + primal * a, one.state.multiplier + dual * b)
        for one, a, b in zip(linear, slacks, multipliers, strict=True)
    ]
    return unknowns + primal * change, states


def _centring(
    linear: list[_Linear], slacks: list[Array], multipliers: list[Array], mean_gap: float, count: int
) -> float:
    """Share of the gap to aim for: little where the step without centring would close most of it."""
    primal, dual = _shares(linear, slacks, multipliers)
    after = sum(
        float((one.state.slack + primal * a) @ (one.state.multiplier + dual * b))
        for one, a, b in zip(linear, slacks, multipliers, strict=True)
    )
    return max((after / count / mean_gap) ** 3, _LEAST_CENTRING)


def _shares(linear: list[_Linear], slacks: list[Array], multipliers: list[Array]) -> tuple[float, float]:
    """The longest steps, at most 1, with which all slacks and all multipliers stay positive."""
    return (
        min(_reach(one.state.slack, change) for one, change in zip(linear, slacks, strict=True)),
        min(_reach(one.state.multiplier, change) for one, change in zip(linear, multipliers, strict=True)),
    )


def _reach(value: Array, change: Array) -> float:
    """The longest step, at most 1, with which positive values stay so."""
    least = float((change / value).min())
    return min(1.0, -1 / least) if least < 0 else 1.0


def _band(linear: list[_Linear], size: int) -> Array:
    """The matrix of second derivatives by the unknowns, as a lower band (3, N)."""
    band = np.zeros((3, size + 2))
    for one in linear:
        for (m, n), value in zip(_PAIRS, one.curvature(), strict=True):
            band[n - m] += np.bincount(one.rows.unknown + m, value, minlength=size + 2)
    return band[:, 1:-1]


def _gathered(linear: list[_Linear], pushes: list[Array], size: int) -> Array:
    """Sums over all limits of a push (E,) times the slope by each unknown, (N,)."""
    found = np.zeros(size + 2)
    for one, push in zip(linear, pushes, strict=True):
        for m in range(3):
            found += np.bincount(one.rows.unknown + m, one.slope[m] * push, minlength=size + 2)
    return found[1:-1]
