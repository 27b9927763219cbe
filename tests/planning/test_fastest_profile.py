# SPDX-License-Identifier: LGPL-2.1-or-later
"""The fastest profile against closed forms, and against the same two passes as plain loops."""

import numpy as np
import pytest

from pkm_post.planning.profile.cell_limits import CellLimits, StationLimits
from pkm_post.planning.profile.fastest_profile import Steps, ceilings

ROUNDING = 1e-6
"""Derivatives are in single precision."""


def steps_of(s, rest, limits, share=1.0):
    cells, shares = np.arange(len(s) - 1), np.full(len(s) - 1, share)
    return Steps(s, rest, limits, ceilings(s, limits, cells, shares), shares)


def curve(curvature, acceleration, s, feed=1e3):
    """Limits of a tip on a way with a curvature, (M,) or a number, and the rests at its ends."""
    curvature, none = np.broadcast_to(curvature, len(s)), np.zeros((len(s), 0))
    products = np.column_stack([np.ones(len(s)), np.zeros(len(s)), curvature**2]) / acceleration**2
    rest = np.zeros(len(s), dtype=bool)
    rest[[0, -1]] = True
    return rest, StationLimits.of(np.full(len(s), feed**2), none, none, products)


def test_a_straight_is_a_trapezoid():
    # 100 mm at 20 mm/s with 100 mm/s^2: v^2 = 2 a s until 400 at s = 2 mm, and the same before the end.
    s = np.linspace(0, 100, 1001)
    found = steps_of(s, *curve(0.0, 100.0, s, feed=20.0)).fastest_profile()
    np.testing.assert_allclose(found, np.minimum(400, np.minimum(200 * s, 200 * (100 - s))), rtol=ROUNDING, atol=1e-4)


@pytest.mark.parametrize("share", [1.0, 0.6])
def test_on_an_arc_the_centre_takes_its_part_of_the_acceleration(share):
    # (dx/ds / 2)^2 + (k x)^2 = A^2 from x = 0 is x = A / k sin(2 k s), up to A / k.
    radius, acceleration = 5.0, 1000.0
    s = np.linspace(0, 2 * np.pi * radius, 4001)
    found = steps_of(s, *curve(1 / radius, acceleration, s), share).fastest_profile()
    ramp = np.sin(np.minimum(2 * np.minimum(s, s[-1] - s) / radius, np.pi / 2))
    np.testing.assert_allclose(found, share * acceleration * radius * ramp, rtol=2e-3, atol=1.0)


def rough_way(seed):
    rng = np.random.default_rng(seed)
    s = np.cumsum(10 ** rng.uniform(-2, 0, 400))
    wave = np.sin(np.outer(s / 7, [1.0, 2.0, 3.0]) + rng.uniform(0, 6, 3))
    slope = np.cos(np.outer(s / 7, [1.0, 2.0, 3.0]) + rng.uniform(0, 6, 3)) / 3
    rest, tip = curve(np.abs(wave[:, 0]) / 3, 900.0, s, feed=60.0)
    rest[rng.integers(1, 399, 3)] = True
    limits = StationLimits.of(tip.speed, wave / 1500.0, slope / 1500.0, tip.table[:, -3:])
    limits.table[rest] = 0.0
    return s, rest, limits


def slow_profile(steps):
    """One pass back and one forth, cell by cell."""
    count = len(steps.s) - 1
    cells = [CellLimits.of(steps.s, steps.limits, np.array([i])) for i in range(count)]
    share = steps.share[:1]
    x = np.where(steps.rest, 0.0, steps.highest())
    for i in range(count - 1, -1, -1):
        x[i] = min(x[i], cells[i].behind(share).reached(x[i + 1 : i + 2])[0])
    for i in range(count):
        x[i + 1] = min(x[i + 1], cells[i].ahead(share).reached(x[i : i + 1])[0])
    return x


@pytest.mark.parametrize("seed", range(6))
def test_against_plain_loops(seed):
    steps = steps_of(*rough_way(seed), share=0.8)
    np.testing.assert_allclose(steps.fastest_profile(), slow_profile(steps), rtol=1e-6, atol=1e-9)


@pytest.mark.parametrize("seed", range(6))
def test_every_cell_is_within_its_limits_and_at_one_of_them(seed):
    steps = steps_of(*rough_way(seed))
    found = steps.fastest_profile()
    cell = CellLimits.of(steps.s, steps.limits, slice(None))
    along = np.diff(found) / cell.width
    least, greatest = cell.ahead(steps.share).bounds(found[:-1])
    size = 1e-6 * (np.abs(least) + np.abs(greatest))
    assert np.all((least - size <= along) & (along <= greatest + size))
    at_limit = (along >= greatest - size) | (along <= least + size)
    at_highest = np.isclose(found, np.where(steps.rest, 0.0, steps.highest()), rtol=1e-6)
    assert np.mean(at_limit | at_highest[1:] | at_highest[:-1]) > 0.95


def test_what_was_known_is_found_when_all_is_open():
    steps = steps_of(*rough_way(9))
    found = steps.fastest_profile()
    np.testing.assert_array_equal(steps.renewed(found, np.ones(len(found) - 1, dtype=bool)), found)
