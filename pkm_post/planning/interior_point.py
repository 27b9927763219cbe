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

from dataclasses import dataclass, replace

import numpy as np

from pkm_post.geometry import Array
from pkm_post.planning.banded import BandedFactor
from pkm_post.planning.motion_limits import Limits

_MOST_STEPS = 60
_LEAST_SLACK = 0.1
"""Slack at the start where a limit leaves less, or is broken."""
_LIFT = 1e-2
"""Least slack at the start of a search that goes on from another one."""
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
class State:
    """Slacks and multipliers of one set of limits, (G, E) each."""

    slack: Array
    multiplier: Array

    def lifted(self) -> State:
        """The same without slacks that would hold a search with other limits where it begins."""
        return State(np.maximum(self.slack, _LIFT), self.multiplier)


@dataclass(frozen=True)
class Solution:
    """Where a search is.

    Attributes:
        unknowns: (N,)
        states: what it knows of each set of limits; nothing at the start.
        reached: whether it was found.
    """

    unknowns: Array
    states: tuple[State, ...] = ()
    reached: bool = False


@dataclass(frozen=True)
class _Linear:
    """A set of limits at the present unknowns.

    Attributes:
        limits: the limits.
        state: slacks and multipliers.
        room: (G, E) what each limit leaves: (1 - p^2) / 2.
        slope: (3, G, E) of ``room`` by k, a and x.
        factor: (E,) of the square of p: x for jerk, else 1.
    """

    limits: Limits
    state: State
    room: Array
    slope: Array
    factor: Array

    @classmethod
    def of(cls, limits: Limits, state: State | None, unknowns: Array, barrier: float) -> _Linear:
        values = limits.ends.values(unknowns)
        numbers = limits.numbers(values)
        factor = values[2] if limits.jerk else np.ones_like(values[2])
        room = (1 - factor * limits.by_group(numbers**2)) / 2
        slope = -factor * limits.by_group(numbers * limits.weights)
        if limits.jerk:
            slope[2] -= 0.5 / values[2]
        if state is None:
            slack = np.maximum(room, _LEAST_SLACK)
            state = State(slack, barrier / slack)
        return cls(limits, state, room, slope, factor)

    def curvature(self) -> list[Array]:
        """The six entries of the second derivatives by k, a and x at each end, (E,) each."""
        weights, slope = self.limits.weights, self.slope
        stiff = self.state.multiplier / self.state.slack * slope
        shared = np.broadcast_to(self.factor * self.state.multiplier, weights.shape[1:]) * weights
        return [
            np.einsum("ge,ge->e", stiff[i], slope[j]) + np.einsum("re,re->e", shared[i], weights[j]) for i, j in _PAIRS
        ]

    def moved(self, step: Array) -> Array:
        """Change of the slacks with a step of the unknowns, (G, E)."""
        along = self.limits.ends.changes(step)
        return np.asarray(np.einsum("bge,be->ge", self.slope, along) + self.room - self.state.slack)


def fastest(weight: Array, limits: tuple[Limits, ...], start: Solution, enough: float) -> Solution:
    """The fastest motion.

    Args:
        weight: (N,) length of path for which each unknown stands.
        limits: the limits.
        start: unknowns above 0, which may break limits; or the end of a search with nearly the same limits.
        enough: gap of optimality at which to stop, and the most by which a limit may be broken, relative.
    """
    count = sum(one.weights[0].size if one.each else one.weights.shape[2] for one in limits)
    barrier = _FIRST_GAP * _time(weight, start.unknowns) / count
    now = Solution(start.unknowns, tuple(one.lifted() for one in start.states))
    for _ in range(_MOST_STEPS):
        states = now.states or (None,) * len(limits)
        linear = [_Linear.of(one, state, now.unknowns, barrier) for one, state in zip(limits, states, strict=True)]
        gap = sum(float((one.state.slack * one.state.multiplier).sum()) for one in linear)
        broken = -min(float(one.room.min()) for one in linear)
        balanced = gap + _imbalance(weight, linear, now.unknowns) <= enough * _time(weight, now.unknowns)
        if balanced and broken <= enough:
            return replace(now, reached=True)
        now = _stepped(weight, linear, now.unknowns, gap / count, count)
    return now


def _time(weight: Array, unknowns: Array) -> float:
    return float((weight / np.sqrt(unknowns)).sum())


def _imbalance(weight: Array, linear: list[_Linear], unknowns: Array) -> float:
    """What unknowns that are not in balance with their limits can cost, s, where they are off by a share."""
    left = _downhill(weight, unknowns) + _gathered(linear, [one.state.multiplier for one in linear], len(unknowns))
    return _OFF * float(np.abs(left * unknowns).sum())


def _downhill(weight: Array, unknowns: Array) -> Array:
    """How much the time goes down with each unknown, (N,)."""
    return np.asarray(0.5 * weight * unknowns**-1.5)


def _stepped(weight: Array, linear: list[_Linear], unknowns: Array, mean_gap: float, count: int) -> Solution:
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
        """The change of the unknowns, and of the slacks, for right sides of the limits (G, E)."""
        right = downhill + _gathered(linear, pushes, size)
        change = scale * factor.solve(scale * right)
        return change, [one.moved(change) for one in linear]

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
    states = (
        State(one.state.slack + primal * a, one.state.multiplier + dual * b)
        for one, a, b in zip(linear, slacks, multipliers, strict=True)
    )
    return Solution(unknowns + primal * change, tuple(states))


def _centring(
    linear: list[_Linear], slacks: list[Array], multipliers: list[Array], mean_gap: float, count: int
) -> float:
    """Share of the gap to aim for: little where the step without centring would close most of it."""
    primal, dual = _shares(linear, slacks, multipliers)
    after = sum(
        float(((one.state.slack + primal * a) * (one.state.multiplier + dual * b)).sum())
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
        basis, unknown, entry = one.limits.ends.basis, one.limits.ends.unknown, {}
        for pair, value in zip(_PAIRS, one.curvature(), strict=True):
            entry[pair] = entry[pair[::-1]] = value
        for m in range(3):
            column = [sum(entry[i, j] * basis[j, m] for j in range(3)) for i in range(3)]
            for n in range(m, 3):
                value = sum(basis[i, n] * column[i] for i in range(3))
                band[n - m] += np.bincount(unknown + m, value, minlength=size + 2)
    return band[:, 1:-1]


def _gathered(linear: list[_Linear], pushes: list[Array], size: int) -> Array:
    """Sums over all limits of a push (G, E) times the slope by each unknown, (N,)."""
    found = np.zeros(size + 2)
    for one, push in zip(linear, pushes, strict=True):
        along = np.einsum("bge,ge->be", one.slope, push)
        for m in range(3):
            value = (one.limits.ends.basis[:, m] * along).sum(axis=0)
            found += np.bincount(one.limits.ends.unknown + m, value, minlength=size + 2)
    return found[1:-1]
