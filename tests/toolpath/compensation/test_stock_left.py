# SPDX-License-Identifier: LGPL-2.1-or-later
"""Material left and gouges: laws of balls on planes, dipped tools, and the sampled solids of all kinds of cutters."""

import math

import numpy as np
import pytest
from cutters import ALL, BALL, BULL_NOSE, TAPERED_BALL

from pkm_post.toolpath.compensation.contact import tip_from_contact
from pkm_post.toolpath.compensation.cutter import Cutter, CutterProfile
from pkm_post.toolpath.compensation.stock_left import stock_left
from pkm_post.toolpath.compensation.swept_volume import SweptVolume

ROUNDING = 1e-9
TOLERANCE = 1e-3
X, Y, Z = np.eye(3)


def upright(count):
    return np.tile(Z, (count, 1))


def zigzag(stepover, passes=5, length=40.0):
    """Level passes along x, one beside the other along y, in alternate directions."""
    ends = [(-length / 2, length / 2)[:: 1 if number % 2 == 0 else -1] for number in range(passes)]
    return np.array([(x, number * stepover, 0.0) for number, pair in enumerate(ends) for x in pair])


def plane(x, y):
    grid = np.stack(np.meshgrid(x, y, [0.0]), axis=-1).reshape(-1, 3)
    return grid, upright(len(grid))


@pytest.mark.parametrize("stepover", [0.5, 2.0, 6.0])
def test_ball_leaves_ridges_of_the_known_height(stepover):
    tips = zigzag(stepover)
    points, normals = plane(np.linspace(-10, 10, 9), np.linspace(0.0, 4 * stepover, 81))
    found = stock_left(tips, upright(len(tips)), BALL, points, normals, tolerance=TOLERANCE, reach=3.0)
    across = np.abs((points[:, 1] + stepover / 2) % stepover - stepover / 2)
    expected = 5.0 - np.sqrt(25.0 - across**2)
    assert np.all(found >= expected - TOLERANCE)
    assert np.all(found <= expected + TOLERANCE)
    assert found.max() == pytest.approx(5.0 - np.sqrt(25.0 - stepover**2 / 4), abs=TOLERANCE)


@pytest.mark.slow
@pytest.mark.parametrize("cutter", [BALL, BULL_NOSE, TAPERED_BALL, ALL["coned bottom"], ALL["flat"]])
def test_dipped_tool_gouges_as_deep_as_it_dips(cutter):
    dip = 0.05
    tips = np.array([[-30.0, 0, 5], [0, 0, -dip], [30, 0, 5]])
    points, normals = plane(np.linspace(-8, 8, 65), np.linspace(-8, 8, 65))
    found = stock_left(tips, upright(3), cutter, points, normals, tolerance=TOLERANCE)
    assert found.min() == pytest.approx(-dip, abs=TOLERANCE)


def test_flat_end_that_turns_on_the_spot_cuts_with_bottom_and_side():
    # It turns about its tip from -30 to 30 degrees. Over x it is lowest at the end, when its edge is over 5 cos 30.
    flat, turn, height = ALL["flat"], np.radians(30.0), 2.5
    axes = [[-np.sin(turn), 0, np.cos(turn)], [np.sin(turn), 0, np.cos(turn)]]
    x = np.array([-4.7, -3.0, 0.0, 3.0, 4.7])
    points, normals = plane(x, [0.0])
    found = stock_left([[0, 0, height]] * 2, axes, flat, points, normals, tolerance=1e-4, reach=6.0)
    bottom = height - np.abs(x) * np.tan(turn)
    side = height - 5.0 * np.sin(turn) + (np.abs(x) - 5.0 * np.cos(turn)) / np.tan(turn)
    assert found == pytest.approx(np.maximum(bottom, side), abs=1e-4)


@pytest.mark.slow
@pytest.mark.parametrize("gap", [0.1, -0.1], ids=["left", "gouge"])
@pytest.mark.parametrize("degrees", [30.0, 5.0, 2.0])
def test_line_that_meets_a_flank_at_a_slant_is_followed_to_it(degrees, gap):
    # The flank is at y = 5. Two degrees from it a step is a thirtieth of what is left of the way.
    slant = np.radians(degrees)
    tips = [[-20.0, 0.0, -5.0], [20.0, 0.0, -5.0]]
    normals = [[0.0, -np.sin(slant), np.cos(slant)]]
    found = stock_left(tips, upright(2), ALL["flat"], [[0.0, 5.0 + gap, 0.0]], normals, reach=10.0, tolerance=TOLERANCE)
    assert found * np.sin(slant) == pytest.approx([gap], abs=TOLERANCE)


def first_entry(profile, tips, axes, point, normal, reach):
    """The least way along the normal to the cutter in any of the poses, by steps and then by halving."""

    def distance(way):
        away = point + way[..., None] * normal - tips[:, None]
        level = np.einsum("pwj,pj->pw", away, axes)
        return profile.distance(np.linalg.norm(away - level[..., None] * axes[:, None], axis=2), level)

    ways = np.broadcast_to(np.linspace(-3.0, reach, 200), (len(tips), 200))
    inside = distance(ways) < 0
    enters = inside.any(axis=1)
    first = np.argmax(inside, axis=1)[enters]
    assert np.all(first > 0)
    tips, axes = tips[enters], axes[enters]
    low, high = ways[0, first - 1][:, None], ways[0, first][:, None]
    for _ in range(30):
        middle = (low + high) / 2
        hit = distance(middle) < 0
        low, high = np.where(hit, low, middle), np.where(hit, middle, high)
    return np.min(high, initial=np.inf)


@pytest.mark.slow
@pytest.mark.parametrize("cutter", ALL.values(), ids=ALL.keys())
def test_value_is_the_first_entry_into_any_pose(cutter):
    rng = np.random.default_rng(7)
    tips, axes = (
        rng.uniform(-1.0, 1.0, (3, 3)) + [0, 0, 0.5],
        np.column_stack([rng.normal(0.0, 0.2, (3, 2)), np.ones(3)]),
    )
    axes /= np.linalg.norm(axes, axis=1)[:, None]
    share = np.linspace(0.0, 1.0, 401)[:, None]
    path = np.vstack([a + share * (b - a) for a, b in zip(tips[:-1], tips[1:], strict=True)])
    turned = np.vstack([a + share * (b - a) for a, b in zip(axes[:-1], axes[1:], strict=True)])
    turned /= np.linalg.norm(turned, axis=1)[:, None]
    points = np.column_stack([rng.uniform(-1.5, 1.5, (12, 2)), np.zeros(12)])
    normals = np.column_stack([rng.normal(0.0, 0.1, (12, 2)), np.ones(12)])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    found = stock_left(tips, axes, cutter, points, normals, tolerance=1e-4, reach=5.0)
    profile = CutterProfile.of(cutter, 30.0)
    for point, normal, left in zip(points, normals, found, strict=True):
        assert left == pytest.approx(first_entry(profile, path, turned, point, normal, 5.0), abs=5e-4)


@pytest.mark.parametrize("cutter", ALL.values(), ids=ALL.keys())
def test_contacts_are_neither_cut_into_nor_left(cutter):
    # A ball-shaped hill of radius 60, cut by rows of contacts along x, with normals that the corner can touch.
    lean = min(max(cutter.corner_start + 0.1, 0.3), cutter.corner_end - 0.1)
    x = np.linspace(-4.0, 4.0, 81)
    normals = np.column_stack([np.sin(x / 60.0), np.zeros(81), np.cos(x / 60.0)])
    points = 60.0 * normals
    axes = math.cos(lean) * normals + math.sin(lean) * np.cross(Y, normals)
    tips, _ = tip_from_contact(points, normals, axes, cutter)
    found = stock_left(tips, axes, cutter, points, normals, tolerance=TOLERANCE)
    assert np.all(np.abs(found) <= TOLERANCE)


def test_cutter_that_stays_away_leaves_more_than_can_be_measured():
    points, normals = plane([0.0, 30.0], [0.0])
    found = stock_left([[0.0, 0.0, 0.5]], [Z], BALL, points, normals, reach=1.0)
    assert found == pytest.approx([0.5, np.inf])


def test_shank_cuts_as_well_up_to_the_height_of_the_tool():
    tall, short = (Cutter.apt(10.0, 5.0, h=height) for height in (40.0, 20.0))
    wall, normals = [[4.9, 0.0, 30.0]], [-X]
    assert stock_left([np.zeros(3)], [Z], tall, wall, normals) == pytest.approx([-0.1], abs=TOLERANCE)
    assert not np.isfinite(stock_left([np.zeros(3)], [Z], short, wall, normals)).any()


def test_turning_and_shifting_everything_changes_nothing():
    rng = np.random.default_rng(3)
    tips, axes = rng.uniform(-5, 5, (20, 3)) * [1, 1, 0.05], rng.normal(0, 0.2, (20, 3)) + Z
    points, normals = plane(np.linspace(-4, 4, 9), np.linspace(-4, 4, 9))
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    turn *= np.linalg.det(turn)
    still = stock_left(tips, axes, BULL_NOSE, points, normals, tolerance=TOLERANCE)
    moved = stock_left(
        tips @ turn.T + 100.0, axes @ turn.T, BULL_NOSE, points @ turn.T + 100.0, normals @ turn.T, tolerance=TOLERANCE
    )
    assert moved == pytest.approx(still, abs=TOLERANCE)


def test_progress_is_reported_and_may_stop_the_work():
    class StopError(Exception):
        pass

    def stop(done):
        raise StopError

    points, _ = plane(np.linspace(-4, 4, 9), np.linspace(-4, 4, 9))
    swept, reported = SweptVolume.of(np.zeros((1, 3)), Z[None], BALL, 1.0, 10.0), []
    swept.distances(points, TOLERANCE, reported.append)
    assert reported[0] > 0.0
    assert max(reported) == 1.0
    with pytest.raises(StopError):
        swept.distances(points, TOLERANCE, stop)


def test_no_points_give_nothing():
    assert stock_left([np.zeros(3)], [Z], BALL, np.zeros((0, 3)), np.zeros((0, 3))).shape == (0,)


@pytest.mark.parametrize(
    ("tips", "points", "tolerance", "reported"),
    [
        (np.zeros((1, 2)), np.zeros((1, 3)), 1e-3, r"tips and axes \(N, 3\), got \(1, 2\) and \(1, 3\)"),
        (np.zeros((1, 3)), np.zeros((2, 3)), 1e-3, r"points and normals \(N, 3\), got \(2, 3\) and \(1, 3\)"),
        (np.zeros((1, 3)), np.full((1, 3), np.nan), 1e-3, "expected finite points"),
        (np.zeros((1, 3)), np.zeros((1, 3)), 0.0, "expected tips, tolerance and reach, got 1, 0.0"),
    ],
)
def test_what_makes_no_sense_is_the_callers_fault(tips, points, tolerance, reported):
    with pytest.raises(ValueError, match=reported):
        stock_left(tips, [Z], BALL, points, [Z], tolerance=tolerance)
