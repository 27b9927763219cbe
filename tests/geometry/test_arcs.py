# SPDX-License-Identifier: LGPL-2.1-or-later
import numpy as np

from pkm_post.geometry import arc_points, arc_sweep, unit
from pkm_post.geometry.arcs import arc_length

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


def test_length_of_a_helix():
    start, end = np.array([[10.0, 0, 0]]), np.array([[10.0, 0, 4]])
    np.testing.assert_allclose(arc_length(start, end, ORIGIN, UP), np.hypot(20 * np.pi, 4))
