# SPDX-License-Identifier: LGPL-2.1-or-later
import numpy as np
import pytest

from pkm_post.model import Event, EventKind, StrutMotion
from pkm_post.writing.controllers.halstreamer import sections


def motion(*events):
    return StrutMotion(np.array([0, 20, 50]), np.full((3, 6), 500.0), np.zeros((3, 6)), events)


def dwell(row, seconds):
    return Event(row, EventKind.DWELL, seconds)


def stop(row):
    return Event(row, EventKind.STOP, 0.0)


def test_a_motion_without_events_is_one_section():
    (section,) = sections(motion())
    assert (section.before, section.after) == ((), ())
    np.testing.assert_array_equal(section.rows_ms(10), [0, 10, 20, 30, 40, 50])


def test_the_clock_runs_in_dwells_and_the_motion_does_not():
    (section,) = sections(motion(dwell(0, 0.005), dwell(1, 0.01), dwell(1, 0.0), dwell(2, 0.005)))
    assert section.clock_ms == (0, 5, 25, 35, 65, 70)
    assert section.motion_ms == (0, 0, 20, 20, 50, 50)
    np.testing.assert_array_equal(section.time_at(np.array([3, 15, 30, 45, 69, 99])), [0, 10, 20, 30, 50, 50])


def test_the_last_row_is_at_the_end_when_the_period_does_not_divide_the_time():
    (section,) = sections(motion())
    np.testing.assert_array_equal(section.rows_ms(30), [0, 30, 50])


def test_what_is_no_dwell_ends_a_section():
    first, second, third = sections(motion(stop(0), dwell(0, 0.002), stop(0), stop(0), stop(1), stop(2)))
    assert (first.before, first.clock_ms) == ((stop(0),), (0, 2))
    assert (second.before, second.motion_ms) == ((stop(0), stop(0)), (0, 20))
    assert (third.before, third.motion_ms, third.after) == ((stop(1),), (20, 50), (stop(2),))


@pytest.mark.parametrize("seed", range(5))
def test_no_time_is_lost_between_sections(seed):
    rng = np.random.default_rng(seed)
    rows = np.sort(rng.integers(0, 3, 12))
    made = motion(*(dwell(int(row), 0.25) if rng.integers(2) else stop(int(row)) for row in rows))
    pieces = sections(made)
    dwells = 1000 * sum(event.value for event in made.events if event.kind == EventKind.DWELL)
    assert sum(piece.clock_ms[-1] for piece in pieces) == 50 + dwells
    ends = [piece.motion_ms[-1] for piece in pieces[:-1]]
    assert ends == [piece.motion_ms[0] for piece in pieces[1:]]
    reported = [event for piece in pieces for event in piece.before] + list(pieces[-1].after)
    assert reported == [event for event in made.events if event.kind == EventKind.STOP]
