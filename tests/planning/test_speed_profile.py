# SPDX-License-Identifier: LGPL-2.1-or-later
import numpy as np
from machines import example
from programs import ON_PALLET, cone, random_job, square_with_arc

from pkm_post.geometry import angle_between, norm
from pkm_post.planning.speed_profile import speed_profile, stations
from pkm_post.planning.tool_path import ToolPath
from pkm_post.toolpath.place import place

ROUNDING = 1e-9


def paths():
    for made in (cone(), square_with_arc(), *(random_job(np.random.default_rng(seed)) for seed in range(4))):
        yield ToolPath.of(place(made, example(), ON_PALLET)[0], 1e-2, 1e-3)


def test_some_close_segments_have_the_stations_that_all_close_ones_have():
    for path in paths():
        close = np.random.default_rng(5).random(len(path.feed)) < 0.5
        some, every = stations(path, close), stations(path)
        for marks, other in ((some, every), (every, some)):
            of_close = close[marks.segment]
            np.testing.assert_array_equal(marks.u[of_close], other.u[close[other.segment]])
        np.testing.assert_array_equal(some.edges, every.edges)
        np.testing.assert_allclose(some.s[some.rest], path.starts[path.rests], atol=ROUNDING)


def test_between_two_of_few_stations_the_way_is_short_and_its_joints_are_stations():
    for path in paths():
        marks = stations(path, np.zeros(len(path.feed), dtype=bool))
        assert np.all(np.isin(path.starts, marks.s))
        poses = path.within(marks.segment, marks.u)
        assert np.all(norm(np.diff(poses.tip, axis=0)) <= 5.0 + ROUNDING)
        turn = angle_between(poses.axis[1:], poses.axis[:-1])
        assert np.degrees(turn.max()) <= 1.0 + 0.2  # the path is rounded at the ends of a cell


def test_edges_are_where_blends_begin_and_end():
    for path in paths():
        marks = stations(path)
        assert np.all(np.diff(marks.edges) > 0)
        assert np.abs(marks.edges[:, None] - marks.s).min(axis=1).max(initial=0.0) <= ROUNDING
        joint = np.flatnonzero(path.blend)
        np.testing.assert_allclose(marks.edges[1::2] - marks.edges[::2], 2 * path.blend[joint], rtol=1e-6)


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
