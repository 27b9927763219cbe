# SPDX-License-Identifier: LGPL-2.1-or-later
import numpy as np
from machines import example
from programs import ON_PALLET, cone, random_job, square_with_arc

from pkm_post.geometry import angle_between, norm
from pkm_post.planning.stations import stations
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
