# SPDX-License-Identifier: LGPL-2.1-or-later
"""The stock at any time of a motion is the same from wherever one comes, and it is compared with the part."""

import math

import numpy as np
import pytest
from meshes import box

from pkm_post.removal import CutterPath, Replay, RotatingShape, Stock, compare, cutting_times, part_distances, replay
from pkm_post.toolpath import Cutter

BLOCK = box([-20, -15, -20], [20, 15, 0])
BALL = RotatingShape.of(Cutter(5.0, 0.0, 5.0), 40.0)
FLAT = RotatingShape.of(Cutter(0.0, 4.0, 0.0), 40.0)
POSES = 350
SAME = 1e-4
"""mm: products of single-precision matrices depend on how many are multiplied at once."""


def tilting_path(shapes=(BALL, FLAT, None)):
    """A tool that winds down and leans all around; the last part with a tool of unknown size."""
    seconds = np.linspace(0.1, 70.0, POSES)
    turn = seconds / 4
    tip = np.column_stack([14 * np.cos(turn), 9 * np.sin(turn), -seconds / 6])
    axis = np.column_stack([0.5 * np.cos(turn), 0.5 * np.sin(turn), np.ones(POSES)])
    tool = np.repeat([0, 1, 2], [200, 100, 50])
    return CutterPath(seconds, tip, axis / np.linalg.norm(axis, axis=1)[:, None], tool, shapes)


@pytest.fixture
def played():
    return Replay(Stock.of(BLOCK, 1.5), tilting_path())


def at_once(seconds):
    fresh = Replay(Stock.of(BLOCK, 1.5), tilting_path())
    fresh.go_to(seconds)
    return fresh.stock


@pytest.mark.slow
@pytest.mark.parametrize("kept", [100_000, 60])
def test_back_and_forth_is_the_same_as_straight_there(played, monkeypatch, kept):
    monkeypatch.setattr(replay, "_MOST_KEPT", kept)
    for seconds in (65.0, 12.0, 43.0, 0.0):
        played.go_to(seconds)
        assert played.is_at(seconds)
        straight = at_once(seconds)
        np.testing.assert_allclose(played.stock.field, straight.field, atol=SAME)
        assert played.stock.volume == pytest.approx(straight.volume, rel=1e-6)


def test_the_bricks_reported_are_those_that_changed(played):
    for seconds in (20.0, 21.0, 5.0):
        before = played.stock.field.copy()
        changed = played.go_to(seconds)
        really = np.flatnonzero((before != played.stock.field).any(axis=1))
        assert set(really.tolist()) <= set(changed.tolist())
        assert len(really) > 0


def test_work_is_done_in_portions_and_a_tool_of_unknown_size_takes_nothing(played):
    calls = 0
    while not played.is_at(70.0):
        played.go_to(70.0, most=50)
        calls += 1
    assert calls == POSES / 50
    assert played.seconds == 70.0
    assert played.stock.volume == pytest.approx(at_once(60.0).volume, rel=1e-6)


def test_times_are_close_where_the_tool_goes_far_and_none_where_it_rests():
    seconds = np.array([0.0, 1.0, 2.0, 3.0])
    tip, axis = (
        np.array([[0, 0, 0], [30, 0, 0], [30, 0, 0], [30, 0, -5]], dtype=float),
        np.tile([0.0, 0.0, 1.0], (4, 1)),
    )
    times = cutting_times(seconds, tip, axis, [BALL], 1.0)
    assert not np.any((times > 1.0) & (times < 2.0001))
    moved = np.diff(np.interp(times, seconds, np.append(0, np.cumsum(np.linalg.norm(np.diff(tip, axis=0), axis=1)))))
    assert np.all(moved[times[1:] <= 1.0] ** 2 / (8 * 5.0) <= 0.05 + 1e-9)  # the ridge between two circles
    assert np.all(np.diff(times) > 0)
    turned = np.column_stack([np.sin([0, 0.5]), [0, 0], np.cos([0, 0.5])])
    assert len(cutting_times(seconds[:2], np.zeros((2, 3)), turned, [FLAT, BALL], 1.0)) > 0.5 * 40 / 2


def test_a_plunge_longer_than_the_cutting_edges_leaves_nothing_between_its_poses():
    """Its volume is that of a cylinder, whatever of the tool is above the edges."""
    drill = RotatingShape.of(Cutter(0.0, 4.0, 0.0), 3.0)
    tip, axis = np.array([[0.0, 0.0, 2.0], [0.0, 0.0, -15.0]]), np.tile([0.0, 0.0, 1.0], (2, 1))
    times = cutting_times(np.array([0.0, 1.0]), tip, axis, [BALL, drill], 0.5)
    stock = Stock.of(BLOCK, 0.5)
    whole = stock.volume
    depths = np.column_stack([*np.zeros((2, len(times))), 2.0 - 17.0 * times])
    for _ in stock.cut(depths, np.tile(axis[0], (len(times), 1)), drill):
        pass
    assert whole - stock.volume == pytest.approx(math.pi * 4**2 * 15, rel=0.01)


@pytest.mark.slow
def test_what_is_left_and_what_is_missing_are_measured():
    stock = Stock.of(BLOCK, 0.5)
    part = part_distances(stock, box([-20, -15, -20], [20, 15, -4]))
    untouched = compare(stock, part)
    assert untouched.left == pytest.approx(40 * 30 * 4, rel=0.02)
    assert (untouched.gouged, untouched.deepest) == (pytest.approx(0, abs=40), pytest.approx(0, abs=0.05))
    assert untouched.thickest == untouched.limit == 3.0
    lanes = np.arange(-15, 16, 3.0)
    tips = np.concatenate([np.linspace([-30, y, -3.5], [30, y, -3.5], 120) for y in lanes])
    for _ in stock.cut(tips, np.tile([0.0, 0.0, 1.0], (len(tips), 1)), FLAT):
        pass
    levelled = compare(stock, part)
    assert levelled.left == pytest.approx(40 * 30 * 0.5, rel=0.03)
    assert levelled.thickest == pytest.approx(0.5, abs=0.05)
    tilt = math.radians(30)
    axis = np.array([[math.sin(tilt), 0, math.cos(tilt)]])
    for _ in stock.cut(np.array([[0.0, 0.0, -5.2]]) + 5 * ([0, 0, 1] - axis), axis, BALL):
        pass
    gouged = compare(stock, part)
    # the lowest point of the ball is 1.2 below the part: a cap, and the tilted side above it is in the air
    assert gouged.deepest == pytest.approx(1.2, abs=0.03)
    assert gouged.gouged == pytest.approx(math.pi * 1.2**2 * (5 - 0.4), rel=0.1)
