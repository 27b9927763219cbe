# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sections of a path: what they cover, and that the motion found in them is that of the whole path."""

import dataclasses
from functools import cache

import numpy as np
import pytest
from machines import example
from programs import ON_PALLET, cone, program

from pkm_post.model import checkpoints
from pkm_post.model.certificate import Tolerances
from pkm_post.planning.feed_plan import tool_path
from pkm_post.planning.jerk import binding_limits, interior_point, search
from pkm_post.planning.jerk import profile as jerk_profile
from pkm_post.planning.jerk.sections import Places, sections
from pkm_post.planning.rough_limits import DerivativeBounds
from pkm_post.planning.speed_profile import stations
from pkm_post.planning.speed_spline import durations
from pkm_post.toolpath.place import place

FEW = 40
"""Cells of a section, so that short paths have many of them."""
COST = 0.01
"""s that a border may cost: it is held at 0.95 of the speed squared about it, where that is best of forty cells."""


def scan():
    """A wave in chords with kinks that slow the tool, and a dwell."""
    x = np.linspace(-40, 40, 161)
    return program(np.column_stack([x, 0 * x, 60 + 2 * np.sin(x / 4)]), feed=60.0)


MADE = {"cone": cone(120, turns=0.5), "scan": scan()}
JOBS = pytest.mark.parametrize("job", MADE)


def searched(job, tolerance=7e-4, **limits):
    machine = dataclasses.replace(example(), **{"strut_jerk": 1e6, "tip_jerk": 4e5} | limits)
    trajectory, _ = place(MADE[job], machine, ON_PALLET)
    path = tool_path(trajectory, Tolerances(tolerance, np.radians(tolerance)))
    return jerk_profile.jerk_limited(path, stations(path), machine, DerivativeBounds.of(path))


@cache
def in_one(job):
    """The profile of a job, found without smaller sections."""
    return searched(job)


@cache
def in_many(job):
    """The profile of a job found in sections of few cells, and these sections."""
    with pytest.MonkeyPatch.context() as patched:
        found = in_sections_of(FEW, patched)
        return searched(job), found


def in_sections_of(cells, monkeypatch):
    found = []

    def recorded(places):
        found.extend(sections(places, cells))
        return iter(found)

    monkeypatch.setattr(jerk_profile, "sections", recorded)
    return found


def time_of(profile):
    return durations(np.diff(profile.s), profile.square, profile.acceleration).sum()


@pytest.mark.slow
@JOBS
def test_the_motion_in_many_sections_is_little_slower_than_in_one(job):
    whole, (profile, used) = in_one(job), in_many(job)
    assert len(used) >= 3
    assert (1 - 5e-3) * time_of(whole) <= time_of(profile)
    assert time_of(profile) <= (1 + 5e-3) * time_of(whole) + COST * len(used)
    assert np.isin(profile.s[profile.rest], whole.s).all()
    assert (profile.square[~profile.rest] > 0).all()


@pytest.mark.slow
@JOBS
def test_sections_follow_one_another_and_their_motions_meet(job):
    profile, used = in_many(job)
    for one, two in zip(used[:-1], used[1:], strict=True):
        assert one.end == two.begin
    assert (used[0].begin, used[-1].end) == (profile.s[0], profile.s[-1])
    assert (np.diff(profile.s) > 0).all()
    # Between places the acceleration is linear: at the end of each cell both place values follow from its start.
    inner = np.flatnonzero((profile.square[:-1] > 0) & (profile.square[1:] > 0))
    width = np.diff(profile.s)[inner]
    end = profile.square[inner] + width * (profile.acceleration[inner] + profile.acceleration[inner + 1])
    np.testing.assert_allclose(end, profile.square[inner + 1], rtol=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_sections_meet_at_speeds_that_a_motion_can_reach(monkeypatch, seed):
    # Borders on a short stretch of high speed, and a start that stepped down beside them, left sections without a
    # motion in three of these four: then the whole path was searched at once.
    x = np.linspace(-30, 30, 201)
    points = np.column_stack([x, 0 * x, 60 + 2 * np.sin(x / 8)])
    points += np.random.default_rng(seed).uniform(-5e-3, 5e-3, points.shape)
    monkeypatch.setitem(MADE, "rough", program(np.round(points, 4), feed=60.0))
    used, plain, failed = in_sections_of(2 * FEW, monkeypatch), jerk_profile._searched, []

    def watched(*section):
        try:
            return plain(*section)
        except search.NotFoundError:
            failed.append(section)
            raise

    monkeypatch.setattr(jerk_profile, "_searched", watched)
    searched("rough", 1e-3, strut_jerk=1e5, tip_jerk=1e5)
    assert len(used) > 5 and not failed


def test_a_path_without_borders_is_one_section_when_none_holds(monkeypatch):
    whole = in_one("scan")
    in_sections_of(FEW, monkeypatch)
    plain = search.fastest

    def not_between_borders(weight, *arguments):
        found = plain(weight, *arguments)
        return found._replace(reached=found.reached and len(weight) > 3 * FEW)

    monkeypatch.setattr(search, "fastest", not_between_borders)
    np.testing.assert_allclose(time_of(searched("scan")), time_of(whole), rtol=5e-3)


def test_a_search_visits_its_caller_before_each_step_and_ends_when_that_says_so(monkeypatch):
    steps, visits = [], []
    plain = interior_point._stepped
    monkeypatch.setattr(interior_point, "_stepped", lambda *arguments: steps.append(len(visits)) or plain(*arguments))
    with checkpoints(lambda: visits.append(len(steps))):
        searched("cone")
    assert len(steps) > 5 and (np.diff(steps) > 0).all()

    class LeftError(Exception):
        pass

    def leave():
        raise LeftError

    taken = len(steps)
    with checkpoints(lambda: leave() if len(steps) == taken + 3 else None), pytest.raises(LeftError):
        searched("cone")
    assert len(steps) == taken + 3


@JOBS
def test_limits_that_were_left_out_are_kept_and_cost_nothing(job, monkeypatch):
    some = in_one(job)
    monkeypatch.setattr(binding_limits, "_BINDS", -1.0)
    every = searched(job)
    np.testing.assert_allclose(time_of(some), time_of(every), rtol=5e-3)


def test_places_inside_plateaus_are_left_out_and_what_is_beside_them_stays():
    cells = 100
    held = np.full(cells, np.nan)
    held[20:80] = 9.0
    s, rest = np.arange(cells + 1.0), np.zeros(cells + 1, dtype=bool)
    rest[[0, -1]] = True
    even, run_up, room = np.full(cells + 1, 9.0), np.ones(cells + 1), np.full(cells, np.inf)
    places = Places(s, rest, even, run_up, held, even[1:], room).thinned()
    np.testing.assert_array_equal(np.setdiff1d(s, places.s), np.arange(37.0, 64.0))  # 20 + 16 to 80 - 16
    fixed = np.isfinite(places.room)
    assert (places.held[fixed] == 9.0).all()
    np.testing.assert_array_equal(places.s[:-1][fixed], [33.0, 34.0, 35.0, 36.0, 64.0, 65.0, 66.0])
