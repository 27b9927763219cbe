# SPDX-License-Identifier: LGPL-2.1-or-later
"""Plans of moves by hand: certified, looked at once more from the lengths alone, and refused by either."""

import dataclasses

import numpy as np
import pytest
from station import MACHINE, SETTINGS, TOOL

from pkm_post.control.numerical_control.control import TOLERANCES
from pkm_post.control.numerical_control.manual_moves import CartesianJog, StrutJog, jog_trajectory
from pkm_post.control.numerical_control.mdi import mdi_trajectory
from pkm_post.control.numerical_control.plan import _end_pose, planned
from pkm_post.model import EventKind
from pkm_post.toolpath import ToolPose

MICRON = 1e-3
HERE = ToolPose(np.array([10.0, -20.0, 280.0]), np.array([0.0, 0.0, 1.0]), 0.02)


def way(jog=CartesianJog((15, 0, 0), (0.1, 0.0))):  # noqa: B008 - frozen
    return jog_trajectory(jog, MACHINE, HERE, TOOL, 10.0)[0]


def test_a_plan_is_certified_and_ends_where_it_was_asked_to():
    plan, reported = planned(way(), MACHINE, SETTINGS, TOLERANCES)
    assert reported == () and plan.certificate.holds and plan.job.program.number == 999
    assert np.allclose(plan.end.tip, [25, -20, 280], atol=MICRON) and plan.end.spin == pytest.approx(0.02, abs=1e-5)
    assert plan.seconds >= 1.5  # 15 mm at 10 mm/s
    assert not plan.job.motion.speed[[0, -1]].any() and not plan.job.motion.events


def test_the_poses_of_the_lengths_are_looked_at_by_themselves():
    """The same lengths on a machine whose joints may swing less: only the last check finds it."""
    trajectory = way()
    plan, _ = planned(trajectory, MACHINE, SETTINGS, TOLERANCES)
    narrow = dataclasses.replace(MACHINE, platform_cone=np.full(6, np.radians(1.0)))
    end, reported = _end_pose(plan.job.motion, trajectory, narrow)
    assert end is not None and {fault.code for fault in reported} == {"K104"}


def test_lengths_that_lead_nowhere_are_refused():
    trajectory = way()
    motion = planned(trajectory, MACHINE, SETTINGS, TOLERANCES)[0].job.motion
    length = motion.length.copy()
    length[-1] = [750.0, 1250, 750, 1250, 750, 1250]
    end, reported = _end_pose(dataclasses.replace(motion, length=length), trajectory, MACHINE)
    assert end is None and [fault.code for fault in reported] == ["V107"]


def test_the_feed_is_kept_and_limited():
    slow, fast = (jog_trajectory(CartesianJog((5, 0, 0)), MACHINE, HERE, TOOL, feed)[0] for feed in (3.0, 1e6))
    assert slow.feed.tolist() == [3.0] and fast.feed.tolist() == [MACHINE.feed_speed]
    for feed in (0.0, -1.0, np.nan, np.inf):
        with pytest.raises(ValueError, match="feed: expected a number above zero"):
            jog_trajectory(CartesianJog((5, 0, 0)), MACHINE, HERE, TOOL, feed)


@pytest.mark.parametrize("jog", [CartesianJog((np.nan, 0, 0)), CartesianJog(spin=np.inf), StrutJog(2, np.nan)])
def test_jogs_are_finite(jog):
    with pytest.raises(ValueError, match="expected"):
        way(jog)


@pytest.mark.parametrize("strut", [0, 7])
def test_there_are_six_struts(strut):
    with pytest.raises(ValueError, match="strut: expected 1 to 6"):
        StrutJog(strut, 1.0)


def test_a_plan_is_one_program():
    line = "G91 G82 X5 Y0 Z-8 R-2 P0.1 L3 F600"  # three holes, a dwell in each: it could be cut there
    trajectory, reported = mdi_trajectory(line, MACHINE, HERE, TOOL)
    assert trajectory is not None and not reported
    assert planned(trajectory, MACHINE, SETTINGS, TOLERANCES)[0] is not None
    small = dataclasses.replace(SETTINGS, memory_words=700)
    plan, reported = planned(trajectory, MACHINE, small, TOLERANCES)
    assert plan is None and [fault.code for fault in reported] == ["C204"]


def test_a_line_may_have_codes_of_the_machine():
    codes = MACHINE.controller["codes"] | {"M21": "P7003=21"}
    machine = dataclasses.replace(MACHINE, controller=MACHINE.controller | {"codes": codes})
    settings = dataclasses.replace(SETTINGS, codes=codes)
    trajectory, reported = mdi_trajectory("M21", machine, HERE, TOOL)
    assert [(each.kind, each.value) for each in trajectory.events] == [(EventKind.FUNCTION, 21.0)] and not reported
    plan, reported = planned(trajectory, machine, settings, TOLERANCES)
    assert reported == () and "P7003=21" in plan.job.program.lines
    for line, where, code in (("M21", MACHINE, "C224"), ("G0 X15 M21", machine, "G437")):
        trajectory, reported = mdi_trajectory(line, where, HERE, TOOL)
        assert trajectory is None and [fault.code for fault in reported] == [code]


def test_a_plan_without_room():
    plan, reported = planned(way(), MACHINE, dataclasses.replace(SETTINGS, memory_words=100), TOLERANCES)
    assert plan is None and [fault.code for fault in reported] == ["C102"]
