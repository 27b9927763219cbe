# SPDX-License-Identifier: LGPL-2.1-or-later
import dataclasses
from concurrent.futures import ThreadPoolExecutor
from functools import cache

import numpy as np
import pytest
from machines import example
from programs import ON_PALLET, cone, program, square_with_arc

from pkm_post.geometry import hermite_accelerations, hermite_speeds
from pkm_post.machine import KnotState, ToolPoses, strut_rates
from pkm_post.machine.kinematics.strut_cubics import tool_deviation
from pkm_post.model.certificate import Tolerances
from pkm_post.planning import interpolate, motion, plan_feed
from pkm_post.planning.knots import deviation
from pkm_post.planning.knots.check_points import Intervals
from pkm_post.planning.knots.choice import LONGEST_MS, even_marks, knots
from pkm_post.planning.knots.interpolation import InterpolationCheck
from pkm_post.planning.knots.places import poses_at
from pkm_post.planning.schedule import by_time
from pkm_post.toolpath.place import place

TOLERANCES = Tolerances(1e-3, np.radians(1e-3))
PATHS = {"lines that turn": cone, "arcs and a helix": square_with_arc}
ROUNDING = 1e-9
"""Of an error by tolerance: 1e-12 mm of 1e-3 mm."""
SHARE_OF_TOLERANCES = 0.4
HIDDEN = 1.25
"""The most that dense instants may find where cubics hold: half as much again is left for it in the tolerances."""
LATE, LATE_S = 0.005, 0.0005
"""Share of an interval, and s, by which a place may be passed too early or too late."""
LITTLE = 0.1
"""Of what cubics may use: a drift that is bounded by it is not added."""
DENSE = np.linspace(0, 1, 103)[1:-1]
STROKED = dataclasses.replace(example(), strut_stroke=(600.0, 2000.0))
GAPS = 8
END_MS = 3000


def upright_scan():
    """A surface of sine waves, scanned with three axes."""
    x = np.linspace(-40, 40, 301)
    return program(np.column_stack([x, 5 * np.cos(x / 9), 60 + 4 * np.sin(x / 3)]))


JOBS = PATHS | {"three axes": upright_scan}


def planned(make, machine=None):
    feed_plan = feed_plan_of(make, machine) if machine else example_plan(make)
    return machine or example(), feed_plan.path, feed_plan.schedule


@cache
def example_plan(make):
    """The feed plan of one of the jobs on the example machine."""
    return feed_plan_of(make, example())


@cache
def example_motion(make):
    """Its motion."""
    return interpolate(example_plan(make)).motion


def feed_plan_of(make, machine):
    trajectory, _ = place(make(), machine, ON_PALLET)
    feed_plan, faults = plan_feed(trajectory, machine, TOLERANCES)
    assert not faults
    return feed_plan


def cubics_of(machine, path, schedule, marks):
    return InterpolationCheck(path, schedule, machine, TOLERANCES, marks)


def intervals(schedule, count=600):
    """Intervals of 1 to 1024 ms all over the motion, short ones more often."""
    rng = np.random.default_rng(21)
    duration = np.rint(np.exp2(rng.uniform(0, 10, count))).astype(np.int64)
    start = rng.integers(0, schedule.rests_ms[-1] - duration)
    return start, start + duration


def dense(machine, path, schedule, start, end, late):
    """How far the struts' cubics take tip and axis off the plan at dense instants, by what cubics may use, (N,).

    If they may be late, each instant is compared with the place of the plan, at most ``LATE`` away in time, that fits
    best: the square of the deviation is a parabola by that time, known from three values of it.
    """
    duration = (end - start) / 1000
    time, most = (start[:, None] + (end - start)[:, None] * DENSE) / 1000, (LATE * duration + LATE_S)[:, None]
    ends = [
        KnotState.of(machine, by_time(path.at(s), v, a)) for s, v, a in (schedule.at(ms / 1000) for ms in (start, end))
    ]

    def off(shift):
        at = np.clip(time + shift, start[:, None] / 1000, end[:, None] / 1000)
        poses = path.at(schedule.at(at.ravel())[0])
        inside = ToolPoses(poses.tip, poses.axis, poses.spin, poses.tool_length)
        found = tool_deviation(machine, *ends, inside, duration, DENSE)
        return found.tip / TOLERANCES.tip, found.axis / TOLERANCES.axis

    def by_least_squares(shift, step):
        early, here, late = (np.square(np.stack(off(shift + by))).sum(axis=0) for by in (-step, 0.0, step))
        bend = np.maximum(early - 2 * here + late, 1e-12)
        return np.clip(shift + np.clip(step / 2 * (early - late) / bend, -most, most), -most, most)

    there_is = np.maximum(*off(0.0))
    if late:
        shift = by_least_squares(by_least_squares(np.zeros_like(time), most / 4), most / 64)
        there_is = np.minimum(there_is, np.maximum(*off(shift)))
    return there_is.max(axis=1) / SHARE_OF_TOLERANCES


@pytest.mark.parametrize("make", JOBS.values(), ids=JOBS)
def test_intervals_that_were_asked_for_before_have_the_errors_that_they_have_at_first(make):
    machine, path, schedule = planned(make)
    start, end = intervals(schedule)
    group = np.arange(len(start)) // 3
    again, fresh = (cubics_of(machine, path, schedule, schedule.rests_ms) for _ in range(2))
    in_groups, error = again.error(start, end, group), fresh.error(start, end)
    assert np.any(in_groups < error)
    np.testing.assert_array_equal(again.error(start, end), error)
    np.testing.assert_array_equal(fresh.error(start, end, group), in_groups)


@pytest.mark.slow
@pytest.mark.parametrize("make", JOBS.values(), ids=JOBS)
@pytest.mark.parametrize("singular", [0.0, 0.2], ids=["drift measured", "drift bounded"])
def test_dense_instants_find_little_more_than_was_seen(make, singular):
    machine, path, schedule = planned(make, dataclasses.replace(STROKED, least_singular_value=singular))
    start, end = intervals(schedule, 1500)
    error, there_is = cubics_of(machine, path, schedule, schedule.rests_ms).error(start, end), np.zeros(len(start))
    held, refused = error <= 1, error > 1.5
    enough, rows = np.where(held, error + LITTLE, 1.0), np.flatnonzero(held | refused)
    for late in (False, True):  # the best place is sought where there is more than enough to say
        for part in np.array_split(rows, len(rows) // 50 + 1):
            there_is[part] = dense(machine, path, schedule, start[part], end[part], late)
        rows = rows[there_is[rows] > enough[rows]]
    assert 100 < held.sum() < len(start) - 100
    assert there_is[held].max() < HIDDEN
    assert np.mean(there_is[held] > error[held] + LITTLE) < 0.05
    # what is refused is refused for a reason: it is off, or too fast for the feed or the machine
    assert np.mean(there_is[refused] > 1) > 0.7


def test_a_point_that_sticks_out_is_seen_wherever_it_is():
    # Between points that are passed in less than 2 ms: even a few dozen spread shares of an interval would miss most.
    agile = dataclasses.replace(example(), tip_acceleration=1e6, strut_acceleration=1e6)
    x = np.arange(0, 10, 0.05)
    for row in (50, 63, 77, 101, 138):
        z = np.full(len(x), 60.0)
        z[row] += 1.5 * TOLERANCES.tip
        made = program(np.column_stack([x, 0 * x, z]))
        machine, path, schedule = planned(lambda made=made: made, agile)
        start = np.floor(1000 * schedule.joint_time[row]).astype(np.int64) - np.arange(10, 90)
        assert cubics_of(machine, path, schedule, schedule.rests_ms).error(start, start + 100).min() > 2


def test_the_tip_is_not_faster_than_the_feed_by_more_than_the_swing():
    path, motion = example_plan(cone).path, example_motion(cone)
    wide = np.flatnonzero(np.diff(motion.time_ms) > 1)
    ends = motion.tip[wide], motion.tip_rate[wide], motion.tip[wide + 1], motion.tip_rate[wide + 1]
    speed = hermite_speeds(*ends, np.diff(motion.time_ms)[wide] / 1000, DENSE)
    feed = np.maximum(path.feed[motion.segment[wide]], path.feed[motion.segment[wide + 1]])
    assert np.all(np.linalg.norm(speed, axis=2).max(axis=1) <= 1.0051 * feed)


FEEDS = np.array([np.nan, *4 * [3.0, 90.0]])


def lines_of_two_feeds():
    """Lines straight on, slow and fast by turns, tilting a little."""
    x = np.linspace(-40, 40, 9)
    tilt = np.radians(np.linspace(0, 4, 9))
    axis = np.column_stack([np.sin(tilt), 0 * tilt, np.cos(tilt)])
    return program(np.column_stack([x, 0 * x, 60 + 0 * x]), axis, feed=FEEDS)


@pytest.mark.parametrize("tolerances", [TOLERANCES, Tolerances(0.1, np.radians(1.0))], ids=["narrow", "wide"])
def test_the_tip_keeps_to_a_slow_feed_until_the_faster_line_begins(tolerances):
    """One cubic over both lines is up to 9 % too fast more than a millisecond before the slow one ends."""
    trajectory, _ = place(lines_of_two_feeds(), example(), ON_PALLET)
    feed_plan, faults = plan_feed(trajectory, example(), tolerances)
    assert not faults
    made = interpolate(feed_plan).motion
    ends = made.tip[:-1], made.tip_rate[:-1], made.tip[1:], made.tip_rate[1:]
    duration = np.diff(made.time_ms) / 1000
    speed = np.linalg.norm(hermite_speeds(*ends, duration, DENSE), axis=2)
    time = made.time_ms[:-1, None] / 1000 + duration[:, None] * DENSE
    slow = np.ones(time.shape, dtype=np.bool_)
    for row in np.flatnonzero(trajectory.feed > 3):
        begin = made.joint_time[row - 1] if row else 0.0
        slow &= (time < begin - 0.001) | (time > made.joint_time[row] + 0.001)
    assert slow.sum() > 200
    assert speed[slow].max() <= 1.05 * 3


@pytest.mark.parametrize("limit", ["strut_speed", "strut_acceleration"])
@pytest.mark.parametrize("make", JOBS.values(), ids=JOBS)
def test_a_strut_beyond_its_limit_is_reported(make, limit):
    machine, path, schedule = planned(make)
    start, end = intervals(schedule)
    slow = dataclasses.replace(machine, **{limit: 10.0})
    error = cubics_of(slow, path, schedule, schedule.rests_ms).error(start, end)
    first, last = (strut_rates(machine, poses_at(path, schedule, ms)) for ms in (start, end))
    struts = first[0], first[1], last[0], last[1], (end - start) / 1000
    most = {
        "strut_speed": np.abs(hermite_speeds(*struts, DENSE)).max(axis=(1, 2)),
        "strut_acceleration": np.abs(hermite_accelerations(*struts)).max(axis=(0, 2)),
    }[limit]
    assert np.sum(most > 10) > 10
    assert error[most > 10.0].min() > 1


@pytest.mark.parametrize("make", PATHS.values(), ids=PATHS)
@pytest.mark.parametrize("places", [40, 1000])
def test_passes_of_other_sizes_find_the_same(monkeypatch, make, places):
    machine, path, schedule = planned(make)
    start, end = intervals(schedule)
    expected = cubics_of(machine, path, schedule, schedule.rests_ms).error(start, end)
    monkeypatch.setattr(deviation, "_POINTS_AT_ONCE", places)
    found = cubics_of(machine, path, schedule, schedule.rests_ms).error(start, end)
    np.testing.assert_allclose(found, expected, rtol=ROUNDING, atol=ROUNDING)


def test_what_is_kept_of_ends_does_not_matter():
    machine, path, schedule = planned(cone)
    start, end = intervals(schedule)
    kept = cubics_of(machine, path, schedule, schedule.rests_ms)
    kept.error(start[::2], end[::2])
    new = cubics_of(machine, path, schedule, schedule.rests_ms)
    np.testing.assert_allclose(kept.error(start, end), new.error(start, end), rtol=ROUNDING, atol=ROUNDING)


@pytest.mark.slow
@pytest.mark.parametrize("make", PATHS.values(), ids=PATHS)
@pytest.mark.parametrize("stretch_ms", [1, 3000, 10**6])
def test_stretches_of_other_lengths_give_the_same_motion(monkeypatch, make, stretch_ms):
    expected = example_motion(make)
    monkeypatch.setattr(motion, "_STRETCH_MS", stretch_ms)
    found = interpolate(example_plan(make)).motion
    for field in dataclasses.fields(found):
        np.testing.assert_array_equal(getattr(found, field.name), getattr(expected, field.name))


@pytest.mark.slow
@pytest.mark.parametrize("workers", [1, 5])
def test_the_number_of_threads_does_not_matter(monkeypatch, workers):
    feed_plan = example_plan(cone)
    monkeypatch.setattr(motion, "_STRETCH_MS", 1000)
    expected = interpolate(feed_plan).motion
    monkeypatch.setattr(motion, "in_workers", lambda call, items: ThreadPoolExecutor(workers).map(call, items))
    found = interpolate(feed_plan).motion
    np.testing.assert_array_equal(found.time_ms, expected.time_ms)
    np.testing.assert_array_equal(found.tip, expected.tip)


def test_even_marks_cut_a_motion_without_a_trace():
    rests, edges = np.array([0, 1000, 1003, 9000]), np.array([77, 400, 2000])

    def error(start, end, group=None):
        return (end - start) / (10 + start % 50)

    marks = even_marks(rests)
    assert np.isin(rests, marks).all()
    assert np.diff(marks).max() <= LONGEST_MS < np.diff(rests).max()
    whole = knots(marks, edges, error)
    pieces = [knots(marks[first : first + 2], edges, error) for first in range(len(marks) - 1)]
    np.testing.assert_array_equal(np.unique(np.concatenate(pieces)), whole)


def random_joints(seed):
    """Joints at random times, some of them at whole ms, and intervals of 2 to 128 ms."""
    rng = np.random.default_rng(seed)
    joint_time = np.sort(rng.uniform(0.0005, 3, int(rng.integers(1, 400))))
    joint_time[::5] = np.rint(1000 * joint_time[::5]) / 1000
    start = rng.integers(0, END_MS - 10, 200)
    end = np.minimum(start + rng.integers(2, 129, 200), END_MS)
    return np.append(np.unique(joint_time[joint_time < 3]), 3.0), start, end


@pytest.mark.parametrize("seed", range(6))
def test_every_joint_inside_is_a_place_and_no_other(seed):
    joint_time, start, end = random_joints(seed)
    joints = Intervals.of(joint_time, start, end).at_joints(joint_time)
    for row in range(len(start)):
        inside = np.flatnonzero((joint_time > start[row] / 1000) & (joint_time < end[row] / 1000))
        np.testing.assert_array_equal(joints.segment[joints.row == row], inside)
        np.testing.assert_array_equal(joints.time[joints.row == row], joint_time[inside])


@pytest.mark.parametrize("seed", range(6))
def test_places_between_joints_leave_no_wide_gap_and_no_segment_out(seed):
    joint_time, start, end = random_joints(seed)
    intervals = Intervals.of(joint_time, start, end)
    joints, between = intervals.at_joints(joint_time), intervals.between_joints(joint_time, GAPS)
    np.testing.assert_array_equal(intervals.duration, (end - start) / 1000)
    assert np.all(np.diff(between.row) >= 0)
    for row in range(len(start)):
        mine = between.row == row
        np.testing.assert_array_equal(
            np.unique(between.segment[mine]), np.arange(intervals.first[row], intervals.last[row] + 1)
        )
        shares = np.concatenate([[0, 1], joints.share[joints.row == row], between.share[mine]])
        assert np.diff(np.sort(shares)).max() <= 1 / GAPS + ROUNDING
        np.testing.assert_allclose(
            start[row] / 1000 + between.share[mine] * intervals.duration[row], between.time[mine]
        )
    before = np.where(between.segment > 0, joint_time[between.segment - 1], 0.0)
    assert np.all((before <= between.time) & (between.time <= joint_time[between.segment]))


def test_between_two_joints_the_middle_is_a_place():
    joint_time = np.array([0.01, 0.02, 0.03, 0.04, 0.05])
    between = Intervals.of(joint_time, np.array([10]), np.array([50])).between_joints(joint_time, 4)
    np.testing.assert_allclose(between.time, [0.015, 0.025, 0.035, 0.045], atol=1e-15)


def test_the_most_of_an_interval_is_that_of_its_places():
    joint_time, start, end = random_joints(7)
    intervals = Intervals.of(joint_time, start, end)
    joints = intervals.at_joints(joint_time)
    values = np.random.default_rng(8).uniform(1, 2, len(joints.row))
    most = joints.maximum(values, len(start))
    for row in range(len(start)):
        assert most[row] == values[joints.row == row].max(initial=0.0)
    assert (most == 0).any()
    np.testing.assert_array_equal(intervals[np.array([3, 5])].start, start[[3, 5]])
    assert len(intervals[np.array([], dtype=int)].at_joints(joint_time).maximum(np.empty(0), 0)) == 0


def test_some_of_the_joints_are_spread_over_each_interval():
    """All where there are no more than asked for; else so many, of even parts of them each the one in the middle."""
    joint_time = np.arange(1, 1001) / 1000
    intervals = Intervals.of(joint_time, np.array([0, 100, 300]), np.array([4, 151, 301]))
    every, some = intervals.at_joints(joint_time), intervals.at_joints(joint_time, 5)
    np.testing.assert_array_equal(np.bincount(every.row, minlength=3), [3, 50, 0])
    np.testing.assert_array_equal(np.bincount(some.row, minlength=3), [3, 5, 0])
    np.testing.assert_array_equal(some.segment[:3], every.segment[:3])
    np.testing.assert_array_equal(some.segment[3:] - every.segment[3], [5, 15, 25, 35, 45])
