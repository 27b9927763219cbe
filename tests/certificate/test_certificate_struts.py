# SPDX-License-Identifier: LGPL-2.1-or-later
from dataclasses import replace

import numpy as np
import pytest

from pkm_post.certificate.struts import (
    AdjacentMotion,
    ProgramPoints,
    acceleration_steps,
    extremes,
    off_plan,
    strut_jerk,
)
from pkm_post.certificate.tool_spline import KnotKinematics
from pkm_post.geometry import hermite_accelerations, hermite_lengths, hermite_speeds
from pkm_post.model import StrutMotion
from pkm_post.report import summary

SHARES = np.linspace(0, 1, 4001)


def ends(count, seed):
    rng = np.random.default_rng(seed)
    lengths, speeds = rng.normal(1000, 1, (2, count, 6)), rng.normal(0, 30, (2, count, 6))
    return lengths[0], speeds[0], lengths[1], speeds[1], rng.uniform(0.001, 0.1, count)


@pytest.mark.slow
def test_closed_forms_are_what_dense_instants_find():
    cubic = ends(300, 4)
    speed, acceleration, shortest, longest = extremes(*cubic)
    dense_length, dense_speed = hermite_lengths(*cubic, SHARES), hermite_speeds(*cubic, SHARES)
    found = np.abs(dense_speed).max(axis=(1, 2))
    step = cubic[-1] / (len(SHARES) - 1)
    bent = np.abs(np.stack(hermite_accelerations(*cubic))).max(axis=(0, 2))
    # between dense instants: half a step of the steepest slope at most, and of an extreme much less
    assert np.all(found <= speed * (1 + 1e-12)) and np.all(speed <= found + bent * step / 2)
    assert np.array_equal(acceleration, bent)
    low, high = dense_length.min(axis=(1, 2)), dense_length.max(axis=(1, 2))
    assert np.all(shortest <= low + 1e-9) and np.all(low <= shortest + bent * step**2)
    assert np.all(high <= longest + 1e-9) and np.all(longest <= high + bent * step**2)


def test_the_report_has_the_shortest_and_longest_length_on_the_way_not_only_at_the_points(monkeypatch):
    rng = np.random.default_rng(9)
    time_ms = np.cumsum(np.append(0, rng.integers(1, 4096, 40)))
    length, speed = 1000 + 5 * rng.normal(size=(41, 6)).cumsum(axis=0), rng.normal(0, 20, (41, 6))
    struts = StrutMotion(time_ms, length, speed, ())
    dense = hermite_lengths(*struts.cubics(np.arange(40)), SHARES)
    for at_once in (1, 7, 8192):
        monkeypatch.setattr(summary, "_AT_ONCE", at_once)
        shortest, longest = summary._strut_ranges(struts)
        np.testing.assert_allclose(shortest, dense.min(axis=(0, 1)), atol=1e-4)
        np.testing.assert_allclose(longest, dense.max(axis=(0, 1)), atol=1e-4)
    assert (longest - length.max(axis=0)).max() > 1


def test_straight_standing_and_even_motion():
    zero, one = np.zeros((1, 6)), np.ones((1, 6))
    for moved, speed in ((zero, zero), (one, 10 * one)):
        found = extremes(1000 * one, speed, 1000 * one + moved, speed, np.array([0.1]))
        np.testing.assert_allclose(np.concatenate(found), [speed[0, 0], 0, 1000, 1000 + moved[0, 0]], atol=1e-9)


def test_an_even_acceleration_turns_a_strut_round_once():
    # 10 mm/s against 100 mm/s^2: it stands after 0.1 s and 0.5 mm, and is back after 0.2 s.
    one, duration = np.ones((1, 6)), np.array([0.2])
    speed, acceleration, shortest, longest = extremes(1000 * one, 10 * one, 1000 * one, -10 * one, duration)
    np.testing.assert_allclose(
        [speed[0], acceleration[0], shortest[0], longest[0]], [10, 100, 1000, 1000.5], rtol=1e-12
    )


def there_and_back():
    """100 ms of 100 mm/s^2 forward, and as much back to rest: the mean accelerations change by 100, 200 and 100."""
    speed = np.repeat([[0.0], [10.0], [0.0]], 6, axis=1)
    return StrutMotion(np.array([0, 100, 200]), 1000 + np.array([[0.0], [0.5], [1.0]]) * np.ones(6), speed, ())


def test_the_jerk_at_both_ends_is_that_from_rest_and_to_rest():
    np.testing.assert_allclose(strut_jerk(there_and_back(), AdjacentMotion()), 3 * [2000.0])


def test_the_acceleration_steps_at_both_ends_as_well():
    np.testing.assert_allclose(acceleration_steps(there_and_back()), [100.0, 200.0, 100.0])


def test_a_wrong_speed_moves_the_longer_of_two_cubics_by_its_largest():
    """The largest difference of the cubics at dense instants; 1 mm/s too fast where 0.1 and 0.9 s meet."""
    length, planned = np.full((3, 6), 1000.0), np.zeros((3, 6))
    struts = StrutMotion(np.array([0, 100, 1000]), length, planned + [[0.0], [1.0], [0.0]] * np.eye(6)[3], ())
    moved = np.abs(hermite_lengths(*struts.cubics(np.arange(2)), SHARES) - 1000.0).max(axis=(1, 2))
    off = off_plan(struts, KnotKinematics(length, planned, np.empty((3, 3, 6)), np.empty(2)))
    np.testing.assert_allclose(off, [0.0, moved.max(), 0.0], rtol=1e-5)
    assert moved[1] > 8 * moved[0]


def test_the_jerk_of_one_strut_is_that_of_all():
    struts = there_and_back()
    alone = replace(struts, speed=struts.speed * np.eye(6)[2])
    np.testing.assert_allclose(strut_jerk(alone, AdjacentMotion()), strut_jerk(struts, AdjacentMotion()))


@pytest.mark.parametrize("moved", [np.ones(6), np.eye(6)[4]], ids=["all", "one"])
def test_points_at_all_knots_have_the_jerk_of_the_knots(moved):
    rng = np.random.default_rng(3)
    time_ms, speed = np.cumsum(np.append(0, rng.integers(1, 90, 12))), rng.normal(0, 20, (13, 6)) * moved
    speed[[0, -1]] = 0.0
    struts, row = StrutMotion(time_ms, 1000 + rng.normal(size=(13, 6)), speed, ()), np.arange(13)
    points = ProgramPoints(row, time_ms, speed, np.maximum(row - 1, 0), np.minimum(row + 1, 12))
    np.testing.assert_allclose(strut_jerk(struts, AdjacentMotion(), points), strut_jerk(struts, AdjacentMotion()))


def test_extremes_are_those_of_the_strut_that_has_them():
    length, still, one, duration = 1000 + np.arange(6.0)[None], np.zeros((1, 6)), np.eye(6)[2:3], np.array([0.2])
    np.testing.assert_allclose(np.concatenate(extremes(length, still, length, still, duration)), [0, 0, 1000, 1005])
    found = np.concatenate(extremes(length, 10 * one, length, -10 * one, duration))
    np.testing.assert_allclose(found, [10, 100, 1000, 1005], rtol=1e-12)
