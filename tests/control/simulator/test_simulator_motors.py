# SPDX-License-Identifier: LGPL-2.1-or-later
"""Motors: jogs, home, following error; and how their status words show it.

The bits of ``#n?`` are those that the EPICS driver for the Turbo PMAC reads and the Software Reference lists.
"""

import numpy as np
import pytest
from simulated import make, ready_machine

ACTIVATED, ENABLED, OPEN_LOOP, STANDS, HOMING = (1 << bit for bit in (23, 19, 18, 13, 10))
IN_SYSTEM, HOMED, IN_POSITION = (1 << bit for bit in (15, 10, 0))
COUNT = 0.1
"""Positions are reported to a tenth of a count."""


def test_motors_wait_for_their_loops_to_be_closed(pmac):
    first, second = pmac.status(1)
    assert first == ACTIVATED | OPEN_LOOP  # Desired Velocity Zero is 0 in open loop [Software Reference, ?]
    assert second == 0
    pmac.say("#1J/")
    assert pmac.status(1) == (ACTIVATED | ENABLED | STANDS, IN_POSITION)
    assert pmac.status(7) == (0, 0)


def test_the_coordinate_system_of_a_motor(pmac):
    pmac.say("&3#2->1000X")
    assert pmac.status(2)[1] == IN_SYSTEM | 2 << 20
    assert pmac.error("&1#2->1000X") == 3  # it is in another one
    pmac.say("&3#2->0")
    assert pmac.status(2)[1] == 0


@pytest.mark.parametrize(
    ("text", "reported"),
    [
        ("10000A-5000000", "10000A-5000000"),
        ("A", "A"),
        ("-2.5x+7", "-2.5X+7"),
        ("$10W", "16W"),
        ("1Y+0", "Y"),
        ("0", "0"),
    ],
)
def test_axis_definitions_are_reported_back(pmac, text, reported):
    pmac.say(f"#4->{text}")
    assert pmac.say("#4->") == reported


def test_a_jog_goes_to_its_position_and_back(machine):
    machine.say("#3J=1000")
    machine.wait(5)
    assert not machine.status(3)[0] & STANDS
    machine.wait(2000)
    assert machine.say("#3P") == "1000"
    machine.say("J:500")
    machine.wait(2000)
    assert machine.say("P") == "1500"
    machine.say("J^-250.5")
    machine.wait(2000)
    assert machine.say("P") == "1249.5"
    machine.say("J=")
    machine.wait(2000)
    assert machine.say("P") == "1500"
    assert [machine.say(f"#{motor}P") for motor in (1, 2, 4, 5, 6)] == ["0"] * 5


def test_a_jog_without_end_keeps_its_speed_until_it_is_stopped(machine):
    machine.say("I122=50 #1J-")
    machine.wait(1000)
    assert machine.say("#1V") == "-50"
    machine.say("J/")
    machine.wait(1000)
    assert machine.say("#1V") == "0" and machine.status(1)[1] & IN_POSITION


def test_the_following_error_is_speed_times_lag():
    machine = ready_machine(lag_ms=2.0)
    machine.say("I122=100 #1J+")
    machine.wait(1000)
    assert float(machine.say("#1F")) == pytest.approx(200, abs=COUNT)
    motors = machine.controller.motors
    assert motors.actual[0] == pytest.approx(motors.commanded[0] - 200, abs=COUNT)


def test_the_lag_does_not_depend_on_the_tick():
    ways = []
    for tick in (0.25, 1.0, 4.0):
        machine = ready_machine(lag_ms=3.0, tick_ms=tick)
        machine.say("I122=100 I119=1000 I120=0 I121=0 #1J=20000")
        machine.wait(100)
        ways.append(machine.controller.motors.actual[0])
    assert np.ptp(ways) < COUNT


def test_home_is_found_at_the_flag():
    machine = make(home_flag=3000.0)
    machine.say("#1J/ J=700")
    machine.wait(2000)
    machine.say("I126=1600 HM")  # home is 100 counts from the flag
    machine.wait(20)
    first, second = machine.status(1)
    assert first & HOMING and not second & HOMED
    machine.wait(5000)
    first, second = machine.status(1)
    assert second & HOMED and not first & HOMING
    assert machine.say("#1P") == "100"
    # Seen from where the motor stood after the reset, the flag is 3000 counts away; it is the zero now.
    assert machine.controller.motors.home_flag[0] == 0


def test_home_in_the_other_direction_never_comes(machine):
    machine.say("I123=-32 #1HM")
    machine.wait(5000)
    assert machine.status(1)[0] & HOMING
    assert float(machine.say("#1P")) < -100_000


def test_where_a_motor_stands_is_home(machine):
    machine.say("#2J=500")
    machine.wait(1000)
    machine.say("HMZ")
    assert machine.say("#2P") == "0"
    assert machine.status(2)[1] & HOMED


def test_killed_and_open_loop_motors_stay(machine):
    machine.say("#1J+")
    machine.wait(200)
    machine.say("K")
    here = machine.say("P")
    machine.wait(500)
    assert machine.say("P") == here and machine.status(1)[0] & OPEN_LOOP
    machine.say("#2O0")
    assert machine.status(2)[0] & (OPEN_LOOP | ENABLED) == OPEN_LOOP | ENABLED
    machine.say("&1E")
    assert not any(machine.status(motor)[0] & OPEN_LOOP for motor in range(1, 7))


def test_abort_all_closes_loops_and_kill_all_opens_them(machine):
    machine.say("#1K #2J+")
    machine.wait(100)
    machine.bytes(b"\x01")
    machine.wait(1000)
    assert not any(machine.status(motor)[0] & OPEN_LOOP for motor in range(1, 7))
    assert machine.say("#2V") == "0"
    machine.bytes(b"\x0b")
    assert all(machine.status(motor)[0] & OPEN_LOOP for motor in range(1, 7))
