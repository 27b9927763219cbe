# SPDX-License-Identifier: LGPL-2.1-or-later
import dataclasses
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from machines import example
from programs import ON_PALLET, cone, square_with_arc

from pkm_post import cubics, planning
from pkm_post.cubics import Cubics
from pkm_post.feed import even_marks, knots
from pkm_post.model.findings import Tolerances
from pkm_post.placement.place import place

TOLERANCES = Tolerances(1e-3, np.radians(1e-3))
PATHS = {"lines that turn": cone, "arcs and a helix": square_with_arc}
ROUNDING = 1e-9
"""Of an error by tolerance: 1e-12 mm of 1e-3 mm."""


def planned(make):
    machine = example()
    trajectory, _ = place(make(), machine, ON_PALLET)
    path = planning.tool_path(trajectory, TOLERANCES)
    schedule, faults = planning.plan_feed(path, trajectory, machine)
    assert not faults
    return machine, trajectory, path, schedule


def cubics_of(machine, path, schedule, marks):
    return Cubics(path, schedule, machine, TOLERANCES, marks)


def intervals(schedule, count=600):
    """Intervals of 1 to 128 ms all over the motion, short ones more often."""
    rng = np.random.default_rng(21)
    duration = np.rint(np.exp2(rng.uniform(0, 7, count))).astype(np.int64)
    start = rng.integers(0, schedule.rests_ms[-1] - duration)
    return start, start + duration


@pytest.mark.parametrize("make", PATHS.values(), ids=PATHS)
def test_the_first_looks_decide_as_all_looks_do(monkeypatch, make):
    machine, _, path, schedule = planned(make)
    start, end = intervals(schedule)
    screened = cubics_of(machine, path, schedule, schedule.rests_ms).error(start, end)
    monkeypatch.setattr(cubics, "_LOOKS", (np.sort(np.concatenate(cubics._LOOKS)),))
    at_once = cubics_of(machine, path, schedule, schedule.rests_ms).error(start, end)
    assert 30 < np.sum(at_once > 1) < len(start) - 30
    np.testing.assert_array_equal(screened > 1, at_once > 1)
    held = at_once <= 1
    np.testing.assert_allclose(screened[held], at_once[held], rtol=0, atol=ROUNDING)


@pytest.mark.parametrize("make", PATHS.values(), ids=PATHS)
@pytest.mark.parametrize("places", [40, 1000])
def test_passes_of_other_sizes_find_the_same(monkeypatch, make, places):
    machine, _, path, schedule = planned(make)
    start, end = intervals(schedule)
    expected = cubics_of(machine, path, schedule, schedule.rests_ms).error(start, end)
    monkeypatch.setattr(cubics, "_PLACES_AT_ONCE", places)
    found = cubics_of(machine, path, schedule, schedule.rests_ms).error(start, end)
    np.testing.assert_allclose(found, expected, rtol=ROUNDING, atol=ROUNDING)


def test_what_is_kept_of_ends_does_not_matter():
    machine, _, path, schedule = planned(cone)
    start, end = intervals(schedule)
    kept = cubics_of(machine, path, schedule, schedule.rests_ms)
    kept.error(start[::2], end[::2])
    new = cubics_of(machine, path, schedule, schedule.rests_ms)
    np.testing.assert_allclose(kept.error(start, end), new.error(start, end), rtol=ROUNDING, atol=ROUNDING)


@pytest.mark.parametrize("make", PATHS.values(), ids=PATHS)
@pytest.mark.parametrize("at_once", [1, 3, 10**6])
def test_stretches_of_other_lengths_give_the_same_motion(monkeypatch, make, at_once):
    machine, trajectory, path, schedule = planned(make)
    expected = planning.interpolate(path, schedule, trajectory.events, machine, TOLERANCES)
    monkeypatch.setattr(planning, "_AT_ONCE", at_once)
    found = planning.interpolate(path, schedule, trajectory.events, machine, TOLERANCES)
    for field in dataclasses.fields(found):
        np.testing.assert_array_equal(getattr(found, field.name), getattr(expected, field.name))


@pytest.mark.parametrize("workers", [1, 5])
def test_the_number_of_threads_does_not_matter(monkeypatch, workers):
    machine, trajectory, path, schedule = planned(cone)
    monkeypatch.setattr(planning, "_AT_ONCE", 4)
    expected = planning.interpolate(path, schedule, trajectory.events, machine, TOLERANCES)
    monkeypatch.setattr(planning, "ThreadPoolExecutor", lambda _: ThreadPoolExecutor(workers))
    found = planning.interpolate(path, schedule, trajectory.events, machine, TOLERANCES)
    np.testing.assert_array_equal(found.time_ms, expected.time_ms)
    np.testing.assert_array_equal(found.tip, expected.tip)


def test_even_marks_cut_a_motion_without_a_trace():
    rests, edges = np.array([0, 1000, 1003, 5000]), np.array([77, 400, 2000])

    def error(start, end):
        return (end - start) / (10 + start % 50)

    marks = even_marks(rests)
    assert np.isin(rests, marks).all()
    assert np.diff(marks).max() <= 128
    whole = knots(rests, edges, error)
    pieces = [knots(marks[first : first + 5], edges, error) for first in range(0, len(marks) - 1, 4)]
    np.testing.assert_array_equal(np.unique(np.concatenate(pieces)), whole)
