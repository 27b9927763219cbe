# SPDX-License-Identifier: LGPL-2.1-or-later
"""On-line commands [Turbo PMAC Software Reference, on-line commands]: variables, programs, identity, resets."""

import pytest
from controller_settings import settings_for
from simulated import make

from pkm_post.control.simulator import SimulatorSettings as SimulatorSettings
from pkm_post.model import StrutMotion
from pkm_post.writing.controllers.pmac import program_text, setup_text


def test_who_it_is(pmac):
    assert pmac.say("TYPE") == "TURBO2, X4"
    assert pmac.say("VER") == pmac.say("VERSION") == "1.947"
    assert pmac.say("CID") == "602413"  # Turbo PMAC2-VME and UMAC
    assert pmac.say("???") == "0" * 12


def test_defaults(pmac):
    # Software Reference, at each variable.
    assert pmac.say("I5190 I5189 I5194 I5195 I42 I68 I16 I17 I10") == "1000\r1000\r1644\r1644\r0\r15\r5\r10\r3713707"
    assert pmac.say("I111 I116 I122 I128") == "32000\r32\r32\r160"
    assert pmac.say("I5193 I6693") == "$2000\r$2F00"  # X:$002x00 are the registers of coordinate system x+1


def test_a_value_beyond_a_limited_range_is_rolled_over(pmac):
    # User Manual, I-Variables, Limited Range: I3=5 gives 1, and no error.
    pmac.say("I9=5 I68=17 I42=3")
    assert pmac.say("I9 I68 I42") == "I9=1\rI68=1\rI42=1"


def test_several_commands_on_a_line_and_small_letters(pmac):
    assert pmac.say("p1=3 P2=P1*2 p1 P2 &2#3p") == "3\r6\r0"
    assert pmac.say("P10..12=8P10..12") == "8\r8\r8"


def test_q_variables_belong_to_their_coordinate_system(pmac):
    pmac.lines("&1Q5=1\n&2Q5=2")
    assert pmac.say("&1Q5&2Q5") == "1\r2"


def test_behind_a_value_an_address_would_be_an_operator(pmac):
    # Which is why a set-up file has its lines with & before the assignments.
    pmac.say("&1 P1=7 &2 P2=1")
    assert pmac.say("P1..2") == "2\r1"


def test_the_commands_before_a_faulty_one_are_carried_out(pmac):
    assert pmac.error("P1=1 FOO P2=2") == 3
    assert pmac.say("P1..2") == "1\r0"


def test_m_variables_keep_what_is_written_and_tell_where_they_point(pmac):
    pmac.say("M5->X:$78200,8,4,S")
    pmac.say("M5=3")
    assert pmac.say("M5") == "3"
    assert pmac.say("M5->") == "X:$78200,8,4,S"
    assert pmac.say("M6->") == "*"


def test_size_counts_the_words_and_is_negative_while_a_buffer_is_open(pmac):
    free = int(pmac.say("SIZE"))
    pmac.lines("OPEN PROG 10\nCLEAR\nA1:2 B3:4\nDWELL0")
    assert int(pmac.say("SIZE")) == -(free - 5)
    pmac.say("CLOSE")
    assert int(pmac.say("SIZE")) == free - 6  # with the return at the end
    pmac.lines("OPEN PROG 10\nCLEAR\nCLOSE")
    assert int(pmac.say("SIZE")) == free


def test_a_written_program_is_listed_as_it_was_written_but_for_its_form(pmac):
    settings = settings_for()
    length = [[512.345678 + strut for strut in range(6)], [-0.000001 * strut - 7 for strut in range(6)]]
    motion = StrutMotion([0, 40], length, [[0.0] * 6] * 2, ())
    text = program_text(motion, settings, ["a comment; with another"])
    pmac.lines(text)
    pmac.say("I9=3")
    listed = pmac.say("LIST PROG 10").split("\r")
    written = text.split("CLEAR\n")[1].splitlines()[:-1]
    assert listed[-1] == "RETURN"
    assert [tokens(line) for line in listed[:-1]] == [tokens(line) for line in written]


def tokens(line):
    """A line without spaces, its numbers as numbers."""
    import re

    return [float(token) if token[-1].isdigit() else token for token in re.findall(r"-?[0-9.]+|[^0-9. -]+", line)]


@pytest.mark.parametrize(
    ("form", "words"),
    [
        (0, "LIN DWE5 RPD RET"),
        (1, "LINEAR DWELL5 RAPID RETURN"),
        (2, "LIN DWE5 RPD RET"),
        (3, "LINEAR DWELL5 RAPID RETURN"),
    ],
)
def test_i9_decides_how_words_are_listed(pmac, form, words):
    pmac.lines(f"OPEN PROG 1\nCLEAR\nLIN\nDWELL 5\nRAPID\nCLOSE\nI9={form}")
    assert pmac.say("LIST PROG 1").split("\r") == words.split()


@pytest.mark.parametrize(
    ("form", "answers"),
    [
        (0, "1000 8448 8704 * 25"),
        (1, "I5190=1000 I5293=8448 I5393=8704 M1->* 25"),
        (2, "1000 $2100 $2200 * 25"),
        (3, "I5190=1000 I5293=$2100 I5393=$2200 M1->* 25"),
    ],
)
def test_i9_decides_how_variables_are_reported(pmac, form, answers):
    # Software Reference, I9: in the long form I-variables and definitions of M-variables are whole statements.
    pmac.lines(f"P1=25\nI9={form}")
    asked = [pmac.say(each) for each in ("I5190", "I5293", "I5393", "M1->", "P1")]
    assert asked == answers.split()


def test_a_part_of_a_program_is_listed_by_words(pmac):
    pmac.lines("OPEN PROG 1\nCLEAR\n" + "\n".join(f"A{line}:1B{line}:2" for line in range(10)) + "\nCLOSE")
    assert pmac.say("LIST PROG 1,8,8") == "A2:1B2:2\rA3:1B3:2"
    assert pmac.say("LIST PROG 1,36") == "A9:1B9:2\rRET"


def test_without_clear_lines_are_appended(pmac):
    pmac.lines("OPEN PROG 1 CLEAR\nX1\nCLOSE\nOPEN PROG 1\nX2\nCLOSE")
    assert pmac.say("LIST PROG 1") == "X1\rX2\rRET"


def test_while_a_buffer_is_open_questions_are_answered(machine):
    machine.lines("OPEN PROG 1\nCLEAR\nX1")
    assert machine.say("#1P") == "0"
    assert machine.say("I5190") == "1000"
    machine.say("I5190=500")  # a statement of the program
    assert machine.say("I5190") == "1000"
    machine.say("CLOSE")
    assert machine.say("LIST PROG 1") == "X1\rI5190=500\rRET"


def test_other_ports_cannot_fill_or_close_what_one_has_opened(pmac):
    from pkm_post.control.simulator import SerialPort

    other = SerialPort(pmac.controller)
    pmac.lines("OPEN PROG 1\nCLEAR")
    assert other.receive(b"X1\r") == b"\x07ERR005\r"
    assert other.receive(b"OPEN PROG 2\r") == b"\x07ERR007\r"
    assert other.receive(b"CLOSE\r") == b"\x06"
    pmac.lines("X2\nCLOSE")
    assert pmac.say("LIST PROG 1") == "X2\rRET"


def test_where_a_program_is(machine):
    machine.lines("OPEN PROG 1\nCLEAR\nLINEAR TM1000\nA501\nDWELL5\nA502\nN50000 A503\nCLOSE\nB1")
    assert machine.say("LIST PC") == "P1:0:LIN"
    machine.say("R")
    machine.wait(10)
    assert machine.say("LIST PC") == "P1:4:A502"
    machine.say("A B1.5")
    assert machine.say("LIST PC") == "P1:5:N50000"


def test_a_reset_brings_back_what_was_saved(machine):
    machine.lines("OPEN PROG 1\nCLEAR\nX1\nCLOSE\nP1=5\nSAVE\nP1=6\nOPEN PROG 1\nCLEAR\nX2\nCLOSE")
    machine.bytes(b"$$$\r")
    assert machine.say("P1") == "5" and machine.say("LIST PROG 1") == "X1\rRET"
    assert machine.say("#1->") == "10000A-5000000"
    first, second = machine.status(1)
    assert first & 1 << 18 and not second & 1 << 10, "open-loop, and home is lost"
    machine.lines("OPEN PROG 1\nX3\nCLOSE")
    assert machine.say("LIST PROG 1") == "X1\rX3\rRET"


def test_the_settings_of_the_factory(machine):
    machine.say("P1=5")
    machine.bytes(b"$$$***\r")
    assert machine.bytes(b"P1\r#1->\r") == b"\n0\r\n\n0\r\n"


def test_the_set_up_file_of_a_machine_is_taken_as_it_is(pmac):
    settings = settings_for(counts_per_mm=-2000.0, zero_length=(700.25,) * 6, coordinate_system=2)
    pmac.lines(setup_text(settings, "a machine", (600.0, 900.0)))
    assert pmac.say("#6->") == "-2000W+1400500"
    assert pmac.say("I5290 I113 I114 I127") == "1000\r200500\r-399500\r0"


def test_plc_words_are_taken_though_there_are_no_plc_programs(pmac):
    for line in ("DISABLE PLC 1..31", "ENABLE PLC 2,3", "ENA PLCC0"):
        assert pmac.say(line) == ""
    assert pmac.error("ENABLE PLC") == 3


@pytest.mark.parametrize("entry", [{"memory_words": 999}, {"tick_ms": 0.0}, {"lag_ms": -1.0}])
def test_settings_without_sense_are_refused(entry):
    with pytest.raises(ValueError, match="expected"):
        SimulatorSettings(**entry)


def test_the_same_commands_at_the_same_times_give_the_same_positions():
    def played():
        pmac = make()
        pmac.lines("&1#1->100X\n#1J/\nOPEN PROG 1\nCLEAR\nLINEAR F7\nX10\nX-3\nPVT33.25\nX1:2\nX1:0\nCLOSE\nB1R")
        pmac.wait(777.25)
        return pmac.controller.motors.actual.tobytes()

    assert played() == played()


def test_an_open_program_without_lines_lists_nothing():
    machine = make()
    machine.lines("OPEN PROG 5\nCLEAR")
    assert machine.say("LIST PROG 5") == ""
