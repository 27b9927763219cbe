# SPDX-License-Identifier: LGPL-2.1-or-later
"""Programs that run: stops, steps, assignments, branches, calls, and those that cannot go on."""

import copy

import pytest

RUNNING, RUNTIME_ERROR = 1, 1 << 22


def test_m0_waits_for_the_next_run(machine):
    machine.lines("OPEN PROG 1\nCLEAR\nLINEAR TM100 TS0 TA10\nA501\nDWELL0\nM0\nA502\nDWELL0\nCLOSE")
    machine.say("B1R")
    machine.wait(1000)
    assert not machine.runs() and machine.position()[0] == 501
    machine.say("R")
    machine.wait(1000)
    assert not machine.runs() and machine.position()[0] == 502


def test_without_a_dwell_assignments_run_ahead_and_synchronous_ones_wait(machine):
    # Turbo PMAC User Manual, synchronous M-variable assignment.
    machine.lines("OPEN PROG 1\nCLEAR\nLINEAR TS0 TA10 TM1000\nA501\nM1=1\nM2==1\nM3|=6\nA502\nDWELL0\nCLOSE\nM3=1")
    machine.say("B1R")
    machine.wait(100)
    assert machine.say("M1..3") == "1\r0\r1"
    machine.wait(1000)
    assert machine.say("M1..3") == "1\r1\r7"


def test_single_steps_stop_behind_each_move_unless_in_a_block(machine):
    machine.lines("OPEN PROG 1\nCLEAR\nLINEAR TS0 TA10 TM50\nA501\nA502\nBSTART A503\nA504 BSTOP A505\nA506\nCLOSE")
    machine.say("B1")
    places = []
    for _ in range(4):
        machine.say("S")
        machine.wait(500)
        assert not machine.runs()
        places.append(machine.position()[0])
    assert places == [501, 502, 505, 506]


def test_a_step_or_an_end_that_was_asked_for_is_taken_back_by_run(machine):
    machine.lines("OPEN PROG 1\nCLEAR\nLINEAR TS0 TA10 TM100\nA501\nA502\nA503\nCLOSE\nB1")
    for last in ("S", "RQ"):
        machine.say("#1J=0")
        machine.wait(2000)
        machine.say("B1" + last[0])
        machine.wait(20)
        machine.say((last[1:] + " R").strip())
        machine.wait(1000)
        assert not machine.runs() and machine.position()[0] == 503


def test_quitting_ends_behind_the_moves_that_are_computed(machine):
    machine.lines("OPEN PROG 1\nCLEAR\nLINEAR TS0 TA10 TM100\nA501\nA502\nA503\nA504\nCLOSE")
    machine.say("B1R")
    machine.wait(50)
    machine.say("Q")
    machine.wait(1000)
    assert not machine.runs() and machine.position()[0] == 502
    machine.say("R")
    machine.wait(1000)
    assert machine.position()[0] == 504


def test_a_program_that_holds_itself_in_a_copy_holds_the_copy(machine):
    machine.lines('OPEN PROG 1\nCLEAR\nLINEAR TS0 TA10 TM100\nA501\nCMD"&1H"\nA502\nA503\nCLOSE')
    other = copy.deepcopy(machine.controller)
    other.load(["B1R"])
    other.advance(100)
    assert other.systems[0].holding and not machine.controller.systems[0].holding


@pytest.mark.parametrize(
    ("body", "result"),
    [
        ("P1=0 WHILE(P1<5) P1=P1+1", "5"),
        ("P1=0\nWHILE(P1<5)\nP1=P1+1\nIF(P1=3)\nP1=10\nENDIF\nENDWHILE", "10"),
        ("IF(P2=1)\nP1=1\nELSE\nP1=2\nENDIF", "2"),
        ("IF(P2=0 AND P3=0 OR P4!=0) P1=7", "7"),
        ("GOSUB 100\nP1=P1*2\nRETURN\nN100 P1=21 RETURN", "42"),
        ("P1=1\nGOTO 5\nP1=2\nN5 P1=P1+10", "11"),
        ("CALL 2.03\nP1=P1+1", "31"),
        ("G4", "400"),
        ("G104", "4104"),
        ("D(1+1) P1=P1+1", "3"),
        ("Q5=3 P1=Q5", "3"),
        ("I5190=500 P1=I5190", "500"),
    ],
)
def test_branches_loops_and_calls(machine, body, result):
    machine.lines("OPEN PROG 2\nCLEAR\nP1=1 RETURN\nN3000 P1=30\nCLOSE")
    machine.lines("OPEN PROG 1000\nCLEAR\nN4000 P1=400\nCLOSE\nOPEN PROG 1010\nCLEAR\nN4000 P1=4104\nCLOSE")
    machine.lines("OPEN PROG 1003\nCLEAR\nN2000 P1=2\nCLOSE")
    machine.lines(f"OPEN PROG 1\nCLEAR\n{body}\nCLOSE")
    machine.say("P2=0 B1R")
    machine.wait(5)
    assert machine.say("P1") == result
    assert not machine.runs()


@pytest.mark.parametrize(
    "body", ["GOTO 99", "CALL 88", "M77", "PVT0 A501:1", "PVT4096", "F0 A501", "P1=1/0", "N1 GOSUB 1"]
)
def test_a_program_that_cannot_go_on_ends_with_a_run_time_error(machine, body):
    machine.lines(f"OPEN PROG 1\nCLEAR\n{body}\nCLOSE")
    machine.say("B1R")
    machine.wait(10)
    words = machine.system()
    assert not words[0] & RUNNING and words[1] & RUNTIME_ERROR


@pytest.mark.parametrize("body", ["WHILE(1=1)", "WHILE(1=1) P1=P1+1", "WHILE(1=1) DWELL0", "N1 GOTO 1"])
def test_a_program_without_end_leaves_the_controller_alive(machine, body):
    machine.lines(
        f"OPEN PROG 1\nCLEAR\n{body}\nENDWHILE\nCLOSE".replace("\nENDWHILE", "" if " " in body else "\nENDWHILE")
    )
    machine.say("B1R")
    machine.wait(3)
    assert machine.runs()
    machine.say("A")
    assert not machine.runs()
