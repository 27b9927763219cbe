# SPDX-License-Identifier: LGPL-2.1-or-later
"""The simulation of a job: poses and struts at any time agree with each other, with the knots, and with the job."""

import numpy as np
import pytest
from cam_jobs import ARC, BELOW, FIVE_AXIS, ON_EXAMPLE, add_operation, add_tool_controller, job_in_reach

from pkm_post.freecad_app.machine_object import create_machine
from pkm_post.freecad_app.simulation import simulate_job
from pkm_post.machine import strut_lengths
from pkm_post.model import Refused

NANOMETRE = 1e-6
TOLERANCE = 1e-3
"""mm: that of the tip, when a job does not say another one; the cubics of the struts are within it."""
FINE = 1e-4
"""s: step of the finite differences."""


@pytest.fixture
def job(document):
    job = job_in_reach(document, BELOW)
    add_operation(job, ARC, "Arcs")
    add_operation(job, FIVE_AXIS, "Tilted")
    return job


@pytest.fixture
def simulation(job):
    return simulate_job(job)


def times(simulation, count=500):
    return np.sort(np.random.default_rng(3).uniform(0.0, simulation.duration, count))


def test_at_the_knots_are_the_poses_of_the_motion(simulation):
    motion = simulation.motion
    tip, axis, spin, length = simulation.pose_at(motion.time_ms[1:] / 1000.0)
    np.testing.assert_allclose(tip, motion.tip[1:], atol=NANOMETRE)
    np.testing.assert_allclose(axis, motion.axis[1:], atol=1e-9)
    np.testing.assert_allclose(spin, motion.spin[1:], atol=1e-9)
    np.testing.assert_array_equal(length, motion.tool_length[1:])


def test_between_the_knots_the_struts_belong_to_the_poses(simulation):
    seconds = times(simulation)
    lengths, _ = simulation.struts_at(seconds)
    expected = strut_lengths(simulation.machine, *simulation.pose_at(seconds))
    np.testing.assert_allclose(lengths, expected, atol=TOLERANCE)


def test_speeds_are_the_rates_of_the_lengths(simulation):
    seconds = np.clip(times(simulation), FINE, simulation.duration - FINE)
    _, speeds = simulation.struts_at(seconds)
    ahead, behind = (simulation.struts_at(seconds + step)[0] for step in (FINE, -FINE))
    # accelerations jump at knots, by less than the 5000 mm/s^2 of the machine: half a step of that
    np.testing.assert_allclose(speeds, (ahead - behind) / (2 * FINE), atol=5000 * FINE)


def test_it_begins_at_home_and_ends_where_the_job_ends(simulation):
    tip, axis, _, _ = simulation.pose_at(np.array([0.0, simulation.duration, 1e9, -1.0]))
    np.testing.assert_allclose(tip[[0, 3]], np.tile(simulation.trajectory.start_tip, (2, 1)), atol=NANOMETRE)
    # FIVE_AXIS of cam_jobs ends upright at (10, 4, 30), the work offset is 250 above the table
    np.testing.assert_allclose(tip[1:3], np.tile([10.0, 4.0, 280.0], (2, 1)), atol=NANOMETRE)
    np.testing.assert_allclose(axis[1], [0, 0, 1], atol=1e-9)


def test_blocks_follow_each_other_and_are_those_of_the_job(simulation):
    at, seen = 0.0, []
    for _ in range(len(simulation.trajectory)):
        ends = simulation.next_block(at)
        seen.append(simulation.block_at((at + ends) / 2))
        assert simulation.block_before(ends) == at
        at = ends
    assert seen == list(range(len(simulation.trajectory)))
    assert at == pytest.approx(simulation.duration, abs=1e-3)  # knots lie on whole milliseconds
    assert simulation.trajectory.place(simulation.block_at(simulation.duration)).operation == "Tilted"
    assert simulation.next_block(simulation.duration) == simulation.duration
    assert simulation.block_before(0.0) == 0.0


def test_a_job_in_reach_has_no_problem_and_one_out_of_reach_stops_where_it_leaves(job, simulation):
    assert simulation.problems == ()
    job.PostProcessorArgs = ON_EXAMPLE.format("500,0,200")
    found = simulate_job(job)
    assert found.problems
    first = found.problems[0]
    assert first.place.operation in ("Arcs", "Tilted")
    assert found.problem_between(first.time - 1.0, found.duration) == first
    assert found.problem_between(found.duration, found.duration) is None
    struts = [problem for problem in found.problems if problem.text.startswith(("shortest", "longest"))]
    assert struts
    for problem in struts:
        # they are in limits where the player stops, and out of limits before the block ends
        seconds = np.linspace(problem.time, found.next_block(problem.time), 200)
        lengths, _ = found.struts_at(seconds)
        shortest, longest = found.machine.strut_stroke
        outside = (lengths > longest).any(axis=1) | (lengths < shortest).any(axis=1)
        assert outside.any()
        assert not outside[0]


def test_a_problem_is_worst_behind_its_beginning_where_its_tip_is(job):
    job.PostProcessorArgs = ON_EXAMPLE.format("500,0,200")
    found = simulate_job(job)
    for problem in found.problems:
        assert problem.time <= problem.worst_time <= found.duration
        tip, *_ = found.pose_at(np.array([problem.worst_time]))
        block = found.block_at(problem.worst_time)
        begins = found.block_before(problem.worst_time)
        step = (found.next_block(begins) - begins) / 200 * found.trajectory.feed[block]
        assert np.linalg.norm(tip[0] - problem.worst_tip) <= max(step, TOLERANCE)
        assert found.trajectory.place(block) == problem.worst_place


def test_operations_begin_where_the_one_before_ends(simulation):
    assert simulation.operation_begins(0) == (0, 0.0)
    row, begins = simulation.operation_begins(1)
    assert simulation.trajectory.place(row - 1).operation == "Arcs"
    assert simulation.trajectory.place(row).operation == "Tilted"
    moving, dwelling = simulation.operation_times()
    assert begins == pytest.approx(moving[0], abs=1e-9)
    assert dwelling.tolist() == [0.0, 0.0]


def test_an_operation_without_moves_is_where_the_next_one_begins(job):
    add_operation(job, ["G4 P1"], "Dwell")
    add_operation(job, ARC, "Next")
    add_operation(job, ["M9"], "Last")
    found = simulate_job(job)
    dwell, following, last = (found.trajectory.operations.index(name) for name in ("Dwell", "Next", "Last"))
    assert found.operation_begins(dwell) == found.operation_begins(following)
    begins = found.operation_begins(following)[1]
    assert [found.line_begins(dwell, line) for line in (0, 3)] == [begins, begins]
    row, begins = found.operation_begins(last)
    assert (row, found.line_begins(last, 0)) == (len(found.trajectory) - 1, begins)


def test_at_a_tool_change_the_platform_stands_and_the_tip_jumps(job):
    operation = add_operation(job, ["G0 X0 Y0 Z30", "G1 X10 F20"], "Other tool")
    operation.ToolController = add_tool_controller(job, 2)  # gauge length 102, that of the first is 120
    found = simulate_job(job)
    change = int(np.flatnonzero(np.diff(found.motion.tool_length))[0])
    at = found.motion.time_ms[change] / 1000.0
    tip, axis, _, length = found.pose_at(at + np.array([-1e-6, 1e-6]))
    assert length.tolist() == [120.0, 102.0]
    nose = tip + length[:, None] * axis
    np.testing.assert_allclose(nose[1], nose[0], atol=NANOMETRE)
    assert found.tool_at(at + 1e-3).number == 2


def test_the_envelope_holds_all_knots_and_meets_them(simulation):
    for columns in (7, 400, 5000):
        for (least, largest), knots in zip(
            simulation.envelope(columns), (simulation.struts.length, simulation.struts.speed), strict=True
        ):
            assert least.shape == (columns, 6)
            assert np.all(least <= largest)
            np.testing.assert_array_equal(largest.max(axis=0) >= knots.max(axis=0), True)
            np.testing.assert_array_equal(least.min(axis=0) <= knots.min(axis=0), True)
            assert np.all((least[1:] <= largest[:-1]) & (least[:-1] <= largest[1:]))  # neighbours touch


def test_a_machine_object_says_where_it_stands(job):
    machine = create_machine(job.Document, "example_6tps")
    machine.WorkOffset.Base.z = 260
    found = simulate_job(job, machine)
    tip, *_ = found.pose_at(np.array([found.duration]))
    assert tip[0] == pytest.approx([10.0, 4.0, 290.0], abs=NANOMETRE)


def test_a_job_that_cannot_be_read_is_refused(job):
    job.PostProcessorArgs = "--machine no_such_machine"
    with pytest.raises(Refused) as refused:
        simulate_job(job)
    assert [fault.code for fault in refused.value.diagnostics] == ["M101"]
