# SPDX-License-Identifier: LGPL-2.1-or-later
"""Spindle: dwells until it has its speed, and threads, in which it is an axis.

A program gets a dwell after each change of the spindle speed, and the spindle is stopped before each tool change, which
leaves it stopped [NGC 3.6.3]. The speed changes at a constant rate, as in drives set by their acceleration and
deceleration times [VFD-B 01-09]. Where the machine file states no time, no dwell is added.

A thread is made of feed moves along the tool axis, up to a highest feed. A mirror image would need another tap, and a
thread cut backwards would end before it starts. Units: mm, mm/s, s.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from pkm_post.geometry import Array, dot, norm
from pkm_post.model import (
    Amount,
    Diagnostic,
    Diagnostics,
    Event,
    EventKind,
    Kind,
    Machine,
    Phrase,
    Program,
    cuts_by_speed,
    threads,
)

_PER_SECOND = 1000
"""Waits are whole milliseconds."""


class _Ramp(NamedTuple):
    """Acceleration of a spindle.

    Attributes:
        up: s per revolution per minute of speed gained.
        down: s per revolution per minute of speed lost.
    """

    up: float
    down: float

    def seconds(self, before: float, after: float) -> float:
        """Time from one signed speed to another; a reversal passes through rest."""
        if before * after < 0.0:
            return self.seconds(before, 0.0) + self.seconds(0.0, after)
        faster = abs(after) - abs(before)
        return faster * self.up if faster > 0.0 else -faster * self.down


def with_spindle_waits(program: Program, machine: Machine) -> tuple[Program, Diagnostics]:
    """The program with waits for the spindle, and diagnostics of cuts with a spindle stopped by a tool change."""
    up = machine.spin_up_time
    faults = tuple(_cuts_at_rest(program))
    if up is None:
        return program, faults
    down = up if machine.spin_down_time is None else machine.spin_down_time
    ramp = _Ramp(up / machine.spindle_speed, down / machine.spindle_speed)
    return replace(program, events=tuple(_waited(program.events, ramp))), faults


def _waited(events: tuple[Event, ...], ramp: _Ramp) -> Iterator[Event]:
    speed, coasting = 0.0, 0.0  # last commanded speed, and speed from which the spindle may still be coasting down
    for event in events:
        if event.kind is EventKind.TOOL_CHANGE:
            if speed:
                yield Event(event.row, EventKind.SPINDLE, 0.0)
            yield from _wait(event.row, ramp.seconds(speed or coasting, 0.0))
            speed, coasting = 0.0, 0.0
            yield event
        elif event.kind is EventKind.SPINDLE:
            yield event
            if event.value:
                possible = (speed,) if speed else (0.0, coasting)
                yield from _wait(event.row, max(ramp.seconds(before, event.value) for before in possible))
            coasting = 0.0 if event.value else speed or coasting
            speed = event.value
        else:
            if event.kind is EventKind.SPINDLE_AXIS:  # its code stops the spindle
                speed, coasting = 0.0, 0.0
            yield event


def _wait(row: int, seconds: float) -> Iterator[Event]:
    if seconds > 0.0:
        yield Event(row, EventKind.DWELL, _rounded_up(seconds))


def _rounded_up(seconds: float) -> float:
    return math.ceil(round(seconds * _PER_SECOND, 6)) / _PER_SECOND


def seconds_from_rest(machine: Machine, speed: float) -> float:
    """Time from rest to a speed of the spindle in 1/min, s; 0 if the machine file does not state it."""
    return _rounded_up((machine.spin_up_time or 0.0) * abs(speed) / machine.spindle_speed)


def _cuts_at_rest(program: Program) -> Iterator[Diagnostic]:
    """The first cut between a tool change that stops a running spindle and the next spindle event."""
    speed = 0.0
    cuts = np.append(np.flatnonzero(cuts_by_speed(program.kind, program.events)), len(program))
    stopped_at: int | None = None
    for event in (*program.events, Event(len(program), EventKind.SPINDLE, 0.0)):
        if event.kind is EventKind.SPINDLE:
            if stopped_at is not None:
                row = int(cuts[np.searchsorted(cuts, stopped_at)])
                if row < event.row:
                    yield Diagnostic(
                        "K143", program.place(row), Phrase("the spindle was at {} rpm before", f"{abs(speed):g}")
                    )
            stopped_at, speed = None, event.value
        elif event.kind is EventKind.TOOL_CHANGE and speed:
            stopped_at = event.row


_SPEED_SHARE = 0.95
"""Planned share of the spindle's speed limit: the controller's cubics oscillate slightly about it."""
_ASIDE = 1e-6
"""mm, and of unit axes: rounding of work offsets."""


def thread_feeds(program: Program, machine: Machine) -> Array:
    """Highest feed on each row, (N,): infinite outside threads."""
    feed = np.full(len(program), np.inf)
    for thread in threads(program.events):
        if machine.spindle_axis is not None:
            feed[thread.first : thread.end] = _SPEED_SHARE * abs(thread.lead) * machine.spindle_axis.speed
    return feed


def thread_faults(program: Program, machine: Machine, tip_before: Array, axis_before: Array) -> Iterator[Diagnostic]:
    """Faults of the threads of a program.

    Args:
        program: in {M}.
        machine: with the axis of its spindle.
        tip_before: (N, 3) tips at the starts of the rows.
        axis_before: (N, 3) unit tool axes there.
    """
    found = threads(program.events)
    if found and machine.spindle_axis is None:
        yield Diagnostic(
            "K154", program.place(found[0].first), Phrase("lead {}", Amount(abs(found[0].lead), "mm", "g"))
        )
        return
    limits = thread_feeds(program, machine)
    for thread in found:
        rows = slice(thread.first, thread.end)
        way, axis = program.position[rows] - tip_before[rows], axis_before[rows]
        along = dot(way, axis)
        aside = norm(way - along[:, None] * axis)
        turned = norm(program.tool_axis[rows] - axis)
        wrong = (program.kind[rows] != Kind.LINE) | (aside > _ASIDE) | (turned > _ASIDE)
        if wrong.any():
            row = thread.first + int(np.argmax(wrong))
            yield Diagnostic(
                "K155", program.place(row), Phrase("{} aside", Amount(float(aside[row - thread.first]), "mm", ".3g"))
            )
        elif along[:1] > 0:
            yield Diagnostic("K155", program.place(thread.first), Phrase("it begins towards the spindle"))
        if (program.feed[rows] > limits[rows]).any():
            feeds = f"F{60 * program.feed[rows].max():g} mm/min, limited to {60 * limits[thread.first]:g}"
            yield Diagnostic("K156", program.place(thread.first), feeds)


def without_threads(program: Program, purpose: str) -> Diagnostics:
    """K157 for a program with threads where they are not supported."""
    found = threads(program.events)
    return (Diagnostic("K157", program.place(found[0].first), purpose),) if found else ()
