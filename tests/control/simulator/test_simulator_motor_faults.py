# SPDX-License-Identifier: LGPL-2.1-or-later
"""Limits, switches, following errors and faults, and how the status words show them.

The bits of ``#n?`` are those that the EPICS driver for the Turbo PMAC reads and the Software Reference lists.
"""

import pytest

NEGATIVE_LIMIT, POSITIVE_LIMIT, ENABLED, OPEN_LOOP = (1 << bit for bit in (22, 21, 19, 18))
ON_LIMIT, AMPLIFIER_FAULT, FATAL, WARNING = (1 << bit for bit in (11, 3, 2, 1))


@pytest.mark.parametrize(("way", "which", "bit"), [("+", 13, POSITIVE_LIMIT), ("-", 14, NEGATIVE_LIMIT)])
def test_a_soft_limit_stops_a_jog(machine, way, which, bit):
    machine.say(f"I1{which}={way.strip('+')}10000 #1J{way}")
    machine.wait(3000)
    first, second = machine.status(1)
    assert first & bit and second & ON_LIMIT and machine.say("#1V") == "0"
    beyond = abs(float(machine.say("#1P"))) - 10000
    # Braking from 200 counts/ms at 10 counts/ms^2 takes 2000 counts; a tick and the lag go before.
    assert 0 < beyond < 2000 + 300
    machine.say(f"#1J={way}5000")
    machine.wait(3000)
    assert machine.say("#1P") == f"{way}5000".lstrip("+")
    assert not machine.status(1)[0] & bit


def test_a_limit_of_zero_is_none_and_ix24_takes_all_away(machine):
    machine.say("I113=0 #1J=20000")
    machine.say("I213=1000 I224=$20000 #2J=20000")
    machine.wait(3000)
    assert machine.say("#1P #2P") == "20000\r20000"
    assert machine.say("I224") == "$20000"


def test_an_overtravel_switch_stops_the_way_towards_it_alone(machine):
    machine.controller.motors.high_switch[0] = True
    machine.say("#1J+")
    machine.wait(1000)
    first, second = machine.status(1)
    assert first & POSITIVE_LIMIT and second & ON_LIMIT
    machine.say("#1J=-500")
    machine.wait(1000)
    assert machine.say("#1P") == "-500"


def test_a_motor_that_cannot_turn_trips_and_takes_its_coordinate_system_with_it(machine):
    machine.lines("OPEN PROG 10\nCLEAR\nLINEAR TM1000\nA520 B520 C520 U520 V520 W520\nDWELL0\nCLOSE\nI312=16000")
    machine.controller.motors.jammed[2] = True
    machine.say("B10R")
    machine.wait(60)
    assert machine.status(3)[1] & WARNING and machine.runs()
    machine.wait(1000)
    first, second = machine.status(3)
    assert first & OPEN_LOOP and not first & ENABLED and second & FATAL
    assert all(machine.status(motor)[0] & OPEN_LOOP for motor in range(1, 7))
    assert not machine.status(1)[1] & FATAL
    words = machine.system()
    assert not words[0] & 1 and words[1] & 1 << 19
    machine.controller.motors.jammed[2] = False
    machine.say("#3J/")
    assert not machine.status(3)[1] & FATAL


def test_an_amplifier_fault_trips(machine):
    machine.controller.motors.amplifier_fault[5] = True
    machine.wait(1)
    assert machine.status(6)[1] & AMPLIFIER_FAULT and machine.status(6)[0] & OPEN_LOOP
    assert machine.system()[1] & 1 << 20
