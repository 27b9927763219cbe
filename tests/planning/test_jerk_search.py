# SPDX-License-Identifier: LGPL-2.1-or-later
"""Searches with limits of jerk: about a few cells beside over all of them, and wide cells."""

import dataclasses
from functools import cache

import numpy as np
import pytest
from machines import example
from posted_jobs import offset, preset
from programs import ON_PALLET, program, random_job

from pkm_post.certificate import certify
from pkm_post.model.certificate import Tolerances
from pkm_post.planning import plan, plan_feed
from pkm_post.planning.feed_plan import tool_path
from pkm_post.planning.jerk import profile, search
from pkm_post.planning.jerk.binding_limits import Weights, _of_vectors
from pkm_post.planning.jerk.demands import Demands
from pkm_post.planning.jerk.profile import jerk_limited
from pkm_post.planning.jerk.search import Iterate
from pkm_post.planning.jerk.sections import Places
from pkm_post.planning.jerk.start import first_places, start, with_middles
from pkm_post.planning.rough_limits import DerivativeBounds
from pkm_post.planning.speed_profile import stations
from pkm_post.planning.speed_spline import durations
from pkm_post.toolpath.place import place

FINE = 5e-3
"""Gap of optimality of the searches, and the most by which they leave a limit broken."""
MACHINE = dataclasses.replace(example(), strut_jerk=1e6, tip_jerk=4e5)


@cache
def rough():
    """Lines of 0.3 mm whose points are off by up to 5 um: at 1 um each of them has a corner."""
    random = np.random.default_rng(7)
    x = np.linspace(-30, 30, 201)
    return path_of(np.column_stack([x, 0 * x, 60 + 2 * np.sin(x / 8)]) + random.uniform(-5e-3, 5e-3, (201, 3)), 40.0)


def path_of(points, feed):
    trajectory, _ = place(program(np.round(points, 4), feed=feed), MACHINE, ON_PALLET)
    return tool_path(trajectory, Tolerances(1e-3, np.radians(1e-3)))


def beginning(path, machine=MACHINE):
    """The iterate that a search begins with."""
    marks = stations(path)
    s, rest = first_places(marks)
    steady = Demands.at(path, machine, marks, with_middles(s)).steady()
    fastest, run_up, held = start(s, rest, steady)
    places = Places(s, rest, fastest, run_up, held, steady.of_cell, np.full(len(held), np.inf))
    return Iterate.of(path, marks, machine, places)


def time_of(iterate):
    return durations(np.diff(iterate.spline.s), *iterate.at_places()).sum()


def most_used(iterate):
    return max(use.max() for use in iterate.uses)


def lowered(iterate, cells, factor):
    """The same motion where some cells have to be slower."""
    slower = iterate.slower.copy()
    slower[cells] = factor
    return dataclasses.replace(iterate, slower=slower)


@pytest.mark.parametrize("factor", [1.02, 1.2])
def test_a_search_about_changed_cells_finds_the_motion_of_a_search_over_all(factor):
    before = beginning(rough()).searched(FINE)
    changed = lowered(before, [300, 301, 520], factor)
    cells = changed.changed_from(before)
    np.testing.assert_array_equal(np.flatnonzero(cells), [300, 301, 520])
    near, whole = changed.searched_about(cells, FINE), changed.searched(FINE)
    np.testing.assert_allclose(time_of(near), time_of(whole), rtol=1e-3)
    assert most_used(near) <= np.sqrt(1 + 2 * FINE) * (1 + 2 * FINE)
    distance = np.abs(near.spline.left[:, None] - np.flatnonzero(cells)).min(axis=1)
    same = near.unknowns == before.unknowns
    assert same[distance > search._NEAR].all() and not same[distance < 5].any()


def test_a_few_broken_limits_are_mended_near_them():
    whole = beginning(rough())
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(search, "_FEW_BROKEN", 0.0)
        until_all_hold = whole.searched(FINE)
        patched.setattr(search, "_FEW_BROKEN", 0.02)
        mended = whole.searched(FINE)
    assert most_used(mended) <= np.sqrt(1 + 2 * FINE) * (1 + 2 * FINE)
    np.testing.assert_allclose(time_of(mended), time_of(until_all_hold), rtol=2e-3)


def test_where_nothing_near_can_be_slow_enough_all_cells_are_searched(monkeypatch):
    before = beginning(rough()).searched(FINE)
    changed = lowered(before, slice(390, 411), 2.0)
    monkeypatch.setattr(search, "_NEAR", 4)
    one = np.zeros(len(changed.slower), dtype=bool)
    one[400] = True
    assert changed._searched_about(one, FINE) is None
    assert most_used(changed.searched_about(one, FINE)) <= np.sqrt(1 + 2 * FINE) * (1 + 2 * FINE)


def test_a_wide_cell_keeps_to_its_feed_in_the_middle_and_at_its_ends():
    # On a line along which struts that are slow decide the speed it changes by little; ends of wide cells were slowed
    # by a fifth when their middles were too fast.
    slow = dataclasses.replace(MACHINE, strut_speed=8.0)
    path = path_of(np.array([[-30.0, 0, 60], [30, 0, 60]]), 60.0)
    profile = jerk_limited(path, stations(path), slow, DerivativeBounds.of(path))
    speed = np.sqrt(profile.square)
    cruise = np.abs(profile.s[:, None] - np.append(path.starts, profile.s[-1])).min(axis=1) > 2
    allowed = np.sqrt(Demands.at(path, slow, stations(path), profile.s).ceiling)
    assert cruise.sum() >= 8
    np.testing.assert_allclose(speed[cruise], allowed[cruise], rtol=5e-3)


def test_vectors_with_one_weight_are_their_lengths():
    random = np.random.default_rng(3)
    table = random.normal(size=(3, 3, 60))
    table[1:, :, ::3], table[[0, 2], :, 1::3] = 0.0, 0.0
    values, seen = random.normal(size=(3, 60)), []
    for rows, weights in _of_vectors(table, np.arange(60)):
        length, expected = (
            np.linalg.norm(np.einsum("vre,ve->re", one, values[:, rows]), axis=0) for one in (weights, table[..., rows])
        )
        np.testing.assert_allclose(length, expected, rtol=1e-12)
        seen.append((len(rows), weights.shape[1]))
    assert seen == [(40, 1), (20, 3)]
    assert Weights(table, each=False).take(np.array([4])).table.shape == (3, 3, 1)


def test_a_search_that_does_not_settle_leaves_a_motion_within_its_limits(monkeypatch):
    """The last of the broken limits may take more steps than there are: planning ended in an exception."""
    solve = search.fastest

    def unsettled(*given):
        found = solve(*given)
        return found._replace(reached=False) if given[4:] in ((), (0.0,)) else found

    monkeypatch.setattr(search, "fastest", unsettled)
    monkeypatch.setattr(Iterate, "_searched_about", lambda iterate, cells, enough: None)
    asked = Tolerances(1e-3, np.radians(1e-3))
    trajectory, _ = place(program([[0, 0, 60], [0.02, -0.16, 60], [0.8, 2.9, 61.5]]), MACHINE, ON_PALLET)
    made, faults = plan(trajectory, MACHINE, asked)
    assert not faults
    assert not certify(made.struts, "job.pmc", trajectory, MACHINE, made.motion, asked)[1]


def test_little_excess_between_places_remains(monkeypatch):
    """A whole run from rest to rest is slowed by what remains of it; after three rounds it was 12 % here."""
    limits = {"strut_speed": 72.0, "strut_acceleration": 18419.0, "strut_jerk": 4.3e3}
    limits |= {"axis_speed": 3.22, "tip_acceleration": 25596.0, "tip_jerk": 3.8e6}
    machine = dataclasses.replace(preset("example_6tps"), **limits)
    trajectory, _ = place(random_job(np.random.default_rng(276)), machine, offset(machine))
    excess, slowed = [], profile._from_rest_to_rest

    def watched(found):
        excess.append(found.too_fast.max())
        return slowed(found)

    monkeypatch.setattr(profile, "_from_rest_to_rest", watched)
    plan_feed(trajectory, machine, Tolerances(0.2, np.radians(2)))
    assert max(excess) <= 1.03
