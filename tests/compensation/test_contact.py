# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tool tips from contact points: worked numbers, the paper's special case, laws, and refusals."""

import numpy as np
import pytest

from pkm_post.compensation import Cutter, tip_from_contact
from pkm_post.model import Place

MICRON = 1e-3
ROUNDING = 1e-9
FOUR_DECIMALS = 5.1e-5

BALL = Cutter(5.0, 0.0, 5.0)
FLAT = Cutter(0.0, 5.0, 0.0)
BULL_NOSE = Cutter(4.0, 6.0, 4.0)
CUTTERS = pytest.mark.parametrize("cutter", [BALL, FLAT, BULL_NOSE], ids=["ball", "flat", "bull nose"])

X, Y, Z = np.eye(3)
HALF = np.sqrt(0.5)


def tips(points, normals, axes, cutter):
    found, diagnostics = tip_from_contact(points, normals, axes, cutter)
    assert diagnostics == ()
    return found


def random_contacts(count, seed):
    """Contact points, and normals and axes at least 1 degree from parallel, with the corner in touch."""
    rng = np.random.default_rng(seed)
    points = rng.uniform(-100.0, 100.0, (count, 3))
    k = rng.normal(size=(count, 3))
    k /= np.linalg.norm(k, axis=1, keepdims=True)
    across = np.cross(k, rng.normal(size=(count, 3)))
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    angle = rng.uniform(np.radians(1.0), np.pi / 2, (count, 1))
    return points, np.cos(angle) * k + np.sin(angle) * across, k


def random_rotation(seed):
    q, r = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    q = q * np.sign(np.diag(r))
    return q * np.linalg.det(q)


def cutter_surface(cutter, height, turn_steps, arc_steps):
    """Points on bottom, corner and side of a cutter with its tip at the origin and its axis along z."""
    r, e, f = cutter.corner_radius, cutter.radial_offset, cutter.axial_offset
    arc = np.linspace(0.0, np.pi / 2, arc_steps)
    radius = np.concatenate([np.linspace(0.0, e, 20), e + r * np.sin(arc), np.full(20, e + r)])
    level = np.concatenate([np.zeros(20), f - r * np.cos(arc), np.linspace(f, height, 20)])
    turn = np.linspace(0.0, 2 * np.pi, turn_steps, endpoint=False)[:, None]
    return np.stack(np.broadcast_arrays(radius * np.cos(turn), radius * np.sin(turn), level), axis=-1).reshape(-1, 3)


def frame_with_z(axis):
    side = np.cross(axis, X if abs(axis[0]) < 0.9 else Y)
    side /= np.linalg.norm(side)
    return np.column_stack([side, np.cross(axis, side), axis])


# The tips below were worked by hand from tip = P + r n + e m - f k and given to four decimals, P = 0.
TILTED = np.array([0.0, -np.sin(np.radians(20.0)), np.cos(np.radians(20.0))])
WORKED = {
    "flat D10 against a wall": (FLAT, X, Z, (5.0, 0.0, 0.0)),
    "ball D10 on a slope": (BALL, (Y + Z) * HALF, Z, (0.0, 3.5355, -1.4645)),
    "bull nose D20 r4 on a slope": (BULL_NOSE, (X + Z) * HALF, Z, (8.8284, 0.0, -1.1716)),
    "bull nose D20 r4 leaning 30 degrees on a plane": (
        BULL_NOSE, Z, np.array([0.5, 0.0, np.sqrt(0.75)]), (-7.1962, 0.0, 3.5359),
    ),
    "bull nose D20 r4 on a slope, axis turned 20 degrees about x": (
        BULL_NOSE, (X + Z) * HALF, TILTED, (8.5056, 3.1927, -0.2662),
    ),
}  # fmt: skip


@pytest.mark.parametrize(("cutter", "normal", "axis", "tip"), WORKED.values(), ids=WORKED.keys())
def test_worked_numbers(cutter, normal, axis, tip):
    assert tips([[0.0, 0.0, 0.0]], [normal], [axis], cutter)[0] == pytest.approx(tip, abs=FOUR_DECIMALS)


@CUTTERS
def test_upright_tool_is_equation_7_of_the_paper(cutter):
    points, normals, _ = random_contacts(200, seed=1)
    normals[:, 2] = np.abs(normals[:, 2])
    corner, radius = cutter.corner_radius, cutter.corner_radius + cutter.radial_offset
    level = np.column_stack([normals[:, :2], np.zeros(len(normals))])
    level /= np.linalg.norm(level, axis=1, keepdims=True)
    tool_centre = points + corner * normals + (radius - corner) * level
    found = tips(points, normals, np.broadcast_to(Z, points.shape), cutter)
    assert found + corner * Z == pytest.approx(tool_centre, abs=ROUNDING)


def test_direction_of_the_paper_gouges_under_a_leaning_tool_where_ours_does_not():
    # Eq. (7) takes m level; with the axis turned 20 degrees about x the cutter then cuts 0.2413 mm into the plane.
    normal = (X + Z) * HALF
    surface = cutter_surface(BULL_NOSE, 30.0, 720, 181) @ frame_with_z(TILTED).T
    level_tip = 4.0 * normal + 6.0 * X - 4.0 * TILTED
    own_tip = tips([[0.0, 0.0, 0.0]], [normal], [TILTED], BULL_NOSE)[0]
    assert np.min((level_tip + surface) @ normal) == pytest.approx(-0.2413, abs=0.2 * MICRON)
    assert np.min((own_tip + surface) @ normal) == pytest.approx(0.0, abs=0.2 * MICRON)


@CUTTERS
def test_cutter_touches_the_tangent_plane_and_does_not_cut_it(cutter):
    turn_steps, arc_steps = 1440, 361
    local = cutter_surface(cutter, 30.0, turn_steps, arc_steps)
    # A sampled arc of radius R misses its lowest point by at most R (step / 2)^2 / 2.
    widest = cutter.corner_radius + cutter.radial_offset
    half_steps = (np.pi / turn_steps) ** 2, (np.pi / 4 / (arc_steps - 1)) ** 2
    bound = (widest * half_steps[0] + cutter.corner_radius * half_steps[1]) / 2.0
    points, normals, axes = random_contacts(25, seed=2)
    for point, normal, axis, tip in zip(points, normals, axes, tips(points, normals, axes, cutter), strict=True):
        gap = np.min((tip + local @ frame_with_z(axis).T - point) @ normal)
        assert -ROUNDING <= gap <= bound + ROUNDING
    assert bound < 0.1 * MICRON


def test_ball_does_not_ask_to_which_side_it_lies():
    points, normals, axes = random_contacts(50, seed=3)
    assert tips(points, normals, axes, BALL) == pytest.approx(points + 5.0 * (normals - axes), abs=ROUNDING)
    assert tips([[1.0, 2.0, 3.0]], [Z], [Z], BALL)[0] == pytest.approx([1.0, 2.0, 3.0])


@CUTTERS
def test_turning_and_shifting_everything_turns_and_shifts_the_tips(cutter):
    points, normals, axes = random_contacts(100, seed=4)
    turn, shift = random_rotation(5), np.array([12.0, -7.0, 150.0])
    moved = tips(points @ turn.T + shift, normals @ turn.T, axes @ turn.T, cutter)
    assert moved == pytest.approx(tips(points, normals, axes, cutter) @ turn.T + shift, abs=ROUNDING)


@CUTTERS
def test_mirroring_everything_mirrors_the_tips(cutter):
    points, normals, axes = random_contacts(100, seed=6)
    mirror = np.diag([1.0, -1.0, 1.0])
    mirrored = tips(points @ mirror, normals @ mirror, axes @ mirror, cutter)
    assert mirrored == pytest.approx(tips(points, normals, axes, cutter) @ mirror, abs=ROUNDING)


def test_length_of_normals_and_axes_does_not_matter():
    points, normals, axes = random_contacts(20, seed=7)
    assert tips(points, 3.0 * normals, 0.2 * axes, BULL_NOSE) == pytest.approx(
        tips(points, normals, axes, BULL_NOSE), abs=ROUNDING
    )


def test_arguments_stay_as_they_were():
    arrays = [*random_contacts(5, seed=8)]
    arrays[1] *= 2.0
    copies = [array.copy() for array in arrays]
    tips(*arrays, BULL_NOSE)
    assert all(np.array_equal(array, copy) for array, copy in zip(arrays, copies, strict=True))


def test_on_a_flat_top_the_tool_stays_on_the_side_it_came_from():
    path = np.outer([0.0, 1.0, 2.0, 3.0], Y)
    normals = np.array([(X + Z) * HALF, Z, Z, Z])
    found = tips(path, normals, np.broadcast_to(Z, path.shape), BULL_NOSE)
    assert found[1:] == pytest.approx(path[1:] + 6.0 * X, abs=ROUNDING)


def test_carried_direction_is_turned_into_the_plane_across_a_leaning_axis():
    lean = np.array([np.sin(0.3), 0.0, np.cos(0.3)])
    found = tips(np.outer([0.0, 1.0], Y), [(X + Z) * HALF, lean], [Z, lean], FLAT)
    assert found[1] == pytest.approx(Y + 5.0 * np.array([np.cos(0.3), 0.0, -np.sin(0.3)]), abs=ROUNDING)


def test_path_that_begins_on_a_flat_top_lies_along_its_travel():
    path = np.array([[0.0, 0.0, 0.0], [0.0, 2.0, 0.0], [2.0, 2.0, 0.0]])
    upright = np.broadcast_to(Z, path.shape)
    assert tips(path, upright, upright, FLAT) == pytest.approx(path + 5.0 * Y, abs=ROUNDING)


def test_carried_direction_along_the_new_axis_gives_way_to_the_travel():
    found = tips([[0.0, 0.0, 0.0], [0.0, 1.0, 0.0]], [(X + Z) * HALF, X], [Z, X], FLAT)
    assert found[1] == pytest.approx([0.0, 6.0, 0.0], abs=ROUNDING)


def refusal(points, normals, axes, cutter=BULL_NOSE):
    found, diagnostics = tip_from_contact(points, normals, axes, cutter, Place("wall.ncl", "Finish"))
    assert found is None
    return [(item.code, item.place.line) for item in diagnostics]


def test_standing_on_a_flat_top_names_no_side():
    assert refusal([[0.0, 0.0, 0.0]], [Z], [Z]) == [("N103", 1)]


def test_drilling_along_the_axis_names_no_side():
    assert refusal([[0.0, 0.0, 2.0], [0.0, 0.0, 1.0]], [Z, Z], [Z, Z]) == [("N103", 1), ("N103", 2)]


def test_undercut_is_refused_row_by_row():
    tilt = np.radians(0.01)
    overhang = np.array([np.cos(tilt), 0.0, -np.sin(tilt)])
    assert refusal(np.zeros((3, 3)), [X, overhang, -Z], [Z, Z, Z]) == [("N102", 2), ("N102", 3)]


def test_wall_with_a_normal_of_six_decimals_is_no_undercut():
    assert tips([[0.0, 0.0, 0.0]], [[1.0, 0.0, -5e-7]], [Z], FLAT)[0] == pytest.approx([5.0, 0.0, 0.0], abs=MICRON)


@pytest.mark.parametrize("bad", [np.zeros(3), np.array([np.nan, 0.0, 1.0]), np.array([np.inf, 0.0, 1.0])])
def test_rows_without_direction_are_refused(bad):
    assert refusal(np.zeros((2, 3)), [X, bad], [Z, Z]) == [("N101", 2)]
    assert refusal(np.zeros((2, 3)), [X, X], [bad, Z]) == [("N101", 1)]


def test_point_that_is_no_number_is_refused_and_shown():
    found, diagnostics = tip_from_contact([[np.inf, 0.0, 0.0]], [X], [Z], BULL_NOSE, Place("wall.ncl", "Finish"))
    assert found is None
    assert str(diagnostics[0]).startswith("wall.ncl: Finish: line 1: error N101: ")
    assert "inf 0 0 1 0 0 0 0 1" in str(diagnostics[0])


@pytest.mark.parametrize("shape", [(3,), (2, 2), (2, 3)])
def test_wrong_shapes_are_the_callers_fault(shape):
    with pytest.raises(ValueError, match=r"expected three arrays \(N, 3\), got"):
        tip_from_contact(np.zeros(shape), np.ones((4, 3)), np.ones((4, 3)), BALL)


def test_no_contacts_give_no_tips():
    assert tips(np.zeros((0, 3)), np.zeros((0, 3)), np.zeros((0, 3)), BULL_NOSE).shape == (0, 3)
