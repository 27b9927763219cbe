# SPDX-License-Identifier: LGPL-2.1-or-later
import numpy as np

from pkm_post.geometry import hermite_accelerations
from pkm_post.planning.limits import PLANNED_SHARE, Bounded, limits


def test_limits_hold_for_every_speed_and_acceleration_they_allow():
    rng = np.random.default_rng(61)
    first, second = rng.normal(size=(500, 6)), rng.normal(size=(500, 6)) / 10
    item = Bounded(first, second, speed=20.0, acceleration=300.0, each=True)
    square, along = limits(np.full(500, 50.0), [item])
    assert (np.sqrt(square)[:, None] * np.abs(first)).max() <= 20 + 1e-9
    for share in (0.0, 0.3, 1.0):
        for sign in (-1, 1):
            total = first * sign * along[:, None] + second * share * square[:, None]
            assert np.abs(total).max() <= PLANNED_SHARE * 300 + 1e-9


def test_a_vector_is_limited_as_a_whole():
    item = Bounded(np.array([[3.0, 4.0, 0.0]]), np.zeros((1, 3)), speed=10.0, acceleration=np.inf, each=False)
    square, _ = limits(np.array([100.0]), [item])
    np.testing.assert_allclose(square, 4.0)


def test_a_rate_that_drops_to_nothing_keeps_its_limit_between_stations():
    # From one station to the next v^2 is linear and, in a blend, y' at most linear: their product bulges in between.
    size = np.array([2.0, 2.0, 1.0, 0.01, 0.01, 0.5, 3.0])[:, None]
    square, _ = limits(np.full(7, 1e4), [Bounded(size, 0 * size, speed=5.0, acceleration=np.inf, each=False)])
    share = np.linspace(0, 1, 101)[:, None]
    squares = square[:-1] + share * np.diff(square)
    sizes = size[:-1, 0] + share * np.diff(size[:, 0])
    assert (sizes * np.sqrt(squares)).max() <= 5.0 * (1 + 1e-12)
    at_station = (5.0 / size[:, 0]) ** 2
    assert (sizes * np.sqrt(at_station[:-1] + share * np.diff(at_station))).max() > 3 * 5.0  # with none of that


def test_planned_share_leaves_room_for_the_overshoot_of_a_cubic():
    # Full acceleration that switches to full braking inside one interval; every switching time is tried. The integral
    # of |4 - 6x| over the interval, 5/3, is the bound for any such plan.
    worst = 0.0
    for x in np.linspace(0, 1, 1001):
        v1 = x - (1 - x)
        p1 = x**2 / 2 + x * (1 - x) - (1 - x) ** 2 / 2
        row = [np.full((1, 6), value) for value in (0.0, 0.0, p1, v1)]
        first, last = hermite_accelerations(*row, np.ones(1))
        worst = max(worst, np.abs(first).max(), np.abs(last).max())
    np.testing.assert_allclose(worst, 5 / 3, atol=1e-5)
    assert worst * PLANNED_SHARE <= 1 + 1e-9
