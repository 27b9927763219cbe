# SPDX-License-Identifier: LGPL-2.1-or-later
"""The way to tool changes and back: laws that hold of any job, and numbers by hand."""

import dataclasses

import numpy as np
import pytest
from machines import example, with_tool_change
from programs import BALL, ON_PALLET, TOOLS, program, random_changes

from pkm_post.geometry import norm
from pkm_post.machine import SpinPolicy, SpinRule, with_spin
from pkm_post.model import Event, EventKind, Kind, Shank, Tool
from pkm_post.toolpath.place import place
from pkm_post.toolpath.symmetry.transform import mirror, transform

NANOMETRE = 1e-6
MACHINE = with_tool_change(example())
POSE = MACHINE.tool_change


def placed(made, machine=MACHINE):
    trajectory, faults = place(made, machine, ON_PALLET)
    assert trajectory is not None, faults
    return trajectory


def changes(trajectory):
    return [event.row for event in trajectory.events if event.kind is EventKind.TOOL_CHANGE]


def of_changes(trajectory):
    """Rows that were added for tool changes."""
    names = np.array([name.startswith("tool change T") for name in trajectory.operations])
    return names[trajectory.operation]


def noses(trajectory):
    """The spindle nose at the end and at the start of each segment, by the length that is in use on the segment."""
    length = trajectory.tool_length()[:, None]
    return trajectory.tip + length * trajectory.axis, trajectory.tip_before() + length * trajectory.axis_before()


@pytest.mark.parametrize("seed", range(40))
def test_the_platform_runs_through_tool_changes_without_a_jump(seed):
    trajectory = placed(random_changes(np.random.default_rng(seed)))
    ends, starts = noses(trajectory)
    np.testing.assert_allclose(starts[1:], ends[:-1], atol=NANOMETRE)
    np.testing.assert_array_equal(trajectory.start_tip, MACHINE.home_tip)


@pytest.mark.parametrize("seed", range(40))
def test_tools_change_at_the_pose_at_rest(seed):
    trajectory = placed(random_changes(np.random.default_rng(seed)))
    assert changes(trajectory)
    for row in changes(trajectory):
        np.testing.assert_allclose(noses(trajectory)[0][row - 1], POSE.nose, atol=NANOMETRE)
        np.testing.assert_allclose(trajectory.axis[row - 1], POSE.axis, atol=1e-12)
        assert trajectory.exact_stop[row - 1]
    np.testing.assert_allclose(trajectory.nose_before(changes(trajectory)), [POSE.nose] * len(changes(trajectory)))


@pytest.mark.parametrize("seed", range(40))
def test_the_way_crosses_above_the_safe_height_and_goes_along_the_axis_below(seed):
    trajectory = placed(random_changes(np.random.default_rng(seed)))
    rows = np.flatnonzero(of_changes(trajectory))
    start, end = trajectory.tip_before()[rows], trajectory.tip[rows]
    along = norm(np.cross(end - start, trajectory.axis[rows])) < NANOMETRE
    stands = norm(trajectory.axis[rows] - trajectory.axis_before()[rows]) < NANOMETRE
    high = np.minimum(start[:, 2], end[:, 2]) >= POSE.safe_height - NANOMETRE
    assert (high | (along & stands)).all()
    assert (trajectory.kind[rows] == Kind.RAPID).all()
    assert (trajectory.feed[rows] == MACHINE.rapid_speed).all()


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(40))
def test_what_was_programmed_is_as_it_is_without_tool_changes(seed):
    """Each cut begins where the program says and not where another length puts the tip; ends of all rows are kept."""
    made = random_changes(np.random.default_rng(seed))
    alike = {number: dataclasses.replace(BALL, number=number) for number in TOOLS}
    alone = dataclasses.replace(made, events=made.events[:1], tools=alike)
    trajectory, plain = placed(made), placed(alone, example())
    kept = ~of_changes(trajectory)
    lines = dict(zip(plain.line.tolist(), range(len(plain)), strict=True))
    for row in np.flatnonzero(kept).tolist():
        if int(trajectory.line[row]) not in lines:
            continue  # a move to where the tool was, which the way back from a change makes a way
        same = lines[int(trajectory.line[row])]
        np.testing.assert_allclose(trajectory.tip[row], plain.tip[same], atol=1e-12)
        if trajectory.kind[row] != Kind.RAPID:
            np.testing.assert_allclose(trajectory.tip_before()[row], plain.tip_before()[same], atol=NANOMETRE)
            np.testing.assert_allclose(trajectory.length[row], plain.length[same], atol=NANOMETRE)
    cuts = [line for line in plain.line[plain.kind != Kind.RAPID].tolist()]
    assert [line for line in trajectory.line[kept & (trajectory.kind != Kind.RAPID)].tolist()] == cuts


def test_events_before_the_change_stay_at_the_part_and_those_after_it_are_at_the_pose():
    happens = (
        Event(0, EventKind.TOOL_CHANGE, 1), Event(0, EventKind.SPINDLE, 900), Event(2, EventKind.SPINDLE, 0),
        Event(2, EventKind.TOOL_CHANGE, 2), Event(2, EventKind.COOLANT, 1), Event(3, EventKind.DWELL, 1.0),
    )  # fmt: skip
    made = program([[0, 0, 60], [10, 0, 60], [20, 0, 60], [30, 0, 60]], events=happens, tools=TOOLS)
    trajectory = placed(made)
    # T1: home is above the safe height: straight to the pose; T2: up, across | over, down, and on with the cut.
    names = [trajectory.operations[number] for number in trajectory.operation]
    one, two = "tool change T1", "tool change T2"
    assert names == [one, one, "Finish", "Finish", two, two, two, two, "Finish", "Finish"]
    assert [(event.row, event.kind) for event in trajectory.events] == [
        (1, EventKind.TOOL_CHANGE), (1, EventKind.SPINDLE), (4, EventKind.SPINDLE), (6, EventKind.TOOL_CHANGE),
        (6, EventKind.COOLANT), (9, EventKind.DWELL),
    ]  # fmt: skip
    assert trajectory.line.tolist() == [1, 1, 1, 2, 3, 3, 3, 3, 3, 4]
    # Above the point of the first rapid move, and above the end of the first cut, which is at z 60 + 150.
    np.testing.assert_allclose(trajectory.tip[1], [0, 0, POSE.safe_height])
    np.testing.assert_allclose(trajectory.tip[4], [10, 0, POSE.safe_height])
    np.testing.assert_allclose(trajectory.tip[6:8], [[10, 0, POSE.safe_height], [10, 0, 210]])
    np.testing.assert_allclose(trajectory.tip[5], POSE.nose - 120.0 * POSE.axis)


def test_a_program_without_a_tool_change_comes_to_its_first_point_from_above():
    happens = (Event(0, EventKind.SPINDLE, 900), Event(1, EventKind.COOLANT, 1))
    made = program([[30, 20, 60], [10, 0, 60]], events=happens)
    trajectory = placed(made)
    names = [trajectory.operations[number] for number in trajectory.operation]
    assert names == ["approach", "Finish", "Finish"]
    np.testing.assert_allclose(trajectory.tip[:2], [[30, 20, POSE.safe_height], [30, 20, 210]])
    assert [(event.row, event.kind) for event in trajectory.events] == [(0, EventKind.SPINDLE), (2, EventKind.COOLANT)]
    low = dataclasses.replace(MACHINE, home_tip=np.array([5.0, 0.0, 200.0]))
    np.testing.assert_allclose(placed(made, low).tip[0], [5, 0, POSE.safe_height])
    high = dataclasses.replace(made, position=made.position + [0, 0, 80])
    assert placed(high).operations == ("Finish",)


def test_a_change_at_the_end_stays_at_the_pose():
    events = (Event(0, EventKind.TOOL_CHANGE, 1), Event(2, EventKind.TOOL_CHANGE, 3))
    trajectory = placed(program([[0, 0, 60], [10, 0, 60]], events=events, tools=TOOLS))
    assert changes(trajectory)[-1] == len(trajectory)
    np.testing.assert_allclose(noses(trajectory)[0][-1], POSE.nose)


def test_an_arc_may_follow_a_change_for_the_tool_comes_back_to_where_it_begins():
    centre = np.full((3, 3), np.nan)
    centre[2] = [15, 0, 60]
    turn = np.where(np.isnan(centre), np.nan, [0.0, 0.0, 1.0])
    events = (Event(0, EventKind.TOOL_CHANGE, 1), Event(2, EventKind.TOOL_CHANGE, 2))
    kind = [Kind.RAPID, Kind.LINE, Kind.ARC]
    made = program(
        [[0, 0, 60], [10, 0, 60], [20, 0, 60]], kind=kind, centre=centre, turn=turn, events=events, tools=TOOLS
    )
    assert {fault.code for fault in place(made, example(), ON_PALLET)[1]} == {"K126"}
    trajectory = placed(made)
    assert trajectory.sweep[-1] == pytest.approx(np.pi) and trajectory.length[-1] == pytest.approx(5 * np.pi)


@pytest.mark.parametrize("seed", range(10))
def test_a_mirrored_program_changes_its_tools_at_the_same_pose(seed):
    made = random_changes(np.random.default_rng(seed))
    other, _ = transform(made, mirror([0, 0, 0], [0.6, 0.8, 0.0]))
    one, two = placed(made), placed(other)
    assert changes(one) == changes(two) and len(one) == len(two)
    at = changes(one)
    np.testing.assert_allclose(two.nose_before(at), one.nose_before(at), atol=NANOMETRE)
    cuts = one.kind != Kind.RAPID
    np.testing.assert_allclose(one.length[cuts], two.length[cuts], atol=1e-9)


@pytest.mark.parametrize("rule", [rule for rule in SpinRule if rule is not SpinRule.OPTIMISED])
def test_the_spin_at_a_change_is_that_of_the_machine_file(rule):
    trajectory, _ = with_spin(placed(random_changes(np.random.default_rng(3))), MACHINE, SpinPolicy(rule))
    at = np.array(changes(trajectory)) - 1
    assert trajectory.spin[at].tolist() == [POSE.spin] * len(at)
    others, _ = with_spin(placed(random_changes(np.random.default_rng(3))), example(), SpinPolicy(rule))
    differ = np.flatnonzero(trajectory.spin != others.spin)
    assert set(differ.tolist()) <= set(at.tolist())


@pytest.mark.parametrize(
    ("code", "changed", "machine"),
    [
        ("K141", {}, with_tool_change(example(), safe_height=330.0)),
        ("K142", {"tool_axis": np.tile([np.sqrt(1 - 0.0081), 0.0, 0.09], (3, 1)), "events": ()}, MACHINE),
        ("K142", {"tool_axis": np.tile([np.sqrt(1 - 0.0081), 0.0, 0.09], (3, 1))}, MACHINE),
        ("K140", {}, dataclasses.replace(example(), largest_tool_diameter=11.9)),
        ("K140", {}, dataclasses.replace(example(), longest_tool=149.9)),
    ],
)
def test_what_stands_against_a_tool_change(code, changed, machine):
    events = (Event(0, EventKind.TOOL_CHANGE, 1), Event(2, EventKind.TOOL_CHANGE, 2))
    made = program([[0, 0, 60], [10, 0, 60], [20, 0, 60]], events=events, tools=TOOLS)
    trajectory, faults = place(dataclasses.replace(made, **changed), machine, ON_PALLET)
    assert trajectory is None
    assert {fault.code for fault in faults} == {code}


@pytest.mark.parametrize("name", ["approach", "tool change T1", "tool change T22"])
def test_an_operation_of_the_program_with_the_name_of_a_route_is_refused(name):
    """With offsets changed at the machine, its moves at the safe height would have stayed there, as a route does."""
    made = dataclasses.replace(
        program([[0, 0, 60], [10, 0, 60]], tools=TOOLS), operations=("A", name), operation=[0, 1]
    )
    trajectory, faults = place(made, MACHINE, ON_PALLET)
    assert trajectory is None and [str(fault.place) for fault in faults] == [f"{made.source}: {name}: line 2"]
    assert [fault.code for fault in faults] == ["K149"]
    assert place(made, example(), ON_PALLET)[1] == ()


@pytest.mark.parametrize("name", ["Approach", "approach 2", "tool change", "tool change Top", "12"])
def test_names_that_resemble_those_of_routes_are_taken(name):
    made = dataclasses.replace(program([[0, 0, 60], [10, 0, 60]], events=()), operations=(name,))
    assert placed(made).operations == (name, "approach")


def test_a_tool_of_unknown_diameter_is_reported_where_the_largest_one_is_stated():
    made = program([[0, 0, 60], [10, 0, 60]], tools={1: dataclasses.replace(BALL, diameter=0.0)})
    limited = dataclasses.replace(example(), largest_tool_diameter=12.0)
    trajectory, faults = place(made, limited, ON_PALLET)
    assert trajectory is not None and [(fault.code, fault.found) for fault in faults] == [("K144", "T1, at most 12 mm")]
    assert place(made, example(), ON_PALLET)[1] == ()


@pytest.mark.parametrize(
    ("tool", "shank", "widest"),
    [
        (Tool(1, "chamfer mill of 90 degrees", 2.0, 0.0, 60.0, side_angle=np.pi / 4), Shank(5.0, 6.0), 12.0),
        (Tool(1, "flat V-bit", 2.0, 0.0, 60.0, side_angle=np.pi / 4), Shank(9.0, 20.0), 20.0),
        (Tool(1, "dovetail", 12.0, 0.0, 60.0, side_angle=-np.pi / 6), Shank(5.0, 6.0), 12.0),
        (Tool(1, "engraver", 2.0, 0.0, 60.0), Shank(5.0, 12.0), 12.0),
        (Tool(1, "cone without a shank", 12.0, 0.0, 60.0, side_angle=np.pi / 4), None, 12.0),
    ],
    ids=lambda value: getattr(value, "name", None),
)
def test_a_tool_is_as_wide_as_its_widest_place(tool, shank, widest):
    made, shanks = program([[0, 0, 60], [10, 0, 60]], tools={1: tool}), {1: shank} if shank else {}
    for largest, codes in ((widest + 1e-6, []), (widest - 1e-3, ["K140"])):
        machine = dataclasses.replace(example(), largest_tool_diameter=largest)
        assert [fault.code for fault in place(made, machine, ON_PALLET, shanks)[1]] == codes
    assert f"diameter {widest:g} mm" in place(made, machine, ON_PALLET, shanks)[1][0].found


def test_tools_that_are_not_used_are_not_measured():
    giant = TOOLS | {9: Tool(9, "giant", 500.0, 0.0, 700.0)}
    machine = dataclasses.replace(example(), largest_tool_diameter=12.0, longest_tool=150.0)
    assert place(program([[0, 0, 60], [10, 0, 60]], tools=giant), machine, ON_PALLET)[1] == ()


def test_a_spindle_speed_after_a_change_is_reported_in_its_operation():
    """It was named "tool change T1", which no job has: the spindle starts at the pose, before the cut it is for."""
    events = (Event(0, EventKind.TOOL_CHANGE, 1), Event(0, EventKind.SPINDLE, 24001.0))
    made = program([[0, 0, 60], [9, 0, 60]], events=events)
    (fault,) = place(made, MACHINE, ON_PALLET)[1]
    assert (fault.code, fault.place) == ("K107", made.place(0))
