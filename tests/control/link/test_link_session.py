# SPDX-License-Identifier: LGPL-2.1-or-later
"""A session with the simulated controller: handshake, queries asked again, sets never."""

import pytest
from rig import Wire, controller, listed

from pkm_post.control.link.download import verify_listing
from pkm_post.control.link.errors import (
    CancelledError,
    DiagnosedError,
    LinkLostError,
    OutcomeUnknownError,
    RefusedError,
)
from pkm_post.control.link.ownership import owned
from pkm_post.control.link.program import PmacProgram
from pkm_post.control.link.session import QUERY_ATTEMPTS, OpenBufferPolicy
from pkm_post.control.simulator import SerialPort


@pytest.fixture(params=["serial", "tcp"])
def wire(request):
    return Wire(controller(), request.param)


@pytest.mark.slow
@pytest.mark.parametrize("handshake", range(4))
@pytest.mark.parametrize("sums", range(2))
@pytest.mark.parametrize("errors", range(4))
def test_any_handshake_is_brought_into_step(wire, handshake, sums, errors):
    assert not wire.line.refusal(f"I3={handshake} I4={sums} I6={errors} I9=0")
    with wire.session() as session:
        assert session.query("I3 I6 I9") == ("I3=2", "I6=1", "I9=3")


def test_answers_and_refusals(wire):
    with wire.session() as session:
        session.command("P1=25 P2=50")
        assert session.query("P1 P2") == ("25", "50")
        with pytest.raises(RefusedError, match="ERR003, not understood") as refused:
            session.command("FOO")
        assert (refused.value.number, refused.value.command) == (3, "FOO")
        assert session.query("P1") == ("25",)


def lose(wire, when):
    """Let the controller's bytes get lost from the moment on when ``when`` is in what was sent."""

    def fault(data, out):
        return data if out or when not in wire.sent else b""

    wire.fault = fault


def test_a_query_is_asked_again_and_then_given_up(wire):
    with wire.session() as session:
        wire.sent.clear()
        lose(wire, b"P77")
        with pytest.raises(LinkLostError):
            session.query("P77")
    assert wire.now < 60


def test_a_query_survives_an_answer_that_got_lost(wire):
    with wire.session() as session:
        count = [0]

        def fault(data, out):
            count[0] += not out
            return b"" if not out and count[0] == 2 else data

        wire.fault = fault
        assert session.query("P1") == ("0",)


@pytest.mark.parametrize("kind", ["serial", "tcp"])
def test_a_set_whose_answer_is_lost_is_not_sent_again(kind):
    wire = Wire(controller(), kind)
    session = wire.session()
    session.open()
    gone = [False]

    def fault(data, out):
        if not out and wire.controller.variables.setting(68) == 7 and not gone[0]:
            gone[0] = True
            return b""
        return data

    wire.fault = fault
    with pytest.raises(OutcomeUnknownError, match="I68=7"):
        session.command("I68=7")
    assert gone[0] and wire.sent.count(b"I68=7") == 1
    assert session.query("I68") == ("I68=7",)  # the state tells, and the session is in step again


def test_a_query_is_asked_so_often_and_no_more():
    wire = Wire(controller(), "tcp")
    with wire.session() as session:
        wire.fault = lambda data, out: b"" if not out and b"P77" in wire.sent[-11:] else data
        with pytest.raises(LinkLostError, match="P77"):
            session.query("P77")
    assert wire.sent.count(b"P77") == QUERY_ATTEMPTS


def test_a_buffer_that_was_left_open_is_made_empty(wire, caplog):
    wire.session().open()  # the handshake is agreed from here on
    for line in ("OPEN PROG 10", "CLEAR", "ABS", "LINEAR"):
        assert not wire.line.refusal(line)
    with wire.session() as session, owned(session, "download"):
        assert "it was cleared" in caplog.text
        assert verify_listing(session, PmacProgram(10, ())).same


@pytest.mark.parametrize("open_buffer", [OpenBufferPolicy.LEAVE, OpenBufferPolicy.STOP])
def test_a_buffer_that_is_open_is_left_alone_by_who_watches_or_stops(wire, open_buffer):
    wire.session().open()  # the handshake is agreed from here on
    for line in ("OPEN PROG 10", "CLEAR", "ABS"):
        assert not wire.line.refusal(line)
    with wire.session(open_buffer=open_buffer) as session:
        assert session.query("I3") == ("I3=2",)
    assert not wire.line.refusal("LINEAR")
    assert wire.line.refusal("CLOSE") == 0
    assert [line for line in listed(wire.controller) if line != "RETURN"] == ["ABS", "LINEAR"]


def test_who_only_watches_does_not_agree_anew_while_a_buffer_is_open(wire):
    for line in ("I3=1", "OPEN PROG 10", "CLEAR", "ABS"):
        assert not wire.line.refusal(line)
    with pytest.raises(LinkLostError, match="a program buffer is open"):
        wire.session().open()
    assert not wire.line.refusal("CLOSE") and listed(wire.controller)[:1] == ["ABS"]
    with wire.session(open_buffer=OpenBufferPolicy.STOP) as session:
        assert session.query("I3") == ("I3=2",)


def test_a_buffer_that_another_port_has_open_is_left_alone(wire):
    wire.session().open()
    other = SerialPort(wire.controller)
    for line in ("OPEN PROG 10", "CLEAR", "ABS"):
        assert not other.refusal(line)
    with wire.session() as session, pytest.raises(DiagnosedError, match="C214"), owned(session, "download"):
        pass
    assert not other.refusal("LINEAR")


def test_no_controller(wire):
    wire.fault = lambda data, out: b""
    with pytest.raises(LinkLostError, match="no controller answers as expected"):
        wire.session().open()
    assert wire.now < 60


def test_what_programs_say_is_kept():
    wire = Wire(controller())
    with wire.session() as session:
        wire.fault = lambda data, out: data if out or data[:1] != b"0" else b"\x02HELLO\r" + data
        assert session.query("P1") == ("0",)
        assert session.messages == ["HELLO"]


def test_a_query_that_takes_long_is_left_for_a_stop(wire):
    """One that does not is waited for: a new connection would take longer."""
    with wire.session() as session:
        session.preempt_when(lambda: True)
        assert session.query("P1") == ("0",)
        wire.delay = lambda: 0.4 if wire.sent.endswith((b"P77", b"P77\r")) else 0.0
        session.query("P77")
        connections = session.connections
        lose(wire, b"P78")
        with pytest.raises(CancelledError, match="a stop came first"):
            session.query("P78")
        wire.fault = lambda data, out: data
        session.command("P1=5")
        assert session.query("P1") == ("5",) and session.connections == connections + 1


def test_a_link_that_does_not_come_back_is_left_for_a_stop(wire):
    with wire.session() as session:
        wire.fault = lambda data, out: b""
        session.preempt_when(lambda: True)
        began = wire.now
        with pytest.raises(CancelledError):
            session.query("P1")
        assert wire.now - began < 3.0


def test_a_stop_is_not_left_for_another(wire):
    """What changes something runs to its end: its outcome has to be known."""
    with wire.session() as session:
        session.preempt_when(lambda: True)
        lose(wire, b"P5=1")
        with pytest.raises(LinkLostError):
            session.command("P5=1")
