# SPDX-License-Identifier: LGPL-2.1-or-later
"""Distances to the solid of a cutter against its outline, sampled."""

import numpy as np
import pytest
from cutters import ALL, BALL, FLAT, profile

from pkm_post.toolpath.compensation.cutter import Profile

ROUNDING = 1e-12
NANOMETRE = 1e-6
TALLEST = 40.0
CUTTERS = pytest.mark.parametrize("cutter", ALL.values(), ids=ALL.keys())


def outline(cutter, top):
    """Points of the outline from the axis to the axis, and the longest step between two of them."""
    side = profile(cutter, top, 2000, 8000)
    across = np.column_stack([np.linspace(side[-1, 0], 0.0, 2000), np.full(2000, top)])
    ring = np.vstack([side, across])
    return ring, np.max(np.linalg.norm(np.diff(ring, axis=0), axis=1))


def winding(point, ring):
    """How often the outline, closed along the axis, turns about the point."""
    away = np.vstack([ring, ring[:1]]) - point
    angle = np.arctan2(away[:, 1], away[:, 0])
    return round(np.sum((np.diff(angle) + np.pi) % (2 * np.pi) - np.pi) / (2 * np.pi))


@CUTTERS
def test_distance_and_side_are_those_of_the_outline(cutter):
    solid = Profile.of(cutter, TALLEST)
    ring, step = outline(cutter, solid.top)
    rng = np.random.default_rng(1)
    points = np.column_stack([rng.uniform(0.01, 25.0, 300), rng.uniform(-10.0, TALLEST + 10.0, 300)])
    found = solid.distance(*points.T)
    expected = np.array([np.min(np.linalg.norm(ring - point, axis=1)) for point in points])
    # Between two samples the outline is nearer than both; its bend does little on so short a step.
    assert np.all(np.abs(found) <= expected + ROUNDING)
    assert np.all(np.abs(found) >= np.sqrt(np.maximum(expected**2 - (step / 2) ** 2, 0.0)) - NANOMETRE)
    assert np.array_equal(found < 0, [winding(point, ring) != 0 for point in points])


@CUTTERS
def test_no_distance_changes_faster_than_the_way(cutter):
    solid = Profile.of(cutter, TALLEST)
    rng = np.random.default_rng(2)
    points = np.column_stack([rng.uniform(0.0, 20.0, 2000), rng.uniform(-5.0, 50.0, 2000)])
    other = np.abs(points + rng.normal(0.0, 1.0, points.shape) * [1, 0]) + rng.normal(0.0, 1.0, points.shape) * [0, 1]
    change = np.abs(solid.distance(*points.T) - solid.distance(*other.T))
    assert np.all(change <= np.linalg.norm(points - other, axis=1) + 1e-9)


def test_numbers_of_a_ball_and_a_flat():
    radius, level = np.array([0.0, 3.0, 0.0, 7.0]), np.array([0.0, 1.0, -2.0, 20.0])
    ball, flat = Profile.of(BALL, TALLEST), Profile.of(FLAT, TALLEST)
    assert ball.distance(radius, level) == pytest.approx([0.0, 0.0, 2.0, 2.0], abs=ROUNDING)
    assert flat.distance(radius, level) == pytest.approx([0.0, -1.0, 2.0, 2.0], abs=ROUNDING)
    assert flat.reach == pytest.approx(np.hypot(5.0, TALLEST))


def test_cutter_ends_at_its_height_or_where_its_side_closes():
    assert Profile.of(ALL["dovetail"], TALLEST).top == 12.0
    closing = Profile.of(ALL["dovetail"].apt(16.0, 1.0, b=np.radians(-60.0)), TALLEST)
    assert closing.distance(np.array([0.0]), np.array([closing.top])) == pytest.approx([0.0], abs=1e-9)
    assert closing.top == pytest.approx(8.0 * np.tan(np.radians(30.0)), abs=1e-9)
