# SPDX-License-Identifier: LGPL-2.1-or-later
"""Every error that the simulator reports, how it comes about, by its number in the PMAC Software Reference at I6."""

import pytest
from simulated import make

from pkm_post.control.simulator import ERROR_TEXTS, CommandError

NEVER = {8, 18, 19}
"""MACRO auxiliary communication, phase reference and the buffer of cutter compensation are not simulated."""

PROGRAM = "OPEN PROG 10\nCLEAR\nLINEAR TM1000\nA510\nA520\nCLOSE"


def test_each_number_has_a_meaning():
    assert sorted(ERROR_TEXTS) == list(range(1, 20))
    assert str(CommandError(12)) == "ERR012: a motor is open-loop"


@pytest.fixture
def running(machine):
    machine.lines(PROGRAM)
    machine.say("&1B10R")
    machine.wait(20)
    assert machine.runs()
    return machine


@pytest.mark.parametrize(
    "command",
    ["OPEN PROG 11", "B10", "#1J+", "#1HM", "#1K", "#1->10000X", "UNDEFINE ALL", "DEFINE ROT 100", "DELETE ROT", "E"],
)
def test_001_not_while_a_program_runs(running, command):
    assert running.error(command) == 1
    assert running.runs()


def test_002_programs_from_1000_on_need_the_password():
    pmac = make(password="sesame")
    assert pmac.error("OPEN PROG 1000") == 2
    assert pmac.error("LIST PROG 1001") == 2
    pmac.say("PASSWORD=wrong")
    assert pmac.error("OPEN PROG 1000") == 2
    pmac.say("OPEN PROG 999")
    pmac.say("CLOSE")
    pmac.say("PASSWORD=sesame")
    pmac.say("OPEN PROG 1000")


NO_COMMANDS = """
FOO|#0P|#33P|&17|##4|I8192|P1..0|LIST PROG 77|OPEN PROG 32768|OPEN PROG 0|O101|#1->0X|#1->10X+10Y|# 1->10X|!
J|OPEN|M1->#|CIRCLE1|PVT|B"""


@pytest.mark.parametrize("command", NO_COMMANDS.strip().replace("\n", "|").split("|"))
def test_003_data_error(machine, command):
    assert machine.error(command) == 3


@pytest.mark.parametrize(
    "line", ["CIRCLE1 X10", "SPLINE1", "HOME1", "X10:", "A1e5 X", "P1==2", 'SEND"open', "ABS(A,Q)", "IF P1>2"]
)
def test_003_what_is_no_statement_stays_out_of_the_buffer(machine, line):
    machine.lines("OPEN PROG 10\nCLEAR")
    assert machine.error(line) == 3
    machine.say("CLOSE")
    assert machine.error("LIST PROG 10") == 3  # a program without lines is none


def test_004_illegal_character(pmac):
    assert pmac.error("P1=1\xff") == 4


@pytest.mark.parametrize(
    "line",
    ["X1000", "A512.3 B513.0", "LINEAR", "DWELL0", "PVT20", "RETURN", "F10", "TA100", "CLEAR", "M3", "S100", "T3 M6"],
)
def test_005_statements_need_an_open_buffer(machine, line):
    if line == "M3":
        assert machine.say(line) == "0"  # on-line this asks for an M-variable
    else:
        assert machine.error(line) == 5


def test_006_no_room_in_the_memory():
    pmac = make(memory_words=1000)
    pmac.lines("DELETE GATHER\nOPEN PROG 10\nCLEAR")
    room = -int(pmac.say("SIZE"))
    for _ in range((room - 1) // 12):
        pmac.say("A1:1B1:1C1:1U1:1V1:1W1:1")
    assert pmac.error("A1:1B1:1C1:1U1:1V1:1W1:1") == 6
    pmac.say("CLOSE")
    assert pmac.say("LIST PROG 10").count("\r") == (room - 1) // 12


def test_006_no_room_beside_gathered_data(pmac):
    pmac.say("DEFINE GATHER")
    assert pmac.say("SIZE") == "0"
    pmac.lines("OPEN PROG 10\nCLEAR")
    assert pmac.error("X1") == 6
    pmac.lines("CLOSE\nDELETE GATHER\nOPEN PROG 10\nCLEAR\nX1\nCLOSE")


def test_006_no_room_in_the_rotary_buffer(machine):
    machine.lines("DEFINE ROT 20\nB0\nOPEN ROT\nA1:1B1:1C1:1U1:1V1:1W1:1")
    assert machine.error("A1:1B1:1C1:1U1:1V1:1W1:1") == 6
    assert machine.say("PR") == "1"


@pytest.mark.parametrize("command", ["OPEN PROG 11", "OPEN ROT", "DEFINE ROT 100", "DELETE GATHER", "DEFINE GATHER"])
def test_007_buffer_in_use(machine, command):
    machine.say("OPEN PROG 10")
    assert machine.error(command) == 7


@pytest.mark.parametrize("body", ["IF(P1>1)", "ENDIF", "WHILE(P1>1)\nENDIF", "ELSE", "IF(P1=1)\nENDWHILE"])
def test_009_a_program_without_structure_and_016_it_does_not_run(machine, body):
    machine.lines(f"OPEN PROG 10\nCLEAR\n{body}")
    assert machine.error("CLOSE") == 9
    machine.say("B10")
    assert machine.error("R") == 16


def test_010_both_limits(machine):
    machine.lines(PROGRAM)
    machine.controller.motors.low_switch[2] = machine.controller.motors.high_switch[2] = True
    assert machine.error("B10R") == 10


def test_011_a_move_is_not_completed(machine):
    machine.lines(PROGRAM)
    machine.say("#2J+")
    machine.wait(50)
    assert machine.error("B10R") == 11
    machine.say("#2J/")
    machine.wait(1000)
    machine.say("#2J=0")
    machine.wait(1000)
    machine.say("B10R")


def test_012_a_motor_is_open_loop(machine):
    machine.lines(PROGRAM)
    machine.say("#4K")
    assert machine.error("B10R") == 12


def test_013_a_motor_is_not_activated(machine):
    machine.lines(PROGRAM)
    machine.say("I500=0")
    assert machine.error("B10R") == 13
    assert machine.error("#5J+") == 13
    assert machine.error("#7J+") == 13


def test_014_no_motors_in_the_coordinate_system(machine):
    machine.lines(PROGRAM)
    assert machine.error("&2B10R") == 14
    machine.say("&1UNDEFINE")
    assert machine.error("B10R") == 14


def test_014_i68_says_how_many_coordinate_systems_are_served(pmac):
    pmac.lines("&3#1->1000X\n#1J/\nOPEN PROG 1\nCLEAR\nDWELL1\nCLOSE\nI68=1\nB1")
    assert pmac.error("R") == 14
    pmac.say("I68=2")
    pmac.say("R")


def test_015_no_valid_program(machine):
    assert machine.error("R") == 15
    assert machine.error("B10R") == 15
    machine.lines(PROGRAM)
    assert machine.error("R") == 15, "opening a program takes all pointers away"
    machine.say("B10R")


def test_015_none_runs_while_a_program_is_open(machine):
    machine.lines(PROGRAM)
    machine.say("OPEN PROG 11")
    machine.say("B10")
    assert machine.error("R") == 15


def test_017_motors_were_moved_away(running):
    running.say("H")
    running.wait(1500)
    running.say("#1J:5000")
    running.wait(1000)
    assert running.error("R") == 17
    running.say("#1J=")
    running.wait(1000)
    running.say("R")
    running.wait(4000)
    assert running.position()[0] == 520 and not running.runs()
