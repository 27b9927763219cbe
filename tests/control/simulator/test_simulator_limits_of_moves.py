# SPDX-License-Identifier: LGPL-2.1-or-later
"""What bounds and delays the moves of a program: Ixx16, Ixx17, feed, ramps, dwells; and all programs at once."""

import numpy as np
import pytest
from simulated import make


def started(machine, body):
    machine.lines(f"OPEN PROG 1\nCLEAR\nFRAX(A,B,C,U,V,W)\n{body}\nCLOSE")
    machine.say("&1B1R")


def sampled_counts(machine, ms):
    places = []
    for _ in range(ms):
        places.append(machine.controller.motors.commanded.copy())
        machine.wait(1)
    return np.array(places)


def test_a_linear_move_keeps_within_ixx16_and_ixx17(machine):
    # Software Reference, Ixx16 and Ixx17: counts/ms and counts/ms^2; 0.5 mm/ms is 5000 counts/ms.
    machine.say("I116=300 I117=2")
    started(machine, "LINEAR TA10 TS0 F500\nA520 B510")
    places = sampled_counts(machine, 2000)
    speed = np.diff(places, axis=0)
    assert np.abs(speed[:, 0]).max() == pytest.approx(300, rel=1e-6)
    assert np.abs(np.diff(speed, axis=0))[:, 0].max() <= 2 * (1 + 1e-6)
    assert speed[:, 1] == pytest.approx(speed[:, 0] / 2, abs=1e-6)
    assert places[-1, :2] == pytest.approx([200_000, 100_000])


def test_the_feed_is_the_root_of_the_sum_of_squares_of_the_feed_axes(machine):
    started(machine, "LINEAR TA100 TS0 F50\nA520 B515")  # 25 mm at 50 mm/s, and one ramp of 100 ms
    places = sampled_counts(machine, 800)
    speed = np.diff(places, axis=0)
    assert np.linalg.norm(speed, axis=1).max() == pytest.approx(500)
    moving = np.flatnonzero(np.any(speed != 0, axis=1))
    assert moving[-1] - moving[0] + 1 == 600


def test_incremental_moves_add_up(machine):
    started(machine, "LINEAR TM20 TA10 TS0\nINC(A)\nA1 B501\nA1 B501\nABS\nU502\nINC\nU-1\nPVT20\nW0.5:0")
    machine.wait(1000)
    assert machine.position() == pytest.approx([502, 501, 500, 501, 500, 500.5])


@pytest.mark.parametrize(("word", "ahead"), [("DWELL", "0"), ("DELAY", "1")])
def test_a_dwell_is_waited_for_and_a_delay_is_not(machine, word, ahead):
    # User Manual: DWELL stops the computation ahead, DELAY does not.
    started(machine, f"{word}500\nM1=1\nLINEAR TM20 TA10 TS0\nA501")
    machine.wait(100)
    assert machine.say("M1") == ahead
    machine.wait(1000)
    assert machine.say("M1") == "1" and machine.position()[0] == 501


def test_a_program_runs_until_its_last_move_is_computed_or_a_dwell_behind_it_is_over(machine):
    # Software Reference, ??: Running Program becomes 0 at the end of the program, even if the motors still move.
    for end, runs in (("", False), ("\nDWELL0", True)):
        started(machine, f"LINEAR TM100 TA10 TS0 A520{end}")
        machine.wait(50)
        assert machine.runs() == runs and machine.position()[0] < 520
        machine.wait(500)
        assert not machine.runs() and machine.position()[0] == 520
        machine.say("#1J=0")
        machine.wait(2000)


@pytest.mark.parametrize(("word", "ms"), [("DWELL", 500), ("DELAY", 1000)])
def test_the_override_slows_a_delay_and_no_dwell(machine, word, ms):
    machine.say("&1%50")
    machine.wait(1000)
    started(machine, f"{word}500\nDWELL0")
    machine.wait(ms - 5)
    assert machine.runs()
    machine.wait(10)
    assert not machine.runs()


def test_an_override_beyond_the_servo_rate_is_cut(machine):
    machine.say("&1%500")
    machine.wait(3000)
    # Software Reference, %{constant}; reported to 3 digits
    assert float(machine.say("&1%")) == pytest.approx(225.88230574, abs=5e-4)


def test_how_fast_a_hold_comes_is_isx95_and_an_override_isx94(machine):
    machine.say("I5195=16440 I5194=822")
    started(machine, "LINEAR TM5000 TA10 TS0\nA510")
    machine.wait(100)
    machine.say("H")
    machine.wait(105)
    assert machine.say("%") == "0" and machine.say("#1V") == "0"
    machine.say("R")
    machine.wait(105)
    machine.say("%50")
    machine.wait(500)
    assert 70 < float(machine.say("%")) < 80
    machine.wait(600)
    assert machine.say("%") == "50"


def test_all_programs_are_run_held_and_ended_by_control_characters(machine):
    machine.lines("OPEN PROG 1\nCLEAR\nLINEAR TM1000 TA10 TS0\nA501\nA502\nA503\nCLOSE\nB1")
    machine.bytes(b"\x13")  # step
    machine.wait(1500)
    assert not machine.runs() and machine.position()[0] == 501
    machine.bytes(b"\x12")  # run
    machine.wait(100)
    assert machine.runs()
    machine.bytes(b"\x0f")  # hold
    machine.wait(1100)
    assert machine.controller.systems[0].holding and machine.runs()
    machine.bytes(b"\x12")
    machine.wait(1100)
    machine.bytes(b"\x11")  # quit
    machine.wait(4000)
    assert not machine.runs() and machine.position()[0] == 503


def test_what_hinders_a_program_is_reported_also_when_all_are_started(machine):
    machine.lines("OPEN PROG 1\nCLEAR\nDWELL1\nCLOSE\nB1\n#1K")
    assert machine.bytes(b"\x12") == b"\x07ERR012\r"


def test_a_motor_that_rests_at_a_switch_was_not_stopped_by_it(machine):
    machine.controller.motors.high_switch[0] = True
    machine.wait(10)
    first, second = machine.status(1)
    assert first & 1 << 21 and not second & 1 << 11


def test_the_last_word_of_the_memory_is_for_the_return():
    pmac = make(memory_words=1000)
    pmac.lines("OPEN PROG 10\nCLEAR")
    room = -int(pmac.say("SIZE"))
    for _ in range(room - 1):
        pmac.say("DWELL0")
    assert pmac.error("DWELL0") == 6
    pmac.say("CLOSE")
    assert pmac.say("SIZE") == "0"
