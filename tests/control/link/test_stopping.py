# SPDX-License-Identifier: LGPL-2.1-or-later
"""A stop never gives up: noise on its own bytes, refusals, silence, cut links, controllers that do not obey."""

import random
from contextlib import suppress
from dataclasses import replace

import numpy as np
import pytest
from link_faults import FIRST, small_program
from rig import SETTINGS, Noise, Wire, controller

from pkm_post.control.link import run as operate
from pkm_post.control.link import stopping
from pkm_post.control.link.download import download
from pkm_post.control.link.errors import CancelledError, NotOwnerError
from pkm_post.control.link.ownership import owned
from pkm_post.control.link.status import read_status

_QUICK = small_program(100)
SLOW = replace(_QUICK, lines=tuple("PVT400" if line == "PVT20" else line for line in _QUICK.lines))
"""40 s of motion: longer than any stop here takes."""
MICRON = 1e-3
LONGEST_CLIMB_S = 20.0
"""Seconds of the wire's clock from the first to the last rung, all times of the rungs and some faults added."""


def running(kind):
    """A wire to a machine in the middle of a program, and an open session."""
    wire = Wire(controller(), kind, moves=True)
    session = wire.session()
    session.open()
    download(session, SLOW)
    operate.start_program(session, SETTINGS, SLOW, FIRST)
    wire.sleep(0.3)
    return wire, session


@pytest.fixture(params=["serial", "tcp"])
def moving(request):
    return running(request.param)


def assert_at_rest(wire):
    """By the simulator's own state, not by what the link says."""
    wire.fault = lambda data, out: data
    before = np.array(wire.controller.motors.commanded)
    wire.sleep(1.0)
    assert np.abs(np.array(wire.controller.motors.commanded) - before).max() < MICRON


def test_a_hold_rests_on_the_path_and_goes_on(moving):
    wire, session = moving
    status = stopping.hold(session, SETTINGS)
    assert status.held and status.standing
    assert_at_rest(wire)
    assert operate.resume_program(session, SETTINGS).running


def test_a_slow_hold_shows_by_its_override_and_stays_on_the_path(moving):
    """No bit of a Turbo PMAC shows a hold [TurboPMAC, ??]; this one takes three seconds [TurboPMAC, Isx95]."""
    wire, session = moving
    wire.controller.variables.write("I", 5195, 548.0)
    sent = len(wire.sent)
    status = stopping.hold(session, SETTINGS)
    assert status.held and status.standing
    assert bytes(wire.sent[sent:]).count(b"&1H") == 1 and b"&1A" not in wire.sent[sent:]
    assert_at_rest(wire)


@pytest.mark.parametrize("action", ["stream", "play"])
@pytest.mark.parametrize("stop", [stopping.hold, stopping.abort])
def test_a_stop_between_two_motions_of_another_client_stops_the_next_one(stop, action):
    """Between them the machine rests and no program runs, but the other client is about to start one."""
    wire = Wire(controller(), "tcp", moves=True)
    other, begun = Wire(wire.controller, "tcp", moves=True, line=wire.line), []
    with wire.session() as owner, other.session() as session, owned(owner, action):
        download(owner, SLOW)
        stopped_at, passed = other.now, other.sleep

        def sleep(seconds):
            passed(seconds)
            if other.now > stopped_at + 0.5 and not begun:
                begun.append(operate.start_program(owner, SETTINGS, SLOW, FIRST))

        other.sleep = session._sleep = sleep
        status = stop(session, SETTINGS)
    assert begun[0].running and (status.held or not status.running)
    assert_at_rest(wire)


def test_an_abort_between_two_pieces_ends_a_play_that_plans_for_long():
    """No program runs, and none is started while somebody waits; but the player is about to, and would not notice."""
    wire = Wire(controller(), "tcp", moves=True)
    other = Wire(wire.controller, "tcp", moves=True, line=wire.line)
    with wire.session() as owner, other.session() as session, owned(owner, "play"):
        download(owner, SLOW)
        assert not stopping.abort(session, SETTINGS).running
        wire.sleep(2.0)
        with pytest.raises(NotOwnerError, match="C211.*an abort from elsewhere"):
            operate.start_program(owner, SETTINGS, SLOW, FIRST)
    assert_at_rest(wire)


def test_an_abort_ends_the_program(moving):
    wire, session = moving
    status = stopping.abort(session, SETTINGS)
    assert not status.running and status.standing
    assert bytes(wire.sent).count(b"&1H") == bytes(wire.sent).count(b"&1A") == 1
    assert_at_rest(wire)


@pytest.mark.slow
@pytest.mark.parametrize("stop", [stopping.hold, stopping.abort, lambda *of: stopping.abort(*of, at_once=True)])
@pytest.mark.parametrize("noise", [b"\x80", b"\xff", b"\x00", b"x", b"\x18"])
def test_a_byte_of_noise_before_the_order_stops_nothing_else(stop, noise):
    """A byte above 127 is not in the checksum; the controller refuses its line with ERR004."""
    wire, session = running("serial")
    orders = [order for order in (b"&1H", b"&1A") if order]

    def fault(data, out):
        if out and orders and data.startswith(orders[0]):
            orders.pop(0)
            return noise + data
        return data

    wire.fault = fault
    began = wire.now
    assert stop(session, SETTINGS).standing
    assert wire.now - began < 5.0
    assert_at_rest(wire)


def test_err004_is_noise_for_queries_and_for_lines_of_a_program_too():
    wire = Wire(controller(), "serial")
    hits = iter(range(0, 10_000, 7))
    due, lines = next(hits), 0

    def fault(data, out):
        nonlocal due, lines
        if out and data.endswith(b"\x0e"):
            lines += 1
            if lines >= due:
                due = next(hits)
                return b"\xa5" + data
        return data

    wire.fault = fault
    with wire.session() as session:
        assert download(session, SLOW).lines == len(SLOW.lines)
        read_status(session, SETTINGS)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("deaf_to", "last"),
    [(("hold",), b"&1A"), (("hold", "abort"), b"\x01"), (("hold", "abort", "all"), b"\x0b")],
)
@pytest.mark.parametrize("kind", ["serial", "tcp"])
def test_what_does_not_obey_is_stopped_by_the_next_rung(kind, deaf_to, last):
    wire, session = running(kind)
    system, motors = wire.controller.systems[0], wire.controller.motors
    forget, abort = system.forget, motors.abort
    system.hold = lambda: None
    if "abort" in deaf_to:
        system.abort = lambda *_: None
    if "all" in deaf_to:
        system.forget, motors.abort = lambda: None, lambda index: None
    began = wire.now
    status = stopping.hold(session, SETTINGS)
    system.forget, motors.abort = forget, abort
    assert status.standing and wire.now - began < LONGEST_CLIMB_S
    sent = bytes(wire.sent)
    coded = last if kind == "serial" or last.startswith(b"&") else b"\xc0\xc4\x00" + last
    assert coded in sent
    assert motors.enabled[0] == ("all" not in deaf_to), "power is taken from the motors only in the end"


def test_motors_keep_their_power_while_nobody_knows_that_they_move(moving):
    wire, session = moving
    wire.fault = lambda data, out: data if out else b""  # every answer is lost
    began = wire.now
    session.preempt_when(lambda: wire.now - began > 8.0)
    with pytest.raises(CancelledError):
        stopping.hold(session, SETTINGS)
    assert all(wire.controller.motors.enabled[:6]) and not wire.controller.runs_program()
    assert_at_rest(wire)


def test_a_link_that_comes_back_stops_the_machine_then(moving):
    wire, session = moving
    wire.cut_at = wire.passed
    restart_at = wire.now + 8.0
    link = wire.link
    assert link
    wire.mends = False

    def mend():
        wire.mends = wire.mends or wire.now > restart_at
        return False

    session.preempt_when(mend)
    assert stopping.hold(session, SETTINGS).standing
    assert wire.now > restart_at
    assert_at_rest(wire)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(40))
def test_over_a_noisy_line_a_stop_ends_at_rest(seed):
    choice = random.Random(seed)
    wire, session = running(choice.choice(("serial", "tcp")))
    kinds = ("drop", "double", "flip") if wire.kind == "serial" else ("drop",)
    wire.fault = Noise(choice.random(), 10 ** choice.uniform(-4, -2.7), kinds)
    wire.piece = choice.choice((None, 1, 7))
    stop = choice.choice((stopping.hold, stopping.abort))
    status = stop(session, SETTINGS)
    assert status.standing
    assert_at_rest(wire)


def test_another_stop_that_waits_takes_over(moving):
    """It may be the one that is to stop at once; the abort was sent before."""
    wire, session = moving
    session.preempt_when(lambda: True)
    began = wire.now
    with suppress(CancelledError):  # unless the struts stand at once
        stopping.abort(session, SETTINGS)
    assert wire.now - began < 0.5, "a hold alone takes longer"
    assert b"&1A" in wire.sent and not wire.controller.runs_program()


def test_a_stop_whose_answer_got_lost_is_made_sure_of(moving):
    wire, session = moving
    gone = []

    def fault(data, out):
        if not out and not gone and b"&1H" in bytes(wire.sent[-8:]) and b"\x06" in data:
            gone.append(data)
            return b""
        return data

    wire.fault = fault
    assert stopping.hold(session, SETTINGS).held
    assert gone
    assert_at_rest(wire)
