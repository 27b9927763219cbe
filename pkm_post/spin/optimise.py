# SPDX-License-Identifier: LGPL-2.1-or-later
"""Optimise: the spin along a whole path that leaves the machine most room.

A trajectory enters; the same with another spin leaves, with what is left of stroke, joint cones and distance to
singular poses before and after. First the worst place of the path is made as good as it can be, then the spin is turned
no more than that needs. The search is coarse first and is refined about its result. [Merlet2000]
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from pkm_post.geometry.vectors import Array
from pkm_post.model import Machine, Trajectory
from pkm_post.spin.course import best_course
from pkm_post.spin.policy import Policy
from pkm_post.spin.samples import Samples
from pkm_post.spin.shares import score, shares

_REFINEMENT = 4
"""Each search has steps this much finer than the one before, and looks as far as one step of that."""
_REFINEMENTS = 2
_EVERY_NODE = 1.0
_BLOCK = 1 << 16
"""Poses per pass, samples times candidates: what is in memory at a time."""


@dataclass(frozen=True)
class Optimised:
    """What the search found.

    Attributes:
        trajectory: with the spin found.
        before: (3,) least shares of stroke, joints and distance to singular poses along the path as it came.
        after: (3,) the same with the spin found.
    """

    trajectory: Trajectory
    before: Array
    after: Array


def optimise(trajectory: Trajectory, machine: Machine, policy: Policy) -> Optimised:
    """Search for the spin.

    Args:
        trajectory: at least one segment; its spin at the start stays.
        machine: geometry and limits.
        policy: what to make as large as possible, and how far and how fast the spin may turn.
    """
    samples = Samples.of(trajectory, policy.step / policy.rate)
    home = trajectory.start_spin
    extent = np.diff(samples.node_s, prepend=0.0)
    course = np.full(len(extent), home)
    step, count = policy.step, max(1, math.floor(policy.widest / policy.step))
    for _ in range(1 + _REFINEMENTS):
        candidates = course[:, None] + step * np.arange(-count, count + 1)
        np.clip(candidates, home - policy.widest, home + policy.widest, out=candidates)
        scores = _scores(samples, machine, policy, candidates)
        best = best_course(candidates, scores, home, policy.rate * extent, extent)
        course = candidates[np.arange(len(course)), best]
        step, count = step / _REFINEMENT, _REFINEMENT
    nodes = np.concatenate([[0.0], samples.node_s]), np.concatenate([[home], course])
    return Optimised(
        trajectory=replace(trajectory, spin=np.interp(samples.row_s, *nodes)),
        before=_least(samples, machine, _spin_at(samples, trajectory)),
        after=_least(samples, machine, np.interp(samples.s, *nodes)),
    )


def least_shares(trajectory: Trajectory, machine: Machine) -> Array:
    """What is left at the worst places of a trajectory, (3,): stroke, joints, distance to singular poses."""
    samples = Samples.of(trajectory, _EVERY_NODE)
    return _least(samples, machine, _spin_at(samples, trajectory))


def _scores(samples: Samples, machine: Machine, policy: Policy, candidates: Array) -> Array:
    """How good each candidate is at each node, (K, M): the worst of the samples next to it."""
    choices = candidates.shape[1]
    chosen_by = np.flatnonzero(samples.node >= 0)
    scores = np.empty((len(chosen_by), choices))
    block = max(1, _BLOCK // choices)
    for first in range(0, len(chosen_by), block):
        rows = chosen_by[first : first + block]
        tip, axis, length = (
            np.repeat(column[rows], choices, axis=0) for column in (samples.tip, samples.axis, samples.tool_length)
        )
        left = shares(machine, tip, axis, candidates[samples.node[rows]].ravel(), length)
        scores[first : first + block] = score(left, policy.weights).reshape(-1, choices)
    starts = np.searchsorted(samples.node[chosen_by], np.arange(len(candidates)))
    return np.asarray(np.minimum.reduceat(scores, starts, axis=0))


def _spin_at(samples: Samples, trajectory: Trajectory) -> Array:
    s = np.concatenate([[0.0], samples.row_s])
    return np.interp(samples.s, s, np.concatenate([[trajectory.start_spin], trajectory.spin]))


def _least(samples: Samples, machine: Machine, spin: Array) -> Array:
    found = shares(machine, samples.tip, samples.axis, spin, samples.tool_length)
    least: Array = found.min(axis=0)
    return least
