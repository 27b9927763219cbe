# SPDX-License-Identifier: LGPL-2.1-or-later
import dataclasses

import numpy as np
import pytest
from machines import example, rotation_about
from programs import BALL, ON_PALLET, cone, program, square_with_arc

from pkm_post.geometry import norm
from pkm_post.model import Event, EventKind, Kind, Tool
from pkm_post.toolpath.place import place


def test_work_offset_turns_points_and_axes():
    offset = np.eye(4)
    offset[:3, :3], offset[:3, 3] = rotation_about(2, 90), [10, 20, 150]
    made = cone(20)
    trajectory, faults = place(made, example(), offset)
    assert not faults
    np.testing.assert_allclose(trajectory.tip[:, 0], 10 - made.position[:, 1], atol=1e-12)
    np.testing.assert_allclose(trajectory.tip[:, 1], 20 + made.position[:, 0], atol=1e-12)
    np.testing.assert_allclose(trajectory.axis[:, 0], -made.tool_axis[:, 1], atol=1e-15)
    np.testing.assert_array_equal(trajectory.start_tip, example().home_tip)


def test_rows_that_move_nothing_are_left_out_and_their_events_kept():
    events = (Event(0, EventKind.TOOL_CHANGE, 1), Event(2, EventKind.DWELL, 1.0), Event(4, EventKind.SPINDLE, 0))
    made = program([[0, 0, 60], [10, 0, 60], [10, 0, 60], [10, 10, 60]], events=events)
    trajectory, _ = place(made, example(), ON_PALLET)
    assert trajectory.line.tolist() == [1, 2, 4]
    assert [(event.row, event.kind) for event in trajectory.events] == [
        (0, EventKind.TOOL_CHANGE), (2, EventKind.DWELL), (3, EventKind.SPINDLE),
    ]  # fmt: skip
    assert trajectory.exact_stop.tolist() == [False, True, True]


def test_arc_and_helix_have_their_sweep_and_length():
    trajectory, _ = place(square_with_arc(), example(), ON_PALLET)
    arcs = trajectory.kind == Kind.ARC
    np.testing.assert_allclose(trajectory.sweep[arcs], [np.pi, 2 * np.pi])
    np.testing.assert_allclose(trajectory.length[arcs], [10 * np.pi, np.hypot(10 * np.pi, 4)])


def test_smooth_joints_are_reported_from_corners():
    # From home straight down, then on down; and the half circle meets its lines without a corner; the rest are corners.
    trajectory, _ = place(square_with_arc(), example(), ON_PALLET)
    assert trajectory.smooth.tolist() == [True, False, True, True, False, False, False]
    start = np.zeros((3, 3))
    start[:, 0] = [0, 10, 20]
    straight, _ = place(program(start + [0, 0, 60]), example(), ON_PALLET)
    assert straight.smooth.tolist() == [False, True, False]


def test_the_way_begins_at_the_home_pose():
    axis = np.array([0.0, np.sin(0.1), np.cos(0.1)])
    leaning = dataclasses.replace(example(), home_axis=axis, home_spin=0.2)
    trajectory, _ = place(cone(20), leaning, ON_PALLET)
    np.testing.assert_array_equal(trajectory.start_axis, axis)
    assert (trajectory.start_spin, trajectory.spin_before()[0]) == (0.2, 0.2)
    assert trajectory.angle[0] == pytest.approx(np.arccos(axis @ trajectory.axis[0]))


def test_a_spindle_speed_below_the_lowest_is_refused():
    slow = dataclasses.replace(example(), spindle_least_speed=3000.0)
    for speed, codes in ((-2999.0, ["K107"]), (3000.0, []), (0.0, [])):
        made = program([[0, 0, 60], [1, 0, 60]], events=(Event(1, EventKind.SPINDLE, speed),))
        assert [fault.code for fault in place(made, slow, ON_PALLET)[1]] == codes


def test_a_spindle_speed_is_reported_with_all_its_digits():
    """24000.001 was refused as 24000, of which 24000 are allowed."""
    made = program([[0, 0, 60], [1, 0, 60]], events=(Event(1, EventKind.SPINDLE, 24000.001),))
    (fault,) = place(made, example(), ON_PALLET)[1]
    assert (fault.code, fault.found[:32]) == ("K107", "24000.001 rpm, the machine allow")


def test_feeds_are_limited_with_a_warning():
    made = program([[0, 0, 60], [10, 0, 60], [20, 0, 60]], feed=np.array([np.nan, 30.0, 900.0]))
    trajectory, faults = place(made, example(), ON_PALLET)
    assert trajectory.feed.tolist() == [250.0, 30.0, 200.0]
    assert [(fault.code, fault.place.line) for fault in faults] == [("K110", 3)]
    assert "F54000 mm/min, limited to 12000" in str(faults[0])


def arc_with_another_tool():
    """A half circle right after the change to a tool that is 30 mm longer."""
    centre = np.full((3, 3), np.nan)
    centre[2] = [15, 0, 60]
    turn = np.where(np.isnan(centre), np.nan, [0.0, 0.0, 1.0])
    events = (Event(0, EventKind.TOOL_CHANGE, 1), Event(2, EventKind.TOOL_CHANGE, 2))
    tools = {1: BALL, 2: Tool(2, "long", 8.0, 4.0, 150.0)}
    kind = [Kind.RAPID, Kind.LINE, Kind.ARC]
    return program(
        [[0, 0, 60], [10, 0, 60], [20, 0, 60]], kind=kind, centre=centre, turn=turn, events=events, tools=tools
    )


@pytest.mark.parametrize(
    ("code", "made"),
    [
        ("K102", program([[0, 0, 60], [12345678.0, 0, 60]])),
        ("K102", program([[0, 0, 60], [1e300, 0, 60]])),
        ("K126", arc_with_another_tool()),
        ("K127", program([[0, 0, 60], [1, 0, 60]], feed=1e-5)),
        ("K106", program([[0, 0, 60], [10, 0, 60]], np.array([[0, 0, 1.0], [0, 0, -1.0]]))),
        ("J103", program([[0, 0, 150]])),
        ("K107", program([[0, 0, 60], [1, 0, 60]], events=(Event(1, EventKind.SPINDLE, -24001),))),
    ],
)
def test_what_the_machine_cannot_do_is_an_error(code, made):
    trajectory, faults = place(made, example(), ON_PALLET)
    assert trajectory is None
    assert [fault.code for fault in faults] == [code]


@pytest.mark.parametrize(
    ("tilts", "faults"),
    [
        ([0, 90, 180, 180, 90], [("K159", 3)]),  # the row that leads there, once
        ([0, 120, 240], [("K159", 3)]),  # on the way from one row to the next
        ([0, 90, 179.5, 90], [("K159", 3)]),
        ([0, 180, 90], [("K106", 2)]),  # the sides of a part are told apart by half a turn
        ([0, 90, 178.5, 90, 0], []),  # the reach refuses it
    ],
)
def test_a_tool_that_points_straight_up_has_no_spin(tilts, faults):
    """R(k) = I + [v] + [v]^2 / (1 + kz) has no value at kz = -1 (docs/conventions.md)."""
    angle = np.radians(tilts)
    axis = np.column_stack([np.sin(angle), 0 * angle, np.cos(angle)])
    found = place(program([[10 * row, 0, 60] for row in range(len(tilts))], axis), example(), ON_PALLET)[1]
    assert [(fault.code, fault.place.line) for fault in found] == faults


def test_at_a_tool_change_the_platform_stands_still():
    longer = Tool(2, "long", 8.0, 4.0, 150.0)
    events = (Event(0, EventKind.TOOL_CHANGE, 1), Event(2, EventKind.TOOL_CHANGE, 2))
    tilt = np.radians([0.0, 10, 10, 0])
    axis = np.column_stack([np.sin(tilt), 0 * tilt, np.cos(tilt)])
    made = program([[0, 0, 60], [10, 0, 60], [20, 0, 60], [30, 0, 60]], axis, events=events, tools={1: BALL, 2: longer})
    trajectory, _ = place(made, example(), ON_PALLET)
    reach = example().spindle_nose + trajectory.tool_length()
    platform_after = trajectory.tip[1] + reach[1] * trajectory.axis[1]
    platform_before = trajectory.tip_before()[2] + reach[2] * trajectory.axis_before()[2]
    np.testing.assert_allclose(platform_before, platform_after, atol=1e-12)
    np.testing.assert_allclose(trajectory.length, norm(trajectory.tip - trajectory.tip_before()), atol=1e-12)


@pytest.mark.parametrize("offset", [np.diag([1.0, -1, 1, 1]), np.diag([2.0, 1, 1, 1]), np.full((4, 4), np.nan)])
def test_a_work_offset_that_is_no_rotation_with_a_shift(offset):
    trajectory, faults = place(cone(20), example(), offset)
    assert trajectory is None
    assert [fault.code for fault in faults] == ["K109"]


def test_exact_stops_of_the_program_are_kept():
    made = dataclasses.replace(program([[0, 0, 60], [10, 0, 60], [20, 0, 60]]), exact_stop=[False, True, False])
    trajectory, _ = place(made, example(), ON_PALLET)
    assert trajectory.exact_stop.tolist() == [False, True, True]
    assert not trajectory.smooth[1]


def test_compensation_that_was_not_applied_is_a_fault_of_the_caller():
    made = dataclasses.replace(program([[0, 0, 60], [10, 0, 60]]), side_offset=[0.0, 4.0])
    with pytest.raises(ValueError, match="expected a program whose cutter compensation was applied"):
        place(made, example(), ON_PALLET)


def test_an_exact_path_rests_at_corners_and_goes_on_where_it_is_tangent():
    given = square_with_arc()
    plain, _ = place(given, example(), ON_PALLET)
    exact, _ = place(dataclasses.replace(given, exact_path=np.ones(len(given), bool)), example(), ON_PALLET)
    # From the smooth joints of the test above; the last of all rests anyway, and the tool axis stands.
    assert exact.exact_stop.tolist() == [not smooth for smooth in plain.smooth]
    assert plain.exact_stop.tolist() == 5 * [False] + 2 * [True]  # the tool goes out of the part the way it went in


def test_an_exact_row_has_exact_corners_at_both_ends():
    zigzag = program([[0, 0, 60], [10, 0, 60], [10, 10, 60], [20, 10, 60], [20, 20, 60]])
    one = dataclasses.replace(zigzag, exact_path=np.arange(5) == 2)
    trajectory, _ = place(one, example(), ON_PALLET)
    assert trajectory.exact_stop.tolist() == [False, True, True, False, True]


def test_an_exact_path_does_not_rest_for_what_rounding_leaves_of_a_tangent_nor_for_another_feed():
    angle = np.radians([0.05, 0.2])
    ends = [[0, 0, 60], [10, 0, 60], [20, 10 * angle[0], 60], [30, 10 * angle.sum() + 10 * angle[0], 60]]
    given = program(ends)
    feed = np.array([np.nan, 10.0, 3.0, 20.0])
    given = dataclasses.replace(given, feed=feed, exact_path=np.ones(4, bool))
    trajectory, _ = place(given, example(), ON_PALLET)
    assert trajectory.exact_stop.tolist() == [True, False, True, True]


def test_the_tool_axis_alone_makes_no_corner_and_a_tip_that_stands_does():
    axis = np.array([[0, 0, 1], [0, 0, 1], [0, np.sin(0.1), np.cos(0.1)], [0, np.sin(0.2), np.cos(0.2)]])
    given = program([[0, 0, 60], [10, 0, 60], [20, 0, 60], [20, 0, 60]], axis)
    trajectory, _ = place(dataclasses.replace(given, exact_path=np.ones(4, bool)), example(), ON_PALLET)
    assert trajectory.exact_stop.tolist() == [True, False, True, True]


def test_tolerances_of_the_program_are_kept():
    given = dataclasses.replace(
        program([[0, 0, 60], [9, 0, 60], [9, 0, 60], [9, 9, 60]]), tip_tolerance=[0, 0.05, 1, 0.2]
    )
    trajectory, _ = place(given, example(), ON_PALLET)
    assert trajectory.tip_tolerance.tolist() == [0, 0.05, 0.2]
    assert trajectory.tip_tolerances(0.001).tolist() == [0.001, 0.05, 0.2]


@pytest.mark.parametrize(
    ("there", "back", "rests"),
    [
        ([10, 0, 0], [-10, 0, 0], True),
        ([0, 0, -3], [0, 0, 40], True),
        ([10, 0, 0], [-10, 10 * np.tan(np.radians(9)), 0], True),
        ([10, 0, 0], [-10, 10 * np.tan(np.radians(11)), 0], False),
        ([10, 0, 0], [0, 10, 0], False),
        ([10, 0, 0], [10, 0, 0], False),
        ([10, 0, 0], [-0.11, 0, 0], True),
        ([0.09, 0, 0], [-10, 0, 0], False),  # noise of the points, perhaps
    ],
)
def test_the_motion_rests_where_the_tip_turns_back(there, back, rests):
    trajectory, _ = place(program(np.cumsum([[0, 0, 60], there, back], axis=0)), example(), ON_PALLET)
    assert trajectory.exact_stop.tolist() == [False, rests, True]


def test_a_tool_axis_that_turns_does_not_rest_where_the_tip_turns_back():
    axis = np.array([[0, 0, 1], [0, 0, 1], [0, np.sin(0.1), np.cos(0.1)]])
    trajectory, _ = place(program([[0, 0, 60], [10, 0, 60], [0, 0, 60]], axis), example(), ON_PALLET)
    assert not trajectory.exact_stop[1]


def test_an_arc_that_goes_back_over_another_rests():
    none, ends = np.full(3, np.nan), [[10, 0, 60], [-10, 0, 60], [10, 0, 60]]
    for turn, rests in (([0, 0, -1], True), ([0, 0, 1], False)):
        both = program(
            ends,
            kind=[Kind.RAPID, Kind.ARC, Kind.ARC],
            centre=np.array([none, [0, 0, 60], [0, 0, 60]]),
            turn=np.array([none, [0, 0, 1], turn]),
        )
        trajectory, _ = place(both, example(), ON_PALLET)
        assert trajectory.exact_stop[1] == rests
