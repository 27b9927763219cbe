# SPDX-License-Identifier: LGPL-2.1-or-later
"""Programs streamed to the simulated controller; whatever becomes of the link, the struts stop at rests alone."""

import itertools

import numpy as np
import pytest
from link_faults import FIRST, refuse, reset_after, small_program
from rig import SETTINGS, Noise, Wire
from streams import JOB, MICRON, REACH, RESTS, WORDS, by_chance, lengths, path, streamed, tried, wired

from pkm_post.control.link import run as operate
from pkm_post.control.link import stopping
from pkm_post.control.link.download import download
from pkm_post.control.link.errors import CancelledError, NotOwnerError, NotReadyError, StreamError
from pkm_post.control.link.session import OpenBufferPolicy
from pkm_post.control.link.stream import stream

KINDS = pytest.mark.parametrize("kind", ["serial", "tcp"])


@KINDS
def test_a_program_larger_than_its_buffer_runs_to_its_end(kind):
    wire, way = wired(kind), []
    reported = []

    def sleep(seconds, passed=wire.sleep):
        for _ in range(round(1000 * seconds)):
            passed(1e-3)
            way.append((lengths(wire) - 500.0) / REACH)

    wire.sleep = sleep
    with wire.session() as session:
        done = streamed(session, wire, progress=lambda *lines: reported.append(lines))
    assert JOB.program.words > WORDS
    assert (done.lines, done.segments, done.resumptions) == (len(JOB.program.lines), len(RESTS) - 1, 0)
    assert reported == sorted(reported) and reported[-1] == (done.lines,) * 3
    # All six struts share one course, so they are in step at every millisecond and reach both of its ends.
    assert np.ptp(way, axis=1).max() < MICRON
    assert np.max(way) == pytest.approx(1.0, abs=MICRON) and abs(way[-1]).max() < MICRON
    turns = np.flatnonzero(np.diff(np.array(way)[:, 0] > 0.5))
    assert len(turns) == 4  # two swings out and back
    assert path(wire).abrupt_stops == 0


@KINDS
def test_a_segment_is_let_go_only_when_it_is_there_whole(kind):
    wire = wired(kind)
    wire.sent = _Watched(wire)
    assert tried(wire) == "streamed 0"
    assert wire.sent.runs == len(RESTS) - 1


class _Watched(bytearray):
    """What is sent; at each R the last line in the buffer has to be STOP."""

    def __init__(self, wire):
        super().__init__()
        self.wire, self.runs = wire, 0

    def __iadd__(self, data):
        super().extend(data)
        is_go = self.endswith(b"&1R\x0e\r") if self.wire.kind == "serial" else data.endswith(b"&1R")
        if is_go:
            self.runs += 1
            assert self.wire.controller.memory.rotaries[1].lines[-1][0].kind == "STOP"
        return self


@pytest.mark.slow
@KINDS
@pytest.mark.parametrize("at", (5000, 8000, 11_000))
def test_a_link_that_is_cut_and_comes_back(kind, at):
    wire = wired(kind, cut_at=at)
    assert tried(wire) == "streamed 1"


@KINDS
@pytest.mark.parametrize("at", (1000, 6000, 11_000))
def test_a_link_that_is_cut_for_good_ends_at_rest(kind, at):
    wire = wired(kind, cut_at=at, mends=False)
    assert tried(wire) in ("unknown", "untouched")


def lost_once(wire, when):
    """Let the answer to a command get lost."""
    gone = []

    def fault(data, out):
        if not out and not gone and bytes(wire.sent).rstrip(b"\r\x0e").endswith(when) and data[:1] == b"\x06":
            gone.append(data)
            return b""
        return data

    wire.fault = fault
    return gone


@KINDS
def test_an_r_whose_answer_got_lost_is_seen_in_the_lines_ahead_and_not_sent_again(kind):
    wire = wired(kind)
    gone = lost_once(wire, b"&1R")
    assert tried(wire).startswith("streamed") and gone
    sent = bytes(wire.sent)
    assert sent.count(b"&1R\x0e" if kind == "serial" else b"&1R") == len(RESTS) - 1


@pytest.mark.parametrize("seed", range(3))
def test_bytes_that_are_lost_or_doubled(seed):
    wire = wired("serial")
    wire.fault = Noise(seed, 2e-4, ("drop", "double"))
    assert tried(wire).startswith("streamed") and wire.fault.faults


@KINDS
def test_a_line_that_is_refused_ends_it_at_rest(kind):
    wire = wired(kind)
    refuse(wire, 30, 3)
    assert tried(wire) == "cleared"


@KINDS
def test_a_controller_that_is_reset_ends_it(kind):
    wire = wired(kind)
    reset_after(wire, 120 if kind == "serial" else 60)
    assert tried(wire, is_reset=True) in ("cleared", "unknown")


@KINDS
def test_cancelled_it_goes_on_to_the_next_rest_and_no_further(kind):
    wire, seen = wired(kind), []

    def is_cancelled():
        seen.append(wire.controller.runs_program())
        return sum(seen) > 3

    assert tried(wire, is_cancelled=is_cancelled) == "cancelled"
    assert any(np.abs(lengths(wire) - rest).max() < MICRON for rest in RESTS[:3])


@KINDS
def test_interrupted_it_is_held_and_aborted(kind):
    wire = wired(kind)

    def sleep(seconds, passed=wire.sleep):
        passed(seconds)
        if wire.now > 2.0 and not interrupted:
            interrupted.append(wire.now)
            raise KeyboardInterrupt

    interrupted, wire.sleep = [], sleep
    session = wire.session()
    session.open()
    with pytest.raises(CancelledError, match="the machine rests, the rotary buffer is empty"):
        streamed(session, wire)
    assert not wire.controller.runs_program() and path(wire).abrupt_stops == 0
    assert b"&1H" in wire.sent and b"&1A" in wire.sent


@pytest.mark.slow
@KINDS
@pytest.mark.parametrize("running", [1, len(RESTS) - 1])
def test_sped_up_by_another_client_it_is_held_and_aborted(kind, running):
    """While lines are sent, and while the last segment runs."""
    wire, highest = wired(kind), []
    system = wire.controller.systems[0]

    def sleep(seconds, passed=wire.sleep):
        passed(seconds)
        sent = bytes(wire.sent)
        if not highest and sent.count(b"&1R\x0e" if kind == "serial" else b"&1R") == running and system.running:
            system.set_override(150.0)
            highest.append(0.0)
        if highest:
            highest.append(system.override)

    wire.sleep = sleep
    session = wire.session()
    session.open()
    with pytest.raises(StreamError, match=r"the override is 1\d\d\S* %, set from elsewhere: .*%; it rests") as failed:
        streamed(session, wire)
    assert failed.value.cleared and not wire.controller.memory.rotaries[1].lines
    assert not wire.controller.runs_program() and path(wire).abrupt_stops == 0
    assert 1.0 < max(highest) < 1.4 and wire.sent.index(b"&1H") < wire.sent.index(b"&1A")


def test_interrupted_again_while_it_goes_to_the_next_rest():
    wire, calls = wired("tcp"), itertools.count()

    def sleep(seconds, passed=wire.sleep):
        passed(seconds)
        if cancelled and next(calls) == 1:
            raise KeyboardInterrupt

    def is_cancelled():
        cancelled[:] = [1] * wire.controller.runs_program()
        return bool(cancelled)

    cancelled, wire.sleep = [], sleep
    session = wire.session()
    session.open()
    with pytest.raises(CancelledError):
        streamed(session, wire, is_cancelled=is_cancelled)
    assert b"&1A" in wire.sent and not wire.controller.runs_program() and path(wire).abrupt_stops == 0


def test_a_fault_of_the_caller_leaves_nothing_behind():
    wire = wired("tcp")

    def progress(done, sent, total):
        if wire.controller.runs_program():
            raise ZeroDivisionError

    session = wire.session()
    session.open()
    with pytest.raises(ZeroDivisionError):
        streamed(session, wire, progress=progress)
    assert not wire.controller.runs_program() and not wire.controller.memory.rotaries[1].lines


@KINDS
def test_without_a_rotary_buffer_it_is_reported(kind):
    wire = wired(kind)
    assert not wire.line.refusal("&1DELETE ROT")
    session = wire.session()
    session.open()
    with pytest.raises(StreamError, match="ERR006, the buffer has no room") as failed:
        streamed(session, wire)
    assert failed.value.line == 0
    assert not wire.controller.runs_program()


def test_a_smaller_buffer_than_was_said_is_reported():
    wire = wired("tcp")
    for line in ("&1DELETE ROT", "&1DEFINE ROT 100"):
        assert not wire.line.refusal(line)
    session = wire.session()
    session.open()
    with pytest.raises(StreamError, match="ERR006"):
        streamed(session, wire)
    assert path(wire).abrupt_stops == 0


def test_a_machine_that_is_not_ready_is_sent_nothing():
    wire = wired("tcp")
    wire.controller.motors.homed[3] = False
    session = wire.session()
    session.open()
    with pytest.raises(NotReadyError, match="strut 4: not homed"):
        streamed(session, wire)
    assert b"OPEN ROT" not in wire.sent


@pytest.mark.slow
@KINDS
@pytest.mark.parametrize("open_buffer", [OpenBufferPolicy.STOP, OpenBufferPolicy.LEAVE])
def test_who_connects_meanwhile_takes_no_line_from_a_running_program(kind, open_buffer):
    wire = wired(kind)
    other = Wire(wire.controller, kind, line=wire.line, moves=True)

    def progress(done, sent, total):
        if not other.sent and wire.controller.runs_program() and wire.controller.memory.rotaries[1].lines:
            with other.session(open_buffer=open_buffer) as session:
                assert stopping.hold(session, SETTINGS).held
                other.sleep(1.0)
                operate.resume_program(session, SETTINGS)

    assert tried(wire, progress=progress) == "streamed 0"
    assert other.sent


@pytest.mark.slow
@pytest.mark.parametrize(
    "order",
    [
        lambda session: download(session, small_program()),
        lambda session: operate.start_program(session, SETTINGS, small_program(), FIRST),
        lambda session: stream(session, SETTINGS, JOB.program, JOB.first, WORDS),
    ],
)
def test_who_loads_or_starts_is_refused_meanwhile(order):
    wire, reported = wired("tcp"), []
    other = Wire(wire.controller, "tcp", line=wire.line)

    def progress(done, sent, total):
        if not reported and wire.controller.memory.rotaries[1].lines:
            with other.session() as session, pytest.raises(NotOwnerError, match="C210.*stream") as refused:
                order(session)
            reported.append(refused)

    assert tried(wire, progress=progress) == "streamed 0" and reported


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(100, 104))
def test_faults_by_chance(seed):
    _, what = by_chance(seed)
    assert what.split()[0] in ("streamed", "cleared", "cancelled", "unknown", "untouched")
