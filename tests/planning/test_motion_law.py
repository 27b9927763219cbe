# SPDX-License-Identifier: LGPL-2.1-or-later
"""The law of motion between places: against small steps of time, and its inverse."""

import numpy as np
import pytest

from pkm_post.planning.motion_law import MotionLaw
from pkm_post.planning.speed_spline import SpeedSpline, durations


def smooth():
    random = np.random.default_rng(8)
    s = np.concatenate([[0.0], np.cumsum(random.uniform(0.05, 2, 20))])
    rest = np.zeros(21, dtype=bool)
    rest[[0, 9, 20]] = True
    spline = SpeedSpline.of(s, rest)
    square, acceleration = spline.at_places(random.uniform(1, 30, len(spline.left)))
    time = np.concatenate([[0.0], np.cumsum(durations(np.diff(s), square, acceleration))])
    return MotionLaw(s, time, np.sqrt(square), acceleration)


def simple():
    random = np.random.default_rng(9)
    speed = np.concatenate([[0.0], random.uniform(1, 20, 8), [0.0]])
    s = np.concatenate([[0.0], np.cumsum(random.uniform(0.1, 3, 9))])
    return MotionLaw(s, np.concatenate([[0.0], np.cumsum(2 * np.diff(s) / (speed[1:] + speed[:-1]))]), speed)


LAWS = pytest.mark.parametrize("law", [smooth(), simple()], ids=["smooth", "simple"])


@LAWS
def test_places_are_met_at_their_times(law):
    s, speed, acceleration = law.at(law.time)
    np.testing.assert_allclose(s, law.s, atol=1e-9)
    np.testing.assert_allclose(speed, law.speed, atol=1e-9)
    if law.acceleration is not None:
        np.testing.assert_allclose(acceleration, law.acceleration, atol=1e-9)
        before = law.at(law.time[1:] * (1 - 1e-13))
        np.testing.assert_allclose(before[1], law.speed[1:], atol=1e-6)
        np.testing.assert_allclose(before[2], law.acceleration[1:], atol=1e-6)


@LAWS
def test_speed_and_acceleration_are_derivatives(law):
    step = 1e-6
    time = np.random.default_rng(2).uniform(step, law.time[-1] - step, 3000)
    time = time[np.abs(law.time[:, None] - time).min(axis=0) > step]
    (s0, v0, _), (_, v, a), (s1, v1, _) = (law.at(time + shift) for shift in (-step, 0, step))
    np.testing.assert_allclose((s1 - s0) / (2 * step), v, atol=1e-6)
    np.testing.assert_allclose((v1 - v0) / (2 * step), a, atol=1e-4)


@LAWS
def test_when_a_place_is_passed(law):
    s = np.sort(np.random.default_rng(4).uniform(0, law.s[-1], 2000))
    time = law.when(s)
    np.testing.assert_allclose(law.at(time)[0], s, atol=1e-9)
    assert (np.diff(time) > 0).all()
    np.testing.assert_allclose(law.when(law.s[1:]), law.time[1:], atol=1e-9)
