# SPDX-License-Identifier: LGPL-2.1-or-later
"""How answers are framed. The bytes are those of the Turbo PMAC Software Reference, at I3, I4, I6 and <CTRL-N>."""

import random

import pytest

from pkm_post.control.simulator import Controller, SerialPort

# Software Reference, I3: for each value no data, data, and an invalid command (I6 = 1).
FRAMES = {
    0: (b"", b"25\r50\r", b"\x07ERR003\r"),
    1: (b"\n", b"\n25\r\n50\r\n", b"\x07\nERR003\r"),
    2: (b"\x06", b"25\r50\r\x06", b"\x07ERR003\r"),
    3: (b"\x06", b"\n25\r\n50\r\x06", b"\x07\nERR003\r"),
}


@pytest.mark.parametrize("handshake", FRAMES)
def test_the_handshake_is_that_of_i3(pmac, handshake):
    pmac.bytes(f"I6=1 P1=25 P2=50 I3={handshake}\r".encode())
    assert tuple(map(pmac.bytes, (b"P3=1\r", b"P1..2\r", b"FOO\r"))) == FRAMES[handshake]


@pytest.mark.parametrize(
    ("form", "handshake", "answer"),
    # Software Reference, I6: 0 and 2 the bell alone, 1 with the number, 3 with a carriage return between.
    [
        (0, 2, b"\x07"),
        (1, 2, b"\x07ERR003\r"),
        (2, 2, b"\x07"),
        (3, 2, b"\x07\rERR003\r"),
        (3, 3, b"\x07\r\nERR003\r"),
    ],
)
def test_errors_are_reported_as_i6_says(pmac, form, handshake, answer):
    pmac.bytes(f"I3={handshake} I6={form}\r".encode())
    assert pmac.bytes(b"FOO\r") == answer


def test_after_a_reset_the_handshake_is_a_line_feed():
    assert SerialPort(Controller()).receive(b"I3\r") == b"\n1\r\n"


def test_sums_follow_the_data_and_the_handshake(pmac):
    # Software Reference, I4; each sum is that of the bytes of its line with the carriage return, the last one that of
    # the six characters of the command: 0x110.
    pmac.say("P1=25 P2=50 P3=75")
    pmac.bytes(b"I4=1\r")
    assert pmac.bytes(b"P1..3\r") == bytes.fromhex("32350D74 35300D72 37350D79 06 10")


def test_the_line_feed_counts_in_the_sum_of_its_line(pmac):
    pmac.say("P1=25")
    pmac.bytes(b"I4=1 I3=3\r")
    assert pmac.bytes(b"P1\r") == b"\n25\r" + bytes([0x74 + 0x0A]) + b"\x06" + bytes([sum(b"P1")])


def test_a_line_is_checked_before_it_is_carried_out(machine):
    # Software Reference, <CTRL-N>: the sum of J/ is 121; then the carriage return, or <CTRL-X> instead.
    machine.bytes(b"I4=1\r")
    assert machine.bytes(b"J/\x0e") == bytes([121])
    assert machine.bytes(b"\r") == bytes([0x06, 121])
    machine.bytes(b"I4=0\r")
    assert machine.bytes(b"P5=17\x0e\x18") == bytes([sum(b"P5=17") & 0xFF])
    assert machine.say("P5") == "0"


def test_cancelling_is_echoed_when_i63_asks_for_it(pmac):
    assert pmac.bytes(b"P1=4\x18") == b""
    pmac.say("I63=1")
    assert pmac.bytes(b"P1=4\x18") == b"\x18"
    assert pmac.say("P1") == "0"


def test_what_a_program_said_is_handed_out_once(machine):
    machine.lines('OPEN PROG 1\nCLEAR\nSEND"hello"\nCLOSE\nB1R')
    machine.wait(2)
    assert machine.line.output() == b"hello\r"
    assert machine.line.output() == b""


def test_backspace_takes_a_character_back(pmac):
    assert pmac.bytes(b"P1=78\x08\x089\r") == b"\x06"
    assert pmac.say("P1") == "9"


def test_a_line_feed_and_a_lone_carriage_return_do_nothing(pmac):
    assert pmac.bytes(b"\n") == b""
    assert pmac.bytes(b"\r") == b"\x06"
    assert pmac.bytes(b"P1\r\n") == b"0\r\x06"


def test_answers_do_not_depend_on_how_bytes_arrive(pmac):
    text = b"P1=3\rP1 P1\rFOO\r#1P\r\x10LIST PROG 1001\rI4=1\rP1..4\rP1\x0e\r"
    whole = SerialPort(Controller()).receive(text)
    chance = random.Random(1)
    for _ in range(20):
        line, answer, at = SerialPort(Controller()), b"", 0
        while at < len(text):
            size = chance.randint(1, 9)
            answer += line.receive(text[at : at + size])
            at += size
        assert answer == whole


def test_a_character_beyond_ascii_spoils_its_line_alone(machine):
    # Error 4: illegal character or parity.
    assert machine.bytes(b"#1\x80J+\r") == b"\x07ERR004\r"
    machine.wait(100)
    assert machine.say("#1P") == "0"


def test_a_line_that_is_too_long_is_refused_and_not_carried_out(pmac):
    assert pmac.error("P1=1" + " " * 252) == 3
    assert pmac.say("P1") == "0"
    assert pmac.say("P1=1" + " " * 251) == ""
    assert pmac.say("P1") == "1"


def test_what_a_program_sends_comes_unasked_without_acknowledge(machine):
    # Software Reference, I64: such lines begin with <CTRL-B>, and so do errors of CMD instead of the bell.
    machine.lines('OPEN PROG 1\nCLEAR\nSEND"hello"\nCMD"P7"\nCMD"FOO"\nCLOSE\nP7=5')
    machine.say("B1R")
    machine.wait(2)
    assert machine.bytes(b"") == b"hello\r5\r\x07ERR003\r"
    machine.say("I64=1 B1R")
    machine.wait(2)
    assert machine.bytes(b"") == b"\x02hello\r\x025\r\x02ERR003\r"
    machine.say("I6=2 B1R")
    machine.wait(2)
    assert machine.bytes(b"") == b"\x02hello\r\x025\r"


# Software Reference, on-line control characters: positions, speeds, following errors of eight motors, status words.
@pytest.mark.parametrize(
    ("control", "answer"),
    [
        (0x10, "1000 0 0 0 0 0 0 0"),
        (0x16, "0 0 0 0 0 0 0 0"),
        (0x06, "0 0 0 0 0 0 0 0"),
        (0x07, "0" * 12),
        (0x02, " ".join(["882000008401"] * 6 + ["0" * 12] * 2)),
        (0x03, " ".join(["000000020000000000"] + ["0" * 18] * 7)),
    ],
)
def test_control_characters_ask_for_eight_motors_at_once(machine, control, answer):
    machine.say("#1J=1000")
    machine.wait(1000)
    assert machine.bytes(bytes([control])) == answer.encode() + b"\r\x06"


def test_the_bank_of_the_control_characters(machine):
    machine.say("#1J=1000")
    machine.wait(1000)
    machine.say("##1")
    assert machine.bytes(b"\x10") == b"0 0 0 0 0 0 0 0\r\x06"


@pytest.mark.parametrize("control", [0x01, 0x04, 0x0B, 0x0C, 0x0F, 0x11, 0x12, 0x13, 0x1A])
def test_other_control_characters_are_not_answered(machine, control):
    assert machine.bytes(bytes([control])) == b""
