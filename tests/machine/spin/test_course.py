# SPDX-License-Identifier: LGPL-2.1-or-later
"""The best course against every course there is."""

import itertools

import numpy as np
import pytest

from pkm_post.machine.spin.optimise import best_sequence


def by_trying(candidates, scores, start, limit, extent):
    """Worst score and change of the best of all courses within the limits."""
    nodes, choices = candidates.shape
    found = []
    for course in itertools.product(range(choices), repeat=nodes):
        values = candidates[np.arange(nodes), list(course)]
        change = np.abs(np.diff(values, prepend=start))
        if (change <= limit * (1 + 1e-9)).all():
            found.append((-scores[np.arange(nodes), list(course)].min(), (change**2 / extent).sum()))
    return min(found)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(25))
def test_against_every_course(seed):
    random = np.random.default_rng(seed)
    candidates = np.tile(np.arange(-2.0, 3.0), (5, 1))
    scores = random.integers(0, 6, candidates.shape).astype(float)
    limit, extent = random.uniform(0.5, 3.0, 5), random.uniform(0.5, 2.0, 5)
    course = best_sequence(candidates, scores, 0.0, limit, extent)
    values = candidates[np.arange(5), course]
    change = np.abs(np.diff(values, prepend=0.0))
    worst, cost = by_trying(candidates, scores, 0.0, limit, extent)
    assert (change <= limit * (1 + 1e-9)).all()
    assert scores[np.arange(5), course].min() == -worst
    assert (change**2 / extent).sum() == pytest.approx(cost)


def test_a_choice_that_looks_best_is_not_taken_into_a_dead_end():
    scores = np.array([[0.0, 5.0, 9.0], [9.0, 5.0, 0.0]])
    assert best_sequence(np.tile([-1.0, 0.0, 1.0], (2, 1)), scores, 0.0, np.ones(2), np.ones(2)).tolist() == [1, 1]


def test_candidates_out_of_reach_are_a_fault_of_the_caller():
    with pytest.raises(ValueError, match="too far apart"):
        best_sequence(np.array([[5.0]]), np.ones((1, 1)), 0.0, np.ones(1), np.ones(1))
