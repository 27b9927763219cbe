# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where the search for a motion with jerk limits begins: its places and its plateaus."""

import dataclasses

import numpy as np
from machines import example
from programs import ON_PALLET, program

from pkm_post.model.certificate import Tolerances
from pkm_post.planning.feed_plan import tool_path
from pkm_post.planning.jerk import profile as jerk_profile
from pkm_post.planning.jerk.demands import Demands
from pkm_post.planning.jerk.start import first_places, long_held, start, unknowns, with_middles
from pkm_post.planning.rough_limits import DerivativeBounds
from pkm_post.planning.speed_profile import stations
from pkm_post.planning.speed_spline import SpeedSpline, durations
from pkm_post.toolpath.place import place


def staircase():
    """Long lines at 20 mm/s with a corner, and one at 10 mm/s."""
    made = program([[-50, 0, 60], [0, 0, 60], [50, 0, 60], [50, 40, 60], [0, 40, 60]], feed=20.0)
    return dataclasses.replace(made, feed=np.array([np.nan, 20.0, 20.0, 20.0, 10.0]))


def begun():
    machine = dataclasses.replace(example(), strut_jerk=1e5, tip_jerk=1e5)
    trajectory, _ = place(staircase(), machine, ON_PALLET)
    path = tool_path(trajectory, Tolerances(1e-2, 1e-4))
    marks = stations(path)
    s, rest = first_places(marks)
    steady = Demands.at(path, machine, marks, with_middles(s)).steady()
    fastest, _, held = start(s, rest, steady)
    spline = SpeedSpline.of(s, rest)
    return machine, path, marks, spline, unknowns(spline, fastest, held), held


def test_joints_rests_and_edges_are_places_and_cells_grow_in_steps():
    _, path, marks, spline, _, _ = begun()
    assert np.isin(marks.s[marks.rest], spline.s).all()
    for wanted in (path.starts, marks.edges):
        assert np.abs(spline.s[:, None] - wanted).min(axis=0).max() <= 1e-9
    width = np.diff(spline.s)[1:-1]
    assert max((width[1:] / width[:-1]).max(), (width[:-1] / width[1:]).max()) <= 20.0


def test_plateaus_are_at_the_feed_and_away_from_corners():
    _, path, _, spline, first, held = begun()
    middle = (spline.s[1:] + spline.s[:-1]) / 2
    segment = np.searchsorted(path.starts, middle) - 1
    known = ~np.isnan(held)
    assert set(segment[known]) >= {2, 3, 4}
    np.testing.assert_allclose(held[known], path.feed[segment[known]] ** 2, rtol=1e-6)
    corners = path.starts[[0, 1, 3, 4, 5]]
    assert np.abs(middle[known][:, None] - corners).min() > 0.5
    np.testing.assert_array_equal(first[known[spline.left]], held[known])


def test_the_motion_is_the_same_without_plateaus(monkeypatch):
    machine, path, marks, *_ = begun()
    found = []
    for held in (start, lambda *given: (*start(*given)[:2], np.full(len(given[0]) - 1, np.nan))):
        monkeypatch.setattr(jerk_profile, "start", held)
        profile = jerk_profile.jerk_limited(path, marks, machine, DerivativeBounds.of(path))
        found.append(durations(np.diff(profile.s), profile.square, profile.acceleration).sum())
    np.testing.assert_allclose(*found, rtol=5e-3)


def test_few_cells_side_by_side_are_not_held():
    nan = np.nan
    held = np.array([1.0, 1, nan, 2, 2, 2, nan, 3, nan, nan, 4, 4, 4, 4])
    np.testing.assert_array_equal(long_held(held), [nan, nan, nan, 2, 2, 2, nan, nan, nan, nan, 4, 4, 4, 4])
