# SPDX-License-Identifier: LGPL-2.1-or-later
import numpy as np
import pytest

from pkm_post.planning.places import Intervals

GAPS = 8
END_MS = 3000
ROUNDING = 1e-9
"""Of a share."""


def motion(seed):
    """Joints at random times, some of them at whole ms, and intervals of 2 to 128 ms."""
    rng = np.random.default_rng(seed)
    joint_time = np.sort(rng.uniform(0.0005, 3, int(rng.integers(1, 400))))
    joint_time[::5] = np.rint(1000 * joint_time[::5]) / 1000
    start = rng.integers(0, END_MS - 10, 200)
    end = np.minimum(start + rng.integers(2, 129, 200), END_MS)
    return np.append(np.unique(joint_time[joint_time < 3]), 3.0), start, end


@pytest.mark.parametrize("seed", range(6))
def test_every_joint_inside_is_a_place_and_no_other(seed):
    joint_time, start, end = motion(seed)
    joints = Intervals.of(joint_time, start, end).at_joints(joint_time)
    for row in range(len(start)):
        inside = np.flatnonzero((joint_time > start[row] / 1000) & (joint_time < end[row] / 1000))
        np.testing.assert_array_equal(joints.segment[joints.row == row], inside)
        np.testing.assert_array_equal(joints.time[joints.row == row], joint_time[inside])


@pytest.mark.parametrize("seed", range(6))
def test_places_between_joints_leave_no_wide_gap_and_no_segment_out(seed):
    joint_time, start, end = motion(seed)
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
    joint_time, start, end = motion(7)
    intervals = Intervals.of(joint_time, start, end)
    joints = intervals.at_joints(joint_time)
    values = np.random.default_rng(8).uniform(1, 2, len(joints.row))
    most = joints.most(values, len(start))
    for row in range(len(start)):
        assert most[row] == values[joints.row == row].max(initial=0.0)
    assert (most == 0).any()
    np.testing.assert_array_equal(intervals[np.array([3, 5])].start, start[[3, 5]])
    assert len(intervals[np.array([], dtype=int)].at_joints(joint_time).most(np.empty(0), 0)) == 0
