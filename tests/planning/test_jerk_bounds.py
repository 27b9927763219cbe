# SPDX-License-Identifier: LGPL-2.1-or-later
"""Segments that surely run at their feed do so by the exact limits too, and the plan is the same without them."""

import dataclasses

import numpy as np
import pytest
from machines import example
from programs import ON_PALLET, program, random_job

from pkm_post.geometry import norm
from pkm_post.model.certificate import Tolerances
from pkm_post.planning.feed_plan import tool_path
from pkm_post.planning.jerk import profile as jerk_profile
from pkm_post.planning.jerk.demands import Demands
from pkm_post.planning.jerk.profile import steady_at_feed
from pkm_post.planning.rough_limits import DerivativeBounds
from pkm_post.planning.speed_profile import stations
from pkm_post.planning.speed_spline import durations
from pkm_post.toolpath import tip_jerk_bound
from pkm_post.toolpath.place import place

PLACES = 16
"""Places on each segment."""


def waves(feed=40.0, noise=0.0, axis=None):
    """Passes over a surface of sine waves, in chords of 0.4 mm."""
    rng = np.random.default_rng(5)
    x = np.tile(np.r_[-20:20.2:0.4, 20:-20.2:-0.4], 2)
    y = np.repeat(np.arange(4.0), len(x) // 4)
    z = 70 + 4 * np.sin(x / 8) * np.cos(y / 2) + rng.uniform(-noise, noise, len(x))
    return program(np.round(np.column_stack([x, y, z]), 4), axis and np.tile(axis, (len(x), 1)), feed=feed)


JOBS = {
    "waves": waves,
    "fast waves": lambda: waves(120.0),
    "rough waves": lambda: waves(noise=2e-3),
    "leaning": lambda: waves(axis=[0.2, 0.1, 0.95**0.5]),
    **{f"random {seed}": (lambda seed=seed: random_job(np.random.default_rng(seed))) for seed in range(4)},
}


def of(job, **limits):
    """Path, machine and rough bounds."""
    machine = dataclasses.replace(example(), **{"strut_jerk": 4e5, "tip_jerk": 2e5, **limits})
    trajectory, _ = place(job, machine, ON_PALLET)
    path = tool_path(trajectory, Tolerances(1e-2, 1e-4))
    return path, machine, steady_at_feed(path, machine, DerivativeBounds.of(path))


@pytest.mark.parametrize("limits", [{}, {"tip_jerk": np.inf}, {"strut_jerk": np.inf, "strut_acceleration": 400.0}])
@pytest.mark.parametrize("name", JOBS)
def test_exact_limits_are_no_lower(name, limits):
    path, machine, rough = of(JOBS[name](), **limits)
    exact = dense(path, machine)
    segment = np.searchsorted(path.starts, (exact.s[1:] + exact.s[:-1]) / 2, side="right") - 1
    surely = ~np.isnan(rough.square[segment])
    steady = exact.demands.steady()
    assert np.all(steady.of_cell[surely] >= path.feed[segment[surely]] ** 2 * (1 - 1e-9))
    for of_place, of_segment in ((steady.along, rough.along), (steady.growth, rough.growth)):
        assert np.all(np.minimum(of_place[1:], of_place[:-1])[surely] >= of_segment[segment[surely]] * (1 - 1e-9))


@dataclasses.dataclass
class Dense:
    """Places, and the demands there and in the middles between them."""

    s: np.ndarray
    demands: Demands


def dense(path, machine):
    ends = np.append(path.starts[:-1], path.starts[-1])
    inside = ends[:-1, None] + np.diff(ends)[:, None] * np.linspace(0, 1, PLACES, endpoint=False)
    s = np.append(inside.ravel(), ends[-1])
    places = np.insert(s, np.arange(1, len(s)), (s[1:] + s[:-1]) / 2)
    return Dense(s, Demands.at(path, machine, stations(path), places))


@pytest.mark.parametrize(("name", "least"), [("waves", 0.8), ("leaning", 0.8), ("fast waves", 0.1)])
def test_most_of_a_smooth_path_is_known(name, least):
    path, _, rough = of(JOBS[name]())
    cutting = path.segments.splines.row
    assert np.mean(~np.isnan(rough.square[cutting])) >= least


def test_nothing_is_known_where_bounds_are_missing():
    for limits in ({"screw_lead": 5.0}, {"strut_stroke": (0.0, np.inf)}):
        assert np.isnan(of(waves(), **limits)[2].square).all()


@pytest.mark.slow
@pytest.mark.parametrize("name", JOBS)
def test_the_motion_is_the_same_with_exact_demands_everywhere(name, monkeypatch):
    path, machine, _ = of(JOBS[name]())
    found = [jerk_profile.jerk_limited(path, stations(path), machine, DerivativeBounds.of(path))]

    def unknown(*given):
        rough = steady_at_feed(*given)
        nothing = np.full(len(rough.square), np.nan)
        return rough._replace(square=nothing, of_cell=nothing)

    monkeypatch.setattr(jerk_profile, "steady_at_feed", unknown)
    found.append(jerk_profile.jerk_limited(path, stations(path), machine, DerivativeBounds.of(path)))
    times = [durations(np.diff(one.s), one.square, one.acceleration).sum() for one in found]
    np.testing.assert_allclose(*times, rtol=2e-3)


def test_third_derivatives_of_curves_are_below_their_bounds():
    path, _, _ = of(waves())
    splines = path.segments.splines
    bound, step = tip_jerk_bound(splines), 1e-3
    shares = np.linspace(0, 1, 33)
    u = np.outer(splines.extent, shares)
    u = np.clip(u, step, splines.extent[:, None] - step)
    rows = np.repeat(splines.row, len(shares))
    after, before = (path.segments.tip_at(rows, u.ravel() + d)[2] for d in (step, -step))
    third = norm(after - before).reshape(u.shape) / (2 * step)
    assert np.all(third.max(axis=1) <= bound * (1 + 1e-6) + 1e-6)
    assert np.median(third.max(axis=1) / bound) > 0.3
