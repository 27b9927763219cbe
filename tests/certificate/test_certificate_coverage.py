# SPDX-License-Identifier: LGPL-2.1-or-later
from dataclasses import replace

import machines
import pytest
from programs import ON_PALLET, TOOLS, cone, program

from pkm_post.certificate.coverage import coverage
from pkm_post.machine import find_machine
from pkm_post.machine.description.reader import read_machine
from pkm_post.model import Event, EventKind
from pkm_post.model.certificate import Extent, Topic, coverage_summary
from pkm_post.toolpath.place import place

TRAJECTORY = place(cone(9), machines.example(), ON_PALLET)[0]


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


CHANGES = (Event(0, EventKind.TOOL_CHANGE, 1), Event(1, EventKind.TOOL_CHANGE, 2), Event(1, EventKind.SPINDLE, 500.0))


def test_a_tool_change_counts_as_covered_where_the_trajectory_has_it_at_the_pose():
    job = program([[0, 0, 60], [10, 0, 60], [20, 0, 60]], events=CHANGES, tools=TOOLS)
    machine = machines.with_tool_change(machines.example())
    there, elsewhere = place(job, machine, ON_PALLET)[0], place(job, machines.example(), ON_PALLET)[0]
    assert beside_the_path(machine, there)["tool change"][0] is Extent.PROVEN
    moved = machines.with_tool_change(machines.example(), nose=machine.tool_change.nose + 1e-3)
    for stated, trajectory, why in (
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


def test_jerk_is_covered_where_a_limit_is_stated():
    before, after = (
        extents(machine, Topic.LIMITS) for machine in (example(), replace(example(), strut_jerk=1e6, tip_jerk=1e6))
    )
    changed = {subject for subject in before if before[subject] is not after[subject]}
    assert changed == {"strut jerk", "tip jerk"}
    assert all(before[subject] is Extent.NOT_COVERED and after[subject] is Extent.SAMPLED for subject in changed)
