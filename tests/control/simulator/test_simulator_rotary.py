# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rotary buffers [Turbo PMAC User Manual and Software Reference, rotary buffers; Software Reference, I16, I17, ??]."""

import pytest
from simulated import PROGRAM_SETTINGS, curved_motion, ready_machine

from pkm_post.writing.controllers.pmac import program_text, rotary_text

FULL = 1 << 16


def move(millimetres, speed=0):
    return " ".join(f"{letter}{500 + millimetres}:{speed}" for letter in "ABCUVW")


@pytest.fixture
def streaming(machine):
    machine.lines("DELETE GATHER\n&1DEFINE ROT 600\nB0\nOPEN ROT\nPVT20")
    return machine


def test_lines_ahead_are_counted_and_leave_when_they_are_carried_out(streaming):
    for count in range(1, 31):
        streaming.say(move(0.1 * count))
    assert streaming.say("PR") == "31"
    streaming.say("R")
    ahead = []
    for _ in range(40):
        streaming.wait(20)
        ahead.append(int(streaming.say("PR")))
    assert ahead == sorted(ahead, reverse=True) and ahead[-1] == 0
    assert ahead[0] == 28  # PVT20, the move that runs, and the one that is computed ahead
    assert streaming.position()[0] == pytest.approx(503) and streaming.runs()


def test_the_request_bit_falls_below_i16_and_rises_at_i17(streaming):
    for count in range(8):
        streaming.say(move(0.1 * count))
    assert not streaming.system()[1] & FULL  # nine lines
    streaming.say(move(0.8))
    assert streaming.system()[1] & FULL
    streaming.say("R")
    seen = {}
    while int(streaming.say("PR")):
        seen[int(streaming.say("PR"))] = bool(streaming.system()[1] & FULL)
        streaming.wait(5)
    assert all(full == (ahead >= 5) for ahead, full in seen.items()) and {4, 5} <= set(seen)


def test_a_line_that_comes_too_late_is_carried_out_at_once(streaming):
    streaming.lines("R\n" + move(0.1))
    streaming.wait(500)
    assert streaming.runs() and streaming.say("PR") == "0"
    streaming.say(move(0.2))
    streaming.wait(1)
    assert 500.1 < streaming.position()[0] < 500.2
    streaming.wait(100)
    assert streaming.position()[0] == pytest.approx(500.2)
    streaming.say("Q")
    streaming.wait(1)
    assert not streaming.runs()


def test_a_starved_buffer_stops_the_motors_abruptly_and_this_is_counted(streaming):
    streaming.lines(move(0.1, 5) + "\nR")
    streaming.wait(500)
    path = streaming.controller.systems[0].path
    assert path.abrupt_stops == 1 and streaming.say("#1V") == "0"


def test_once_open_b0_is_a_move_of_axis_b(streaming):
    # Software Reference, B: it must come before OPEN ROT.
    before = int(streaming.say("PR"))
    streaming.say("B0")
    assert int(streaming.say("PR")) == before + 1


@pytest.mark.parametrize("line", ["N10", "WHILE(P1<1)", "IF(P1<1)", "GOTO 1", "RETURN", "CALL 5"])
def test_branches_have_no_place_in_a_rotary_buffer(streaming, line):
    assert streaming.error(line) == 3


def test_clear_empties_it_and_control_characters_open_and_close_it(streaming):
    streaming.say(move(1))
    streaming.say("CLEAR")
    assert streaming.say("PR") == "0"
    streaming.bytes(b"\x0c")
    assert streaming.error(move(1)) == 5
    streaming.bytes(b"\x15")
    streaming.say(move(1))
    assert streaming.say("PR") == "1"


def test_without_a_buffer_there_is_nothing_to_run(machine):
    machine.say("&1B0")
    assert machine.error("R") == 15
    machine.say("OPEN ROT")
    assert machine.error(move(1)) == 6


def test_it_is_lost_by_a_reset_and_deleted_on_request(streaming):
    streaming.say("CLOSE")
    free = int(streaming.say("SIZE"))
    streaming.say("DELETE ROT")
    assert int(streaming.say("SIZE")) == free + 600
    streaming.say("DEFINE ROT 600")
    streaming.bytes(b"$$$\r")
    assert streaming.bytes(b"I3=2 SIZE\r") == f"{free + 600}\r\x06".encode()


def test_a_written_program_runs_from_the_rotary_buffer_as_it_does_from_a_fixed_one(machine):
    text = program_text(curved_motion(), PROGRAM_SETTINGS, [])
    lines = rotary_text(text, PROGRAM_SETTINGS).splitlines()
    machine.lines("&1DEFINE ROT 800")
    start = lines.index("OPEN ROT") + 1
    machine.lines("\n".join(lines[:start]))
    places, rest, home = [], lines[start:], tuple(machine.position())
    for tick in range(6000):
        while rest and int(machine.say("PR")) < 40:
            machine.say(rest.pop(0))
        if tick == 0:
            machine.say("R")
        machine.wait(1)
        places.append(tuple(machine.position()))
    fixed = fixed_places(text)
    moving = [place for place in places if place != home]
    assert len(moving) > 2400
    assert (
        max(abs(a - b) for one, two in zip(moving, fixed, strict=False) for a, b in zip(one, two, strict=True)) < 1e-9
    )


def fixed_places(text):
    machine = ready_machine()
    machine.lines(text)
    machine.say("&1B10R")
    start = tuple(machine.position())
    places = []
    for _ in range(6000):
        machine.wait(1)
        places.append(tuple(machine.position()))
    return [place for place in places if place != start]
