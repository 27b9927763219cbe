# SPDX-License-Identifier: LGPL-2.1-or-later
"""Writer and reader each have a statement of what codes do: a fault in one of them is not read as if it were none."""

from dataclasses import replace
from itertools import combinations

import pytest
from controller_settings import settings_for, threading_settings
from strut_motions import threaded

from pkm_post.control.numerical_control.execute import same_motion
from pkm_post.model import Event, EventKind, StrutMotion
from pkm_post.writing.controllers import CONTROLLERS
from pkm_post.writing.controllers.pvt import codes, syntax

PAIRS = list(combinations([name for name in codes.EVENT_CODES if name not in codes.OF_THREADS], 2))
VALUES = {
    EventKind.TOOL_CHANGE: (7.0,),
    EventKind.SPINDLE: (0.0, 900.0, -900.0),
    EventKind.COOLANT: (0.0, 1.0, 2.0),
    EventKind.STOP: (0.0, 1.0),
}


def test_both_know_the_same_codes():
    assert set(codes.EVENT_CODES) == set(syntax.EFFECTS)


@pytest.mark.slow
@pytest.mark.parametrize("kind", CONTROLLERS)
@pytest.mark.parametrize("pair", PAIRS, ids="-".join)
def test_two_meanings_swapped_in_the_writer_are_found(monkeypatch, job, kind, pair):
    first, second = pair
    swapped = codes.EVENT_CODES | {first: codes.EVENT_CODES[second], second: codes.EVENT_CODES[first]}
    settings, controller = settings_for(kind), CONTROLLERS[kind]
    monkeypatch.setattr(codes, "EVENT_CODES", swapped)
    for event in (Event(0, kind, value) for kind, values in VALUES.items() for value in values):
        alone = StrutMotion(job.time_ms[:3], job.length[:3], job.speed[:3], (event,))
        if controller.faults(alone, settings, "job"):
            continue  # nothing is written
        (text,) = controller.program_parts(alone, settings, [])
        read, _ = controller.read_parts([("job.pmc", text)], settings)
        if read is None or read.events != alone.events:
            return
    pytest.fail("every event is read as it was meant")


def test_the_begin_and_the_end_of_threads_swapped_in_the_writer_are_found(monkeypatch, job):
    settings, controller = threading_settings(), CONTROLLERS["turbo_pmac"]
    motion = threaded(job)
    (text,) = controller.program_parts(motion, settings, [])
    read, faults = controller.read_parts([("job.pmc", text)], settings)
    assert faults == ()
    assert same_motion(read, replace(motion, length=read.length, speed=read.speed))
    first, second = codes.OF_THREADS
    swapped = codes.EVENT_CODES | {first: codes.EVENT_CODES[second], second: codes.EVENT_CODES[first]}
    monkeypatch.setattr(codes, "EVENT_CODES", swapped)
    (text,) = controller.program_parts(motion, settings, [])
    read, faults = controller.read_parts([("job.pmc", text)], settings)
    assert read is None
    assert {fault.code for fault in faults} == {"C101"}
