# SPDX-License-Identifier: LGPL-2.1-or-later
"""Streams over a link with faults, and what has to hold of each: the struts never stop within a move."""

import itertools
import math
import random

import numpy as np
from link_faults import delayed, in_pieces, refuse, reset_after
from rig import SETTINGS, Noise, Wire, controller

from pkm_post.control.link.errors import CancelledError, PmacError, StreamError
from pkm_post.control.link.program import read_job
from pkm_post.control.link.rotary_buffer import split_into_segments
from pkm_post.control.link.stream import stream
from pkm_post.model import StrutMotion
from pkm_post.writing.controllers.pmac import program_text

WORDS = 330
REACH = np.array([1.0, 2.0, -3.0, 4.0, -5.0, 6.0])
MICRON = 1e-3
LONGEST_S = 300.0
LONGEST_SEGMENT_MS = 1500


def swings(count=2, knots=20, interval=20):
    """A job of six struts that go out and back in step, at rest at both ends of each swing."""
    time_ms = np.arange(0, count * knots * interval + 1, interval)
    turn = 2 * np.pi * time_ms / (knots * interval)
    length = 500.0 + REACH * (1 - np.cos(turn))[:, None] / 2
    speed = REACH * (np.pi * 1000 / (knots * interval) * np.sin(turn))[:, None]
    speed[:: knots // 2] = 0.0
    text = program_text(StrutMotion(time_ms, length, speed, ()), SETTINGS, ["test"])
    job, faults = read_job(text, SETTINGS, "swings.pmc")
    assert not faults
    return job


JOB = swings()
RESTS = [500.0 * np.ones(6), *(segment.rest for segment in split_into_segments(JOB.program, SETTINGS, WORDS))]


def wired(kind, **arguments):
    """A wire to a controller with a rotary buffer."""
    wire = Wire(controller(), kind, moves=True, **arguments)
    assert not wire.line.refusal(f"&1DEFINE ROT {WORDS}")
    return wire


def path(wire):
    return wire.controller.systems[0].path


def lengths(wire):
    """Commanded lengths, mm."""
    return wire.controller.motors.commanded / SETTINGS.counts_per_mm + 500.0


def streamed(session, wire, **arguments):
    return stream(session, SETTINGS, JOB.program, JOB.first, WORDS, **arguments)


def tried(wire, is_reset=False, **arguments):
    """Stream over a wire and check what has to hold, however it ends; how it ended.

    Args:
        wire: with its faults.
        is_reset: whether the controller itself may stop the struts anywhere.
        arguments: of ``stream``.
    """
    try:
        with wire.session() as session:
            done = streamed(session, wire, **arguments)
    except StreamError as failed:
        what, rests = ("cleared" if failed.cleared else "unknown"), _rests_until(failed.line)
    except CancelledError:
        what, rests = "cancelled", RESTS
    except PmacError:
        what, rests = "untouched", RESTS[:1]
    else:
        what, rests = f"streamed {done.resumptions}", RESTS[-1:]
    assert wire.now < LONGEST_S
    wire.cut_at = None
    wire.controller.advance(LONGEST_SEGMENT_MS)
    assert path(wire).abrupt_stops == 0
    assert not wire.controller.runs_program()
    assert is_reset or any(np.abs(lengths(wire) - rest).max() < MICRON for rest in rests), lengths(wire)
    if what not in ("unknown", "untouched"):
        rotary = wire.controller.memory.rotaries.get(1)
        assert wire.controller.memory.opened is None and not (rotary and rotary.lines)
    return what


def _rests_until(line):
    ends = [0, *(segment.last for segment in split_into_segments(JOB.program, SETTINGS, WORDS))]
    return RESTS[: ends.index(line) + 1]


def by_chance(seed):
    """A stream with a fault of a kind, at a place and over a link that the seed decides."""
    choice = random.Random(seed)
    kind, fault = choice.choice(("serial", "tcp")), choice.choice((*_FAULTS, "cancel"))
    wire = wired(kind)
    if fault in _FAULTS:
        _FAULTS[fault](wire, choice)
    calls, last = itertools.count(), choice.randrange(1, 60) if fault == "cancel" else math.inf
    return fault, tried(wire, fault == "reset", is_cancelled=lambda: next(calls) > last)


def _noisy(wire, choice):
    # A changed bit may be a control character, which stops the struts at once, and no client can help it.
    wire.fault = Noise(choice.random(), 10 ** choice.uniform(-5, -3), ("drop", "double"))


def _cut(wire, choice):
    wire.cut_at, wire.mends = choice.randrange(1, 20_000), choice.random() < 0.5


_FAULTS = {
    "noise": _noisy,
    "delay": delayed,
    "pieces": in_pieces,
    "cut": _cut,
    "refusal": lambda wire, choice: refuse(wire, choice.randrange(1, 60), choice.randrange(1, 20)),
    "reset": lambda wire, choice: reset_after(wire, choice.randrange(1, 200)),
}
