# SPDX-License-Identifier: LGPL-2.1-or-later
"""The tapered column: the cutter touches the wall and nothing else, all the way round, within a machine's reach."""

import importlib.util
import sys
from pathlib import Path

import FreeCAD as App
import numpy as np
import Part
import Path as Cam
import pytest

import pkm_post as pkm

ROOT = Path(__file__).resolve().parents[2]
MICRON = 1e-3
SIX_DECIMALS = 1e-6
LABELS = ("Quadrant 1", "Quadrant 4", "Quadrant 2", "Quadrant 3")
FORMATS = {
    "Quadrant 1": np.diag([1.0, 1.0, 1.0]),
    "Quadrant 4": np.diag([1.0, -1.0, 1.0]),
    "Quadrant 2": np.diag([-1.0, 1.0, 1.0]),
    "Quadrant 3": np.diag([-1.0, -1.0, 1.0]),
}


def load_example():
    spec = importlib.util.spec_from_file_location("tapered_column_build", ROOT / "examples/tapered_column/build.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


example = load_example()
COLUMN = example.Column()


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    folder = tmp_path_factory.mktemp("column")
    document, job = example.build(out=folder)
    yield document, job, folder
    App.closeDocument(document.Name)


def operations(document):
    return [document.getObjectsByLabel(label)[0] for label in LABELS]


def poses(operation, *codes):
    """Tips and tool axes of the moves of an operation, (N, 3) each."""
    moves = [command.Parameters for command in operation.Path.Commands if command.Name in codes]
    table = np.array([[move[letter] for letter in "XYZIJK"] for move in moves])
    return table[:, :3], table[:, 3:] / np.linalg.norm(table[:, 3:], axis=1, keepdims=True)


def cutting(operation):
    """The poses with the cutter on the wall: all feed moves but the last, which leaves it."""
    tips, axes = poses(operation, "G1")
    return tips[:-1], axes[:-1]


@pytest.fixture(scope="module")
def first(built):
    return cutting(operations(built[0])[0])


def corner_circle(tip, axis):
    r = COLUMN.tool.corner_radius
    along = App.Vector(*axis)
    return Part.Circle(App.Vector(*tip) + along * r, along, COLUMN.tool.diameter / 2 - r).toShape()


def test_sections_of_the_wall_are_ellipses_between_foot_and_top():
    face = example.wall(example.solid(COLUMN))
    (a, b), r = COLUMN.foot_semi_axes, COLUMN.top_radius
    u, v = (column.ravel() for column in np.meshgrid(np.linspace(0, 2 * np.pi, 60), np.linspace(0, 1, 9)))
    points, normals = pkm.surface_points(face, u, v)
    along_x, along_y = a + (r - a) * v, b + (r - b) * v
    expected = np.column_stack([along_x * np.cos(u), along_y * np.sin(u), COLUMN.height * v])
    assert points == pytest.approx(expected, abs=0.1 * MICRON)
    assert np.all(np.einsum("nj,nj->n", normals[:, :2], points[:, :2]) > 0)


def test_cutter_touches_the_wall_without_gouge_or_excess(first):
    # The corner is a tube of radius r round the corner circle: that circle has to be r away from the face.
    face = example.wall(example.solid(COLUMN))
    gaps = [
        corner_circle(tip, axis).distToShape(face)[0] - COLUMN.tool.corner_radius
        for tip, axis in list(zip(*first, strict=True))[::7]
    ]
    assert len(gaps) > 100
    assert np.abs(gaps).max() < 5 * MICRON


def test_cutter_touches_with_its_corner(first):
    _, axes = first
    cosine = np.einsum("nj,nj->n", example.contacts(COLUMN).normal, axes)
    assert np.all((np.sin(np.radians(28.0)) < cosine) & (cosine < np.sin(np.radians(32.0))))


def test_flutes_and_shank_stay_clear_of_the_column(first):
    solid = example.solid(COLUMN)
    tool, reach = COLUMN.tool, COLUMN.tool.length
    for tip, axis in list(zip(*first, strict=True))[::40]:
        along = App.Vector(*axis)
        shank = Part.makeCylinder(tool.diameter / 2, reach, App.Vector(*tip) + along * tool.corner_radius, along)
        assert shank.distToShape(solid)[0] > 0.5


def test_cutter_stays_above_the_table(first):
    tips, axes = first
    r, e = COLUMN.tool.corner_radius, COLUMN.tool.diameter / 2 - COLUMN.tool.corner_radius
    lowest = tips[:, 2] + r * axes[:, 2] - e * np.hypot(axes[:, 0], axes[:, 1]) - r
    assert lowest.min() > 1.0


def test_each_quadrant_has_at_least_300_blocks_and_the_job_1000(built):
    blocks = [len(cutting(operation)[0]) for operation in operations(built[0])]
    assert len(set(blocks)) == 1
    assert blocks[0] >= 300
    assert sum(blocks) >= 1000


def test_copies_are_the_mirrors_and_the_half_turn_of_the_first(built):
    first_operation, *copies = operations(built[0])
    tips, axes = poses(first_operation, "G0", "G1")
    for copy in copies:
        matrix = FORMATS[copy.Label]
        copied_tips, copied_axes = poses(copy, "G0", "G1")
        assert copied_tips == pytest.approx(tips @ matrix, abs=2 * SIX_DECIMALS)
        assert copied_axes == pytest.approx(axes @ matrix, abs=2 * SIX_DECIMALS)


def turn_covered(points):
    """Where the angles of some points about z begin, from 0 to 360 degrees, and the angles, rising."""
    middle = points.mean(axis=0)
    across, along = np.array([-middle[1], middle[0], 0.0]), np.array([middle[0], middle[1], 0.0])
    from_middle = np.sort(np.degrees(np.arctan2(points @ across, points @ along)))
    angles = np.degrees(np.arctan2(middle[1], middle[0])) % 360.0 + from_middle
    return angles[0], angles


def test_contact_points_of_the_four_quadrants_tile_the_turn(built):
    touched = example.contacts(COLUMN).point
    level = touched[np.isclose(touched[:, 2], COLUMN.lowest_contact)]
    tips, _ = cutting(operations(built[0])[0])
    angles, ends = [], []
    for operation in operations(built[0]):
        matrix, *_ = np.linalg.lstsq(tips, cutting(operation)[0], rcond=None)
        low, angle = turn_covered(level @ matrix)
        ends.append((round(low), round(angle[-1])))
        angles.append(angle)
    assert sorted(ends) == [(0, 90), (90, 180), (180, 270), (270, 360)]
    all_angles = np.sort(np.concatenate(angles))
    assert np.diff(all_angles).max() < 2.5
    in_each = [np.sum((all_angles > low + 0.1) & (all_angles < low + 89.9)) for low in (0, 90, 180, 270)]
    assert in_each == [len(level) - 2] * 4


def test_neighbouring_quadrants_meet_in_the_same_poses(first):
    tips, axes = first
    for coordinate in (0, 1):
        border = np.abs(tips[:, coordinate]) < SIX_DECIMALS
        assert border.sum() > 20
        assert axes[border, coordinate] == pytest.approx(0.0, abs=SIX_DECIMALS)


def test_pass_keeps_to_spacing_and_stepover():
    touched = example.contacts(COLUMN).point
    way = np.linalg.norm(np.diff(touched, axis=0), axis=1)
    link = np.diff(touched[:, 2]) < -1.0
    assert way[~link].max() <= COLUMN.spacing
    assert way[~link].min() > 0.9 * COLUMN.spacing
    assert way[link].max() <= COLUMN.stepover + MICRON


def test_tool_axis_tilts_in_bounds_and_turns_smoothly(first):
    _, axes = first
    tilt = np.degrees(np.arccos(axes[:, 2]))
    assert 7.0 < tilt.min() < 9.0
    assert 18.0 < tilt.max() < 21.0
    step = np.degrees(2 * np.arcsin(np.linalg.norm(np.diff(axes, axis=0), axis=1) / 2))
    assert step.max() < 2.5


def test_five_axes_really_move(first):
    tips, axes = first
    assert np.all(np.ptp(np.hstack([tips, axes[:, :2]]), axis=0) > [30.0, 30.0, 60.0, 0.2, 0.2])


def strut_lengths_and_swings(tips, axes, tool_length=200.0, work_offset=(0.0, 0.0, 150.0)):
    """Ten lines of inverse kinematics for an octahedral hexapod: base ring 600 at z 1400, platform ring 200."""
    angles = np.radians([12, 108, 132, 228, 252, 348])
    base = np.column_stack([600 * np.cos(angles), 600 * np.sin(angles), np.full(6, 1400.0)])
    angles = np.radians([48, 72, 168, 192, 288, 312])
    platform = np.column_stack([200 * np.cos(angles), 200 * np.sin(angles), np.zeros(6)])
    v = np.column_stack([-axes[:, 1], axes[:, 0], np.zeros(len(axes))])
    skew = np.cross(v[:, None, :], np.eye(3)).transpose(0, 2, 1)
    turn = np.eye(3) + skew + skew @ skew / (1.0 + axes[:, 2])[:, None, None]
    struts = (tips + work_offset + tool_length * axes)[:, None] + platform @ turn.transpose(0, 2, 1) - base
    lengths = np.linalg.norm(struts, axis=2)
    rest = platform + [0.0, 0.0, 200.0 + tool_length] - base
    swings = np.einsum("nij,njk,ik->ni", struts, turn, rest) / lengths / np.linalg.norm(rest, axis=1)
    return lengths, np.degrees(np.arccos(swings))


def test_inverse_kinematics_of_this_test():
    # Worked elsewhere for the same joints: tip (0, 150, 200), tilt 25 degrees towards +x, no spin.
    lengths, _ = strut_lengths_and_swings(
        np.array([[0.0, 150.0, 200.0]]),
        np.array([[np.sin(np.radians(25)), 0.0, np.cos(np.radians(25))]]),
        200.0,
        (0, 0, 0),
    )
    assert lengths[0] == pytest.approx([1153.9999, 1118.5095, 1017.9289, 1130.8235, 1216.2718, 1147.7747], abs=1e-4)


@pytest.mark.parametrize("number", range(4), ids=LABELS)
def test_every_quadrant_is_within_the_reach_of_a_machine(built, number):
    lengths, swings = strut_lengths_and_swings(*poses(operations(built[0])[number], "G0", "G1"))
    assert lengths.min() > 750.0 + 200.0
    assert lengths.max() < 1250.0 - 20.0
    assert swings.max() < 45.0 - 10.0


def test_every_cutting_move_carries_feed_and_tool_axis(built):
    for operation in operations(built[0]):
        feeds = {command.Parameters.get("F") for command in operation.Path.Commands if command.Name == "G1"}
        assert feeds == {COLUMN.feed}


def test_path_begins_and_ends_above_the_column(built):
    tips, _ = poses(operations(built[0])[0], "G0", "G1")
    assert tips[[0, -1], 2] == pytest.approx(COLUMN.height + COLUMN.clearance)


def test_job_has_one_controller_with_the_tool_of_the_column(built):
    document, job, _ = built
    (tool_controller,) = job.Tools.Group
    assert tool_controller.Tool.Diameter.Value == pytest.approx(16.0)
    assert tool_controller.HorizFeed.getValueAs("mm/min") == pytest.approx(1800.0)
    assert tool_controller.VertFeed.getValueAs("mm/min") == pytest.approx(1800.0)
    assert (tool_controller.SpindleSpeed, tool_controller.SpindleDir) == (12000.0, "Forward")
    assert tool_controller.GaugeLength.Value == pytest.approx(120.0)
    assert all(operation in job.Operations.Group for operation in operations(document))


def test_tool_bit_has_the_shape_that_is_compensated(built):
    shape = built[1].Tools.Group[0].Tool.Shape
    r, e = COLUMN.tool.corner_radius, COLUMN.tool.diameter / 2 - COLUMN.tool.corner_radius
    for angle in np.radians(np.arange(0.0, 91.0, 15.0)):
        on_corner = Part.Vertex(e + r * np.sin(angle), 0.0, r - r * np.cos(angle))
        assert min(face.distToShape(on_corner)[0] for face in shape.Faces) < MICRON


def test_post_processor_is_chosen_where_it_is_installed(built):
    installed = example.POST_PROCESSOR in Cam.Preferences.allAvailablePostProcessors()
    assert (built[1].PostProcessor == example.POST_PROCESSOR) == installed


def test_saved_document_opens_with_the_same_path(built):
    document, _, folder = built
    copy = folder / "copy.FCStd"
    copy.write_bytes((folder / "tapered_column.FCStd").read_bytes())
    reopened = App.openDocument(str(copy))
    try:
        reopened.recompute()
        for before, after in zip(operations(document), operations(reopened), strict=True):
            assert np.hstack(poses(after, "G0", "G1")) == pytest.approx(np.hstack(poses(before, "G0", "G1")), abs=1e-6)
    finally:
        App.closeDocument(reopened.Name)


def test_sizes_are_parameters():
    round_column = example.Column(foot_semi_axes=(50.0, 50.0), top_radius=30.0, height=60.0, stepover=4.0, spacing=3.0)
    touched = example.contacts(round_column)
    assert np.hypot(*touched.point[:, :2].T) == pytest.approx(50.0 - touched.point[:, 2] / 3.0, abs=0.1 * MICRON)
    assert touched.point[0, 2] == pytest.approx(60.0)


@pytest.mark.parametrize("sizes", [{"foot_semi_axes": (40.0, 60.0)}, {"top_radius": 45.0}, {"lowest_contact": 80.0}])
def test_column_that_does_not_taper_is_the_callers_fault(sizes):
    with pytest.raises(ValueError, match="Column: expected"):
        example.Column(**sizes)


def test_blocks_are_fixed_point_and_the_same_every_time():
    blocks = example.quadrant(COLUMN)
    assert blocks == example.quadrant(COLUMN)
    assert not any("e" in block or "-0.000000" in block for block in blocks)
