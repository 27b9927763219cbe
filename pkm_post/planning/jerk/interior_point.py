# SPDX-License-Identifier: LGPL-2.1-or-later
"""Interior point: the fastest speed spline under limits, by Newton's method for all unknowns at once.

Minimises the sum of w / sqrt(c) over the unknowns c of a ``SpeedSpline``, the time of the motion, under the limits of
``motion_limits``. Speed and acceleration limits are convex. The jerk limit, |p| <= 1 / sqrt(x), has a convex right
side, so its tangent is on the safe side: every step solves a convex problem, and successive steps form a sequential
convex programme [Debrouwere2013]. Slacks start positive, whether or not they match; the predictor-corrector is
Mehrotra's [Mehrotra1992]. The matrix of a step has two diagonals on either side, as only three unknowns count at a
place (``banded``).
"""

from __future__ import annotations

import functools
from typing import NamedTuple

import numpy as np

from pkm_post.geometry import Array, dot
from pkm_post.model import checkpoint
from pkm_post.planning.jerk.banded import BandedFactor
from pkm_post.planning.jerk.motion_limits import Limits

_MOST_STEPS = 60
_LEAST_SLACK = 0.1
"""Least initial slack, for limits with little or negative room."""
_FIRST_GAP = 1.0
"""Initial duality gap, as a share of the time."""
_HOPELESS = 1e12
"""Duality gap, as a share of the time, above which the limits leave no motion: there it grows without end."""
_OFF = 0.1
"""Relative error assumed for the unknowns in the cost of a stationarity residual."""
_TO_BOUNDARY = 0.95
"""Share of the way to the nearest bound that a step takes."""
_LEAST_CENTRING = 1e-4
_STIFFENING = 1e-13
"""Relative addition to the main diagonal: keeps the matrix positive definite despite rounding."""
_PAIRS = ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))
"""The six distinct entries of a symmetric 3 x 3 matrix."""


class _SlacksAndMultipliers(NamedTuple):
    """Slacks and multipliers of one set of limits, (E,) each."""

    slack: Array
    multiplier: Array


class Solution(NamedTuple):
    """Result of a search.

    Attributes:
        unknowns: (N,)
        reached: whether they are optimal; else the search gave up.
    """

    unknowns: Array
    reached: bool


class _Rows(NamedTuple):
    """A set of limits in terms of the three unknowns that count at each of E ends.

    Attributes:
        unknown: (E,) index of the first of the three among the padded unknowns.
        weights: (3, R, E) growth of the numbers with each of them.
        settled: (R, E) the numbers without them.
        square: (3, E) growth of the speed squared with each of them, for jerk limits, and
        square_settled: (E,) the speed squared without them; else None.
        products: (6, E) products of two weights, summed over the numbers, for each of ``_PAIRS``.
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
        """Values of these three unknowns, (E,) each, from all unknowns, padded by one at both ends."""
        return padded[self.unknown], padded[self.unknown + 1], padded[self.unknown + 2]


class _Linear(NamedTuple):
    """Limits linearised at the present unknowns.

    Attributes:
        rows: the limits.
        state: slacks and multipliers.
        room: (E,) margin of each limit: (1 - factor p^2) / 2.
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
        """Second derivatives at each end, (E,) for each of ``_PAIRS``."""
        stiff, shared = self.state.multiplier / self.state.slack * self.slope, self.factor * self.state.multiplier
        return [stiff[m] * self.slope[n] + shared * self.rows.products[k] for k, (m, n) in enumerate(_PAIRS)]

    def moved(self, padded: Array) -> Array:
        """Change of the slacks for a step of the unknowns, (E,)."""
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
    """Find the fastest motion.

    Args:
        weight: (N,) path length represented by each unknown.
        limits: the limits.
        unknowns: (N,) starting point, positive; it may break limits.
        enough: duality gap at which to stop, and largest violation of a limit, relative.
        few_broken: share of limits that may stay broken by more. The last few take as many steps as all the others.
    """
    count = sum(one.weights.shape[2] for one in limits)
    barrier = _FIRST_GAP * _time(weight, unknowns) / count
    rows = [_Rows.of(one) for one in limits]
    states: list[_SlacksAndMultipliers] | list[None] = [None] * len(limits)
    for _ in range(_MOST_STEPS):
        checkpoint()
        padded = _padded(unknowns)
        linear = [_Linear.of(one, state, padded, barrier) for one, state in zip(rows, states, strict=True)]
        gap = sum(float(dot(one.state.slack, one.state.multiplier)) for one in linear)
        broken = sum(np.count_nonzero(one.room < -enough) for one in linear)
        balanced = gap + _imbalance(weight, linear, unknowns) <= enough * _time(weight, unknowns)
        if balanced and broken <= few_broken * count:
            return Solution(unknowns, reached=True)
        if gap > _HOPELESS * _time(weight, unknowns):
            break
        unknowns, states = _stepped(weight, linear, unknowns, gap / count, count)
    return Solution(unknowns, reached=False)


def _time(weight: Array, unknowns: Array) -> float:
    return float((weight / np.sqrt(unknowns)).sum())


def _imbalance(weight: Array, linear: list[_Linear], unknowns: Array) -> float:
    """Time that the stationarity residual may cost, s, at an assumed relative error of the unknowns."""
    left = _downhill(weight, unknowns) + _gathered(linear, [one.state.multiplier for one in linear], len(unknowns))
    return _OFF * float(np.abs(left * unknowns).sum())


def _downhill(weight: Array, unknowns: Array) -> Array:
    """Negative gradient of the time by the unknowns, (N,)."""
    return np.asarray(0.5 * weight * unknowns**-1.5)


class _Equations(NamedTuple):
    """The linear equations of a step, factored.

    Attributes:
        linear: the linearised limits.
        downhill: (N,) negative gradient of the time.
        scale: (N,) scale of each unknown, which makes the diagonal 1.
        factor: of the scaled matrix.
    """

    linear: list[_Linear]
    downhill: Array
    scale: Array
    factor: BandedFactor

    @classmethod
    def of(cls, weight: Array, linear: list[_Linear], unknowns: Array) -> _Equations:
        size = len(unknowns)
        band = _band(linear, size)
        band[0] += 0.75 * weight * unknowns**-2.5
        scale = 1 / np.sqrt(band[0])
        for d in range(3):
            band[d, : size - d] *= scale[d:] * scale[: size - d]
        band[0] += _STIFFENING
        return cls(linear, _downhill(weight, unknowns), scale, BandedFactor(band))

    def solve(self, pushes: list[Array]) -> tuple[Array, list[Array]]:
        """Changes of the unknowns and of the slacks for right-hand sides of the limits, (E,)."""
        right = self.downhill + _gathered(self.linear, pushes, len(self.scale))
        change = self.scale * self.factor.solve(self.scale * right)
        padded = _padded(change)
        return change, [one.moved(padded) for one in self.linear]


def _stepped(
    weight: Array, linear: list[_Linear], unknowns: Array, mean_gap: float, count: int
) -> tuple[Array, list[_SlacksAndMultipliers]]:
    """Take one predictor-corrector step."""
    equations = _Equations.of(weight, linear, unknowns)
    still = [one.state.multiplier * (one.state.slack - one.room) / one.state.slack for one in linear]
    _, slacks = equations.solve(still)
    multipliers = _multipliers(linear, slacks)
    centring = _centring(linear, slacks, multipliers, mean_gap, count)
    targets = [
        (centring * mean_gap - a * b) / one.state.slack for one, a, b in zip(linear, slacks, multipliers, strict=True)
    ]
    change, slacks = equations.solve([a + b for a, b in zip(still, targets, strict=True)])
    multipliers = [target + own for target, own in zip(targets, _multipliers(linear, slacks), strict=True)]
    primal, dual = (_TO_BOUNDARY * share for share in _shares(linear, slacks, multipliers))
    primal = min(primal, _TO_BOUNDARY * _reach(unknowns, change))
    states = [
        _SlacksAndMultipliers(one.state.slack + primal * a, one.state.multiplier + dual * b)
        for one, a, b in zip(linear, slacks, multipliers, strict=True)
    ]
    return unknowns + primal * change, states


def _multipliers(linear: list[_Linear], slacks: list[Array]) -> list[Array]:
    """Changes of the multipliers with changes of the slacks, (E,) each, towards a gap of zero."""
    return [-one.state.multiplier * (1 + moved / one.state.slack) for one, moved in zip(linear, slacks, strict=True)]


def _centring(
    linear: list[_Linear], slacks: list[Array], multipliers: list[Array], mean_gap: float, count: int
) -> float:
    """Centring parameter: small where the predictor step would close most of the gap."""
    primal, dual = _shares(linear, slacks, multipliers)
    after = sum(
        float(dot(one.state.slack + primal * a, one.state.multiplier + dual * b))
        for one, a, b in zip(linear, slacks, multipliers, strict=True)
    )
    return max((after / count / mean_gap) ** 3, _LEAST_CENTRING)


def _shares(linear: list[_Linear], slacks: list[Array], multipliers: list[Array]) -> tuple[float, float]:
    """Longest steps, at most 1, that keep all slacks and all multipliers positive."""
    return (
        min(_reach(one.state.slack, change) for one, change in zip(linear, slacks, strict=True)),
        min(_reach(one.state.multiplier, change) for one, change in zip(linear, multipliers, strict=True)),
    )


def _reach(value: Array, change: Array) -> float:
    """Longest step, at most 1, that keeps positive values positive."""
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
    """Sums over all limits of push, (E,), times slope by each unknown, (N,)."""
    found = np.zeros(size + 2)
    for one, push in zip(linear, pushes, strict=True):
        for m in range(3):
            found += np.bincount(one.rows.unknown + m, one.slope[m] * push, minlength=size + 2)
    return found[1:-1]
