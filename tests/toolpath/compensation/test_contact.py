# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tool tips from contact points: worked numbers, the paper's special case, laws, and refusals."""

import dataclasses

import numpy as np
import pytest
from cutters import ALL, BALL, BULL_NOSE, DRILL, FLAT, LENS, TAPERED, cloud, frame_with_z
from programs import program

from pkm_post.model import Event, EventKind, Kind, Place
from pkm_post.toolpath.compensation.compensate import compensate_tips
from pkm_post.toolpath.compensation.contact import radial_directions, size_changes, tip_from_contact, tip_offsets
from pkm_post.toolpath.compensation.cutter import Cutter

MICRON = 1e-3
ROUNDING = 1e-9
FOUR_DECIMALS = 5.1e-5
CUTTERS = pytest.mark.parametrize("cutter", ALL.values(), ids=ALL.keys())
UPRIGHT_SIDES = pytest.mark.parametrize("cutter", [BALL, FLAT, BULL_NOSE], ids=["ball", "flat", "bull nose"])

X, Y, Z = np.eye(3)
HALF = np.sqrt(0.5)


def tips(points, normals, axes, cutter, reported=()):
    found, diagnostics = tip_from_contact(points, normals, axes, cutter)
    assert tuple(item.code for item in diagnostics) == reported
    return found


def random_contacts(count, seed, cutter=BULL_NOSE):
    """Contact points, normals and axes with the corner in touch, and normal and axis 1.2 degrees or more apart."""
    rng = np.random.default_rng(seed)
    points = rng.uniform(-100.0, 100.0, (count, 3))
    k = rng.normal(size=(count, 3))
    k /= np.linalg.norm(k, axis=1, keepdims=True)
    across = np.cross(k, rng.normal(size=(count, 3)))
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    angle = rng.uniform(max(cutter.corner_start, np.radians(1.2)), cutter.corner_end, (count, 1))
    return points, np.cos(angle) * k + np.sin(angle) * across, k


def random_rotation(seed):
    q, r = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    q = q * np.sign(np.diag(r))
    return q * np.linalg.det(q)


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


@UPRIGHT_SIDES
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
    surface = cloud(BULL_NOSE, 30.0, 720, 181) @ frame_with_z(TILTED).T
    level_tip = 4.0 * normal + 6.0 * X - 4.0 * TILTED
    own_tip = tips([[0.0, 0.0, 0.0]], [normal], [TILTED], BULL_NOSE)[0]
    assert np.min((level_tip + surface) @ normal) == pytest.approx(-0.2413, abs=0.2 * MICRON)
    assert np.min((own_tip + surface) @ normal) == pytest.approx(0.0, abs=0.2 * MICRON)


@pytest.mark.slow
@CUTTERS
def test_cutter_touches_the_tangent_plane_and_does_not_cut_it(cutter):
    turn_steps, arc_steps = 1440, 361
    local = cloud(cutter, min(30.0, cutter.height), turn_steps, arc_steps)
    # A sampled arc of radius R misses its lowest point by at most R (step / 2)^2 / 2.
    widest = np.max(np.hypot(local[:, 0], local[:, 1]))
    arc_step = (cutter.corner_end - cutter.corner_start) / (arc_steps - 1)
    bound = (widest * (np.pi / turn_steps) ** 2 + cutter.corner_radius * (arc_step / 2) ** 2) / 2.0
    points, normals, axes = random_contacts(25, 2, cutter)
    for point, normal, axis, tip in zip(points, normals, axes, tips(points, normals, axes, cutter), strict=True):
        gap = np.min((tip + local @ frame_with_z(axis).T - point) @ normal)
        assert -ROUNDING <= gap <= bound + ROUNDING
    assert bound < 0.2 * MICRON


def test_ball_does_not_ask_to_which_side_it_lies():
    points, normals, axes = random_contacts(50, seed=3)
    assert tips(points, normals, axes, BALL) == pytest.approx(points + 5.0 * (normals - axes), abs=ROUNDING)
    assert tips([[1.0, 2.0, 3.0]], [Z], [Z], BALL)[0] == pytest.approx([1.0, 2.0, 3.0])


@CUTTERS
def test_turning_and_shifting_everything_turns_and_shifts_the_tips(cutter):
    points, normals, axes = random_contacts(100, 4, cutter)
    turn, shift = random_rotation(5), np.array([12.0, -7.0, 150.0])
    moved = tips(points @ turn.T + shift, normals @ turn.T, axes @ turn.T, cutter)
    assert moved == pytest.approx(tips(points, normals, axes, cutter) @ turn.T + shift, abs=ROUNDING)


@CUTTERS
def test_mirroring_everything_mirrors_the_tips(cutter):
    points, normals, axes = random_contacts(100, 6, cutter)
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
    found = tips(np.outer([0.0, 1.0], Y), [(X + Z) * HALF, lean], [Z, lean], FLAT, reported=("N106",))
    assert found[1] == pytest.approx(Y + 5.0 * np.array([np.cos(0.3), 0.0, -np.sin(0.3)]), abs=ROUNDING)


def test_path_that_begins_on_a_flat_top_lies_along_its_travel():
    path = np.array([[0.0, 0.0, 0.0], [0.0, 2.0, 0.0], [2.0, 2.0, 0.0]])
    upright = np.broadcast_to(Z, path.shape)
    assert tips(path, upright, upright, FLAT) == pytest.approx(path + 5.0 * Y, abs=ROUNDING)


def test_carried_direction_along_the_new_axis_gives_way_to_the_travel():
    found = tips([[0.0, 0.0, 0.0], [0.0, 1.0, 0.0]], [(X + Z) * HALF, X], [Z, X], FLAT, reported=("N106",))
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


def test_range_of_the_corner_is_reported_on_both_sides():
    def leaning(cosines):
        return [np.sqrt(1.0 - c * c) * X + c * Z for c in cosines]

    flattest, steepest = np.cos(DRILL.corner_start), np.cos(TAPERED.corner_end)
    assert refusal(np.zeros((2, 3)), leaning([flattest, flattest + 2e-6]), [Z, Z], DRILL) == [("N104", 2)]
    assert refusal(np.zeros((2, 3)), leaning([steepest, steepest - 2e-6]), [Z, Z], TAPERED) == [("N102", 2)]
    assert refusal(np.zeros((1, 3)), [Z], [Z], LENS) == [("N104", 1)]


def test_many_faulty_rows_are_counted():
    _, diagnostics = tip_from_contact(np.zeros((500, 3)), np.tile(-Z, (500, 1)), np.tile(Z, (500, 1)), BALL)
    assert len(diagnostics) == 50
    assert diagnostics[-1].found == "0 0 -1 0 0 1, and 450 rows more"


def test_tip_that_jumps_over_a_ridge_is_reported_with_its_size():
    sine = 0.01
    normals = [[-sine, 0.0, np.sqrt(1 - sine**2)], [sine, 0.0, np.sqrt(1 - sine**2)]]
    _, diagnostics = tip_from_contact([[-0.1, 0.0, 0.0], [0.1, 0.0, 0.0]], normals, [Z, Z], BULL_NOSE)
    assert [(item.code, item.found, item.place.line) for item in diagnostics] == [
        ("N105", "2 of 2 rows, this the first", 1),
        ("N106", "by 12 mm", 2),  # 2 e
    ]


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
    with pytest.raises(ValueError, match=r"expected 3 arrays \(N, 3\), got"):
        tip_from_contact(np.zeros(shape), np.ones((4, 3)), np.ones((4, 3)), BALL)


def test_no_contacts_give_no_tips():
    assert tips(np.zeros((0, 3)), np.zeros((0, 3)), np.zeros((0, 3)), BULL_NOSE).shape == (0, 3)


NAN = np.full(3, np.nan)
SLOPE = (X + Z) * np.sqrt(0.5)
SMALLER_BALL = Cutter(4.0, 0.0, 4.0)


def contacts(count, seed):
    rng = np.random.default_rng(seed)
    azimuth, angle = rng.uniform(0, 2 * np.pi, count), rng.uniform(0.1, 1.3, count)
    normals = np.column_stack([np.sin(angle) * np.cos(azimuth), np.sin(angle) * np.sin(azimuth), np.cos(angle)])
    return rng.uniform(-50, 50, (count, 3)), normals, np.tile(Z, (count, 1))


def shifts(normals, axes, nominal, actual, points=None):
    columns = np.zeros(np.shape(normals)) if points is None else points, np.array(normals), np.array(axes)
    place_of = [Place("part.h", "LN", line) for line in (1, 2)].__getitem__
    return tip_offsets(*columns, size_changes(nominal, actual), (nominal, actual), place_of)


@pytest.mark.parametrize("actual", [BALL, FLAT, BULL_NOSE, TAPERED])
@pytest.mark.parametrize("nominal", [BALL, FLAT, BULL_NOSE, TAPERED])
def test_shift_is_the_difference_of_the_tips_at_one_contact(nominal, actual):
    points, normals, axes = contacts(100, seed=1)
    before, after = (tip_from_contact(points, normals, axes, cutter)[0] for cutter in (nominal, actual))
    shift, reported = shifts(normals, axes, nominal, actual, points)
    assert reported == ()
    assert before + shift == pytest.approx(after, abs=ROUNDING)


def test_worn_ball_comes_nearer_along_normal_and_axis():
    # dr (n - k) with dr = -1, n = (1, 0, 1) / sqrt 2
    shift, _ = shifts([SLOPE], [Z], BALL, SMALLER_BALL)
    assert shift[0] == pytest.approx([-np.sqrt(0.5), 0.0, 1.0 - np.sqrt(0.5)], abs=ROUNDING)


def test_corner_of_both_cutters_has_to_touch():
    for pair in ((BALL, TAPERED), (TAPERED, BALL)):
        found, reported = shifts([X], [Z], *pair)
        assert found is None
        assert [(item.code, item.place) for item in reported] == [("N102", Place("part.h", "LN", 1))]


def test_points_give_the_direction_where_normal_and_axis_are_parallel():
    path = np.outer([0.0, 1.0], Y)
    wider = Cutter(0.0, 6.0, 0.0)
    assert shifts([Z, Z], [Z, Z], FLAT, wider, path)[0] == pytest.approx(np.array([Y, Y]), abs=ROUNDING)
    assert [item.code for item in shifts([Z, Z], [Z, Z], FLAT, wider)[1]] == ["N103", "N103"]


RAPID, LINE, ARC = Kind.RAPID, Kind.LINE, Kind.ARC


def passes():
    """Two passes along slopes that face each other, with approach, retract and rapids between, which have no normal."""
    other = SLOPE * [-1.0, 1.0, 1.0]
    normal = [NAN, NAN, SLOPE, SLOPE, NAN, NAN, NAN, NAN, other, NAN]
    kind = [RAPID, LINE, LINE, LINE, LINE, RAPID, RAPID, LINE, LINE, RAPID]
    position = np.cumsum(np.random.default_rng(3).normal(size=(10, 3)), axis=0)
    return dataclasses.replace(program(position, kind=np.array(kind)), normal=normal)


def test_rows_without_a_normal_keep_their_distance_to_the_contact_they_leave_or_approach():
    before = passes()
    after, reported = compensate_tips(before, BALL, SMALLER_BALL)
    assert reported == ()
    first, second = (shifts([n], [Z], BALL, SMALLER_BALL)[0][0] for n in (before.normal[2], before.normal[8]))
    # The first rapid after a pass retracts; what follows it approaches the next pass.
    assert after.position - before.position == pytest.approx(np.array([first] * 6 + [second] * 4), abs=ROUNDING)


def test_all_but_the_tips_stays():
    before = passes()
    after, _ = compensate_tips(before, BALL, SMALLER_BALL)
    assert after.events == before.events
    for name in ("kind", "tool_axis", "feed", "line", "normal"):
        assert np.array_equal(getattr(after, name), getattr(before, name), equal_nan=True)


def test_same_cutter_moves_nothing():
    before = passes()
    assert np.array_equal(compensate_tips(before, BULL_NOSE, BULL_NOSE)[0].position, before.position)


def test_there_and_back_again():
    before = passes()
    there, _ = compensate_tips(before, BALL, BULL_NOSE)
    back, _ = compensate_tips(there, BULL_NOSE, BALL)
    assert back.position == pytest.approx(before.position, abs=ROUNDING)


def arc_program(normals):
    centre, turn = np.full((3, 3), np.nan), np.full((3, 3), np.nan)
    centre[2], turn[2] = [5.0, 0.0, 0.0], Z
    made = program([[0, 0, 5], [0, 0, 0], [10, 0, 0]], kind=np.array([RAPID, LINE, ARC]), centre=centre, turn=turn)
    return dataclasses.replace(made, normal=normals)


def test_arc_on_a_plane_is_shifted_as_it_is_and_one_on_a_wall_is_refused():
    flat = arc_program([NAN, SLOPE, SLOPE])
    moved, _ = compensate_tips(flat, BALL, SMALLER_BALL)
    shift = moved.position[1] - flat.position[1]
    assert moved.arc_centre[2] == pytest.approx(flat.arc_centre[2] + shift, abs=ROUNDING)
    found, reported = compensate_tips(arc_program([NAN, -X + Z, X + Z]), BALL, SMALLER_BALL)
    assert found is None
    assert [(item.code, item.place, item.found) for item in reported] == [
        ("N107", Place("part.FCStd", "Finish", 3), "its ends would move 1.414 mm apart")
    ]


def test_faults_name_the_row_of_the_program():
    made = dataclasses.replace(passes(), normal=[NAN] * 8 + [-Z, NAN])
    found, reported = compensate_tips(made, BALL, SMALLER_BALL)
    assert found is None
    assert [(item.code, item.place.line) for item in reported] == [("N102", 9)]


def test_program_without_normals_is_refused():
    found, reported = compensate_tips(program(np.zeros((2, 3))), BALL, SMALLER_BALL)
    assert found is None
    assert [item.code for item in reported] == ["N108"]


def test_rows_of_other_tools_stay():
    events = (Event(0, EventKind.TOOL_CHANGE, 1), Event(5, EventKind.TOOL_CHANGE, 2))
    before = dataclasses.replace(passes(), events=events)
    with pytest.raises(ValueError, match="expected the number of a tool"):
        compensate_tips(before, BALL, SMALLER_BALL)
    after, _ = compensate_tips(before, BALL, SMALLER_BALL, tool=2)
    assert np.array_equal(after.position[:5], before.position[:5])
    assert np.all(np.any(after.position[5:] != before.position[5:], axis=1))


TENTH_MICRON = 1e-4
E = 6.0


def leaning(sine, azimuth):
    sine, azimuth = np.broadcast_arrays(sine, azimuth)
    return np.column_stack([sine * np.cos(azimuth), sine * np.sin(azimuth), np.sqrt(1.0 - sine**2)])


def upright(count):
    return np.tile(Z, (count, 1))


def test_direction_is_where_the_normal_leans():
    azimuth = np.linspace(0.0, 6.0, 50)
    m, near = radial_directions(np.zeros((50, 3)), leaning(0.5, azimuth), upright(50), E)
    assert np.allclose(m, leaning(1.0, azimuth), rtol=0, atol=1e-12)
    assert not near.any()


def test_noise_of_rounded_normals_is_averaged_out():
    # Normals 0.06 degrees from the axis and 3e-5 off, which is what four decimals do: the azimuth is off by 2 degrees.
    count, sine = 400, 1e-3
    true = leaning(1.0, np.linspace(0.0, 0.5, count))
    rounded = leaning(sine, np.linspace(0.0, 0.5, count)) + np.random.default_rng(2).normal(0.0, 3e-5, (count, 3))
    m, near = radial_directions(
        np.zeros((count, 3)), rounded / np.linalg.norm(rounded, axis=1)[:, None], upright(count), E
    )
    raw = rounded[:, :2] / np.linalg.norm(rounded[:, :2], axis=1)[:, None]
    assert near.all()
    error, raw_error = np.linalg.norm(m - true, axis=1), np.linalg.norm(raw - true[:, :2], axis=1)
    assert np.sqrt(np.mean(error**2)) < 0.5 * np.sqrt(np.mean(raw_error**2))


def test_averaging_never_lets_the_cutter_into_the_surface_by_more_than_a_tenth_of_a_micron():
    rng = np.random.default_rng(1)
    normals = leaning(10 ** rng.uniform(-5.5, -1.0, 3000), rng.uniform(0.0, 2 * np.pi, 3000))
    m, near = radial_directions(np.zeros((3000, 3)), normals, upright(3000), E)
    exact = normals - normals[:, 2:] * Z
    exact /= np.linalg.norm(exact, axis=1)[:, None]
    into_surface = E * np.einsum("nj,nj->n", exact - m, normals)
    assert np.all(into_surface <= TENTH_MICRON * (1 + 1e-9))
    assert np.max(into_surface) > 0.5 * TENTH_MICRON
    assert np.array_equal(m[~near], exact[~near])


def test_only_parallel_rows_are_carried():
    normals = leaning(np.array([0.5, 0.0, 1e-7, 0.5]), np.array([0.0, 0.0, 2.0, 1.0]))
    m, near = radial_directions(np.outer(np.arange(4.0), Y), normals, upright(4), E)
    assert np.allclose(m[:3], X, rtol=0, atol=1e-12)
    assert np.allclose(m[3], [np.cos(1.0), np.sin(1.0), 0.0], rtol=0, atol=1e-12)
    assert not near.any()
