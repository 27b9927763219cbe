# SPDX-License-Identifier: LGPL-2.1-or-later
"""A program from a line on: the same motion from there, the same modal state, and a way down along the tool axis."""

from dataclasses import replace

import numpy as np
import pytest
from machines import example
from programs import ON_PALLET, cone, program

from pkm_post.geometry import angle_between, norm
from pkm_post.model import TRAJECTORY_COLUMNS, Event, EventKind, Kind, Tool, ToolChange
from pkm_post.toolpath import StartLine, place, row_of_line, started_at_line
from pkm_post.writing.trajectory_file.invariants import contradictions

MACHINE = replace(example(), tool_change=None)
POSE = ToolChange(np.array([0.0, 0.0, 600.0]), np.array([0.0, 0.0, 1.0]), 0.0, 320.0)
STEPS = [[0, 0, 60], [30, 0, 60], [30, 20, 40], [0, 20, 40], [0, 0, 70]]
EVENTS = (
    Event(0, EventKind.SPINDLE, 1000.0),
    Event(1, EventKind.COOLANT, 1.0),
    Event(1, EventKind.SPINDLE, 3000.0),
    Event(1, EventKind.DWELL, 0.5),
    Event(2, EventKind.STOP, 0),
    Event(2, EventKind.DWELL, 2.0),
    Event(3, EventKind.COOLANT, 0.0),
    Event(4, EventKind.SPINDLE, 0.0),
)


def placed(made=None, machine=MACHINE):
    found, faults = place(made or program(STEPS, events=EVENTS), machine, ON_PALLET)
    assert not faults
    return found


def begun(trajectory, line, operation="", machine=MACHINE):
    found, faults = started_at_line(trajectory, StartLine(line, operation), machine)
    assert not faults
    return found


def consistent(trajectory):
    """Lengths and angles are those of the poses, and the file of the trajectory can be read back."""
    assert contradictions(trajectory) == []
    np.testing.assert_allclose(
        norm(trajectory.tip - trajectory.tip_before())[trajectory.kind != Kind.ARC],
        trajectory.length[trajectory.kind != Kind.ARC], atol=1e-9,
    )  # fmt: skip
    np.testing.assert_allclose(angle_between(trajectory.axis_before(), trajectory.axis), trajectory.angle, atol=1e-7)
    assert (np.maximum(trajectory.length, trajectory.angle) > 0).all()


@pytest.mark.parametrize("made", [program(STEPS, events=EVENTS), cone(40)], ids=["steps", "cone"])
def test_what_follows_is_the_program_from_that_line_on(made):
    whole = placed(made)
    for row in range(1, len(whole)):
        found = begun(whole, int(whole.line[row]))
        consistent(found)
        kept = len(whole) - int(np.flatnonzero(whole.line >= whole.line[row])[0])
        for name in TRAJECTORY_COLUMNS:
            np.testing.assert_array_equal(getattr(found, name)[-kept:], getattr(whole, name)[-kept:])
        np.testing.assert_allclose(found.tip_before()[-kept], whole.tip_before()[-kept], atol=1e-12)
        np.testing.assert_allclose(found.axis_before()[-kept], whole.axis_before()[-kept], atol=1e-12)
        np.testing.assert_array_equal(found.start_tip, whole.start_tip)


def test_it_crosses_above_an_arc_that_is_higher_than_its_ends():
    position = [[-20, 0, 41], [-20, 0, 40], [20, 0, 40], [20, 10, 40], [-20, 10, 40]]
    kind = [Kind.RAPID, Kind.LINE, Kind.ARC, Kind.LINE, Kind.ARC]
    centre, turn = np.full((5, 3), np.nan), np.full((5, 3), np.nan)
    centre[[2, 4]], turn[[2, 4]] = [[0, 0, 10], [0, 10, 10]], [[0, 1, 0], [0, -1, 0]]
    whole = placed(program(position, kind=kind, centre=centre, turn=turn))
    found = begun(whole, 5)
    top = whole.machine_from_work[2, 3] + 10 + np.hypot(20, 30)
    assert found.tip[found.operation == 1][:-1, 2].max() >= top - 1e-9 > whole.tip[:, 2].max()


def test_a_line_after_the_call_of_a_subprogram_at_the_end_of_the_source():
    whole = placed(replace(program(STEPS), line=np.array([2, 12, 13, 6, 7])))  # called in line 4
    assert [row_of_line(whole, StartLine(line)) for line in (4, 6, 7, 12, 14)] == [1, 3, 4, 1, None]
    two = replace(whole, operations=("A", "B"), operation=np.array([0, 0, 1, 1, 1]), line=np.array([1, 9, 1, 5, 9]))
    assert [row_of_line(two, StartLine(5, name)) for name in ("", "A", "B")] == [1, 1, 3]


def test_a_line_of_the_main_file_after_the_call_of_a_subprogram_in_a_file_of_its_own():
    called = "subprogram 1234.ngc"  # in line 5
    whole = replace(
        placed(program(STEPS)), operations=("", called), operation=np.array([0, 1, 1, 0, 0]),
        line=np.array([2, 7, 9, 6, 7]),
    )  # fmt: skip
    assert [row_of_line(whole, StartLine(line)) for line in (2, 5, 6, 7, 8)] == [0, 1, 3, 4, None]
    assert [row_of_line(whole, StartLine(line, called)) for line in (7, 8, 9)] == [1, 2, 2]


def test_it_comes_down_along_the_axis_from_above_the_whole_program_and_cuts_with_the_feed_of_the_line():
    whole = placed(cone(40))
    found = begun(whole, int(whole.line[20]))
    down = int(np.flatnonzero(found.operation < len(whole.operations))[0]) - 1
    way = found.tip_before()[down] - found.tip[down]
    assert found.operations[found.operation[down]] == "approach"
    assert norm(np.cross(way, found.axis[down])) < 1e-9 and way @ found.axis[down] > 0
    assert found.tip_before()[down][2] == pytest.approx(whole.tip[:, 2].max())
    assert found.kind[down] == Kind.LINE and found.feed[down] == whole.feed[20]
    assert (found.kind[:down] == Kind.RAPID).all() and found.exact_stop[: down + 1].all()


def test_the_way_to_the_line_is_no_cut_of_the_program():
    """Its end has a feed, as it may touch what was not cut; the figures of the program's cuts leave it out."""
    whole = placed(cone(40))
    found = begun(whole, int(whole.line[20]))
    kept = len(whole) - 20
    assert not found.cutting()[:-kept].any() and (found.kind[:-kept] == Kind.LINE).sum() == 1
    np.testing.assert_array_equal(found.cutting()[-kept:], whole.kind[20:] != Kind.RAPID)
    np.testing.assert_array_equal(whole.cutting(), whole.kind != Kind.RAPID)
    named = replace(whole, operations=tuple("approach" for _ in whole.operations))
    np.testing.assert_array_equal(named.cutting(), whole.cutting())  # an operation of that name is none
    behind = replace(whole, operations=("without moves", "approach"), operation=np.ones(len(whole), int))
    np.testing.assert_array_equal(behind.cutting(), whole.cutting())


@pytest.mark.parametrize(
    ("row", "wanted"),
    [
        (1, [("coolant", 1.0), ("spindle", 3000.0), ("dwell", 0.5)]),
        (2, [("coolant", 1.0), ("spindle", 3000.0), ("dwell", 0.5)]),
        (3, [("coolant", 0.0), ("spindle", 3000.0), ("dwell", 0.5)]),
    ],
)
def test_spindle_and_coolant_are_on_above_the_line_and_stops_before_it_are_behind(row, wanted):
    whole = placed()
    found = begun(whole, int(whole.line[row]))
    count = len(found) - (len(whole) - row)
    there = [each for each in found.events if each.row < count]
    assert {each.row for each in there} == {count - 1}
    named = {EventKind.SPINDLE: "spindle", EventKind.COOLANT: "coolant", EventKind.DWELL: "dwell"}
    assert sorted((named[each.kind], each.value) for each in there) == sorted(wanted)
    later = [replace(each, row=each.row - row + count) for each in EVENTS if each.row > row]
    assert list(found.events[len(there) :]) == later


@pytest.mark.parametrize(
    ("own", "wanted"),
    [
        ([], 4.0 * 3000 / 24_000),
        ([Event(1, EventKind.DWELL, 0.1)], 4.0 * 3000 / 24_000),  # from 2000 rpm, which it had before
        ([Event(1, EventKind.DWELL, 5.0)], 5.0),
        ([Event(1, EventKind.COOLANT, 1.0), Event(1, EventKind.DWELL, 5.0)], 5.0),  # S3000 M3, M8, G4 P5
    ],
)
def test_the_spindle_is_waited_for_from_rest(own, wanted):
    machine = replace(MACHINE, spin_up_time=4.0, spindle_speed=24_000.0)
    whole = placed(program(STEPS, events=EVENTS[:1]))
    events = (Event(0, EventKind.SPINDLE, 2000.0), Event(0, EventKind.DWELL, 0.4), Event(1, EventKind.SPINDLE, 3000.0))
    whole = replace(whole, events=(*events, *own))
    found, _ = started_at_line(whole, StartLine(int(whole.line[2])), machine)
    assert [(each.kind, each.value) for each in found.events if each.kind is not EventKind.COOLANT] == [
        (EventKind.SPINDLE, 3000.0),
        (EventKind.DWELL, wanted),
    ]


@pytest.mark.parametrize(("again", "wanted"), [((), []), ((Event(2, EventKind.SPINDLE, -700.0),), [-700.0])])
def test_a_tool_change_before_the_line_has_stopped_the_spindle(again, wanted):
    tools = {number: Tool(number, "", 6.0, 0.0, 120.0) for number in (1, 2)}
    events = (Event(0, EventKind.SPINDLE, 20_000.0), Event(1, EventKind.TOOL_CHANGE, 2.0), *again)
    whole = placed(program(STEPS, events=EVENTS[:1]))
    whole = replace(whole, tools=tools, tool=np.where(np.arange(len(whole)) >= 1, 2, 1), events=events)
    found = begun(whole, int(whole.line[3]))
    assert [each.value for each in found.events if each.kind is EventKind.SPINDLE] == wanted
    before = begun(whole, int(whole.line[1]))
    assert [each.value for each in before.events if each.kind is EventKind.SPINDLE] == wanted


@pytest.mark.parametrize(
    ("switched", "wanted"),
    [([1, 2], [1, 2]), ([2, 1], [2, 1]), ([1, 2, 1], [2, 1]), ([1, 2, 0], [0]), ([1, 2, 0, 2], [2]), ([0, 1], [1])],
)
def test_flood_and_mist_are_both_on_where_the_program_has_them_both_on(switched, wanted):
    """M7 and M8 switch outputs of their own, and M9 both off [LinuxCNC 2.9, M codes: M7, M8, M9].

    rs274 prints MIST_ON and FLOOD_ON for them, and MIST_OFF and FLOOD_OFF for M9.
    """
    events = tuple(Event(1, EventKind.COOLANT, float(value)) for value in switched)
    whole = placed(program(STEPS, events=events))
    found = begun(whole, int(whole.line[3]))
    assert [each.value for each in found.events if each.kind is EventKind.COOLANT] == wanted


@pytest.mark.parametrize("machine", [MACHINE, replace(MACHINE, tool_change=POSE)], ids=["in place", "at a pose"])
def test_the_tool_of_the_line_is_put_in_before_the_way_to_it(machine):
    tools = {number: Tool(number, "", 6.0, 0.0, length) for number, length in ((1, 120.0), (2, 95.0))}
    made = replace(placed(machine=machine), tools=tools)
    number = np.where(np.arange(len(made)) >= 2, 2, 1)
    events = (Event(0, EventKind.TOOL_CHANGE, 1.0), Event(2, EventKind.TOOL_CHANGE, 2.0))
    whole = replace(made, tool=number, events=events)
    found = begun(whole, int(whole.line[3]), machine=machine)
    consistent(found)
    (change,) = found.events
    assert change.value == 2.0 and (found.tool == 2).all()  # before the first change, the tool of the first change
    home = whole.start_tip + 120.0 * whole.start_axis
    np.testing.assert_allclose(found.start_tip + 95.0 * found.start_axis, home, atol=1e-9)
    nose = found.nose_before([change.row])[0] if change.row else home
    np.testing.assert_allclose(nose, home if machine.tool_change is None else POSE.nose, atol=1e-9)
    begun_first = begun(whole, int(whole.line[1]), machine=machine)
    assert [each.value for each in begun_first.events] == [1.0, 2.0]


@pytest.mark.parametrize("line", [3, 4])
def test_the_line_behind_a_tool_change_begins_with_the_new_tool(line):
    """Not on the route to the tool-change pose, which begins with the old one at the end of its cut."""
    machine = replace(MACHINE, tool_change=POSE)
    tools = {number: Tool(number, "", 6.0, 0.0, length) for number, length in ((1, 120.0), (2, 95.0))}
    kind = [Kind.RAPID, Kind.LINE, Kind.RAPID, Kind.LINE, Kind.LINE]
    events = (Event(0, EventKind.TOOL_CHANGE, 1.0), Event(2, EventKind.TOOL_CHANGE, 2.0))
    made = program(STEPS, kind=kind, events=events, tools=tools)
    whole = placed(replace(made, line=np.array([1, 2, 4, 5, 6])), machine)
    assert "tool change T2" in whole.operations
    found = begun(whole, line, machine=machine)
    consistent(found)
    assert (found.tool == 2).all() and [each.value for each in found.events] == [2.0]
    assert begun(whole, 1, machine=machine) is begun(whole, 1, "Finish", machine) is whole


def test_codes_of_the_machine_before_the_line_are_named_and_left_out():
    functions = tuple(
        Event(row, EventKind.FUNCTION, number) for row, number in ((0, 10.0), (1, 21.0), (1, 10.0), (3, 11.0))
    )
    whole = replace(placed(), events=functions)
    found, (fault,) = started_at_line(whole, StartLine(int(whole.line[2])), MACHINE)
    assert (fault.code, fault.found, fault.place.line) == ("K152", "M10, M21", int(whole.line[2]))
    assert [each.value for each in found.events] == [11.0]


def test_codes_of_the_machine_are_repeated_where_that_is_wanted():
    kinds = EventKind.FUNCTION, EventKind.SPINDLE, EventKind.DWELL, EventKind.COOLANT
    events = ((0, 0, 10), (0, 1, 800), (0, 2, 3), (1, 0, 21), (1, 3, 1), (1, 0, 10), (3, 0, 11))
    whole = replace(placed(), events=tuple(Event(row, kinds[kind], float(value)) for row, kind, value in events))
    found, faults = started_at_line(whole, StartLine(int(whole.line[2]), repeat_codes=True), MACHINE)
    assert not faults
    above = [each for each in found.events if each.row < len(found) - len(whole) + 3]
    wanted = [(1, 800), (2, 3), (0, 21), (3, 1), (0, 10)]  # each where it came last, the dwell behind its spindle
    assert [(each.kind, each.value) for each in above] == [(kinds[kind], value) for kind, value in wanted]
    assert {each.row for each in above} == {len(found) - len(whole) + 2 - 1}
    assert started_at_line(whole, StartLine(int(whole.line[0]), repeat_codes=True), MACHINE) == (whole, ())


def test_the_first_line_changes_nothing_and_others_are_refused():
    whole = placed()
    assert begun(whole, 1) is whole
    for start in (StartLine(99), StartLine(1, "Another")):
        found, faults = started_at_line(whole, start, MACHINE)
        assert found is None and [each.code for each in faults] == ["K150"]
    flat = np.array(whole.axis)
    flat[1:3] = [1.0, 0.0, 0.0]
    found, faults = started_at_line(replace(whole, axis=flat), StartLine(int(whole.line[2])), MACHINE)
    assert found is None and [each.code for each in faults] == ["K151"]
