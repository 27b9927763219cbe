# SPDX-License-Identifier: LGPL-2.1-or-later
"""Moves and profiles, each against another statement of the same motion."""

import numpy as np
import pytest

from pkm_post.control.simulator.motors import endless, go_to, stop
from pkm_post.control.simulator.moves import BlendedMove, PvtMove, ramps_of, share
from pkm_post.geometry import curves as hermite

PICOMETRE = 1e-9  # mm
RNG = np.random.default_rng(7)


def test_a_pvt_move_is_the_cubic_of_the_geometry():
    # The two are written apart: this one for one move at a time, in ms, from its end.
    for _ in range(200):
        p0, p1 = RNG.uniform(300, 900, (2, 9))
        v0, v1 = RNG.uniform(-0.3, 0.3, (2, 9))  # mm/ms
        duration = float(RNG.integers(1, 4096))
        move = PvtMove(17.0, duration, p0, p1, v0, v1)
        shares = RNG.uniform(0, 1, 20)
        expected = hermite.hermite_lengths(
            *(column[None] for column in (p0, v0, p1, v1)), np.array([duration]), shares
        )[0]
        got = np.array([p1 - move.missing(17.0 + gone * duration) for gone in shares])
        assert np.abs(got - expected).max() < PICOMETRE


def test_before_and_after_a_pvt_move_the_axes_are_at_its_ends():
    p0, p1 = np.zeros(9), np.ones(9)
    move = PvtMove(10.0, 20.0, p0, p1, p0 + 0.1, p1 * 0.2)
    assert (move.missing(5.0) == 1).all()
    assert np.abs(move.missing(40.0)).max() < 1e-15


def speed_of(boxes, steps):
    """The convolution of boxes, by summing them up in small steps of time; its integral goes to one."""
    step = sum(boxes) / steps
    speed = np.array([1.0])
    for box in boxes:
        count = round(box / step)
        speed = np.convolve(speed, np.full(count, 1 / count))
    return step, np.concatenate([[0.0], np.cumsum(speed)])


@pytest.mark.parametrize("boxes", [(100,), (100, 20), (50, 50), (100, 30, 20), (60, 60, 60), (20, 90, 10)])
def test_the_share_of_a_smoothed_move_is_the_integral_of_convolved_boxes(boxes):
    step, gone = speed_of(boxes, sum(boxes) * 20)
    # Each discrete box begins half a step late.
    times = step * (np.arange(len(gone)) + 0.5 * (len(boxes) - 1))
    computed = np.array([share(time, tuple(map(float, boxes))) for time in times])
    assert np.abs(computed - gone).max() < 2e-3


@pytest.mark.parametrize("boxes", [(100.0,), (1000.0, 20.0), (1e6, 30.0, 20.0), (60.0, 60.0, 60.0), (80.0, 0.0)])
def test_the_share_grows_from_nothing_to_one_evenly_about_the_middle(boxes):
    times = np.linspace(0, sum(boxes), 1001)
    gone = np.array([share(time, boxes) for time in times])
    assert gone[0] == 0 and gone[-1] == 1
    assert (np.diff(gone) >= -1e-15).all()
    assert np.abs(gone + gone[::-1] - 1).max() < 1e-12


def test_moves_that_blend_go_on_at_their_speed():
    # Two moves of the same speed in one line: no change of speed where they meet.
    step = np.array([10.0] + [0.0] * 8)
    first = BlendedMove(0.0, 100.0, (20.0,), step, step, True)
    second = BlendedMove(first.hand_over, 100.0, (20.0,), step, 2 * step, True)
    times = np.arange(20, 200, 1.0)
    places = np.array([(2 * step - first.missing(time) - second.missing(time))[0] for time in times])
    assert np.abs(np.diff(places) - 0.1).max() < 1e-12


@pytest.mark.parametrize(
    ("ramp", "curve", "boxes"), [(50, 0, (50,)), (50, 10, (40, 10)), (10, 20, (20, 20)), (0, 0, (0,))]
)
def test_ramps(ramp, curve, boxes):
    assert ramps_of(ramp, curve) == boxes


@pytest.mark.parametrize("speed", [0.0, 3.0, -3.0, 10.0])
@pytest.mark.parametrize("goal", [0.0, 1.0, -500.0, 700.0, 12.5])
def test_a_profile_arrives_within_its_limits(speed, goal):
    limit, acceleration = 10.0, 0.5
    profile = go_to(100.0, speed, goal, limit, acceleration)
    step = 0.01
    times = np.arange(0, profile.duration + 1, step)
    places = np.array([profile.at(time) for time in times])
    speeds = np.diff(places) / step
    assert profile.at(0.0) == pytest.approx(100.0)
    assert profile.at(profile.duration) == goal and profile.ended(profile.duration)
    assert np.abs(speeds).max() <= limit + 1e-9
    assert np.abs(np.diff(speeds)).max() <= acceleration * step + 1e-9
    assert abs(speeds[0] - speed) <= acceleration * step


def test_a_stop_and_a_motion_without_end():
    braking = stop(0.0, 10.0, 0.5)
    assert (braking.duration, braking.goal) == (20.0, 100.0)
    going = endless(0.0, -2.0, 10.0, 0.5)
    assert not going.ended(1e9)
    assert going.at(24.0) == pytest.approx(-2 * 24 + 0.25 * 24**2)
    assert going.at(34.0) - going.at(24.0) == pytest.approx(100.0)
