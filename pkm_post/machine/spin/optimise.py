# SPDX-License-Identifier: LGPL-2.1-or-later
"""Optimise: the spin along a whole path with the largest margins.

Takes a trajectory; returns it with another spin. The search first maximises the score at the worst place of the path,
then minimises the change of spin needed for it. It starts coarse and refines around its result. The scores of the
candidates are most of the work; any executor of ``concurrent.futures`` can distribute them. [Merlet2000]
"""

from __future__ import annotations

import functools
import math
from concurrent.futures import Executor
from dataclasses import replace

import numpy as np

from pkm_post.geometry import Array
from pkm_post.machine.spin.normalised_margins import SampledPoses, normalised_margins, score
from pkm_post.machine.spin.policy import SpinPolicy
from pkm_post.model import Machine, Trajectory

_SLACK = 1e-9
"""Tolerance in comparisons: relative for computed steps, absolute for scores."""


def best_sequence(candidates: Array, scores: Array, start: float, limit: Array, extent: Array) -> Array:
    """Choose a candidate at each node: their indices, (K,).

    Args:
        candidates: (K, M) values to choose from at each node.
        scores: (K, M) scores of the candidates.
        start: the value before the first node.
        limit: (K,) largest change from the node before.
        extent: (K,) path length from the node before; the sum of change^2 / extent is minimised.

    Raises:
        ValueError: no sequence stays within the limits.
    """
    before = np.vstack([np.full(candidates.shape[1], start), candidates[:-1]])
    worst = _worst_score(before, candidates, scores, limit)
    return _least_change(before, candidates, scores >= worst - _SLACK, limit, extent)


def _worst_score(before: Array, candidates: Array, scores: Array, limit: Array) -> float:
    """The best score at the worst node, over all sequences."""
    best = np.full(candidates.shape[1], np.inf)
    for node, at_node in enumerate(scores):
        change = np.abs(candidates[node][:, None] - before[node])
        reachable = np.where(_within(change, limit[node]), best, -np.inf).max(axis=1)
        best = np.minimum(at_node, reachable)
    if best.max() == -np.inf:
        raise ValueError("expected a course within the limits, got none: the candidates are too far apart")
    return float(best.max())


def _least_change(before: Array, candidates: Array, allowed: Array, limit: Array, extent: Array) -> Array:
    """The sequence of least change through allowed candidates, as indices (K,)."""
    nodes, choices = candidates.shape
    came_from = np.empty((nodes, choices), dtype=np.int32)
    cost = np.zeros(choices)
    for node in range(nodes):
        change = np.abs(candidates[node][:, None] - before[node])
        total = cost + np.where(_within(change, limit[node]), change**2 / extent[node], np.inf)
        came_from[node] = np.argmin(total, axis=1)
        cost = np.where(allowed[node], total.min(axis=1), np.inf)
    course = np.empty(nodes, dtype=np.int64)
    course[-1] = np.argmin(cost)
    for node in range(nodes - 1, 0, -1):
        course[node - 1] = came_from[node, course[node]]
    return course


def _within(change: Array, limit: float) -> Array:
    inside: Array = change <= limit * (1 + _SLACK)
    return inside


_REFINEMENT = 4
"""Each search refines the step by this factor, within one step of the previous search."""
_REFINEMENTS = 2
_BLOCK = 1 << 16
"""Poses per pass and per task of an executor, samples times candidates: limits memory."""


def optimise_spin(
    trajectory: Trajectory, machine: Machine, policy: SpinPolicy, executor: Executor | None = None
) -> Trajectory:
    """Search for the spin.

    Args:
        trajectory: at least one segment; its spin at the start is kept.
        policy: objective, and range and rate of the spin.
        executor: distributes the scores of candidates; by default they are computed in this process.
    """
    samples, home = SampledPoses.of(trajectory), trajectory.start_spin
    node_s = samples.row_s[_nodes(samples.row_s, policy.step / policy.rate)]
    extent = np.diff(node_s, prepend=0.0)
    course = np.full(len(node_s), home)
    step, count = policy.step, max(1, math.floor(policy.widest / policy.step))
    for _ in range(1 + _REFINEMENTS):
        candidates = course[:, None] + step * np.arange(-count, count + 1)
        np.clip(candidates, home - policy.widest, home + policy.widest, out=candidates)
        scores = _scores(samples, node_s, machine, policy, candidates, executor)
        best = best_sequence(candidates, scores, home, policy.rate * extent, extent)
        course = candidates[np.arange(len(course)), best]
        step, count = step / _REFINEMENT, _REFINEMENT
    spin = np.interp(samples.row_s, np.append(0.0, node_s), np.append(home, course))
    return replace(trajectory, spin=spin)


def least_normalised_margins(trajectory: Trajectory, machine: Machine) -> Array:
    """Least shares over a trajectory, (3,): stroke, joints, distance to singular poses."""
    samples = SampledPoses.of(trajectory)
    left = normalised_margins(machine, samples.tip, samples.axis, samples.spin, samples.tool_length)
    return np.asarray(left.min(axis=0))


def _nodes(row_s: Array, least: float) -> list[int]:
    """Segments whose ends are nodes: each the first one far enough from the previous node, and the last segment."""
    nodes, at, last = [], 0.0, len(row_s) - 1
    while at + least < row_s[-1]:
        nodes.append(min(int(np.searchsorted(row_s, at + least)), last))
        at = row_s[nodes[-1]]
    if not nodes or nodes[-1] != last:
        nodes[-1:] = [last]
    return nodes


def _scores(
    samples: SampledPoses,
    node_s: Array,
    machine: Machine,
    policy: SpinPolicy,
    candidates: Array,
    executor: Executor | None,
) -> Array:
    """Score of each candidate at each node, (K, M): the worst of the samples nearest to the node."""
    halfway = (np.append(0.0, node_s[:-1]) + node_s) / 2
    # Samples nearest to the start of the path have the spin of the start.
    chosen = np.flatnonzero(samples.s >= halfway[0])
    node = np.searchsorted(halfway, samples.s[chosen], side="right") - 1
    columns = samples.tip[chosen], samples.axis[chosen], samples.tool_length[chosen], candidates[node]
    parts = np.arange(0, len(chosen), max(1, _BLOCK // candidates.shape[1]))[1:]
    task, split = functools.partial(_scores_of, machine, policy), [np.split(column, parts) for column in columns]
    scores = np.concatenate(list(executor.map(task, *split) if executor else map(task, *split)))
    return np.asarray(np.minimum.reduceat(scores, np.searchsorted(node, np.arange(len(node_s))), axis=0))


def _scores_of(
    machine: Machine, policy: SpinPolicy, tip: Array, axis: Array, tool_length: Array, spins: Array
) -> Array:
    """Scores of the spins (P, M) to choose from at some samples, (P, M)."""
    choices = spins.shape[1]
    tip, axis, tool_length = (np.repeat(column, choices, axis=0) for column in (tip, axis, tool_length))
    left = normalised_margins(machine, tip, axis, spins.ravel(), tool_length)
    return score(left, policy.weights).reshape(spins.shape)
