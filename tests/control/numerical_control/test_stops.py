# SPDX-License-Identifier: LGPL-2.1-or-later
"""Going on behind M0 and M1."""

import dataclasses

import numpy as np
import pytest
from station import PER_BLOCK, job

from pkm_post.control.link.errors import NotReadyError
from pkm_post.control.numerical_control.execute import program_stops, remaining_job, same_motion
from pkm_post.model import Event, EventKind

COUNT = 1e-4
"""mm: what the encoder of the example counts."""
SPINDLE, STOP, COOLANT = EventKind.SPINDLE, EventKind.STOP, EventKind.COOLANT
EVENTS = (
    Event(0, SPINDLE, 1200.0),
    Event(PER_BLOCK, SPINDLE, 0.0),
    Event(PER_BLOCK, STOP, 0.0),
    Event(PER_BLOCK, SPINDLE, 800.0),
    Event(2 * PER_BLOCK, STOP, 1.0),
    Event(3 * PER_BLOCK, COOLANT, 0.0),
)


def run(station, made):
    """Load and start a program, and wait until it stops."""
    station.control.load(made, lambda done, lines: None, lambda: False)
    station.control.start(made)
    return station.to_rest()


def spindle(station):
    """What the codes M3, M4 and M5 of the simulated machine have left: 1, -1 or 0."""
    return station.wire.controller.variables.read("P", 7001)


def test_what_stands_behind_a_stop(station):
    made = job(station.settings, EVENTS)
    behind = remaining_job(made, program_stops(made)[0], station.settings)
    assert behind.program.number == made.program.number
    for name in ("length", "speed"):
        assert np.array_equal(getattr(behind.motion, name), getattr(made.motion, name)[PER_BLOCK:])
    assert behind.motion.time_ms[-1] == made.motion.time_ms[-1] - made.motion.time_ms[PER_BLOCK]
    # The spindle was stopped before the stop; what stands behind it is to come.
    assert behind.motion.events == (
        Event(0, SPINDLE, 800.0),
        Event(PER_BLOCK, STOP, 1.0),
        Event(2 * PER_BLOCK, COOLANT, 0.0),
    )


def test_from_stop_to_stop_to_the_end(station):
    made = job(station.settings, EVENTS)
    first, second = program_stops(made)
    assert np.allclose(run(station, made).status.commanded, first.length, atol=COUNT) and spindle(station) == 0
    assert station.control.continue_after_stop(made, 1).running
    assert np.allclose(station.to_rest().status.commanded, second.length, atol=COUNT) and spindle(station) == 1
    station.control.continue_after_stop(made, 2)
    assert np.allclose(station.to_rest().status.commanded, made.motion.length[-1], atol=COUNT)


def test_behind_a_stop_in_front_of_the_first_move(station):
    made = job(station.settings, (Event(0, STOP, 0.0), Event(0, SPINDLE, 500.0)))
    run(station, made)
    assert spindle(station) == 0
    station.control.continue_after_stop(made, 1)
    assert np.allclose(station.to_rest().status.commanded, made.motion.length[-1], atol=COUNT) and spindle(station) == 1


@pytest.mark.parametrize(
    ("events", "number", "said"),
    [
        ((), 1, "the program has 0 stops"),
        ((Event(3 * PER_BLOCK, STOP, 0.0),), 1, "the program has 0 stops"),
        (EVENTS, 3, "the program has 2 stops .* there is no stop 3"),
        (EVENTS, 0, "there is no stop 0"),
        (EVENTS, 1, "mm from the first point of the program(?s:.*)to a later block, or to a stop, go by jog or mdi"),
    ],
)
def test_nothing_is_started_on_a_guess(station, events, number, said):
    station.wait(0.1)
    with pytest.raises(NotReadyError, match=said):
        station.control.continue_after_stop(job(station.settings, events), number)
    assert b"OPEN" not in station.sent() and not station.wire.controller.runs_program()


def test_an_aborted_program_is_not_gone_on_with(station):
    made = job(station.settings, EVENTS)
    station.control.load(made, lambda done, lines: None, lambda: False)
    station.control.start(made)
    while station.wait(0.02).status.commanded[5] < made.motion.length[0, 5] + 0.5:
        pass
    station.control.abort(at_once=True)
    station.to_rest()
    for stop in (1, 2):
        with pytest.raises(NotReadyError, match="mm from the first point of the program"):
            station.control.continue_after_stop(made, stop)
    with pytest.raises(NotReadyError, match="no program is held; after a stop"):
        station.control.resume()


def test_a_piece_is_another_motion_when_a_number_differs(station):
    motion = job(station.settings, ()).motion
    length = motion.length.copy()
    length[3, 3] += 1e-6
    assert same_motion(motion, motion)
    assert not same_motion(motion, dataclasses.replace(motion, length=length))
