# SPDX-License-Identifier: LGPL-2.1-or-later
"""Packets, byte by byte as the manual of the Ethernet card has them."""

import pytest

from pkm_post.control.link.ethernet_protocol import CTRL_RESPONSE, MOST_ANSWER, EthernetProtocol, packet
from pkm_post.control.link.protocol import Answer, CommandKind, ControllerCommand, Lost, Refusal


@pytest.fixture
def talk():
    return EthernetProtocol()


def test_get_response(talk):
    # the manual's example: "ver" and the answer 1.945 with two blanks
    talk.begin(ControllerCommand("ver"), 0.0)
    assert talk.outgoing() == bytes.fromhex("40 BF 0000 0000 0003 76 65 72")
    talk.receive(bytes.fromhex("31 2E 39 34 35 20 20 0D 06"), 0.1)
    assert talk.events() == [Answer(("1.945  ",))]


def test_a_control_character_is_in_the_value():
    assert packet(CTRL_RESPONSE, value=1, length=0x578) == bytes.fromhex("C0 C4 0001 0000 0578")


def test_a_long_answer_is_fetched(talk):
    talk.begin(ControllerCommand("LIST"), 0.0)
    talk.outgoing()
    answer = b"".join(b"%06d\r" % number for number in range(1000)) + b"\x06"
    for first in range(0, len(answer), MOST_ANSWER):
        assert not talk.events()
        if first:
            assert talk.outgoing() == bytes.fromhex("C0 C5 0000 0000 0578")
        talk.receive(answer[first : first + MOST_ANSWER], 0.1)
    (event,) = talk.events()
    assert event.lines == tuple(f"{number:06d}" for number in range(1000))


def test_an_answer_that_ends_with_its_packet_is_not_asked_for_more(talk):
    talk.begin(ControllerCommand("P1"), 0.0)
    talk.outgoing()
    talk.receive(b"1" * (MOST_ANSWER - 2) + b"\r\x06", 0.1)
    assert len(talk.events()) == 1 and talk.outgoing() == b""


def test_write_buffer(talk):
    talk.begin(ControllerCommand("ABS\nLINEAR", CommandKind.BUFFER), 0.0)
    assert talk.outgoing() == bytes.fromhex("40 C6 0000 0000 000B") + b"ABS\0LINEAR\0"
    talk.receive(bytes(4), 0.1)
    assert talk.events() == [Answer()]


def test_a_line_that_is_refused(talk):
    talk.begin(ControllerCommand("ABS\nFOO", CommandKind.BUFFER), 0.0)
    talk.receive(bytes([2, 0, 3]), 0.1)
    assert not talk.events()
    talk.receive(b"\x80", 0.1)
    assert talk.events() == [Refusal(3, line=1)]


def test_a_strange_answer_to_lines(talk):
    talk.begin(ControllerCommand("ABS", CommandKind.BUFFER), 0.0)
    talk.receive(b"\x01\x02\x03\x04", 0.1)
    assert isinstance(talk.events()[0], Lost)


def test_silence(talk):
    talk.begin(ControllerCommand("P1", answer_timeout=2.0), 0.0)
    assert talk.deadline == 2.0
    talk.receive(b"1", 1.0)
    assert talk.deadline == 3.0
    talk.expire(3.0)
    assert isinstance(talk.events()[0], Lost)


def test_lines_at_once_fit_into_a_packet(talk):
    lines = ["A" * 99] * 20
    count = talk.lines_at_once(lines)
    assert count == 10
    talk.begin(ControllerCommand("\n".join(lines[:count]), CommandKind.BUFFER), 0.0)
    assert len(talk.outgoing()) == 8 + 1000


def test_one_command_at_a_time(talk):
    talk.begin(ControllerCommand("P1"), 0.0)
    with pytest.raises(ValueError, match="expected none outstanding"):
        talk.begin(ControllerCommand("P2"), 0.0)
