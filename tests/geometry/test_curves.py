# SPDX-License-Identifier: LGPL-2.1-or-later
import numpy as np

from pkm_post.geometry import (
    arc_points,
    arc_sweep,
    arc_turning_points,
    hermite_accelerations,
    hermite_column_speeds,
    hermite_columns,
    hermite_lengths,
    hermite_speeds,
    unit,
)
from pkm_post.geometry.curves import arc_length

UP = np.array([[0.0, 0, 1]])
ORIGIN = np.zeros((1, 3))


def sweep_deg(start, end, axis=UP):
    return np.degrees(arc_sweep(np.array([start], float), np.array([end], float), ORIGIN, axis))[0]


def test_quarter_and_three_quarters():
    np.testing.assert_allclose(sweep_deg((5, 0, 0), (0, 5, 0)), 90)
    np.testing.assert_allclose(sweep_deg((5, 0, 0), (0, 5, 0), -UP), 270)


def test_start_equal_to_end_is_a_full_turn_also_on_a_helix():
    np.testing.assert_allclose(sweep_deg((5, 0, 0), (5, 0, 0)), 360)
    np.testing.assert_allclose(sweep_deg((5, 0, 0), (5, 0, 3)), 360)


def test_points_end_where_the_arc_ends():
    rng = np.random.default_rng(21)
    axis, centre = unit(rng.normal(size=(200, 3))), rng.normal(size=(200, 3))
    start = centre + rng.normal(size=(200, 3)) * 10
    sweep, rise = rng.uniform(0.01, 6.2, 200), rng.normal(size=200)
    end = arc_points(start, centre, axis, sweep, rise)
    np.testing.assert_allclose(arc_sweep(start, end, centre, axis), sweep, atol=1e-12)


def test_no_point_of_an_oblique_helix_is_beyond_its_ends_and_turning_points():
    rng = np.random.default_rng(22)
    axis, centre = unit(rng.normal(size=(200, 3))), rng.normal(size=(200, 3))
    start = centre + rng.normal(size=(200, 3)) * 10
    sweep, rise = rng.uniform(0.01, 6.2, 200), rng.normal(size=200) * 20
    end = arc_points(start, centre, axis, sweep, rise)
    places = np.stack([start, end, *arc_turning_points(start, end, centre, axis, sweep)])
    share = np.linspace(0, 1, 4001)[:, None]
    points = arc_points(start, centre, axis, share * sweep, share * rise)
    beyond = np.maximum(places.min(0) - points.min(0), points.max(0) - places.max(0))
    inside = np.maximum(points.min(0) - places.min(0), places.max(0) - points.max(0))
    assert beyond.max() < 1e-12
    assert inside.max() < 1e-4  # mm: the sag between two of the points


def test_length_of_a_helix():
    start, end = np.array([[10.0, 0, 0]]), np.array([[10.0, 0, 4]])
    np.testing.assert_allclose(arc_length(start, end, ORIGIN, UP), np.hypot(20 * np.pi, 4))


def cubic(t):
    """A cubic of each strut; a Hermite segment through its ends must be this very cubic."""
    c = np.random.default_rng(31).normal(size=(4, 6))
    return (
        c[0] + t * (c[1] + t * (c[2] + t * c[3])),
        c[1] + t * (2 * c[2] + 3 * t * c[3]),
        2 * c[2] + 6 * t * c[3],
    )


def test_a_cubic_is_reproduced():
    (p0, v0, a0), (p1, v1, a1) = cubic(0.5), cubic(2.5)
    ends = p0[None], v0[None], p1[None], v1[None], np.array([2.0])
    share = np.linspace(0, 1, 9)
    expected = [cubic(0.5 + 2 * x) for x in share]
    np.testing.assert_allclose(hermite_lengths(*ends, share)[0], [row[0] for row in expected], atol=1e-12)
    np.testing.assert_allclose(hermite_speeds(*ends, share)[0], [row[1] for row in expected], atol=1e-12)
    first, last = hermite_accelerations(*ends)
    np.testing.assert_allclose(first[0], a0, atol=1e-12)
    np.testing.assert_allclose(last[0], a1, atol=1e-12)


def test_error_on_a_circle_is_the_published_bound():
    # The largest deviation between points h apart is h^4/384 max|f''''|: 1.742 um for a strut that swings 20 mm at
    # 1.5 Hz with max f'''' = 1.08e5 mm/s^4 ... the bound alone, 1.757 um, is for the worst phase of the sine.
    h, omega, radius = 0.05, 2 * np.pi * 1.5, 13.7
    t = np.arange(0, 1, h)
    column = np.ones((1, 6))
    p, v = radius * np.sin(omega * t)[:, None] * column, radius * omega * np.cos(omega * t)[:, None] * column
    share = np.linspace(0, 1, 33)
    span = np.full(len(t) - 1, h)
    found = hermite_lengths(p[:-1], v[:-1], p[1:], v[1:], span, share)[..., 0]
    true = radius * np.sin(omega * (t[:-1, None] + h * share))
    bound = h**4 / 384 * radius * omega**4
    worst = np.abs(found - true).max()
    assert 0.9 * bound < worst <= bound


def test_columns_are_the_same_as_rows():
    rng = np.random.default_rng(34)
    p0, v0, p1, v1 = rng.normal(size=(4, 50, 7))
    duration, of_all, of_each = rng.uniform(0.001, 0.128, 50), np.linspace(0, 1, 5), rng.uniform(size=(50, 3))
    columns = p0.T, v0.T, p1.T, v1.T, duration
    for share, shares in ((of_all, of_all[:, None]), (of_each, of_each.T)):
        positions, speeds = hermite_columns(*columns, shares), hermite_column_speeds(*columns, shares)
        np.testing.assert_allclose(positions.T, hermite_lengths(p0, v0, p1, v1, duration, share), atol=1e-13)
        np.testing.assert_allclose(speeds.T, hermite_speeds(p0, v0, p1, v1, duration, share), rtol=1e-12, atol=1e-9)
