# SPDX-License-Identifier: LGPL-2.1-or-later
"""Simulation in the document: figures by property, what follows, what is kept and what is not."""

import numpy as np
import pytest
from cam_jobs import ARC, BELOW, FIVE_AXIS, ON_EXAMPLE, add_operation, job_in_reach, reopened

from pkm_post.freecad_app.document import is_operation, is_simulation
from pkm_post.freecad_app.machine_object import create_machine
from pkm_post.freecad_app.simulation import simulate_job
from pkm_post.freecad_app.simulation_object import create_simulation, plan_of, present_plan
from pkm_post.model import Refused

MICROSECOND = 1e-6
NANOMETRE = 1e-6


@pytest.fixture
def job(document):
    job = job_in_reach(document, BELOW)
    add_operation(job, ARC, "Arcs")
    add_operation(job, [*FIVE_AXIS, "G4 P1.5"], "Tilted")
    return job


@pytest.fixture
def made(job):
    found = create_simulation(job)
    job.Document.recompute()
    return found


def test_figures_are_quantities_of_the_planned_motion(job, made):
    plan = simulate_job(job)
    assert made.Followable
    assert made.Duration.getValueAs("s").Value == pytest.approx(plan.duration, abs=MICROSECOND)
    assert made.DwellTime.getValueAs("s").Value == pytest.approx(1.5, abs=MICROSECOND)
    assert (made.Blocks, made.Points) == (len(plan.trajectory), len(plan.motion))
    assert made.ShortestStrut.getValueAs("mm").Value == pytest.approx(plan.struts.length.min(), abs=NANOMETRE)
    assert made.LongestStrut.getValueAs("mm").Value == pytest.approx(plan.struts.length.max(), abs=NANOMETRE)
    # looked at closely, no strut is faster than it is said to be, and one is as fast to within a thousandth
    _, speeds = plan.struts_at(np.linspace(0.0, plan.duration, 200_000))
    fastest = np.abs(speeds).max(axis=0)
    reported = made.GreatestStrutSpeed.getValueAs("mm/s").Value
    assert fastest.max() <= reported + NANOMETRE
    assert fastest[made.FastestStrut - 1] == pytest.approx(reported, rel=1e-3)


def test_the_way_is_as_long_as_its_lines_and_arcs(made, job):
    # ARC of cam_jobs, from its first point on: 10 down, half a circle of radius 5, a helix that goes from (10, 0, 0)
    # once around a circle of radius 3 down to -2, and 12 up
    plan = plan_of(made)
    rows = np.flatnonzero(plan.trajectory.operation == 0)[-4:]
    expected = [10.0, 5 * np.pi, np.hypot(2 * np.pi * 3, 2), 12.0]
    np.testing.assert_allclose(plan.trajectory.length[rows], expected, atol=1e-4)
    assert made.WayLength.getValueAs("mm").Value == pytest.approx(plan.trajectory.length.sum(), abs=NANOMETRE)


def test_times_of_the_operations_make_the_whole(made):
    assert list(made.Operations) == ["Arcs", "Tilted"]
    whole = made.Duration.getValueAs("s").Value + made.DwellTime.getValueAs("s").Value
    assert sum(made.OperationTimes) == pytest.approx(whole, abs=1e-3)  # knots lie on whole milliseconds
    # the dwell is in the second one; the joint between them is where the first block of the second begins
    plan = plan_of(made)
    first = int(np.flatnonzero(plan.trajectory.operation == 0)[-1])
    assert made.OperationTimes[0] == pytest.approx(plan.motion.joint_time[first], abs=MICROSECOND)


def test_it_follows_the_job_and_lists_what_cannot_be_followed(job, made):
    job.PostProcessorArgs = ON_EXAMPLE.format("500,0,200")
    job.Document.recompute()
    assert not made.Followable
    count = made.ProblemCount
    assert count == len(made.Problems) > 0
    for name in ("ProblemTimes", "WorstTimes", "WorstOperations", "WorstLines", "WorstPoints"):
        assert len(getattr(made, name)) == count
    assert list(made.ProblemTimes) == sorted(made.ProblemTimes)
    assert all(begin <= worst for begin, worst in zip(made.ProblemTimes, made.WorstTimes, strict=True))
    assert set(made.WorstOperations) <= {"Arcs", "Tilted"}
    # at the worst time the tool is where the worst point is marked, in coordinates of the document
    plan = plan_of(made)
    tips, *_ = plan.pose_at(np.array(made.WorstTimes))
    away = np.linalg.norm(tips - (500.0, 0.0, 200.0) - np.array(made.WorstPoints), axis=1)
    steps = [np.diff(plan.motion.joint_time).max() / 200 * plan.trajectory.feed.max()]
    assert away.max() < steps[0]  # it is found among 200 instants of its block
    made.Active = False
    job.PostProcessorArgs = ON_EXAMPLE.format("0,0,250")
    job.Document.recompute()
    assert made.ProblemCount == count
    made.Active = True
    job.Document.recompute()
    assert made.Followable


def test_a_machine_object_says_what_it_runs_on(job, made):
    machine = create_machine(job.Document, "example_6tps")
    machine.WorkOffset.Base.z = 260
    before = made.LongestStrut.Value
    made.Machine = machine
    job.Document.recompute()
    assert made.LongestStrut.Value != before
    assert plan_of(made).trajectory.machine_from_work[2, 3] == 260.0


def test_a_machine_with_an_error_leaves_no_old_motion(job, made):
    machine = made.Machine = create_machine(job.Document, job=job)
    job.Document.recompute()
    assert present_plan(made) is plan_of(made)
    machine.MachineFile = "no_such_machine"
    job.Document.recompute()
    assert made.isValid()  # FreeCAD leaves it as it was
    assert present_plan(made) is None
    with pytest.raises(Refused, match="M101"):
        plan_of(made)


def test_the_motion_of_a_job_that_changed_while_it_was_inactive_is_planned_anew(job, made):
    made.Active = False
    before, length = plan_of(made), made.LongestStrut
    job.PostProcessorArgs = ON_EXAMPLE.format("0,0,260")
    job.Document.recompute()
    assert made.LongestStrut == length
    assert present_plan(made) is None
    assert plan_of(made).trajectory.machine_from_work[2, 3] == 260.0 != before.trajectory.machine_from_work[2, 3]


def test_a_job_that_cannot_be_read_or_is_gone_leaves_no_old_result(job, made):
    job.PostProcessorArgs = "--machine no_such_machine"
    job.Document.recompute()
    assert not made.isValid()
    assert (made.Duration.Value, list(made.Operations), made.Followable) == (0.0, [], False)
    made.Job = None
    job.Document.recompute()
    assert made.isValid()
    assert made.Duration.Value == 0.0
    with pytest.raises(ValueError, match="expected a job"):
        plan_of(made)


def test_figures_survive_saving_and_the_motion_is_planned_anew(job, made, tmp_path):
    duration, times = made.Duration.Value, list(made.OperationTimes)
    path = tmp_path / "simulation.FCStd"
    again = reopened(job.Document, path).getObject("Simulation")
    assert type(again.Proxy).__module__ == "pkm_post.freecad_app.simulation_object"
    assert again.Proxy.plan is None
    assert (again.Duration.Value, list(again.OperationTimes)) == (duration, times)
    assert plan_of(again).duration == pytest.approx(duration, abs=MICROSECOND)
    assert plan_of(again) is plan_of(again)


def test_one_undo_takes_it_back(job):
    document = job.Document
    document.UndoMode = 1
    document.openTransaction("Simulate")
    create_simulation(job)
    document.commitTransaction()
    document.recompute()
    document.undo()
    assert document.getObject("Simulation") is None


def test_it_is_reported_from_other_objects(job, made):
    assert is_simulation(made)
    assert not is_operation(made)
    assert not any(is_simulation(item) for item in job.Document.Objects if item != made)


def test_undo_and_redo_leave_no_motion_of_another_state(job, made):
    document, operation = job.Document, job.Operations.Group[0]
    document.UndoMode = 1
    shown = [made.Duration.Value]
    document.openTransaction("Edit")
    operation.Gcode = [*ARC, "G1 X40 F5"]
    document.recompute()
    document.commitTransaction()
    shown.append(made.Duration.Value)
    assert plan_of(made).duration == pytest.approx(shown[1], abs=MICROSECOND) != pytest.approx(shown[0], abs=1.0)
    for step, duration in ((document.undo, shown[0]), (document.redo, shown[1])):
        step()
        assert made.Proxy.plan is None
        with pytest.raises(Refused, match="J133"):  # CAM's operations wait for a recompute
            plan_of(made)
        document.recompute()
        assert (made.Duration.Value, plan_of(made).duration) == pytest.approx((duration, duration), abs=MICROSECOND)
