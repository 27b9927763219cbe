# SPDX-License-Identifier: LGPL-2.1-or-later
"""A program starts from its start pose alone, and the way there is planned from where the machine stands."""

import dataclasses
import sys
from pathlib import Path

import numpy as np
import pytest
from station import MACHINE, SETTINGS, START, job

from pkm_post.control.link.errors import NotReadyError
from pkm_post.control.link.program import read_job
from pkm_post.control.link.tool_pose import deviation_from_start, start_faults
from pkm_post.control.numerical_control import manual_moves as moves
from pkm_post.control.numerical_control.control import NumericalControl
from pkm_post.control.numerical_control.manual_moves import CartesianJog
from pkm_post.control.numerical_control.single_block import read_blocks
from pkm_post.machine import strut_lengths
from pkm_post.model import ToolChange
from pkm_post.posting.steps import post
from pkm_post.toolpath import ToolPose
from pkm_post.writing.controllers import pmac

sys.path.insert(0, str(Path(__file__).parents[2]))

from programs import cone  # noqa: E402

TOOL = 120.0
MICRON, COUNT = 1e-3, 1e-4
NANOMETRE = 1e-6
UP = np.array([0.0, 0.0, 1.0])


def lengths_at(tip, axis=UP, spin=0.0, tool=TOOL):
    pose = np.array([tip], float), np.array([axis], float), np.array([spin]), np.array([tool])
    return strut_lengths(MACHINE, *pose)[0]


@pytest.fixture(scope="module")
def posted(tmp_path_factory):
    """A job that was posted: it starts at home."""
    return in_folder(tmp_path_factory.mktemp("job"))[0]


def in_folder(folder):
    """A job that was posted, and its blocks."""
    program = post(cone(40, turns=0.2), MACHINE, folder / "cone.pmc").program
    made, faults = read_job(program.read_text(), SETTINGS, program.name)
    blocks, reported = read_blocks(program, MACHINE)
    assert not faults and not reported
    return made, blocks


def jog(station, **how):
    plan, reported = station.control.plan_jog(CartesianJog(**how), 20.0)
    assert plan is not None, reported
    station.control.execute(plan)
    return station.to_rest()


JOGS = (
    {"shift": (0.0, 0.0, -60.0)},
    {"shift": (0.06, 0.0, 0.0)},
    {"shift": (40.0, -25.0, 30.0), "tilt": (0.15, -0.1), "spin": 0.1},
    {"tilt": (0.0, 0.02)},
    {"spin": 0.02},
)


@pytest.mark.slow
@pytest.mark.parametrize("how", JOGS)
def test_a_program_does_not_start_from_elsewhere_and_does_after_the_planned_approach(station, posted, how):
    station.control.load(posted, lambda done, lines: None, lambda: False)
    jog(station, **how)
    with pytest.raises(NotReadyError, match="the tool is away from the start of the program: tip .* approach"):
        station.control.start(posted)
    assert not station.wire.controller.runs_program()
    plan, reported = station.control.plan_approach(posted, 50.0)
    assert reported == () and plan.certificate.holds
    station.control.execute(plan)
    assert np.allclose(station.to_rest().status.commanded, posted.first, atol=2 * COUNT)
    assert station.control.start(posted).running
    assert np.allclose(station.to_rest(600.0).status.commanded, posted.motion.length[-1], atol=2 * COUNT)


def test_it_tells_how_far_away_the_tool_is(station, posted):
    station.control.load(posted, lambda done, lines: None, lambda: False)
    jog(station, shift=(3.0, 0.0, -4.0), tilt=(0.0, np.radians(2.0)))
    with pytest.raises(NotReadyError) as refused:
        station.control.start(posted)
    reported = next(reason for reason in refused.value.reasons if reason.startswith("the tool is away"))
    assert "tip 5.000 mm, axis 2.0000 degrees, spin " in reported


def test_the_stream_and_single_block_begin_at_the_start_as_well(station, tmp_path):
    from pkm_post.control.link.stream import stream

    posted, blocks = in_folder(tmp_path)
    jog(station, shift=(2.0, 0.0, 0.0))
    session = station.wire.session()
    with pytest.raises(NotReadyError, match="the tool is away from the start"):
        stream(session, SETTINGS, posted.program, posted.first, 2600, 1.9, machine=MACHINE)
    session.close()
    station.control.open_blocks(blocks)
    plan, _ = station.control.plan_step()
    with pytest.raises(NotReadyError, match="the tool is away from the start"):
        station.control.execute(plan)


def test_the_first_point_of_another_program_is_approached(station):
    """Not home: a part of a program, or one that begins elsewhere."""
    other = job(SETTINGS, ())
    first = lengths_at([20.0, 10.0, 280.0], [0.1, 0.0, np.sqrt(0.99)], 0.05)
    length = other.motion.length - START + first
    text = pmac.program_text(dataclasses.replace(other.motion, length=length), SETTINGS, ["other"])
    made, _ = read_job(text, SETTINGS, "other.pmc")
    plan, _ = station.control.plan_approach(made, 50.0)
    assert np.allclose(plan.end.tip, [20.0, 10.0, 280.0], atol=MICRON)
    np.testing.assert_allclose(plan.lengths, made.first, atol=2e-6)


def test_a_machine_at_the_start_has_no_way_to_go(station, posted):
    plan, _ = station.control.plan_approach(posted)
    assert plan is None or np.abs(plan.job.motion.length - posted.first).max() < COUNT
    at_start = ToolPose(np.array([0.0, 0.0, 300.0]), UP, 0.0)
    trajectory, reported = moves.approach_trajectory(MACHINE, at_start, at_start, TOOL, 20.0)
    assert trajectory is None and [fault.code for fault in reported] == ["C201"]


def way(here, start, machine=MACHINE):
    trajectory, reported = moves.approach_trajectory(machine, here, start, TOOL, 20.0)
    assert trajectory is not None, reported
    return trajectory


@pytest.mark.parametrize("seed", range(20))
def test_the_way_goes_up_along_the_axis_and_across_above_everything(seed):
    """Whatever both poses: below the height of the way the tool moves along its axis alone."""
    rng = np.random.default_rng(seed)

    def pose():
        axis = rng.normal(size=3) * [0.2, 0.2, 0] + UP
        return ToolPose(
            rng.uniform([-80, -80, 150], [80, 80, 350]), axis / np.linalg.norm(axis), rng.uniform(-0.2, 0.2)
        )

    here, start, safe = pose(), pose(), rng.uniform(200, 330)
    machine = dataclasses.replace(MACHINE, tool_change=ToolChange(np.array([0, 0, 500.0]), UP, 0.0, safe))
    for stated, height in ((machine, max(safe, start.tip[2])), (MACHINE, start.tip[2])):
        made = way(here, start, stated)
        np.testing.assert_array_equal(made.start_tip, here.tip)
        np.testing.assert_allclose(made.tip[-1], start.tip)
        assert made.spin[-1] == start.spin
        before, axis_before = made.tip_before(), made.axis_before()
        low = np.minimum(before[:, 2], made.tip[:, 2]) < height - NANOMETRE
        along = np.linalg.norm(np.cross(made.tip - before, made.axis), axis=1) < NANOMETRE
        stands = np.linalg.norm(made.axis - axis_before, axis=1) < NANOMETRE
        assert (~low | (along & stands)).all()


def test_a_way_out_of_reach_is_no_plan(station, posted):
    """The checks of planning stand in the way here as everywhere; nothing is sent."""
    narrow = dataclasses.replace(MACHINE, strut_stroke=(1007.5, 1250.0))
    jog(station, shift=(30.0, 0.0, -40.0))
    control = NumericalControl(station.wire.session(), narrow, SETTINGS, TOOL)
    plan, reported = control.plan_approach(posted)
    assert plan is None and "K101" in {fault.code for fault in reported}


def test_a_tool_that_lies_flat_is_not_retracted():
    flat = ToolPose(np.array([0.0, 0.0, 200.0]), np.array([np.sqrt(1 - 0.0081), 0.0, 0.09]), 0.0)
    trajectory, reported = moves.approach_trajectory(
        MACHINE, flat, ToolPose(np.array([0.0, 0, 300]), UP, 0.0), TOOL, 20.0
    )
    assert trajectory is None and [fault.code for fault in reported] == ["K142"]


def test_how_far_away_is_a_matter_of_poses():
    first = lengths_at([0, 0, 300])
    away = deviation_from_start(MACHINE, lengths_at([3, 4, 300], spin=np.radians(2)), first)
    assert away.tip == pytest.approx(5, abs=MICRON) and away.spin == pytest.approx(np.radians(2), abs=1e-6)
    assert away.axis < 1e-6
    assert start_faults(MACHINE, first + 0.01, first, 0.05) == ()
    # a hundredth of a degree at the characteristic length of 200 mm is 0.035 mm, two hundredths are 0.07 mm
    assert start_faults(MACHINE, lengths_at([0, 0, 300], spin=np.radians(0.01)), first, 0.05) == ()
    assert start_faults(MACHINE, lengths_at([0, 0, 300], spin=np.radians(0.02)), first, 0.05)
    assert "no pose" in start_faults(MACHINE, np.full(6, np.nan), first, 0.05)[0]


def test_a_line_by_hand_goes_straight_whatever_the_safe_height(station):
    """What a program does on its way from home is not what a typed line asks for."""
    from pkm_post.control.numerical_control.mdi import mdi_trajectory

    pose = ToolChange(np.array([0.0, 0.0, 500.0]), UP, 0.0, 290.0)
    machine = dataclasses.replace(MACHINE, tool_change=pose, spin_up_time=2.0, largest_tool_diameter=40.0)
    here = ToolPose(np.array([0.0, 0.0, 200.0]), UP, 0.0)
    trajectory, reported = mdi_trajectory("G0 X10", machine, here, TOOL)
    assert reported == () and len(trajectory) == 1 and trajectory.operations == ("",)
    np.testing.assert_allclose(trajectory.tip, [[10.0, 0.0, 200.0]], atol=1e-6)
    started, _ = mdi_trajectory("S12000 M3 G0 X10", machine, here, TOOL)
    assert [event.value for event in started.events] == [12000.0, 1.0]
