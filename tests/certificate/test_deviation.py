# SPDX-License-Identifier: LGPL-2.1-or-later
import dataclasses

import numpy as np
import pytest
from best_segment import deviation_from_any
from machines import example
from numpy.polynomial import Polynomial
from programs import ON_PALLET, cone, program, square_with_arc

from pkm_post.certificate import tool_spline
from pkm_post.certificate.deviation import FeedRuler, TrajectoryRuler
from pkm_post.geometry import norm, unit
from pkm_post.model import Kind
from pkm_post.model.certificate import Tolerances
from pkm_post.planning import plan
from pkm_post.planning.tool_path import ToolPath
from pkm_post.toolpath.place import place

TOLERANCES = Tolerances(1e-3, np.radians(1e-3))


def poses_on(made, count=3000):
    """A trajectory with poses on it: a path whose corners are rounded by next to nothing."""
    trajectory, _ = place(made, example(), ON_PALLET)
    path = ToolPath.of(trajectory, 1e-12, 1e-12)
    return trajectory, path.at(np.linspace(0, path.starts[-1], count))


def test_poses_on_the_trajectory_do_not_deviate():
    for made in (cone(), square_with_arc()):
        trajectory, poses = poses_on(made)
        tip, axis, _ = TrajectoryRuler(trajectory, TOLERANCES).deviation_from(poses.tip, poses.axis, poses.segment)
        assert tip.max() < 1e-9
        assert axis.max() < 1e-9


def test_a_known_offset_is_found():
    # Shifted across the path, straight up for level moves: the distance is the shift.
    trajectory, poses = poses_on(square_with_arc())
    level = (poses.segment > 1) & (poses.segment < 6)
    tip, axis, _ = TrajectoryRuler(trajectory, TOLERANCES).deviation_from(
        poses.tip[level] + [0, 0, 0.01], unit(poses.axis[level] + [1e-4, 0, 0]), poses.segment[level]
    )
    np.testing.assert_allclose(tip, 0.01, atol=1e-9)
    np.testing.assert_allclose(axis, 1e-4, rtol=1e-6)


def test_against_dense_sampling_of_the_path():
    # The nearest of very many points on the trajectory is an upper bound close to the distance.
    rng = np.random.default_rng(71)
    trajectory, dense = poses_on(square_with_arc(), 60000)
    level = np.flatnonzero((dense.segment > 1) & (dense.segment < 6))
    chosen = rng.choice(level, 100)
    points = dense.tip[chosen] + rng.normal(scale=0.5, size=(100, 3))
    ruler = TrajectoryRuler(trajectory, TOLERANCES)
    found, _ = deviation_from_any(ruler, points, dense.axis[chosen], np.full(100, 2), np.full(100, 5))
    nearest = np.array([norm(dense.tip[level] - point).min() for point in points])
    assert np.all(found <= nearest + 1e-9)
    np.testing.assert_allclose(found, nearest, atol=2e-3)


def test_a_turn_about_the_tool_axis_alone_has_something_to_be_measured_by():
    way, _ = place(program([[0, 0, 60], [10, 0, 60], [20, 0, 60]]), example(), ON_PALLET)
    still = np.array([len(way) - 1])
    columns = {name: getattr(way, name).copy() for name in ("tip", "axis", "spin", "length")}
    columns["tip"][-1], columns["spin"][-1], columns["length"][-1] = way.tip[-2], 0.2, 0.0
    trajectory = dataclasses.replace(way, **columns)
    tip, axis = trajectory.tip[still] + [0, 0, 3e-4], trajectory.axis[still]
    found = TrajectoryRuler(trajectory, TOLERANCES).deviation_from(tip, axis, still)
    np.testing.assert_allclose(found, [[3e-4], [0], [TOLERANCES.tip]], atol=1e-12)


@pytest.mark.parametrize("past", [-1e-3, 1e-6, 1e-4])
@pytest.mark.parametrize(("rise", "tilt"), [(-4.0, 0.0), (-0.0024, 0.0), (-0.002, 0.0), (-0.001, 0.0), (0.0, 5.0)])
def test_both_ends_of_a_full_turn_are_reported_apart(past, rise, tilt):
    start, centre = np.array([0.0, 0, 40]), np.array([5.0, 0, 40])
    blank = np.full((2, 3), np.nan)
    position, kind = [start, start + [0, 0, rise]], [Kind.RAPID, Kind.ARC]
    axis = np.array([[0.0, 0, 1], [np.sin(np.radians(tilt)), 0, np.cos(np.radians(tilt))]])
    around = program(position, axis, kind, centre=np.stack([blank[0], centre]), turn=np.stack([blank[0], [0, 0, 1]]))
    trajectory, _ = place(around, example(), ON_PALLET)
    last = np.array([len(trajectory) - 1])
    tangent = np.array([0.0, -5, 0]) / 5  # of a turn about z that begins at -x of its centre
    for end, pose in (
        (trajectory.tip_before()[last], trajectory.axis_before()[last]),
        (trajectory.tip[last], trajectory.axis[last]),
    ):
        off = TrajectoryRuler(trajectory, TOLERANCES).deviation_from(end + past * tangent, pose, last)
        assert off[0][0] <= abs(past) + 1e-9
        assert off[1][0] <= np.radians(5) * abs(past) / 10


@pytest.mark.parametrize("rise", [-30.0, 2.0, 60.0])
def test_the_nearest_point_of_a_helix_is_not_the_one_at_the_same_angle(rise):
    # A helix is a straight line on its unrolled cylinder: a shift along its axis is off by the cosine of its slope.
    start, centre = np.array([0.0, 0, 40]), np.array([5.0, 0, 40])
    position, kind = [start, centre + [0, 5, rise]], [Kind.RAPID, Kind.ARC]  # three quarters of a turn
    blank = np.full(3, np.nan)
    made = program(position, kind=kind, centre=np.stack([blank, centre]), turn=np.stack([blank, [0, 0, 1.0]]))
    trajectory, poses = poses_on(made, 4000)
    last = np.flatnonzero(poses.segment == len(trajectory) - 1)[500:-500]
    shift, way = 1e-3, 1.5 * np.pi * 5
    found = TrajectoryRuler(trajectory, TOLERANCES).deviation_from(
        poses.tip[last] + [0, 0, shift], poses.axis[last], poses.segment[last]
    )
    np.testing.assert_allclose(found[0], shift * way / np.hypot(way, rise), rtol=1e-3)


@pytest.mark.parametrize(("share", "ahead"), [(0.002, 0.005), (0.998, -0.005), (0.5, 0.005)])
def test_near_the_ends_of_a_steep_full_turn_the_nearest_point_is_found(share, ahead):
    """At the same angle the helix may be farther from the pose than its end, and next to the pose nearer."""
    radius, rise = 0.05, -3.0
    start, centre, blank = np.array([0.0, 0, 40]), np.array([radius, 0, 40]), np.full(3, np.nan)
    position, kind = [start, start + [0, 0, rise]], [Kind.RAPID, Kind.ARC]
    made = program(position, kind=kind, centre=np.stack([blank, centre]), turn=np.stack([blank, [0, 0, 1.0]]))
    trajectory, _ = place(made, example(), ON_PALLET)
    last = np.array([len(trajectory) - 1])
    way = np.append(np.linspace(0, 1, 100_001), share)
    x, y = -radius * np.cos(2 * np.pi * way), -radius * np.sin(2 * np.pi * way)
    helix = trajectory.tip_before()[last] + np.column_stack([x + radius, y, rise * way])
    tangent = np.array([y[-1], -x[-1], 0]) / -radius
    pose = helix[-1] + ahead * tangent
    found = TrajectoryRuler(trajectory, TOLERANCES).deviation_from(pose[None], trajectory.axis[last], last)
    assert found[0][0] == pytest.approx(norm(pose - helix).min(), rel=0.02)


def test_no_other_segment_is_measured_from_than_the_one_that_is_named():
    # A level side after a plunge: measured from the plunge, a pose on it is as far off as it is from their corner.
    trajectory, poses = poses_on(square_with_arc())
    plunge, side = 1, np.flatnonzero(poses.segment == 2)
    off = TrajectoryRuler(trajectory, TOLERANCES).deviation_from(
        poses.tip[side], poses.axis[side], np.full(len(side), plunge)
    )
    np.testing.assert_allclose(off[0], norm(poses.tip[side] - trajectory.tip[plunge]), atol=1e-9)
    assert off[0].max() > 29


def test_what_the_tip_may_be_is_reported_by_segment():
    made = dataclasses.replace(square_with_arc(), tip_tolerance=np.array([0, 0, 0.02, 0, 0.05, 0, 0]))
    trajectory, poses = poses_on(made, 700)
    reported = TrajectoryRuler(trajectory, TOLERANCES).deviation_from(poses.tip, poses.axis, poses.segment)[2]
    said = trajectory.tip_tolerance[poses.segment]
    assert set(np.unique(said)) == {0, 0.02, 0.05}
    np.testing.assert_array_equal(reported, np.where(said > 0, said, TOLERANCES.tip))


def test_no_poses_have_no_deviations():
    trajectory, _ = poses_on(square_with_arc(), 10)
    nothing = TrajectoryRuler(trajectory, TOLERANCES).deviation_from(
        np.empty((0, 3)), np.empty((0, 3)), np.empty(0, dtype=int)
    )
    assert nothing.shape == (3, 0)


def test_what_leaves_a_cubic_does_so_by_no_more_than_the_looks_and_the_factors_say():
    # The factors: quadratics times x^2 (1 - x)^2 are 1 at each look in turn; signs that add up are the worst case.
    share, looks = np.linspace(0, 1, 20001), tool_spline._LOOKS.ravel()
    bases, bends = [], []
    for look in looks:
        others = looks[looks != look]
        quadratic = np.prod([(share - other) / (look - other) for other in others], axis=0)
        bases.append(quadratic * (share * (1 - share) / (look * (1 - look))) ** 2)
        whole = Polynomial.fromroots([*others, 0.0, 0.0, 1.0, 1.0])
        bends.append((whole / whole(look)).deriv(2)(share))
    assert np.abs(bases).sum(axis=0).max() == pytest.approx(1.442, abs=1e-3)
    rates = np.gradient(np.array(bases), share, axis=1)
    assert np.abs(rates).sum(axis=0).max() == pytest.approx(11.153, abs=1e-2)
    assert np.abs(bends).sum(axis=0).max() == pytest.approx(323.56, abs=1e-2)
    with_room = 1.1  # for the change of the Jacobian
    assert with_room * np.abs(bases).sum(axis=0).max() <= tool_spline._MOST
    assert with_room * np.abs(rates).sum(axis=0).max() <= tool_spline._FASTEST
    assert with_room * np.abs(bends).sum(axis=0).max() <= tool_spline._BENDS


def test_where_the_feed_changes_the_slower_one_holds_on_both_sides():
    """From 5 to 50 mm/s and back to 5: on the chord between two instants a change up counts as one down does."""
    made, _ = place(program([[0, 0, 60], [10, 0, 60], [60, 0, 60], [70, 0, 60]]), example(), ON_PALLET)
    trajectory = dataclasses.replace(made, feed=np.append(made.feed[:-3], [5.0, 50.0, 5.0]))
    motion = plan(trajectory, example(), TOLERANCES)[0].motion
    feeds, rows = FeedRuler(trajectory, motion, 0.001), np.arange(len(motion) - 1)
    time = np.linspace(motion.time_ms[:-1], motion.time_ms[1:], 9) / 1000
    _, _, lower = feeds.at_changes(rows, time, np.zeros((3, *time.shape)))
    assert len(lower) == 3  # the rapid before them ends as well
    assert lower.max() < 1.1 * 5.0
