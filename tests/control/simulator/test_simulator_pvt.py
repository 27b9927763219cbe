# SPDX-License-Identifier: LGPL-2.1-or-later
"""Motions that were written for the Turbo PMAC, played: against the cubics of the geometry, held, slowed, aborted."""

import numpy as np
import pytest
from simulated import PROGRAM_SETTINGS, curved_motion

from pkm_post.control.simulator.variables import stored
from pkm_post.geometry.curves import hermite_lengths
from pkm_post.model import Event, EventKind, StrutMotion
from pkm_post.writing.controllers.pmac import program_text

PICOMETRE = 1e-9  # mm
LAST_BIT_OF_500_MM = 500 * 2.0**-34
IN_PVT, LOOK_AHEAD = 1 << 4, 1 << 23


def run_to_first_move(machine):
    """Start program 10 and wait until its first PVT move begins, to the millisecond."""
    machine.say("&1B10R")
    machine.wait(1)
    while not machine.system()[1] & IN_PVT:
        assert machine.runs()
        machine.wait(1)
    return machine.controller.systems[0].path


def sampled(machine, count):
    places = []
    for _ in range(count):
        places.append(machine.position())
        machine.wait(1)
    return np.array(places)


def played(motion, times):
    """The cubics of a motion at times since its start, (K, 6) in mm."""
    knot = np.clip(np.searchsorted(motion.time_ms, times, side="right") - 1, 0, len(motion) - 2)
    span = np.diff(motion.time_ms)[knot]
    share = (times - motion.time_ms[knot]) / span
    return hermite_lengths(
        motion.length[knot], motion.speed[knot], motion.length[knot + 1], motion.speed[knot + 1], span / 1000,
        share[:, None],
    )[:, 0]  # fmt: skip


def as_kept(motion):
    """The motion with the numbers of its program as words of the controller."""
    word = np.vectorize(stored)
    return StrutMotion(motion.time_ms, word(motion.length.round(6)), word(motion.speed.round(4)), motion.events)


def test_a_written_program_is_played_as_the_cubics_between_its_knots(machine):
    motion = curved_motion()
    machine.lines(program_text(motion, PROGRAM_SETTINGS, ["a test"]))
    path = run_to_first_move(machine)
    # The first move began within the tick that has just passed.
    since = path.time - path.current().start
    got = sampled(machine, 2480)
    times = since + np.arange(len(got))
    times, got = times[times <= 2480], got[times <= 2480]
    assert len(got) > 2470
    assert np.abs(got - played(as_kept(motion), times)).max() < PICOMETRE
    plain = StrutMotion(motion.time_ms, motion.length.round(6), motion.speed.round(4), ())
    assert np.abs(got - played(plain, times)).max() < LAST_BIT_OF_500_MM
    machine.wait(2000)
    assert not machine.runs()
    assert np.abs(np.array(machine.position()) - motion.length[-1]).max() < 1e-6
    assert machine.controller.systems[0].path.abrupt_stops == 0


def test_the_actual_position_is_reported_in_counts(machine):
    machine.lines(program_text(curved_motion(), PROGRAM_SETTINGS, []))
    machine.say("&1B10R")
    machine.wait(10_000)
    assert [machine.say(f"#{motor}P") for motor in range(1, 7)] == ["20000"] * 6


def test_at_half_the_override_all_takes_twice_as_long_on_the_same_path(machine):
    motion = curved_motion()
    machine.lines(program_text(motion, PROGRAM_SETTINGS, []))
    machine.say("&1%50")
    machine.wait(2000)
    assert machine.say("%") == "50"
    path = run_to_first_move(machine)
    since = path.time - path.current().start
    got = sampled(machine, 1000)
    assert np.abs(got - played(as_kept(motion), since + 0.5 * np.arange(1000))).max() < PICOMETRE


def test_a_hold_stops_on_the_path_and_goes_on_from_there(machine):
    motion = curved_motion()
    machine.lines(program_text(motion, PROGRAM_SETTINGS, []))
    path = run_to_first_move(machine)
    begun = path.current().start
    machine.wait(300)
    machine.say("H")
    machine.wait(1200)
    assert not machine.system()[1] & LOOK_AHEAD and machine.say("#1V %") == "0\r0"
    held = np.array(machine.position())
    # From 100 % to nothing in a second, half a second of the program goes by [Software Reference, Isx95].
    assert path.time - begun == pytest.approx(300 + 500, abs=5)
    assert np.abs(held - played(as_kept(motion), np.array([path.time - begun]))).max() < PICOMETRE
    machine.wait(1000)
    assert (np.array(machine.position()) == held).all()
    machine.say("R")
    machine.wait(5000)
    assert not machine.runs() and np.abs(np.array(machine.position()) - motion.length[-1]).max() < 1e-6


def test_an_abort_stops_each_motor_by_itself_and_ends_the_program(machine):
    machine.lines(program_text(curved_motion(), PROGRAM_SETTINGS, []))
    run_to_first_move(machine)
    machine.wait(250)
    speeds = [abs(float(machine.say(f"#{motor}V"))) for motor in range(1, 7)]
    before = np.array(machine.position())
    machine.say("A")
    assert not machine.runs()
    machine.wait(1000)
    # By Ixx15 = 10 counts/ms^2 from v counts/ms: v^2 / 20 counts.
    expected = np.square(speeds) / 20 / 10000
    assert np.abs(np.abs(np.array(machine.position()) - before) - expected).max() < 2e-4


def test_codes_are_carried_out_where_the_motion_rests(machine):
    events = (
        Event(0, EventKind.TOOL_CHANGE, 3.0),
        Event(0, EventKind.SPINDLE, 1200.0),
        Event(0, EventKind.COOLANT, 1.0),
        Event(50, EventKind.DWELL, 0.5),
        Event(50, EventKind.SPINDLE, -850.5),
        Event(90, EventKind.SPINDLE, 0.0),
        Event(90, EventKind.COOLANT, 0.0),
    )
    machine.lines(program_text(curved_motion(events), PROGRAM_SETTINGS, []))
    path = run_to_first_move(machine)
    begun = path.current().start
    assert machine.say("Q127 P7001 P7002") == "1200\r1\r1"
    machine.wait(990)
    assert machine.say("Q127 P7001") == "1200\r1"
    machine.wait(500)
    assert not machine.system()[1] & IN_PVT and machine.runs()  # the dwell
    machine.wait(20)
    assert machine.system()[1] & IN_PVT and machine.say("Q127 P7001") == "850.5\r-1"
    assert path.current().start - begun == pytest.approx(1500)
    machine.wait(2000)
    assert machine.say("P7001 P7002") == "0\r0" and not machine.runs()


@pytest.mark.parametrize(
    ("whole_ms", "interval", "kept_ms"), [(0, "12.3456", 12.345703125), (1, "12.3456", 12.0), (0, "20", 20.0)]
)
def test_intervals_are_kept_in_the_units_of_i42(machine, whole_ms, interval, kept_ms):
    # Software Reference, I42 and PVT: 1/4096 ms, or whole ms.
    machine.lines(f"I42={whole_ms}\nOPEN PROG 1\nCLEAR\nPVT{interval}\nA501:0\nDWELL1000\nCLOSE")
    machine.say("B1R")
    machine.wait(1)
    assert machine.controller.systems[0].path.current().duration == kept_ms


def test_a_pvt_move_that_ends_at_a_speed_with_nothing_behind_it_is_counted(machine):
    machine.lines("OPEN PROG 1\nCLEAR\nPVT20\nA500.1:10\nCLOSE")
    machine.say("B1R")
    machine.wait(100)
    assert machine.controller.systems[0].path.abrupt_stops == 1
    assert machine.position()[0] == pytest.approx(500.1)
