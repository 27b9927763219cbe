# SPDX-License-Identifier: LGPL-2.1-or-later
"""Course: the best path through a field of scores, one value at each node, by dynamic programming.

Takes candidates and their scores at nodes along a path, and limits of the change between nodes; returns one candidate
per node. The course maximises the worst score, and among all courses with that worst score minimises the change. The
best choice at one node may lead into a dead end, so all nodes are decided together.
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry import Array

_SLACK = 1e-9
"""Tolerance in comparisons: relative for computed steps, absolute for scores."""


def best_course(candidates: Array, scores: Array, start: float, limit: Array, extent: Array) -> Array:
    """The index of the candidate to take at each node, (K,).

    Args:
        candidates: (K, M) values to choose from at each node.
        scores: (K, M) scores of the candidates.
        start: the value before the first node.
        limit: (K,) largest change from the node before.
        extent: (K,) path length from the node before; the sum of change^2 / extent is minimised.

    Raises:
        ValueError: no course keeps within the limits.
    """
    before = np.vstack([np.full(candidates.shape[1], start), candidates[:-1]])
    worst = _worst_score(before, candidates, scores, limit)
    return _least_change(before, candidates, scores >= worst - _SLACK, limit, extent)


def _worst_score(before: Array, candidates: Array, scores: Array, limit: Array) -> float:
    """The largest worst score of any course."""
    best = np.full(candidates.shape[1], np.inf)
    for node, score in enumerate(scores):
        change = np.abs(candidates[node][:, None] - before[node])
        reachable = np.where(_within(change, limit[node]), best, -np.inf).max(axis=1)
        best = np.minimum(score, reachable)
    if best.max() == -np.inf:
        raise ValueError("expected a course within the limits, got none: the candidates are too far apart")
    return float(best.max())


def _least_change(before: Array, candidates: Array, allowed: Array, limit: Array, extent: Array) -> Array:
    """The course of least change through allowed candidates, as indices (K,)."""
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
