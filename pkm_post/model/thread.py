# SPDX-License-Identifier: LGPL-2.1-or-later
"""Thread: the stretches of a path along which the spindle is an axis, synchronised with the depth of the tool.

A thread begins and ends at rest, with an event each. In between the tool moves along its own axis, and turns against
the work by one turn for each lead of depth, to the bottom and back. So the angle of the spindle is a function of the
pose, and no table needs a column for it. Units: mm, turns; angles are positive clockwise, seen from the spindle.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

from pkm_post.model.columns import Array
from pkm_post.model.program import Event, EventKind, Kind


@dataclass(frozen=True)
class Thread:
    """One stretch.

    Attributes:
        first: row of the table of motions that it begins with, or the knot at which the spindle becomes an axis.
        end: the row after its last one, or the knot at which the spindle ends to be an axis.
        lead: mm of depth for a turn of the tool against the work, negative for a left-hand thread.
    """

    first: int
    end: int
    lead: float


def threads(events: Iterable[Event]) -> tuple[Thread, ...]:
    """The threads between events, in order.

    Raises:
        ValueError: a thread begins within another one, or does not end.
    """
    found: list[Thread] = []
    begun: Event | None = None
    for event in events:
        if event.kind is not EventKind.SPINDLE_AXIS:
            continue
        if (begun is None) == (event.value == 0):
            raise ValueError(f"events: expected threads that begin and end in turn, got {event}")
        if begun is not None:
            found.append(Thread(begun.row, event.row, begun.value))
        begun = event if event.value else None
    if begun is not None:
        raise ValueError(f"events: expected an end of each thread, got none after {begun}")
    return tuple(found)


def as_executed(events: Iterable[Event]) -> tuple[Event, ...]:
    """The events as a program of the controller has them: no lead of a thread, only that the spindle is an axis."""
    return tuple(
        replace(event, value=float(event.value != 0)) if event.kind is EventKind.SPINDLE_AXIS else event
        for event in events
    )


def cuts_by_speed(kind: Array, events: Iterable[Event]) -> Array:
    """Rows that cut with a spindle that runs at a speed, (N,): feed moves outside threads."""
    cuts = kind != Kind.RAPID
    for thread in threads(events):
        cuts[thread.first : thread.end] = False
    return cuts
