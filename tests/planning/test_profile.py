# SPDX-License-Identifier: LGPL-2.1-or-later
import numpy as np

from pkm_post.planning.profile import speed_profile


def slow_profile(s, ceiling, acceleration):
    """The same two passes written as plain loops: the independent answer."""
    x = ceiling.copy()
    cell = np.minimum(acceleration[1:], acceleration[:-1])
    for i in range(len(s) - 1):
        x[i + 1] = min(x[i + 1], x[i] + 2 * cell[i] * (s[i + 1] - s[i]))
    for i in range(len(s) - 2, -1, -1):
        x[i] = min(x[i], x[i + 1] + 2 * cell[i] * (s[i + 1] - s[i]))
    return x


def test_against_plain_loops():
    rng = np.random.default_rng(51)
    for _ in range(50):
        s = np.cumsum(rng.uniform(0.01, 2, 300))
        ceiling, acceleration = rng.uniform(0, 900, 300), rng.uniform(10, 3000, 300)
        ceiling[[0, -1, 100]] = 0
        np.testing.assert_allclose(
            speed_profile(s, ceiling, acceleration), slow_profile(s, ceiling, acceleration), atol=1e-8
        )


def test_what_is_slow_behind_what_is_fast_never_stands_still():
    """A feed of 6e-5 mm/min, v^2 = 1e-12, where the sum of the slopes is 1e8: their difference has no digit of it."""
    s = np.array([0.0, 10000.0, 20000.0, 20000.001, 20000.002])
    ceiling = np.array([0.0, 6e4, 1e-12, 1e-12, 0.0])
    found = speed_profile(s, ceiling, np.full(5, 5000.0))
    assert found[1] == 6e4 and found[2:4].tolist() == [1e-12, 1e-12] and found[[0, -1]].tolist() == [0.0, 0.0]


def test_a_long_straight_is_a_trapezoid():
    # 100 mm at 20 mm/s with 100 mm/s^2: v^2 = 2 a s until 400 at s = 2 mm, and the same before the end.
    s = np.linspace(0, 100, 1001)
    ceiling = np.full(1001, 400.0)
    ceiling[[0, -1]] = 0
    found = speed_profile(s, ceiling, np.full(1001, 100.0))
    np.testing.assert_allclose(found, np.minimum(400, np.minimum(200 * s, 200 * (100 - s))), atol=1e-9)
