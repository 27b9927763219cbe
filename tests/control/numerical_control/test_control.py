# SPDX-License-Identifier: LGPL-2.1-or-later
"""A machine operated by hand: what is looked at, what moves, and what is not sent."""

import math
from dataclasses import replace

import numpy as np
import pytest
from rig import listed
from station import job

from pkm_post.cli.pmac_manual import wait_for_end
from pkm_post.control.link.errors import CancelledError, NotReadyError, PmacError
from pkm_post.control.numerical_control.manual_moves import CartesianJog, StrutJog
from pkm_post.control.numerical_control.mdi import MdiSettings, mdi_trajectory
from pkm_post.machine import strut_lengths
from pkm_post.model import Diagnostic

MICRON = 1e-3
COUNT = 1e-4
"""mm: what the encoder of the example counts."""
FEED = 10.0
FIVE, SIN, COS = math.radians(5), math.sin(math.radians(5)), math.cos(math.radians(5))


def lengths_at(machine, tip, axis=(0, 0, 1), spin=0.0):
    return strut_lengths(
        machine, np.array([tip], float), np.array([axis], float), np.array([spin]), np.array([120.0])
    )[0]  # fmt: skip


def test_the_readout_at_home(station):
    state = station.control.poll()
    assert np.allclose(state.pose.tip, [0, 0, 300], atol=MICRON) and state.pose.axis[2] == pytest.approx(1.0)
    assert abs(state.pose.spin) < 1e-6
    assert not state.lost and state.emergency == () and state.homing is None and state.status.homed == (True,) * 6


@pytest.mark.slow
@pytest.mark.parametrize(
    ("jog", "tip", "axis", "spin"),
    [
        (CartesianJog(shift=(20, -10, 15)), (20, -10, 315), (0, 0, 1), 0.0),
        (
            CartesianJog(tilt=(math.radians(5), 0)),
            (0, 0, 300),
            (0, -math.sin(math.radians(5)), math.cos(math.radians(5))),
            0,
        ),
        (
            CartesianJog(tilt=(0, math.radians(5))),
            (0, 0, 300),
            (math.sin(math.radians(5)), 0, math.cos(math.radians(5))),
            0,
        ),
        (CartesianJog(spin=math.radians(4)), (0, 0, 300), (0, 0, 1), math.radians(4)),
        (CartesianJog((0, 5, 0), (0, 0.05), 0.03), (0, 5, 300), (math.sin(0.05), 0, math.cos(0.05)), 0.03),
    ],
)
def test_a_jog_leads_where_it_says(station, jog, tip, axis, spin):
    """The lengths that are reached are those of inverse kinematics for the pose that was asked for."""
    plan, reported = station.control.plan_jog(jog, FEED)
    assert (
        reported == () and np.allclose(plan.end.tip, tip, atol=MICRON) and np.allclose(plan.end.axis, axis, atol=1e-5)
    )
    station.control.execute(plan)
    state = station.to_rest()
    assert np.allclose(state.status.commanded, lengths_at(station.machine, tip, axis, spin), atol=2 * MICRON)
    assert np.allclose(state.pose.tip, tip, atol=5 * MICRON) and state.pose.spin == pytest.approx(spin, abs=1e-5)
    assert state.status.fault_texts() == () and b"B999R" in station.sent() and b"PROG 10" not in station.sent()


@pytest.mark.slow
@pytest.mark.parametrize(("strut", "by"), [(1, 5.0), (4, -8.0)])
def test_a_jog_of_one_strut_leaves_the_others(station, strut, by):
    before = station.control.poll().status.commanded
    plan, reported = station.control.plan_jog(StrutJog(strut, by), FEED)
    assert reported == ()
    station.control.execute(plan)
    furthest = np.zeros(6)
    while (state := station.wait(0.02)).status.running:
        furthest = np.maximum(furthest, np.abs(state.status.commanded - before))
    changed = state.status.commanded - before
    expected = np.zeros(6)
    expected[strut - 1] = by
    assert np.allclose(changed, expected, atol=MICRON)
    assert np.all(np.delete(furthest, strut - 1) < 2 * MICRON)  # also on the way
    there = lengths_at(station.machine, plan.end.tip, plan.end.axis, plan.end.spin)
    assert np.allclose(there, state.status.commanded, atol=MICRON)


@pytest.mark.slow
def test_jogs_follow_each_other(station):
    for shift in ((5, 0, 0), (0, 5, 0), (-5, -5, 0)):
        plan, _ = station.control.plan_jog(CartesianJog(shift), FEED)
        station.control.execute(plan)
        state = station.to_rest()
    assert np.allclose(state.pose.tip, [0, 0, 300], atol=5 * MICRON)


@pytest.mark.parametrize(
    ("jog", "codes"),
    [
        (CartesianJog((0, 0, -350)), {"K102"}),
        (CartesianJog((700, 0, 0)), {"K102", "K103", "K104"}),
        (CartesianJog(tilt=(math.radians(60), 0)), {"K102", "K103", "K104", "K105", "K114"}),
        (CartesianJog(tilt=(math.radians(179.5), 0)), {"K159"}),
        (CartesianJog(), {"C201"}),
        (StrutJog(1, 300.0), {"C202"}),
        (StrutJog(6, -200.0), {"K101", "K103", "K104", "K105", "C202"}),
    ],
)
def test_what_the_checks_refuse_is_not_sent(station, jog, codes):
    plan, reported = station.control.plan_jog(jog, FEED)
    assert plan is None and reported and {fault.code for fault in reported} <= codes | {"C228"}
    out_of_reach = {fault.code for fault in reported} & {"K101", "K102", "K103", "K104", "K105", "K114"}
    assert (reported[-1].code == "C228") == bool(out_of_reach)
    assert all(isinstance(fault, Diagnostic) for fault in reported)
    assert b"OPEN" not in station.sent() and b"R" not in station.sent().replace(b"PR", b"")


def test_a_line_of_gcode(station):
    plan, reported = station.control.plan_line("G1 X30 Y20 F1200")
    assert reported == ()
    station.control.execute(plan)
    state = station.to_rest()
    assert np.allclose(state.pose.tip, [30, 20, 300], atol=5 * MICRON)  # G54 is 150 mm up, and Z was not said


def test_a_line_begins_where_the_tool_is_and_keeps_its_axis(station):
    station.control.execute(station.control.plan_jog(CartesianJog((10, 0, 0), (0, 0.1), 0.05), FEED)[0])
    station.to_rest()
    plan, _ = station.control.plan_line("G91 G1 Y7 F600")
    assert np.allclose(plan.end.tip, [10, 7, 300], atol=5 * MICRON)
    assert np.allclose(plan.end.axis, [math.sin(0.1), 0, math.cos(0.1)], atol=1e-5)
    assert plan.end.spin == pytest.approx(0.05, abs=1e-5)
    upright, _ = station.control.plan_line("G43.5 G1 Y7 I0 J0 K1 F600", MdiSettings(axis_words="vector"))
    assert np.allclose(upright.end.axis, [0, 0, 1], atol=1e-5)


@pytest.mark.parametrize(
    ("line", "code"),
    [
        ("G1 X10", "C225"),
        ("T2 M6 G1 X10 F100", "C203"),
        ("G41 D1 G1 X10 F100", "C227"),
        ("G91 G1 X0 Y0 F100", "C201"),
        ("G17", "C201"),
        ("S1000", "C201"),
        ("M30", "C201"),
        ("", "C201"),
        ("T2 M6", "C203"),
        ("G41 D1 M3 S500", "C227"),
        ("M98 P5", "C224"),
        ("G76 X1 F100", "C224"),
        ("G28 Z0", "C226"),
        ("G1 Z-210 F600", "K102"),
        ("G0 X900", "K102"),
        ("HELLO", "G201"),
    ],
)
def test_a_line_that_is_refused_is_not_sent(station, line, code):
    plan, reported = station.control.plan_line(line)
    assert plan is None and code in {fault.code for fault in reported}
    assert b"OPEN" not in station.sent()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("line", "variable", "value"),
    [("M3 S1000", 7001, 1), ("S300 M4", 7001, -1), ("M8", 7002, 1), ("G20 M7", 7002, 2), ("G91 M9", 7002, 0)],
)
@pytest.mark.parametrize("axis_words", ["none", "vector"])
def test_a_line_that_switches_alone(station, line, variable, value, axis_words):
    """The machine stands meanwhile, to less than its encoders count."""
    before = station.control.poll().status.commanded
    variables = station.wire.controller.variables
    variables.write("P", variable, 9.0)
    plan, reported = station.control.plan_line(line, MdiSettings(axis_words=axis_words))
    assert reported == ()
    station.control.execute(plan)
    furthest = np.zeros(6)
    while (state := station.wait(0.02)).status.running:
        furthest = np.maximum(furthest, np.abs(state.status.commanded - before))
    assert variables.read("P", variable) == value
    assert furthest.max() < COUNT and np.abs(state.status.commanded - before).max() < COUNT


def test_a_line_of_a_dwell_alone_takes_its_time(station):
    station.control.execute(station.control.plan_line("G4 P2")[0])
    began = station.wire.now
    station.to_rest()
    assert station.wire.now - began >= 2.0


@pytest.mark.slow
def test_a_long_dwell_is_waited_for(station):
    plan, _ = station.control.plan_line("G91 G1 X1 F600 G4 P40")
    assert 40.0 < plan.seconds < 41.0
    station.control.execute(plan)
    assert not wait_for_end(station.control, plan.seconds).running and station.wire.now > 40.0


def test_an_unknown_work_offset(station):
    plan, reported = station.control.plan_line("G1 X1 F100", MdiSettings("G59"))
    assert plan is None and [fault.code for fault in reported] == ["K108"]


def turned(degrees, *origin):
    """A frame in {M}, turned about z."""
    frame, angle = np.eye(4), math.radians(degrees)
    frame[:2, :2] = [[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]]
    frame[:3, 3] = origin
    return frame


@pytest.mark.parametrize(
    ("chosen", "line", "tip"),
    [
        ("G54", "G1 X4 Y3 Z2 F600", (14, 3, 302)),
        ("G54", "G54 G1 X4 Y3 Z2 F600", (14, 3, 302)),
        ("G54", "G55 G1 X4 Y3 Z2 F600", (-3, 4, 312)),
        ("G54", "G55 G91 G1 X4 Y3 F600", (-3, 4, 300)),
        ("G55", "G1 X4 Y3 Z2 F600", (-3, 4, 312)),
        ("G55", "G54 G1 X4 Y3 Z2 F600", (14, 3, 302)),
        ("vise", "G1 X4 Y3 Z2 F600", (4, 23, 302)),
        ("G55", "G53 G1 X4 Y3 Z250 F600", None),
        ("G54", "G53 G1 X4 Y3 Z250 F600", (4, 3, 310)),
        ("G54", "G56 G1 X4 Y3 Z2 F600", None),
        ("vise", "G54 G1 X4 Y3 Z2 F600", None),
    ],
)
def test_a_line_goes_to_the_work_offset_that_it_names(station, chosen, line, tip):
    offsets = {"G54": turned(0, 10, 0, 300), "G55": turned(90, 0, 0, 310), "vise": turned(0, 0, 20, 300)}
    machine = replace(station.machine, work_offsets=offsets, machine_zero=np.array([0.0, 0.0, 60.0]))
    pose = station.control.standing_pose()
    trajectory, reported = mdi_trajectory(line, machine, pose, 120.0, MdiSettings(chosen))
    if tip is None:
        assert trajectory is None and [fault.code for fault in reported] == ["C226"]
    else:
        assert reported == () and np.allclose(trajectory.tip[-1], tip, atol=MICRON)


def test_two_lines_are_none(station):
    with pytest.raises(ValueError, match="expected one line, got 2"):
        station.control.plan_line("G1 X1 F100\nG1 X2")


def test_a_plan_is_good_where_it_was_made(station):
    """After another move the machine does not stand where the plan begins."""
    first, _ = station.control.plan_jog(CartesianJog((5, 0, 0)), FEED)
    station.control.execute(first)
    station.to_rest()
    before = len(station.sent())
    with pytest.raises(NotReadyError, match="from the first point of the program"):
        station.control.execute(first)
    assert b"OPEN" not in station.sent()[before:]


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (lambda motors: motors.homed.__setitem__(2, False), "strut 3: not homed"),
        (lambda motors: motors.closed.__setitem__(0, False), "strut 1: in open loop"),
        (lambda motors: motors.amplifier_fault.__setitem__(1, True), "strut 2: amplifier fault"),
    ],
)
def test_a_machine_that_is_not_ready_does_not_move(station, spoil, said):
    plan, _ = station.control.plan_jog(CartesianJog((5, 0, 0)), FEED)
    spoil(station.motors)
    with pytest.raises(NotReadyError) as refused:
        station.control.execute(plan)
    assert said in refused.value.reasons and not station.wire.controller.runs_program()


def test_nothing_is_planned_while_something_moves_or_has_no_home(station):
    station.control.execute(station.control.plan_jog(CartesianJog((20, 0, 0)), FEED)[0])
    with pytest.raises(NotReadyError, match="a program runs"):
        station.control.plan_jog(CartesianJog((1, 0, 0)), FEED)
    station.to_rest()
    station.motors.homed[4] = False
    with pytest.raises(NotReadyError, match="strut 5: not homed"):
        station.control.plan_line("G1 X1 F100")


def test_hold_resume_override_and_abort(station):
    control = station.control
    control.execute(control.plan_jog(CartesianJog((40, 0, 0)), FEED)[0])
    station.wait(2.0)
    control.hold()
    held = station.wait(2.0)
    assert held.status.held and held.status.standing and 0 < held.pose.tip[0] < 40
    with pytest.raises(NotReadyError, match="a program is held"):
        control.override(50)
    assert np.allclose(station.wait(1.0).pose.tip, held.pose.tip, atol=COUNT)
    control.resume()
    station.wait(0.1)  # the time base has begun to rise
    assert control.override(25.0).override == pytest.approx(25.0)
    a, b = station.wait(0.0), station.wait(0.5)
    assert np.linalg.norm(b.pose.tip - a.pose.tip) == pytest.approx(0.25 * FEED * 0.5, rel=0.05)
    control.abort()
    state = station.to_rest()
    assert not state.status.running and abs(state.pose.tip[1]) < 10 * MICRON  # held on its path before


@pytest.mark.parametrize("percent", [0, -1, 100.1, math.nan, 0.001, 0.0099])
def test_overrides_beyond_the_plan_are_refused(station, percent):
    """Below the last decimal of the command, an override would arrive as 0, which is a stop."""
    with pytest.raises(ValueError, match=r"expected 0\.01 to 100, got"):
        station.control.override(percent)
    assert station.sent() == b""


def test_the_least_override_is_none_of_zero(station):
    assert station.control.override(0.01).override == pytest.approx(0.01)
    system = station.wire.controller.systems[0]
    system.set_override(0.0)
    system.override, system.set_override = 0.0, lambda percent: None  # another source has selected a stop
    with pytest.raises(PmacError, match=r"stays at 0 % after %0\.01"):
        station.control.override(0.01)


def test_an_override_that_does_not_come_is_reported(station):
    station.control.poll()
    assert not station.wire.line.refusal("I5194=0")  # the time base stays as it is
    with pytest.raises(PmacError, match="the time base stays at 100 %.*I5194 may be too low"):
        station.control.override(30)


def test_the_number_of_the_jobs_is_not_taken(station):
    station.control._number = station.settings.program
    with pytest.raises(ValueError, match="expected another one than that of the jobs, got 10"):
        station.control.plan_jog(CartesianJog((1, 0, 0)), FEED)


@pytest.mark.parametrize("length", [0.0, -5.0, math.nan])
def test_a_tool_has_a_length(station, length):
    with pytest.raises(ValueError, match="tool_length"):
        station.control.tool_length = length


def test_another_tool_is_elsewhere(station):
    station.control.tool_length = 150.0
    assert station.control.poll().pose.tip[2] == pytest.approx(270.0, abs=MICRON)


def test_a_lost_link_is_a_state_and_tells_what_to_do_when_something_moved(station):
    quiet = station.control.poll()
    assert quiet.emergency == ()
    station.wire.cut_at, station.wire.mends = station.wire.passed, False
    lost = station.control.poll()
    assert lost.lost and lost.status is quiet.status and lost.emergency == ()


def test_a_machine_that_was_never_reached_is_no_emergency(station):
    station.wire.cut_at, station.wire.mends = 0, False
    state = station.control.poll()
    assert state.lost and state.status is None and state.emergency == ()


@pytest.mark.parametrize("looked", [True, False])
def test_a_link_that_is_lost_while_a_program_runs(station, looked):
    station.control.poll()
    station.control.execute(station.control.plan_jog(CartesianJog((40, 0, 0)), FEED)[0])
    if looked:
        station.control.poll()
    station.wire.cut_at, station.wire.mends = station.wire.passed, False
    lost = station.control.poll()
    assert "EMERGENCY STOP" in lost.emergency[1] and [line[0] for line in lost.emergency[1:]] == list("1234567")
    station.wire.mends = True
    assert station.control.poll().emergency == ()


def test_a_set_up_that_changed_behind_the_download_starts_nothing(station):
    loaded = job(station.settings, ())
    station.control.load(loaded, lambda done, lines: None, lambda: False)
    assert not station.wire.line.refusal("I5190=60000")
    with pytest.raises(NotReadyError, match=r"I5190: expected 1000 \(speeds are in mm/s\)"):
        station.control.start(loaded)
    assert f"B{loaded.program.number}R".encode() not in station.sent()


def test_a_start_that_may_have_been_carried_out_is_an_emergency(station):
    plan, _ = station.control.plan_jog(CartesianJog((40, 0, 0)), FEED)
    wire, said = station.wire, []

    def lose_the_start(data, out):
        if out and b"B999R" in data:
            said.append(data)
            wire.cut_at, wire.mends = wire.passed, False
        return data

    wire.fault = lose_the_start
    with pytest.raises(PmacError):
        station.control.execute(plan)
    assert len(said) == 1
    assert station.control.poll().emergency


def test_a_stop_ends_a_download_and_nothing_is_started(station):
    """It gets through between two lines; nothing is left under the number."""
    plan, _ = station.control.plan_jog(CartesianJog((20, 0, 0)), FEED)
    station.control.preempt_when(lambda: station.sent().endswith(b"\0") or b"PVT" in station.sent())
    with pytest.raises(CancelledError, match="a stop came first|nothing is left under program 999"):
        station.control.execute(plan)
    assert b"B999R" not in station.sent() and not station.wire.controller.runs_program()
    assert listed(station.wire.controller, 999) in ([], ["RETURN"])


def test_a_reading_that_gives_way_to_a_stop_is_no_lost_link(station):
    before = station.control.poll()
    station.control.preempt_when(lambda: True)
    station.wire.fault = lambda data, out: b""
    assert station.control.poll() is before
    station.control.preempt_when(lambda: False)
    assert station.control.poll().lost


def test_a_program_that_another_client_speeds_up_is_held_while_the_panel_polls(station, caplog):
    plan, _ = station.control.plan_line("G91 G1 Z-20 F120")
    station.control.execute(plan)
    assert not station.wait(0.1).note
    station.wire.controller.systems[0].set_override(150.0)
    states = [station.wait(0.1) for _ in range(30)]
    assert states[-1].status.held and states[-1].status.standing
    assert [record.message for record in caplog.records if "set from elsewhere" in record.message]
    assert "set from elsewhere" in states[-1].note
    station.control.resume()
    assert [station.wait(0.1) for _ in range(30)][-1].status.held
    assert not station.control.abort().running and not station.wait(0.1).note
