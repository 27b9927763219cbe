# SPDX-License-Identifier: LGPL-2.1-or-later
"""Nearness of segments: distances against a search, and the tree against all pairs."""

import numpy as np
import pytest

from pkm_post.geometry import segment_to_segment
from pkm_post.toolpath.compensation.proximity import Chords, close_pairs

ROUNDING = 1e-9


def table(points, contour=0, clearance=1.0, height=None):
    points = np.asarray(points, dtype=float)
    count = len(points) - 1
    height = np.zeros(count) if height is None else height
    numbers = np.full(count, contour)
    return Chords(points[:-1], points[1:], height, height, np.full(count, clearance), numbers, numbers, np.zeros(count))


def joined(*tables):
    return Chords(**{name: np.concatenate([getattr(t, name) for t in tables]) for name in vars(tables[0])})


def test_distances_are_the_least_of_a_search():
    rng = np.random.default_rng(0)
    a, b, c, d = rng.normal(size=(4, 200, 3))
    share = np.linspace(0, 1, 101)
    left = a[:, None] + share[:, None] * (b - a)[:, None]
    # For each point of the one the nearest of the other in closed form.
    way = (d - c)[:, None]
    foot = np.clip(np.sum((left - c[:, None]) * way, axis=2) / np.sum(way * way, axis=2), 0, 1)
    searched = np.linalg.norm(left - c[:, None] - foot[..., None] * way, axis=2).min(axis=1)
    found = segment_to_segment(a, b, c, d)
    assert np.all(found < searched + ROUNDING)
    np.testing.assert_allclose(found, searched, atol=0.02)


@pytest.mark.parametrize(
    ("segment", "other", "expected"),
    [
        ([[0, 0, 0], [4, 0, 0]], [[1, -1, 0], [1, 1, 0]], 0.0),
        ([[0, 0, 0], [4, 0, 0]], [[1, 2, 0], [9, 2, 0]], 2.0),
        ([[0, 0, 0], [4, 0, 0]], [[7, 4, 0], [9, 4, 0]], 5.0),
        ([[0, 0, 0], [4, 0, 0]], [[2, 3, 0], [2, 3, 0]], 3.0),
        ([[1, 0, 0], [1, 0, 0]], [[1, 0, 2], [1, 0, 2]], 2.0),
    ],
    ids=["crossing", "parallel", "apart", "a point", "two points"],
)
def test_worked_distances(segment, other, expected):
    (a, b), (c, d) = np.array(segment, float), np.array(other, float)
    assert segment_to_segment(a, b, c, d) == pytest.approx(expected, abs=ROUNDING)
    assert segment_to_segment(c, d, a, b) == pytest.approx(expected, abs=ROUNDING)


@pytest.mark.parametrize("counts", [(1, 1), (2, 7), (33, 64), (200, 1), (90, 301)])
def test_the_tree_finds_what_all_pairs_have(counts):
    rng = np.random.default_rng(sum(counts))
    paths, walls = (
        joined(*(
            table(np.cumsum(rng.normal(size=(part + 1, 3)), axis=0), number, rng.uniform(0.5, 3), rng.normal(size=part))
            for number, part in enumerate(np.diff([0, count // 2, count]))
        ))
        for count in counts
    )  # fmt: skip
    here, there, lacking = close_pairs(paths, walls, 0.25)
    i, j = (index.ravel() for index in np.indices(counts))
    distance = segment_to_segment(paths.start[i], paths.end[i], walls.start[j], walls.end[j])
    lacks = np.minimum(paths.clearance[i], walls.clearance[j]) - distance
    near = (lacks > 0.25) & (paths.first[i] == walls.first[j]) & (walls.high[j] >= paths.low[i] - 0.25)
    assert sorted(zip(here, there, strict=True)) == sorted(zip(i[near], j[near], strict=True))
    order = np.lexsort((there, here))
    np.testing.assert_allclose(lacking[order], lacks[near], atol=ROUNDING)


def test_few_pairs_are_looked_at(monkeypatch):
    """Along a circle of 20000 chords and its offset, pairs grow with the length of the path, not with its square."""
    angle = np.linspace(0, 2 * np.pi, 20001)
    circle = np.column_stack([np.cos(angle), np.sin(angle), 0 * angle])
    looked_at = []

    def counted(*points):
        looked_at.append(points[0].size // 3)
        return segment_to_segment(*points)

    monkeypatch.setattr("pkm_post.toolpath.compensation.proximity.segment_to_segment", counted)
    here, _, _ = close_pairs(table(45 * circle, clearance=5.0), table(40 * circle, clearance=5.0), 1e-3)
    assert len(here) == 0
    assert sum(looked_at) < 100 * 20000
