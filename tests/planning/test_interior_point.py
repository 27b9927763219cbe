# SPDX-License-Identifier: LGPL-2.1-or-later
"""The interior point method on problems with known answers."""

import numpy as np
import pytest

from pkm_post.planning.jerk.interior_point import fastest
from pkm_post.planning.jerk.motion_limits import Limits
from pkm_post.planning.speed_spline import SpeedSpline, durations


def straight(places, speed, acceleration, jerk):
    """Limits of a straight line, whose path length is the only quantity, from rest to rest."""
    rest = np.zeros(len(places), dtype=bool)
    rest[[0, -1]] = True
    spline = SpeedSpline.of(places, rest)
    ends, one = spline.ends, np.ones((1, len(spline.ends.place)))
    zero = np.zeros_like(one)
    return spline, (
        Limits(ends, np.stack([zero, zero, one / speed**2]), jerk=False),
        Limits(ends, np.stack([zero, one / acceleration, zero]), jerk=False),
        Limits(ends, np.stack([one / jerk, zero, zero]), jerk=True),
    )


def graded(length, count=40):
    half = length / 2 * np.concatenate([[0.0], np.geomspace(1e-4, 1, count)])
    return np.concatenate([half, length - half[-2::-1]])


def like_from_rests(spline, level):
    """Unknowns that grow as the speed squared does from a rest under even jerk."""
    middle = (spline.s[spline.left] + spline.s[spline.left + 1]) / 2
    return level * (np.minimum(middle, spline.s[-1] - middle) / spline.s[-1]) ** (4 / 3)


@pytest.mark.parametrize(
    "length, shortest",
    [(2.0, 0.4), (6.0, 0.6), (20.0, 1.3)],
    ids=["jerk alone", "jerk and acceleration", "all three"],
)
@pytest.mark.parametrize("level", [100.0, 1000.0])
def test_an_s_curve(length, shortest, level):
    # With 1000 mm/s^3, 100 mm/s^2 and 20 mm/s: 2 mm are 4 phases of 0.1 s; 6 mm are twice 0.1 s up, 0.1 s of even
    # acceleration, 0.1 s down; 20 mm/s are reached after 0.3 s on 3 mm, so 20 mm take 0.6 s and 14 mm at 20 mm/s.
    spline, limits = straight(graded(length), 20.0, 100.0, 1000.0)
    unknowns = fastest(spline.weight, limits, like_from_rests(spline, level), 1e-4).unknowns
    square, acceleration = spline.at_places(unknowns)
    time = durations(np.diff(spline.s), square, acceleration).sum()
    assert shortest * (1 - 1e-3) <= time <= 1.02 * shortest
    for one in limits:
        assert one.use(one.ends.values(unknowns)).max() <= 1 + 1e-4


def test_a_vector_is_limited_by_its_length():
    # Two numbers of one vector, 3/5 and 4/5 of the acceleration, are one limit of the whole; each alone is looser.
    spline, limits = straight(graded(6.0), 20.0, 100.0, 1000.0)
    whole = limits[1].weights
    parted = Limits(limits[1].ends, np.concatenate([0.6 * whole, 0.8 * whole], axis=1), jerk=False)
    start = like_from_rests(spline, 100.0)
    found, expected = (
        fastest(spline.weight, (limits[0], one, limits[2]), start, 1e-8).unknowns for one in (parted, limits[1])
    )
    np.testing.assert_allclose(found, expected, rtol=1e-4)


def test_the_time_does_not_depend_on_the_start():
    spline, limits = straight(graded(20.0), 20.0, 100.0, 1000.0)
    starts = (like_from_rests(spline, level) for level in (100.0, 500.0))
    found = (fastest(spline.weight, limits, start, 1e-6).unknowns for start in starts)
    times = [durations(np.diff(spline.s), *spline.at_places(unknowns)).sum() for unknowns in found]
    np.testing.assert_allclose(*times, rtol=1e-5)
