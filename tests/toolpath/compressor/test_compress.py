# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which rows become curves, how far these are off, and what they keep."""

import dataclasses
import tracemalloc

import numpy as np
import pytest
from best_segment import deviation_from_any
from machines import example
from programs import BALL, ON_PALLET, program
from smooth_runs import column_like, fitted_rows, wavy

from pkm_post.certificate.deviation import TrajectoryRuler
from pkm_post.geometry import length_of, norm
from pkm_post.model import Event, EventKind, Tolerances
from pkm_post.toolpath import Segments, compress
from pkm_post.toolpath.compressor import compress as criteria
from pkm_post.toolpath.compressor.compress import runs
from pkm_post.toolpath.place import place

TIP, AXIS = 0.006, 1e-4
MICRON = 1e-3
SHARES = np.linspace(0.05, 0.95, 19)


def trajectory_of(point, axis=None, **changes):
    made = dataclasses.replace(program(np.asarray(point), axis), **changes)
    trajectory, faults = place(made, example(), ON_PALLET)
    assert not faults
    return trajectory


def wave(rows=80, noise=0.0, chord=0.2):
    """Positions on a wave above the pallet."""
    return wavy(rows, chord, noise)[:3].T + [-10, 0, 60]


def curves_of(trajectory, tip=TIP, axis=AXIS):
    return compress(trajectory, Segments.of(trajectory), np.full(len(trajectory), tip), axis)


def first_and_count(trajectory, tip=TIP):
    return [
        one.tolist() for one in runs(trajectory, Segments.of(trajectory).extent, np.full(len(trajectory), tip), AXIS)
    ]


def test_a_wave_is_one_run_after_the_approach():
    assert first_and_count(trajectory_of(wave())) == [[1], [80]]


@pytest.mark.parametrize("noise", [0.0, 0.002, 0.005])
def test_a_vertex_off_by_noise_is_no_corner(noise):
    assert first_and_count(trajectory_of(wave(noise=noise))) == [[1], [80]]


@pytest.mark.parametrize(("turn", "kept"), [(15, False), (25, True), (90, True), (180, True)])
def test_a_sharp_corner_ends_a_run(turn, kept):
    """A corner on a curve whose other turns are a third of the smaller one."""
    angle = np.radians(np.concatenate([np.full(20, 6.0), [turn], np.full(20, 6.0)])).cumsum()
    way = np.cumsum(0.3 * np.column_stack([np.cos(angle), np.sin(angle), 0 * angle]), axis=0)
    trajectory = trajectory_of(np.vstack([[0, 0, 60], way + [0, 0, 60]]))
    assert first_and_count(trajectory, 1e-4) == ([[1, 21], [20, 21]] if kept else [[1], [41]])


def test_a_corner_alone_between_straight_rows_ends_a_run():
    angle = np.radians(np.repeat([0.0, 5.0], 20))
    way = np.cumsum(0.3 * np.column_stack([np.cos(angle), np.sin(angle), 0 * angle]), axis=0)
    trajectory = trajectory_of(np.vstack([[0, 0, 60], way + [0, 0, 60]]))
    assert first_and_count(trajectory, 1e-4) == [[1, 21], [20, 20]]


def test_noise_explains_a_sharp_turn_of_tiny_chords():
    assert first_and_count(trajectory_of(wave(400, noise=0.005, chord=0.02))) == [[1], [400]]


def test_long_lines_remain_lines():
    x = np.concatenate([np.arange(0, 4, 0.2), [12.0], 12 + np.arange(0.2, 4, 0.2), [25.0, 45.0, 46.0]])
    trajectory = trajectory_of(np.column_stack([x - 20, 0 * x, 0 * x + 60]))
    long = trajectory.length > criteria._LONGEST
    assert long.sum() > 2
    begin, count = runs(trajectory, trajectory.length, np.full(len(trajectory), TIP), AXIS)
    assert not any(long[first : first + many].any() for first, many in zip(begin, count, strict=True))
    assert count.tolist() == [19, 19]


def changed_feed(trajectory):
    return dataclasses.replace(trajectory, feed=np.where(np.arange(len(trajectory)) > 40, 20.0, 30.0))


def changed_operation(trajectory):
    operation = (np.arange(len(trajectory)) > 40).astype(trajectory.operation.dtype)
    return dataclasses.replace(trajectory, operation=operation, operations=("one", "other"))


def changed_tolerance(trajectory):
    return dataclasses.replace(trajectory, tip_tolerance=np.where(np.arange(len(trajectory)) > 40, 0.01, 0.0))


def rest(trajectory):
    stop = trajectory.exact_stop.copy()
    stop[40] = True
    return dataclasses.replace(trajectory, exact_stop=stop)


@pytest.mark.parametrize("change", [changed_feed, changed_operation, changed_tolerance, rest])
def test_a_change_ends_a_run(change):
    assert first_and_count(change(trajectory_of(wave()))) == [[1, 41], [40, 40]]


def test_feeds_of_inverse_time_do_not():
    trajectory = trajectory_of(wave())
    feed = 30 * (1 + 0.04 * np.sin(np.arange(len(trajectory))))
    assert first_and_count(dataclasses.replace(trajectory, feed=feed)) == [[1], [80]]


def test_events_end_a_run():
    events = Event(0, EventKind.TOOL_CHANGE, float(BALL.number)), Event(41, EventKind.DWELL, 1.0)
    trajectory = trajectory_of(wave(), events=events)
    assert first_and_count(trajectory) == [[1, 41], [40, 40]]


def test_an_axis_that_turns_far_in_a_row_remains():
    lean = np.repeat([0.0, 0.3, 0.35], [30, 30, 21])
    axis = np.column_stack([np.sin(lean), 0 * lean, np.cos(lean)])
    begin, count = first_and_count(trajectory_of(wave(), axis))
    assert 30 not in [row for first, many in zip(begin, count, strict=True) for row in range(first, first + many)]


def test_long_runs_are_cut(monkeypatch):
    monkeypatch.setattr(criteria, "_MOST_ROWS", 30)
    assert first_and_count(trajectory_of(wave())) == [[1, 27, 54], [26, 27, 27]]


def jobs():
    rng = np.random.default_rng(7)
    leaning = column_like(150)
    yield "wave", wave(300), None, MICRON, AXIS
    yield "noise", wave(600, noise=0.005), None, 0.01, AXIS
    yield "noise beyond the tolerance", wave(200, noise=0.005), None, MICRON, AXIS
    yield "leaning", leaning[:3].T + [0, 0, 60], leaning[3:6].T, 2 * MICRON, AXIS
    for number in range(12):
        turn = np.cumsum(rng.normal(size=(200, 2)) * 10 ** rng.uniform(-2, -0.5), axis=0) * 0.2
        way = np.column_stack([np.cos(turn[:, 0]), np.sin(turn[:, 0]), np.sin(turn[:, 1])])
        chord = rng.uniform(0.05, 0.4, 200)
        point = np.cumsum(way * chord[:, None], axis=0) + [0, 0, 60]
        lean = 0.2 * np.sin(np.cumsum(chord) / rng.uniform(2, 20))
        axis = np.column_stack([np.sin(lean), 0 * lean, np.cos(lean)])
        yield f"random {number}", point, axis if number % 2 else None, 10 ** rng.uniform(-3.5, -1), AXIS


@pytest.mark.parametrize(("point", "axis", "tip", "turn"), [job[1:] for job in jobs()], ids=[job[0] for job in jobs()])
def test_curves_stay_within_their_share(point, axis, tip, turn):
    """Measured as the certificate does, from any of the segments nearby; and from each programmed point."""
    trajectory = trajectory_of(point, axis)
    splines = curves_of(trajectory, tip, turn)
    if not len(splines):
        pytest.fail("no row became a curve")
    segments = Segments.of(trajectory).smoothed(splines)
    rows, u = np.repeat(splines.row, len(SHARES)), np.outer(splines.extent, SHARES).ravel()
    at = segments.tip_at(rows, u)[0], segments.axis_at(rows, u)[0]
    ruler = TrajectoryRuler(trajectory, Tolerances(tip, turn))
    near = np.maximum(rows - 1, 0), np.minimum(rows + 1, len(trajectory) - 1)
    off_tip, off_axis = deviation_from_any(ruler, *at, *near)
    # between the places where it is measured it may be a little more; the rest of the tolerance takes that
    assert off_tip.max() <= 1.05 * tip
    assert off_axis.max() <= 1.05 * turn
    ends = segments.tip_at(splines.row, splines.extent)[0]
    assert norm(ends - trajectory.tip[splines.row]).max() <= 1.01 * tip


def test_lines_of_many_rows_are_reproduced():
    share = np.sort(np.random.default_rng(1).uniform(0, 1, 60))
    trajectory = trajectory_of([0, 0, 60] + share[:, None] * np.array([20.0, 9.0, -3.0]))
    splines = curves_of(trajectory)
    assert len(splines) > 50
    value, slope, second = splines.at(np.arange(len(splines)), 0.3 * splines.extent, splines.tip)
    way = np.array([20.0, 9.0, -3.0]) / np.sqrt(490)
    np.testing.assert_allclose(slope.T, np.tile(way, (len(splines), 1)), atol=1e-9)
    assert np.abs(second).max() < 1e-8
    start = trajectory.tip_before()[splines.row]
    np.testing.assert_allclose(value.T, start + 0.3 * splines.extent[:, None] * way, atol=1e-9)


@pytest.mark.parametrize("reflected", [True, False], ids=["mirror", "rotation"])
def test_copies_have_the_copied_curve(reflected):
    point = column_like(160)
    point[2] += np.random.default_rng(4).uniform(-0.003, 0.003, 161)
    turn, _ = np.linalg.qr(np.random.default_rng(5).normal(size=(3, 3)))
    turn *= np.linalg.det(turn) * (-1 if reflected else 1)
    copy = np.concatenate([turn @ point[:3], turn @ point[3:6], point[6:]])
    (one, off), (other, off_copy) = (fitted_rows(each, 0.005, 1e-3) for each in (point, copy))
    np.testing.assert_allclose(off, off_copy, atol=1e-6)
    u = 0.4 * one.extent
    left, right = one.at(one.row, u, one.tip)[0], other.at(other.row, u, other.tip)[0]
    np.testing.assert_allclose(turn @ left, right, atol=1e-9)


def test_the_way_back_has_the_same_curve():
    point = wavy(160, noise=0.003)
    (one, _), (back, _) = fitted_rows(point, 0.004), fitted_rows(point[:, ::-1], 0.004)
    left = one.at(one.row, 0.3 * one.extent, one.tip)[0]
    right = back.at(back.row, 0.7 * back.extent, back.tip)[0]
    np.testing.assert_allclose(left, right[:, ::-1], atol=1e-9)


def test_runs_do_not_depend_on_each_other():
    first, second = wavy(90, noise=0.003), wavy(50, noise=0.003, seed=9)
    together, off = fitted_rows(np.concatenate([first, second], axis=1), 0.004, counts=np.array([90, 50]))
    alone, off_alone = fitted_rows(second, 0.004)
    np.testing.assert_allclose(off[90:], off_alone, atol=1e-6)
    left = together.at(np.arange(90, 140), 0.4 * together.extent[90:], together.tip)[0]
    np.testing.assert_allclose(left, alone.at(alone.row, 0.4 * alone.extent, alone.tip)[0], atol=1e-9)


def test_noise_bends_a_wide_curve_little():
    """Curvature through noise of 5 um in chords of 0.2 mm is that of the wave, 4 / 15^2, and a little more."""
    splines, off = fitted_rows(wavy(2000, noise=0.005), 0.006)
    assert off.max() <= 1
    _, slope, second = splines.at(splines.row, 0.5 * splines.extent, splines.tip)
    bend = length_of(*second) / np.square(length_of(*slope))
    assert np.quantile(bend, 0.99) < 2 * 4 / 15**2
    assert len(splines.begin) < 0.3 * len(splines)


def test_path_length_is_that_of_the_tip():
    """A polyline with noise of 5 um in chords of 0.02 mm is longer than the curve by a few percent."""
    point = wavy(1000, chord=0.02, noise=0.005)
    splines, off = fitted_rows(point, 0.006)
    assert off.max() <= 1
    polyline = length_of(*np.diff(point[:3], axis=1)).sum()
    shares = (np.arange(10) + 0.5) / 10
    _, slope, _ = splines.at(np.repeat(splines.row, 10), np.outer(splines.extent, shares).ravel(), splines.tip)
    travel = (length_of(*slope).reshape(-1, 10).mean(axis=1) * splines.extent).sum()
    assert splines.extent.sum() < 0.99 * polyline
    assert splines.extent.sum() == pytest.approx(travel, rel=1e-4)


def test_memory_grows_with_the_rows():
    def peak(rows):
        trajectory = trajectory_of(wave(rows, noise=0.002) * [0.02, 1, 1])
        segments = Segments.of(trajectory)
        tracemalloc.start()
        compress(trajectory, segments, np.full(len(trajectory), TIP), AXIS)
        most = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        return most

    few, many = peak(10_000), peak(20_000)
    assert many < 2.5 * few
