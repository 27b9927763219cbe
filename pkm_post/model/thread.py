# SPDX-License-Identifier: LGPL-2.1-or-later
"""Thread: the stretches of a path along which the spindle is an axis, synchronised with the depth of the tool.

A thread starts and ends at rest, with an event each. In between the tool moves along its own axis to the bottom and
back, and turns against the work once per lead of depth. The spindle angle is thus a function of the pose and needs no
column of its own. Units: mm, turns; angles are positive clockwise, seen from the spindle.
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
        first: its first row in the table of motions, or the knot at which the spindle becomes an axis.
        end: the row after its last, or the knot at which the spindle returns to speed control.
        lead: depth per turn of the tool against the work, mm; negative for a left-hand thread.
    """

    first: int
    end: int
    lead: float


def threads(events: Iterable[Event]) -> tuple[Thread, ...]:
    """The threads that the events delimit, in order.

    Raises:
        ValueError: a thread starts within another, or has no end.
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
    """The events as a controller program has them: whether the spindle is an axis, without the lead."""
    return tuple(
        replace(event, value=float(event.value != 0)) if event.kind is EventKind.SPINDLE_AXIS else event
        for event in events
    )


def cuts_by_speed(kind: Array, events: Iterable[Event]) -> Array:
    """Whether each row cuts with the spindle under speed control, (N,): feed moves outside threads."""
    cuts = kind != Kind.RAPID
    for thread in threads(events):
        cuts[thread.first : thread.end] = False
    return cuts
