# SPDX-License-Identifier: LGPL-2.1-or-later
"""Laws of mirrors and rotations, and the rules for what a mirror does to arcs and spindles."""

import dataclasses

import numpy as np
import pytest
from machines import rotation_about
from programs import cone, program, square_with_arc

from pkm_post.geometry import arc_points, arc_sweep, norm
from pkm_post.geometry.curves import arc_length
from pkm_post.model import Event, EventKind, Kind
from pkm_post.model.program import MOTION_COLUMNS, OPTIONAL_COLUMNS
from pkm_post.toolpath.symmetry.transform import concatenate, mirror, mirrors, rotation, transform

ROUNDING = 1e-12
VECTORS = ("position", "tool_axis", "arc_centre", "arc_axis")
XZ_MIRROR = mirror([0, 0, 0], [0, 1, 0])
YZ_MIRROR = mirror([0, 0, 0], [1, 0, 0])
MATRICES = {
    "turn": rotation([10, -20, 5], [1, 2, 3], 0.7),
    "mirror": mirror([10, -20, 5], [3, -1, 2]),
    "mirror and turn": rotation([0, 5, 0], [0, 1, 1], -2.0) @ mirror([1, 2, 3], [1, 1, 0]),
}


def moved(made, matrix):
    result, faults = transform(made, matrix)
    assert not faults
    return result


def assert_same(left, right):
    for name in VECTORS:
        np.testing.assert_allclose(getattr(left, name), getattr(right, name), atol=1e-10, err_msg=name)


def arcs_of(made):
    """Start, end, centre and axis of the arcs, (n, 3) each."""
    rows = np.flatnonzero(made.kind == Kind.ARC)
    return made.position[rows - 1], made.position[rows], made.arc_centre[rows], made.arc_axis[rows]


@pytest.mark.parametrize("made", [cone(40), square_with_arc()])
def test_mirroring_twice_changes_nothing(made):
    matrix = mirror([10, -20, 5], [3, -1, 2])
    np.testing.assert_allclose(matrix @ matrix, np.eye(4), atol=ROUNDING)
    assert_same(moved(moved(made, matrix), matrix), made)


def test_both_mirrors_of_the_papers_part_make_its_third_quarter_a_turn_by_180_degrees():
    np.testing.assert_allclose(XZ_MIRROR, np.diag([1, -1, 1, 1]), atol=ROUNDING)
    np.testing.assert_allclose(YZ_MIRROR, np.diag([-1, 1, 1, 1]), atol=ROUNDING)
    half_turn = rotation([0, 0, 0], [0, 0, 1], np.pi)
    np.testing.assert_allclose(XZ_MIRROR @ YZ_MIRROR, half_turn, atol=ROUNDING)
    quarter = cone(40, turns=0.25)
    assert_same(moved(moved(quarter, YZ_MIRROR), XZ_MIRROR), moved(quarter, half_turn))


def test_quarters_of_the_ellipse_meet_without_a_gap():
    quarter = cone(40, turns=0.25)
    quarter = program(quarter.position * [1, 1, 0], quarter.tool_axis)
    across_xz, across_yz = moved(quarter, XZ_MIRROR), moved(quarter, YZ_MIRROR)
    opposite = moved(quarter, rotation([0, 0, 0], [0, 0, 1], np.pi))
    for one, other in [(quarter, across_xz), (across_yz, opposite)]:
        np.testing.assert_allclose(one.position[0], other.position[0], atol=ROUNDING)
    for one, other in [(quarter, across_yz), (across_xz, opposite)]:
        np.testing.assert_allclose(one.position[-1], other.position[-1], atol=ROUNDING)


@pytest.mark.parametrize(("axis", "angle"), [(0, 30), (1, -75), (2, 140)])
def test_rotation_is_right_handed_about_its_axis(axis, angle):
    matrix = rotation([0, 0, 0], np.eye(3)[axis] * 2.5, np.radians(angle))
    np.testing.assert_allclose(matrix[:3, :3], rotation_about(axis, angle), atol=ROUNDING)
    assert not mirrors(matrix)


def test_points_of_the_mirror_and_of_the_line_stay():
    np.testing.assert_allclose(mirror([1, 2, 3], [0, 0, 5]) @ [7, -8, 3, 1], [7, -8, 3, 1], atol=ROUNDING)
    np.testing.assert_allclose(mirror([1, 2, 3], [0, 0, 5]) @ [7, -8, 4, 1], [7, -8, 2, 1], atol=ROUNDING)
    np.testing.assert_allclose(rotation([1, 2, 3], [0, 0, 1], 1.0) @ [1, 2, 9, 1], [1, 2, 9, 1], atol=ROUNDING)


@pytest.mark.parametrize("matrix", MATRICES.values(), ids=MATRICES)
def test_lengths_sweeps_and_angles_to_the_tool_axis_are_kept(matrix):
    before = square_with_arc()
    after = moved(before, matrix)
    np.testing.assert_allclose(norm(np.diff(after.position, axis=0)), norm(np.diff(before.position, axis=0)))
    np.testing.assert_allclose(arc_sweep(*arcs_of(after)), arc_sweep(*arcs_of(before)), rtol=1e-9)
    np.testing.assert_allclose(arc_length(*arcs_of(after)), arc_length(*arcs_of(before)))
    steps = [(np.diff(made.position, axis=0) * made.tool_axis[1:]).sum(axis=1) for made in (before, after)]
    np.testing.assert_allclose(steps[1], steps[0], atol=1e-10)


@pytest.mark.parametrize("matrix", MATRICES.values(), ids=MATRICES)
def test_an_arc_goes_through_the_images_of_its_points(matrix):
    before = square_with_arc()
    after = moved(before, matrix)
    (start, _, centre, axis), (start_after, _, centre_after, axis_after) = arcs_of(before), arcs_of(after)
    rise = np.array([0.0, 2.0])  # half the depth of the helix, along its axis
    for share in (0.25, 0.5, 0.75):
        angle = share * arc_sweep(*arcs_of(before))
        points = arc_points(start, centre, axis, angle, rise)
        images = points @ matrix[:3, :3].T + matrix[:3, 3]
        # A mirror keeps right-handed arcs right-handed, so what rises along the axis falls along its image.
        risen = -rise if mirrors(matrix) else rise
        np.testing.assert_allclose(arc_points(start_after, centre_after, axis_after, angle, risen), images, atol=1e-10)


@pytest.mark.parametrize(
    ("normal", "before", "after"),
    [
        ([0, 1, 0], [0, 0, 1], [0, 0, -1]),  # one of X and Y mirrored: G2 and G3 change places
        ([1, 0, 0], [0, 0, 1], [0, 0, -1]),
        ([0, 0, 1], [0, 0, 1], [0, 0, 1]),  # Z alone: they do not
        ([0, 1, 0], [1, 0, 0], [-1, 0, 0]),
        ([0, 1, 0], [0, 1, 0], [0, 1, 0]),
    ],
)
def test_arc_axes_are_axial_vectors(normal, before, after):
    blank = np.full((2, 3), np.nan)
    centre, turn = blank.copy(), blank.copy()
    centre[1], turn[1] = [0, 0, 0], before
    start = np.roll(before, 1) * 10.0
    made = program([start, start], kind=[Kind.RAPID, Kind.ARC], centre=centre, turn=turn)
    np.testing.assert_allclose(moved(made, mirror([0, 0, 0], normal)).arc_axis[1], after, atol=ROUNDING)


def test_mirroring_both_x_and_y_keeps_the_sense_of_arcs():
    made = square_with_arc()
    np.testing.assert_allclose(moved(made, XZ_MIRROR @ YZ_MIRROR).arc_axis, made.arc_axis, atol=ROUNDING)


def test_the_spindle_and_everything_else_keeps_its_sense():
    events = (Event(0, EventKind.TOOL_CHANGE, 1), Event(0, EventKind.SPINDLE, 8000), Event(2, EventKind.COOLANT, 1))
    made = program([[0, 0, 60], [10, 0, 60], [20, 5, 60]], events=events)
    after = moved(made, XZ_MIRROR)
    assert after.events == events
    assert mirrors(XZ_MIRROR)
    for name in ("kind", "feed", "operation", "line"):
        np.testing.assert_array_equal(getattr(after, name), getattr(made, name))
    assert (after.operations, after.tools, after.source) == (made.operations, made.tools, made.source)


def test_tool_axes_stay_unit_vectors_behind_a_matrix_of_six_decimals():
    typed = np.round(rotation([0, 0, 0], [1, 2, 3], 0.7), 6)
    np.testing.assert_allclose(norm(moved(cone(40), typed).tool_axis), 1.0, rtol=1e-15)


@pytest.mark.parametrize(
    ("matrix", "found"),
    [
        (np.diag([2.0, 2, 2, 1]), "scales by 2 2 2"),
        (np.diag([1.0, 1, 1.001, 1]), "scales by 1 1 1.001"),
        (np.diag([1.0, 0, 1, 1]), "scales by 1 0 1"),
        ([[1, 0.6, 0, 0], [0, 0.8, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]], "not at right angles"),
        (np.diag([1.0, 1, 1, 2]), "last row is 0 0 0 2"),
        (np.diag([1.0, 1, np.nan, 1]), "no finite number"),
    ],
)
def test_scale_shear_and_perspective_are_refused(matrix, found):
    made, faults = transform(cone(4), matrix)
    assert made is None
    assert [fault.code for fault in faults] == ["K109"]
    assert found in faults[0].found
    assert faults[0].place.file == "part.FCStd"


def test_wrong_arguments_are_the_callers_fault():
    with pytest.raises(ValueError, match=r"expected a matrix \(4, 4\), got \(3, 3\)"):
        transform(cone(4), np.eye(3))
    with pytest.raises(ValueError, match="direction"):
        mirror([0, 0, 0], [0, 0, 0])
    with pytest.raises(ValueError, match="direction"):
        rotation([0, 0, 0], [0, 0, 0], 1.0)


# The signs by which x, y and z are mirrored, the plane, and what becomes of a tool on the left: the rule "G41 and
# G42 swap when exactly one of the two axes of the plane is mirrored".
@pytest.mark.parametrize(
    ("signs", "plane", "side"),
    [
        ((1, -1, 1), 2, -1), ((-1, 1, 1), 2, -1), ((1, 1, -1), 2, 1), ((-1, -1, 1), 2, 1),
        ((-1, 1, 1), 1, -1), ((1, -1, 1), 1, 1), ((1, 1, -1), 0, -1), ((-1, 1, 1), 0, 1),
    ],
)  # fmt: skip
def test_side_of_the_compensation(signs, plane, side):
    made = dataclasses.replace(program([[0, 0, 0], [9, 5, 2]]), side_offset=[0.0, 4.0], plane=[plane, plane])
    moved, faults = transform(made, np.diag([*signs, 1.0]))
    assert not faults
    assert moved.side_offset.tolist() == [0.0, 4.0 * side]
    assert moved.plane.tolist() == [plane, plane]


def test_compensation_may_not_leave_its_plane_but_may_change_it():
    made = dataclasses.replace(program([[0, 0, 0], [9, 5, 2]]), side_offset=[0.0, 4.0])
    moved, _ = transform(made, rotation((0, 0, 0), (1, 0, 0), np.pi / 2))
    assert moved.plane.tolist() == [1, 1]
    oblique, faults = transform(made, rotation((0, 0, 0), (1, 0, 0), 0.3))
    assert oblique is None
    assert [fault.code for fault in faults] == ["K112"]


def test_normals_turn_with_the_part():
    made = dataclasses.replace(program([[0, 0, 0], [9, 5, 2]]), normal=[[np.nan] * 3, [0, 0.6, 0.8]])
    moved, _ = transform(made, mirror((0, 0, 0), (0, 1, 0)))
    np.testing.assert_allclose(moved.normal[1], [0, -0.6, 0.8], atol=1e-15)


def test_a_mirror_turns_the_spin_round_and_a_rotation_keeps_it():
    made = dataclasses.replace(program([[0, 0, 0], [9, 5, 2]]), spin=[0.1, -0.3])
    for matrix, spin in (
        (mirror((0, 0, 0), (0, 1, 0)), [-0.1, 0.3]),
        (rotation((0, 0, 0), (0, 0, 1), np.pi), [0.1, -0.3]),
    ):
        assert transform(made, matrix)[0].spin.tolist() == spin


def test_what_a_program_says_of_corners_stays_with_its_rows():
    rows = np.arange(7)
    made = dataclasses.replace(
        square_with_arc(), exact_stop=rows == 2, exact_path=rows == 4, tip_tolerance=np.where(rows > 4, 0.05, 0.0)
    )
    after = moved(made, mirror((0, 0, 0), (1, 0, 0)))
    for name in ("exact_stop", "exact_path", "tip_tolerance"):
        np.testing.assert_array_equal(getattr(after, name), getattr(made, name))


def test_rows_and_events_follow_each_other():
    events = (Event(0, EventKind.SPINDLE, 5000), Event(3, EventKind.SPINDLE, 0))
    first = program([[0, 0, 30], [1, 2, 0], [3, 4, 0]], events=events)
    second, _ = transform(dataclasses.replace(first, side_offset=[0, 2, 2]), mirror((0, 0, 0), (1, 0, 0)))
    both = concatenate([first, second])
    assert both.position[:, 0].tolist() == [0, 1, 3, 0, -1, -3]
    assert both.side_offset.tolist() == [0, 0, 0, 0, -2, -2]
    assert [(event.row, event.value) for event in both.events] == [(0, 5000), (3, 0), (3, 5000), (6, 0)]
    assert np.array_equal(both.line, [1, 2, 3, 1, 2, 3])


def test_one_program_stays_as_it_is():
    made = program([[0, 0, 30], [1, 2, 0]])
    assert np.array_equal(concatenate([made]).position, made.position)
    assert concatenate([made]).events == made.events


def test_programs_of_other_operations_are_a_fault_of_the_caller():
    made = program([[0, 0, 30]])
    for programs in ([], [made, dataclasses.replace(made, operations=("Other",))]):
        with pytest.raises(ValueError, match="same operations"):
            concatenate(programs)


def test_every_column_of_each_program_is_there():
    rows = np.arange(3)
    first = program([[0, 0, 30], [1, 2, 0], [3, 4, 0]])
    reported = {
        "exact_stop": rows == 1,
        "exact_path": rows == 2,
        "tip_tolerance": 0.01 * rows,
        "side_offset": 1.0 * rows,
    }
    reported |= {"plane": [0, 1, 2], "normal": np.eye(3), "spin": 0.1 * rows, "smaller_tool": rows == 0}
    reported["contact"] = rows == 1
    assert set(reported) == set(OPTIONAL_COLUMNS)
    second = dataclasses.replace(first, **reported)
    both = concatenate([first, second, first])
    for name in (*MOTION_COLUMNS, *OPTIONAL_COLUMNS, "position", "tool_axis"):
        for begin, made in enumerate([first, second, first]):
            np.testing.assert_array_equal(getattr(both, name)[3 * begin : 3 * begin + 3], getattr(made, name), name)
