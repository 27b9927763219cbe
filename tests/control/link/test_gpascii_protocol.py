# SPDX-License-Identifier: LGPL-2.1-or-later
"""Gpascii, byte by byte: start, echo, ACK, errors with number and meaning, what comes late."""

import pytest

from pkm_post.control.link.gpascii_protocol import LONGEST_LINE, START_S, GpasciiProtocol
from pkm_post.control.link.protocol import Answer, CommandKind, ControllerCommand, Lost, Refusal


@pytest.fixture
def talk():
    return GpasciiProtocol(silence=0.5)


def test_gpascii_is_started_and_reported_to_answer_with_values(talk):
    talk.reset(0.0)
    assert talk.outgoing() == b"gpascii -2\n" and talk.deadline == START_S
    talk.receive(b"Welcome\r\nroot@ppmac# gpascii -2\r\nSTDIN Open for ASCII Input\r\n", 1.0)
    assert talk.outgoing() == b"" and not talk.events()
    talk.receive(b"\x06", 2.0)
    assert talk.outgoing() == b"echo 7\n"
    talk.receive(b"\r\necho 7\r\n\x06\r\n", 2.1)
    assert talk.events() == [Answer()] and talk.deadline is None


def test_the_line_that_gpascii_listens_may_be_the_last_one(talk):
    """Elettra's LTPy compares the last line of the start with it, the Java client of the MET5 waits for its CR LF."""
    talk.reset(0.0)
    talk.receive(b"gpascii -2\r\nSTDIN Open for ASCII Input\r\n", 1.0)
    assert talk.outgoing() == b"gpascii -2\n" and talk.deadline == 1.5
    talk.expire(1.5)
    assert talk.outgoing() == b"echo 7\n"
    talk.receive(b"echo 7\r\n\x06\r\n", 1.6)
    assert talk.events() == [Answer()] and talk.deadline is None


def test_a_computer_that_is_no_controller(talk):
    talk.reset(0.0)
    talk.receive(b"$ gpascii -2\r\nsh: gpascii: not found\r\n$ ", 1.0)
    talk.expire(talk.deadline)
    assert isinstance(talk.events()[0], Lost)


def test_an_answer_comes_in_any_pieces(talk):
    talk.begin(ControllerCommand("#1p #2p"), 0.0)
    assert talk.outgoing() == b"#1p #2p\n"
    for byte in b"#1p #2p\r\n100.5\r\n-3\r\n\x06\r\n":
        talk.receive(bytes([byte]), 0.1)
    assert talk.events() == [Answer(("100.5", "-3"))]


@pytest.mark.parametrize("left", [b"\r\n", b"\x06\r\n", b"\r\n\x06\r\n"])
def test_what_an_answer_before_left_is_passed_over(talk, left):
    talk.begin(ControllerCommand("#1p"), 0.0)
    talk.receive(left + b"#1p\r\n5\r\n\x06\r\n", 0.1)
    assert talk.events() == [Answer(("5",))]


def test_the_answer_to_another_command_is_no_answer(talk):
    talk.begin(ControllerCommand("#1p"), 0.0)
    talk.receive(b"#2p\r\n7\r\n\x06\r\n", 0.1)
    (event,) = talk.events()
    assert isinstance(event, Lost) and "'#2p' in place of the echo of '#1p'" in event.why and not event.untouched


def test_an_error_has_its_number_and_meaning(talk):
    talk.begin(ControllerCommand("foo", CommandKind.SET), 0.0)
    talk.receive(b"foo\r\nstdin:3:1: error #20: ILLEGAL CMD: foo\r\n", 0.1)
    assert not talk.events()
    talk.receive(b"\x06\r\n", 0.2)
    (event,) = talk.events()
    assert isinstance(event, Refusal) and event.number == 20 and event.words.startswith("error #20, illegal command: ")


def test_answers_may_come_after_an_error(talk):
    talk.begin(ControllerCommand("#1p #2p foo"), 0.0)
    talk.receive(b"#1p #2p foo\r\nstdin:4:10: error #20: ILLEGAL CMD: #1p #2p foo\r\n0\r\n-11.5\r\n\x06\r\n", 0.1)
    (event,) = talk.events()
    assert isinstance(event, Refusal) and event.number == 20


def test_an_error_without_ack_ends_in_silence(talk):
    talk.begin(ControllerCommand("&1b5r", CommandKind.SET), 0.0)
    talk.receive(b"&1b5r\r\nstdin:3:1: error #99: SOMETHING NEW: &1b5r\r\n", 0.1)
    assert talk.deadline == pytest.approx(0.6)
    talk.expire(0.6)
    (event,) = talk.events()
    assert event.number == 99 and "SOMETHING NEW" in event.words


@pytest.mark.parametrize("said", [b"", b"#1", b"#1p\r\n", b"#1p\r\n5", b"#1p\r\n5\r\n"])
def test_silence(talk, said):
    talk.begin(ControllerCommand("#1p", answer_timeout=2.0), 0.0)
    talk.receive(said, 1.0)
    assert talk.deadline == (3.0 if said else 2.0)
    talk.expire(3.0)
    assert isinstance(talk.events()[0], Lost)


def test_an_ack_within_a_line_makes_no_sense(talk):
    talk.begin(ControllerCommand("#1p"), 0.0)
    talk.receive(b"#1p\r\n12\x06", 0.1)
    assert isinstance(talk.events()[0], Lost)


def test_an_answer_without_end_has_an_end(talk):
    talk.begin(ControllerCommand("#1p", most=100), 0.0)
    talk.receive(b"#1p\r\n" + b"1" * 200, 0.0)
    assert [type(event) for event in talk.events()] == [Lost]


def test_one_line_at_a_time_and_not_too_long(talk):
    with pytest.raises(ValueError, match="expected one line"):
        talk.begin(ControllerCommand("abs\nlinear", CommandKind.BUFFER), 0.0)
    with pytest.raises(ValueError, match=f"expected up to {LONGEST_LINE} characters"):
        talk.begin(ControllerCommand("A" * (LONGEST_LINE + 1)), 0.0)
    talk.begin(ControllerCommand("#1p"), 0.0)
    with pytest.raises(ValueError, match="expected none outstanding"):
        talk.begin(ControllerCommand("#2p"), 0.0)
