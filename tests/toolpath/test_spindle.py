# SPDX-License-Identifier: LGPL-2.1-or-later
"""Waits for the spindle: numbers by hand, and a spindle that is followed second by second."""

import dataclasses

import numpy as np
import pytest
from machines import example, with_tool_change
from programs import ON_PALLET, TOOLS, program, random_changes

from pkm_post.model import Event, EventKind, Kind
from pkm_post.toolpath.place import place
from pkm_post.toolpath.spindle import with_spindle_waits

# 24000 rpm in 4 s, to rest in 2 s: 6000 rpm faster is 1 s, 12000 slower is 1 s.
MACHINE = dataclasses.replace(example(), spin_up_time=4.0, spin_down_time=2.0)
CHANGE, SPINDLE, DWELL = EventKind.TOOL_CHANGE, EventKind.SPINDLE, EventKind.DWELL


def waits(*happens, machine=MACHINE, kind=None):
    """What takes place, without the rows."""
    made = program([[0, 0, 60], [10, 0, 60], [20, 0, 60]], events=happens, tools=TOOLS, kind=kind)
    waited, faults = with_spindle_waits(made, machine)
    return [(event.kind, event.value) for event in waited.events], [fault.code for fault in faults]


@pytest.mark.parametrize(
    ("speeds", "expected"),
    [
        ((6000,), (1.0,)),
        ((-6000,), (1.0,)),
        ((6000, 6000), (1.0,)),  # the same speed again
        ((6000, 12000), (1.0, 1.0)),
        ((12000, 6000), (2.0, 0.5)),
        ((6000, -6000), (1.0, 1.5)),  # half a second to rest, one from there
        ((12000, 0), (2.0,)),
        ((12000, 0, 6000), (2.0, 1.0)),  # 0.5 s from 12000 if it still turns, 1 s if it stands
        ((24000, 0, 6000), (4.0, 1.5)),  # 1.5 s from 24000 down to 6000
        ((7, 8.0), (0.002, 0.001)),  # 1.1667 ms and 0.17 ms: up to whole milliseconds
    ],
)
def test_a_change_of_speed_is_waited_for(speeds, expected):
    reported, faults = waits(*(Event(1, SPINDLE, float(speed)) for speed in speeds))
    assert [value for kind, value in reported if kind is DWELL] == pytest.approx(list(expected), abs=1e-12)
    assert not faults
    for before, after in zip(reported, reported[1:], strict=False):
        assert after[0] is not DWELL or (before[0] is SPINDLE and before[1] != 0)


def test_the_spindle_comes_to_rest_before_a_tool_is_changed():
    stops, starts = Event(1, SPINDLE, 0.0), Event(2, SPINDLE, 6000.0)
    runs = Event(0, SPINDLE, 12000.0)
    rapid = [Kind.RAPID, Kind.RAPID, Kind.LINE]
    reported, faults = waits(runs, Event(1, CHANGE, 2), starts, kind=rapid)
    assert reported == [
        (SPINDLE, 12000.0), (DWELL, 2.0), (SPINDLE, 0.0), (DWELL, 1.0), (CHANGE, 2), (SPINDLE, 6000.0), (DWELL, 1.0),
    ]  # fmt: skip
    assert not faults
    reported, _ = waits(runs, stops, Event(1, CHANGE, 2), starts)
    assert reported[2:5] == [(SPINDLE, 0.0), (DWELL, 1.0), (CHANGE, 2)]
    assert waits(Event(0, CHANGE, 1), Event(1, CHANGE, 2))[0] == [(CHANGE, 1), (CHANGE, 2)]


@pytest.mark.parametrize("machine", [MACHINE, example()], ids=["with a time", "without a time"])
def test_a_cut_after_a_change_needs_a_spindle_that_was_started(machine):
    def faults(*happens):
        return waits(*happens, machine=machine)[1]

    runs = Event(0, SPINDLE, 12000.0)
    assert faults(runs, Event(1, CHANGE, 2)) == ["K143"]
    assert faults(runs, Event(1, CHANGE, 2), Event(2, SPINDLE, 900.0)) == ["K143"]
    assert faults(runs, Event(1, CHANGE, 2), Event(1, SPINDLE, 900.0)) == []
    assert faults(Event(1, CHANGE, 2)) == []
    assert faults(runs, Event(3, CHANGE, 2)) == []


def test_nothing_waits_where_no_time_is_stated():
    events = Event(0, SPINDLE, 12000.0), Event(1, CHANGE, 2), Event(1, SPINDLE, 6000.0)
    reported, faults = waits(*events, machine=example())
    assert reported == [(SPINDLE, 12000.0), (CHANGE, 2), (SPINDLE, 6000.0)] and not faults


def test_one_time_serves_both_ways():
    both = dataclasses.replace(MACHINE, spin_down_time=None)
    assert waits(Event(0, SPINDLE, 12000.0), Event(1, SPINDLE, 6000.0), machine=both)[0][-1] == (DWELL, 1.0)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(60))
def test_the_spindle_is_at_its_speed_at_each_move_and_at_rest_at_each_change(seed):
    """A spindle that is followed from event to event: its speed changes by so much a second, and moves take no time."""
    made = random_changes(np.random.default_rng(seed))
    machine = with_tool_change(MACHINE) if seed % 2 else MACHINE
    trajectory, faults = place(made, machine, ON_PALLET)
    assert trajectory is not None, faults
    speed = wanted = 0.0
    ends = Event(len(trajectory), DWELL, 0)
    for event, following in zip(trajectory.events, (*trajectory.events[1:], ends), strict=True):
        if event.kind is DWELL:
            speed = followed(speed, wanted, event.value)
        wanted = event.value if event.kind is SPINDLE else wanted
        if event.kind is CHANGE:
            assert speed == wanted == 0.0
        if following.row > event.row and wanted:
            assert speed == pytest.approx(wanted, abs=1e-6)


def followed(speed, wanted, seconds):
    """By steps of a millisecond: 6 rpm faster or 12 rpm slower in each."""
    for _ in range(round(seconds * 1000)):
        towards = np.sign(wanted - speed)
        slower = speed * towards < 0
        limit = 0.0 if slower else wanted
        step = towards * (12.0 if slower else 6.0)
        if not slower and abs(wanted) < abs(speed):
            step = towards * 12.0
        speed = speed + step if abs(limit - speed) > abs(step) else limit
    return speed
