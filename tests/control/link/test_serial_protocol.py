# SPDX-License-Identifier: LGPL-2.1-or-later
"""The guarded line: checksum before CR, ^X and again when it is wrong, nothing twice behind CR."""

import pytest

from pkm_post.control.link.protocol import Answer, CommandKind, ControllerCommand, Lost, Message, Refusal
from pkm_post.control.link.serial_protocol import GUARD_ATTEMPTS, LONGEST_LINE, SerialProtocol


@pytest.fixture
def talk():
    return SerialProtocol(silence=0.1)


def test_a_jog_as_the_manual_shows_it(talk):
    # J/ and ^N: the controller answers 121, 79 hexadecimal; then CR, and ACK with the same sum
    talk.begin(ControllerCommand("J/", CommandKind.SET), 0.0)
    assert talk.outgoing() == b"J/\x0e"
    talk.receive(b"\x79", 0.1)
    assert talk.outgoing() == b"\r"
    talk.receive(b"\x06\x79", 0.2)
    assert talk.events() == [Answer()]
    assert talk.deadline is None and talk.outgoing() == b""


def test_a_line_that_arrived_wrong_is_forgotten_and_sent_again(talk):
    talk.begin(ControllerCommand("J/", CommandKind.SET), 0.0)
    talk.outgoing()
    talk.receive(b"\x78", 0.1)
    assert talk.outgoing() == b"\x18"
    talk.receive(b"\x18", 0.15)  # I63=1: the controller says that it has forgotten
    assert talk.deadline == pytest.approx(0.25)
    talk.expire(0.25)
    assert talk.outgoing() == b"J/\x0e"


def test_a_line_that_never_arrives_right_was_not_carried_out(talk):
    talk.begin(ControllerCommand("J/", CommandKind.SET), 0.0)
    sent = b""
    while not (events := talk.events()):
        talk.expire(talk.deadline)
        sent += talk.outgoing()
    assert [type(event) for event in events] == [Lost] and events[0].untouched
    assert sent.count(b"J/\x0e") == GUARD_ATTEMPTS and b"\r" not in sent


def test_silence_behind_cr_leaves_it_open_whether_it_was_carried_out(talk):
    talk.begin(ControllerCommand("J/", CommandKind.SET, answer_timeout=2.0), 0.0)
    talk.receive(b"\x79", 0.5)
    talk.outgoing()
    assert talk.deadline == pytest.approx(2.5)
    talk.expire(2.5)
    (event,) = talk.events()
    assert isinstance(event, Lost) and not event.untouched and talk.outgoing() == b""


def test_a_refusal(talk):
    talk.begin(ControllerCommand("J/", CommandKind.SET), 0.0)
    talk.receive(b"\x79\x07ERR003\r", 0.1)
    assert talk.events() == [Refusal(3)]


def test_messages_come_between(talk):
    talk.begin(ControllerCommand("J/", CommandKind.SET), 0.0)
    talk.receive(b"\x79\x02HELLO\r\x06\x79", 0.1)
    assert talk.events() == [Message("HELLO"), Answer()]


def test_bytes_come_in_any_pieces(talk):
    talk.begin(ControllerCommand("P1..3"), 0.0)
    for byte in bytes.fromhex("10 32 35 0D 74 35 30 0D 72 37 35 0D 79 06 10"):
        talk.receive(bytes([byte]), 0.0)
    assert talk.events() == [Answer(("25", "50", "75"))]


def test_an_answer_without_end_has_an_end(talk):
    talk.begin(ControllerCommand("P1..3", most=100), 0.0)
    talk.receive(b"\x10" + b"1" * 200, 0.0)
    assert [type(event) for event in talk.events()] == [Lost]


def test_one_command_at_a_time(talk):
    talk.begin(ControllerCommand("P1"), 0.0)
    with pytest.raises(ValueError, match="expected none outstanding, got 'P1'"):
        talk.begin(ControllerCommand("P2"), 0.0)


def test_too_long_a_line_is_not_sent(talk):
    with pytest.raises(ValueError, match="expected up to 255 characters, got 256"):
        talk.begin(ControllerCommand("A" * (LONGEST_LINE + 1)), 0.0)


@pytest.mark.parametrize("text", ["", "P1\r", "P1\x0b", "P\u00e4", "P1\nP2"])
def test_control_characters_are_not_sent(text):
    with pytest.raises(ValueError, match="expected printable ASCII"):
        ControllerCommand(text)
