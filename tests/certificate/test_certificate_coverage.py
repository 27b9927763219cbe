# SPDX-License-Identifier: LGPL-2.1-or-later
"""Every entry of a machine file is certified, checked elsewhere, or no limit: a new one has to be put somewhere."""

import dataclasses
from dataclasses import replace

import machines
import numpy as np
import pytest
from posted_jobs import NARROW, of, preset
from programs import ON_PALLET, TOOLS, cone, program, random_job, tapped_hole

from pkm_post.certificate.coverage import CERTIFIED, CHECKED_ELSEWHERE, coverage
from pkm_post.machine import find_machine
from pkm_post.machine.description.fields import FIELDS
from pkm_post.machine.description.reader import read_machine
from pkm_post.model import Event, EventKind, SpindleAxis
from pkm_post.model.certificate import Extent, Topic, coverage_summary
from pkm_post.toolpath.place import place

TRAJECTORY = place(cone(9), machines.example(), ON_PALLET)[0]
CHANGES = (Event(0, EventKind.TOOL_CHANGE, 1), Event(1, EventKind.TOOL_CHANGE, 2), Event(1, EventKind.SPINDLE, 500.0))
NO_LIMITS = {
    "name", "description", "units.length", "units.angle", "units.time", "base.joints", "platform.joints",
    "platform.spindle_nose", "struts.length_offset", "struts.screw_lead", "struts.tube_radius", "struts.tube_length",
    "struts.rod_radius", "struts.rod_length", "struts.stiffness", "struts.rigidity", "joints.base_kind",
    "joints.platform_kind", "joints.rest_pose", "joints.rest_tool_length", "joints.base_rest", "joints.platform_rest",
    "joints.base_axes", "joints.platform_axes", "interference.base_joint_radius",
    "interference.platform_joint_radius", "interference.bodies", "interference.fixtures",
    "singularity.characteristic_length", "tool_path.home_tip", "tool_path.home_axis", "tool_path.home_spin",
    "struts.velocity_gain", "tool_change.nose", "tool_change.axis", "tool_change.spin",
    "work_offsets.*.origin", "work_offsets.*.rotation_z", "work_offsets.*.matrix", "part_programs.machine_zero",
    "part_programs.leave_out", "part_programs.tool_table", "part_programs.optional_stops", "controller.kind",
    "controller.letters", "controller.coordinate_system", "controller.program", "controller.length_decimals",
    "controller.speed_decimals", "controller.counts_per_mm", "controller.zero_length", "controller.codes.tool_change",
    "controller.codes.spindle_clockwise", "controller.codes.spindle_counterclockwise",
    "controller.codes.spindle_stop", "controller.codes.coolant_flood", "controller.codes.coolant_mist",
    "controller.codes.coolant_off", "controller.codes.stop", "controller.codes.optional_stop",
    "controller.codes.functions", "spindle.axis.motor", "spindle.axis.letter", "spindle.axis.counts_per_turn",
    "controller.codes.spindle_axis", "controller.codes.spindle_speed",
}  # fmt: skip
"""Entries that say what the machine is, where things are and what its controller is set to."""


def example():
    machine, faults = read_machine(find_machine("example_6tps"))
    assert not faults
    return machine


def extents(machine, topic):
    return {row.subject: row.extent for row in coverage(machine, TRAJECTORY) if row.topic is topic}


def test_every_topic_is_one_line_and_every_hazard_stands_in_it_once():
    rows = coverage(example(), TRAJECTORY)
    lines = coverage_summary(rows)
    assert [line.split(":")[0] for line in lines] == [topic.value for topic in Topic]
    for row in rows:
        assert [row.subject in line for line in lines].count(True) == 1, row


@pytest.mark.parametrize(
    ("left_out", "uncovered"),
    [
        ({"tube_radius": 0.0, "rod_radius": 0.0}, {"strut and strut", "strut and platform", "strut and fixture"}),
        ({"bodies": ()}, {"strut and platform", "spindle and fixture"}),
        ({"fixtures": ()}, {"strut and fixture", "spindle and fixture"}),
    ],
)
def test_bodies_that_the_machine_file_does_not_state_are_not_covered(left_out, uncovered):
    before = extents(example(), Topic.COLLISIONS)
    after = extents(replace(example(), **left_out), Topic.COLLISIONS)
    assert all(before[subject] is Extent.PROVEN for subject in uncovered)
    assert {subject for subject in before if before[subject] is not after[subject]} == uncovered
    assert all(after[subject] is Extent.NOT_COVERED for subject in uncovered)


def test_a_row_of_each_extent_is_named_with_it():
    (first, *_), (last, *_) = (
        [row for row in coverage(example(), TRAJECTORY) if row.topic is topic] for topic in (Topic.PATH, Topic.SETUP)
    )
    lines = coverage_summary((first, replace(first, extent=Extent.SAMPLED, subject="a sample"), last))
    assert lines[0] == f"tool path: proven: {first.subject}; sampled: a sample"
    assert lines[-1] == f"machine and set-up: not covered: {last.subject}"


def beside_the_path(machine, trajectory):
    return {
        row.subject: (row.extent, row.detail) for row in coverage(machine, trajectory) if row.topic is Topic.AUXILIARY
    }


def test_a_tool_change_counts_as_covered_where_the_trajectory_has_it_at_the_pose():
    job = program([[0, 0, 60], [10, 0, 60], [20, 0, 60]], events=CHANGES, tools=TOOLS)
    machine = machines.with_tool_change(machines.example())
    there, elsewhere = place(job, machine, ON_PALLET)[0], place(job, machines.example(), ON_PALLET)[0]
    assert beside_the_path(machine, there)["tool change"][0] is Extent.PROVEN
    moved = machines.with_tool_change(machines.example(), nose=machine.tool_change.nose + 1e-3)
    spun = machines.with_tool_change(machines.example(), spin=machine.tool_change.spin + 1e-3)
    for stated, trajectory, why in (
        (spun, there, "elsewhere than at the tool-change pose"),
        (machine, elsewhere, "elsewhere than at the tool-change pose"),
        (moved, there, "elsewhere than at the tool-change pose"),
        (machines.example(), there, "states no tool-change pose"),
    ):
        extent, detail = beside_the_path(stated, trajectory)["tool change"]
        assert extent is Extent.NOT_COVERED and why in detail


def test_a_way_to_the_start_is_promised_where_this_program_plans_one():
    for kind, promised in (("turbo_pmac", True), ("power_pmac", False)):
        machine = replace(example(), controller=example().controller | {"kind": kind})
        extent, detail = beside_the_path(machine, TRAJECTORY)["way to the start of the program"]
        assert extent is Extent.NOT_COVERED and ("pmac approach" in detail) is promised


def test_the_spindle_counts_as_covered_where_the_motion_waits_for_it():
    job = program([[0, 0, 60], [10, 0, 60], [20, 0, 60]], events=CHANGES, tools=TOOLS)
    waits, no_time = replace(machines.example(), spin_up_time=2.0), machines.example()
    for stated, events, extent, why in (
        (waits, CHANGES, Extent.PROVEN, "takes 2 s"),
        (waits, CHANGES[:1], Extent.NOT_COVERED, "cuts before it starts the spindle"),
        (waits, (replace(CHANGES[2], row=2),), Extent.NOT_COVERED, "cuts before it starts the spindle"),
        (no_time, CHANGES, Extent.NOT_COVERED, "states no spindle.spin_up_time"),
    ):
        trajectory = place(replace(job, events=events), stated, ON_PALLET)[0]
        assert beside_the_path(stated, trajectory)["spindle speed at the first cut"][0] is extent
        assert why in beside_the_path(stated, trajectory)["spindle speed at the first cut"][1]


SPINDLE, DWELL = EventKind.SPINDLE, EventKind.DWELL
CHANGE, AXIS = EventKind.TOOL_CHANGE, EventKind.SPINDLE_AXIS


@pytest.mark.parametrize(
    ("events", "why"),  # 24000 rpm in 4 s, to rest in 2 s
    [
        (((SPINDLE, 6000), (DWELL, 1.0)), ""),
        (((SPINDLE, -6000), (DWELL, 0.5), (DWELL, 0.5)), ""),
        (((SPINDLE, 6000),), "up to 1.000 s before the spindle has its speed"),
        (((SPINDLE, 6000), (DWELL, 0.998)), "up to 0.002 s before"),
        (((DWELL, 1.0), (SPINDLE, 6000)), "up to 1.000 s before"),
        (((SPINDLE, 12000), (DWELL, 2.0), (SPINDLE, 6000)), "up to 0.500 s before"),
        (((SPINDLE, 12000), (DWELL, 2.0), (SPINDLE, -6000), (DWELL, 1.9)), "up to 0.100 s before"),
        (((SPINDLE, 12000), (DWELL, 2.0), (SPINDLE, -6000), (DWELL, 2.0)), ""),
        (((SPINDLE, 24000), (SPINDLE, 6000), (DWELL, 1.4)), "up to 0.100 s before"),  # at 24000 in the worst case
        (((SPINDLE, 24000), (SPINDLE, 0), (SPINDLE, 6000), (DWELL, 1.5)), ""),
        (((SPINDLE, 6000), (DWELL, 1.0), (CHANGE, 2)), "after a tool change that stops the spindle"),
        (((SPINDLE, 6000), (DWELL, 1.0), (CHANGE, 2), (SPINDLE, 6000), (DWELL, 1.0)), ""),
        (((SPINDLE, 6000), (DWELL, 1.0), (AXIS, 1.0), (AXIS, 0.0)), "after a thread that stops the spindle"),
        (((SPINDLE, 6000), (DWELL, 1.0), (AXIS, 1.0), (AXIS, 0.0), (SPINDLE, 6000), (DWELL, 1.0)), ""),
        (((SPINDLE, 6000), (DWELL, 1.0), (SPINDLE, 0)), ""),  # meant to cut at rest
    ],
)
def test_the_spindle_is_covered_where_every_cut_has_its_waits(events, why):
    """Trajectories as a hand or another program writes them: nothing has put the waits in."""
    machine = replace(machines.example(), spin_up_time=4.0, spin_down_time=2.0)
    job = program([[0, 0, 60], [10, 0, 60], [20, 0, 60]], tools=TOOLS)
    trajectory = place(job, machines.example(), ON_PALLET)[0]  # a rapid move and two cuts
    cut_before = (Event(1, SPINDLE, 6000.0), Event(1, DWELL, 1.0), Event(2, SPINDLE, 0.0), Event(2, DWELL, 0.5))
    for before, row in (((), 1), (cut_before, 2)):
        made = (*before, *(Event(row, kind, value) for kind, value in events))
        extent, detail = beside_the_path(machine, replace(trajectory, events=made))["spindle speed at the first cut"]
        assert (extent is Extent.PROVEN) is (why == "") and why in detail, detail


def test_the_way_from_the_part_program_to_the_trajectory_is_never_called_covered():
    """A reader or a compensation that makes another trajectory gives a program that holds, by this trajectory."""
    assert extents(all_stated(), Topic.SETUP)["meaning of the part program"] is Extent.NOT_COVERED


def test_jerk_is_covered_where_a_limit_is_stated():
    before, after = (extents(machine, Topic.LIMITS) for machine in (machines.without_jerk(example()), example()))
    changed = {subject for subject in before if before[subject] is not after[subject]}
    assert changed == {"strut jerk", "tip jerk"}
    assert all(before[subject] is Extent.NOT_COVERED and after[subject] is Extent.SAMPLED for subject in changed)


def all_stated():
    """The example machine with every limit that a file can state."""
    axis = SpindleAxis(
        motor=7, letter="Z", counts_per_turn=36000.0, speed=25.0, acceleration=200.0, lead_tolerance=0.005
    )
    return dataclasses.replace(preset("example_6tps"), spindle_axis=axis)


def test_every_entry_stands_in_one_place():
    placed = [*CERTIFIED, *CHECKED_ELSEWHERE, *NO_LIMITS]
    assert sorted(placed) == sorted(field.entry for field in FIELDS)


@pytest.mark.slow
def test_certified_limits_are_findings_of_a_certificate():
    *_, certificate, faults = of(all_stated(), random_job(np.random.default_rng(3)), NARROW)
    assert faults == ()
    *_, of_a_thread, faults = of(all_stated(), tapped_hole(), NARROW)
    assert faults == ()
    names = {row.name for row in (*certificate.findings, *of_a_thread.findings)}
    assert {name for rows in CERTIFIED.values() for name in rows} <= names


def test_rows_without_an_entry_are_about_the_job():
    *_, certificate, _ = of(all_stated(), random_job(np.random.default_rng(3)), NARROW)
    of_machine = {name for rows in CERTIFIED.values() for name in rows}
    assert {row.code for row in certificate.findings if row.name not in of_machine} == {
        "V101", "V102", "V107", "V110", "V111",
    }  # fmt: skip
