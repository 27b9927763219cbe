# SPDX-License-Identifier: LGPL-2.1-or-later
"""Normal Compensation on shapes whose tips are known, on the loft of the column, and in CAM's own terms."""

import importlib.util
import math
import sys
import types
from pathlib import Path

import FreeCAD as App
import numpy as np
import Part
import Path.Main.Job as CamJob
import pytest
from another_freecad import printed_by
from cam_jobs import add_operation, moves, reopened
from Path.Base.Util import opProperty, toolControllerForOp
from Path.Dressup.Utils import baseOp
from test_tools import stock_bit

from pkm_post.freecad_app import progress
from pkm_post.freecad_app.job import read_job, set_gauge_length
from pkm_post.freecad_app.normal_compensation import FROM_NORMAL, NormalCompensation, create_normal_compensation
from pkm_post.freecad_app.post_job import post_job
from pkm_post.freecad_app.symmetry import create_mirror
from pkm_post.pipeline import Options

ROOT = Path(__file__).resolve().parents[2]
MICRON = 1e-3
SIX_DECIMALS = 1e-6
X, Y, Z = np.eye(3)
COMMENTS = 2
"""Commands that a Custom operation puts before those it is given."""
ACROSS_THE_TOP = [(5.0, 5.0, 20.0), (15.0, 5.0, 20.0), (15.0, 12.0, 20.0)]


def job_on(document, shape, bit="ballend.fcstd", **sizes):
    """A job on a part of this shape, with a ball end mill D10 unless another cutter is told."""
    part = document.addObject("Part::Feature", "Part")
    part.Shape = shape
    job = CamJob.Create("Job", [part], None)
    controller = job.Tools.Group[0]
    controller.Tool = stock_bit(document, bit, **({"Diameter": 10} | sizes))
    controller.SpindleSpeed, controller.SpindleDir = 9000, "Forward"
    set_gauge_length(controller, 120)
    return job


def corner(diameter, radius):
    """The size that says the corner of a bull nose in this FreeCAD."""
    return {"FlatRadius": diameter / 2 - radius} if int(App.Version()[1]) == 0 else {"CornerRadius": radius}


def bull_nose(diameter, radius):
    return {"bit": "bullnose.fcstd", "Diameter": diameter, **corner(diameter, radius)}


def lines(points, axes=None):
    """G-code of a cut along contact points, from above and back."""
    rows = [np.round([*point], 6) for point in points]
    turned = [""] * len(rows) if axes is None else [" I{:.6f} J{:.6f} K{:.6f}".format(*axis) for axis in axes]
    words = ["X{:.6f} Y{:.6f} Z{:.6f}".format(*row) for row in rows]
    above = ["X{:.6f} Y{:.6f} Z60".format(*rows[place]) for place in (0, -1)]
    cut = [f"G1 {row}{axis} F10" for row, axis in zip(words, turned, strict=True)]
    return [f"G0 {above[0]}{turned[0]}", *cut, f"G0 {above[1]}{turned[-1]}"]


def dressed(job, code, **properties):
    """The dress-up over an operation with these lines of G-code, computed."""
    dressup = create_normal_compensation(add_operation(job, code))
    for name, value in properties.items():
        setattr(dressup, name, value)
    job.Document.recompute()
    return dressup


def valid(dressup):
    assert dressup.isValid(), dressup.getStatusString()
    return dressup


def poses(operation, code="G1"):
    """Tips and unit tool axes of moves, upright where no axis is given."""
    words = [words for name, words in moves(operation) if name == code]
    tips = np.array([[each[letter] for letter in "XYZ"] for each in words])
    axes = np.array([[each.get(letter, up) for letter, up in zip("IJK", Z, strict=True)] for each in words])
    return tips, axes / np.linalg.norm(axes, axis=1)[:, None]


def refused(dressup):
    """The text at a dress-up that could not be computed; it has no path then, and the job is not posted."""
    assert not dressup.isValid()
    assert moves(dressup) == []
    job = next(each for each in dressup.Document.Objects if hasattr(each, "PostProcessor"))
    program, faults = read_job(job)
    assert program is None
    assert ("J116", dressup.Label) in [(fault.code, fault.place.operation) for fault in faults]
    return dressup.getStatusString()


@pytest.fixture
def box_job(document):
    return job_on(document, Part.makeBox(20, 20, 20))


# shapes


@pytest.mark.parametrize("cutter", [{}, {"bit": "endmill.fcstd"}, bull_nose(10, 2)], ids=["ball", "flat", "bull nose"])
def test_on_a_plane_across_the_tool_axis_tips_are_the_points(document, cutter):
    dressup = valid(dressed(job_on(document, Part.makeBox(20, 20, 20), **cutter), lines(ACROSS_THE_TOP)))
    assert poses(dressup)[0] == pytest.approx(np.array(ACROSS_THE_TOP), abs=SIX_DECIMALS)
    assert poses(dressup, "G0")[0] == pytest.approx(np.array([(5, 5, 60), (15, 12, 60)]), abs=SIX_DECIMALS)


def slope():
    """A wedge whose slope through the origin has the normal (1, 0, 1) / sqrt 2."""
    corners = [App.Vector(*corner) for corner in [(-20, -20, 20), (20, -20, -20), (-20, -20, -20), (-20, -20, 20)]]
    return Part.Face(Part.makePolygon(corners)).extrude(App.Vector(0, 40, 0))


# The tips below were worked by hand from tip = P + r n + e m - f k and given to four decimals, P = 0.
@pytest.mark.parametrize(
    ("shape", "axis", "tip"),
    [
        (slope, Z, (8.8284, 0.0, -1.1716)),
        (slope, np.array([0.0, -np.sin(np.radians(20.0)), np.cos(np.radians(20.0))]), (8.5056, 3.1927, -0.2662)),
        (
            lambda: Part.makeBox(20, 20, 20, App.Vector(-10, -10, -20)),
            np.array([0.5, 0, 0.8660254]),
            (-7.1962, 0, 3.5359),
        ),
    ],
    ids=["upright on a slope", "leaning on a slope", "leaning on a plane"],
)
def test_bull_nose_on_a_plane_against_worked_numbers(document, shape, axis, tip):
    points = np.array([(0.0, 0.0, 0.0), (0.0, 5.0, 0.0)])
    dressup = valid(dressed(job_on(document, shape(), **bull_nose(20, 4)), lines(points, [axis, axis])))
    assert poses(dressup)[0] == pytest.approx(points + tip, abs=1e-4)


SPHERE_RADIUS, BALL_RADIUS = 20.0, 5.0


def over_the_sphere(spacing=0.05):
    """Unit vectors along a half circle over a sphere, not through its pole."""
    angle = np.arange(-1.2, 1.2, spacing)
    return np.column_stack([np.sin(angle), np.full(len(angle), 0.3), np.cos(angle)]) / math.hypot(1.0, 0.3)


@pytest.mark.parametrize(
    "properties", [{}, {"ToolAxis": FROM_NORMAL, "Lead": 10, "Tilt": -20}], ids=["kept", "leaning"]
)
def test_centre_of_a_ball_is_its_radius_off_a_sphere(document, properties):
    sphere = Part.makeSphere(SPHERE_RADIUS)
    dressup = valid(dressed(job_on(document, sphere), lines(SPHERE_RADIUS * over_the_sphere()), **properties))
    tips, axes = poses(dressup)
    centres = tips + BALL_RADIUS * axes
    distances = [sphere.Faces[0].distToShape(Part.Vertex(App.Vector(*centre)))[0] for centre in centres]
    assert np.array(distances) == pytest.approx(BALL_RADIUS, abs=MICRON)
    assert centres / np.linalg.norm(centres, axis=1)[:, None] == pytest.approx(over_the_sphere(), abs=SIX_DECIMALS)


def test_faces_that_were_drawn_are_found_up_to_where_they_bulge_out_of_their_triangles(document):
    job = job_on(document, Part.makeSphere(SPHERE_RADIUS))
    shape = job.Model.Group[0].Shape
    shape.tessellate(2.0)  # as a window does
    job.Model.Group[0].Shape = shape
    angle = np.linspace(3.0, 3.3, 10)
    equator = SPHERE_RADIUS * np.column_stack([np.cos(angle), np.sin(angle), np.zeros(len(angle))])
    assert job.Model.Group[0].Shape.Faces[0].BoundBox.XMin > equator[:, 0].min() + MICRON
    tips, _ = poses(valid(dressed(job, lines(equator))))
    assert tips + BALL_RADIUS * Z == pytest.approx(equator * (1 + BALL_RADIUS / SPHERE_RADIUS), abs=SIX_DECIMALS)


def column_example():
    spec = importlib.util.spec_from_file_location("column_build", ROOT / "examples" / "tapered_column" / "build.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


def test_cutter_touches_the_loft_of_the_tapered_column(document):
    example = column_example()
    column = example.Column(stepover=25.0, spacing=2.0)
    touched = example.contacts(column)
    axes = example.tool_axes(touched.normal, column.relief, touched.lead)
    job = job_on(document, example.solid(column), **bull_nose(column.tool.diameter, column.tool.corner_radius))
    links = np.linalg.norm(np.diff(touched.point, axis=0), axis=1) > 3.0  # from one level to the next
    assert links.any()
    last = np.append(np.flatnonzero(links), len(axes) - 1)
    first = np.append(0, last[:-1] + 1)
    passes = [lines(touched.point[a : b + 1], axes[a : b + 1]) for a, b in zip(first, last, strict=True)]
    high = [line.replace("Z60", "Z100") for cut in passes for line in cut]
    tips, found_axes = poses(valid(dressed(job, high, Faces=[(job.Model.Group[0], "Face1")])))
    wall = example.wall(example.solid(column))
    e = column.tool.diameter / 2 - column.tool.corner_radius
    for tip, axis in zip(tips[::7], found_axes[::7], strict=True):
        centre, direction = App.Vector(*(tip + column.tool.corner_radius * axis)), App.Vector(*axis)
        corner_circle = Part.Circle(centre, direction, e).toShape()
        assert wall.distToShape(corner_circle)[0] == pytest.approx(column.tool.corner_radius, abs=MICRON)


def test_arcs_become_chords_before_they_are_compensated(document):
    """On a cylinder of radius 10 a ball of radius 5 runs round on a circle, its tip at half its height."""
    job = job_on(document, Part.makeCylinder(10, 20))
    dressup = valid(dressed(job, ["G0 X10 Y0 Z60", "G1 Z10 F10", "G3 X-10 Y0 I-10 J0", "G0 Z60"]))
    tips, _ = poses(dressup)
    assert {name for name, _ in moves(dressup)} == {"G0", "G1"}
    assert len(tips) > 50
    assert np.hypot(tips[:, 0], tips[:, 1]) == pytest.approx(15.0, abs=SIX_DECIMALS)
    assert tips[:, 2] == pytest.approx(5.0, abs=SIX_DECIMALS)


def test_stock_is_left_along_the_normal(document):
    job = job_on(document, slope())
    points = np.array([(0.0, 0.0, 0.0), (0.0, 5.0, 0.0)])
    bare, stocked = (
        poses(valid(dressed(job, lines(points))))[0],
        poses(valid(dressed(job, lines(points), StockToLeave=0.3)))[0],
    )
    assert stocked - bare == pytest.approx(
        np.tile([0.3 / math.sqrt(2), 0, 0.3 / math.sqrt(2)], (2, 1)), abs=SIX_DECIMALS
    )


def test_lead_leans_forward_and_tilt_to_the_left(box_job):
    forward = dressed(box_job, lines(ACROSS_THE_TOP[:2]), ToolAxis=FROM_NORMAL, Lead=30)
    left = dressed(box_job, lines(ACROSS_THE_TOP[:2]), ToolAxis=FROM_NORMAL, Tilt=30)
    half, tall = 0.5, math.sqrt(0.75)
    assert poses(valid(forward))[1] == pytest.approx(np.tile([half, 0, tall], (2, 1)), abs=SIX_DECIMALS)
    assert poses(valid(left))[1] == pytest.approx(np.tile([0, half, tall], (2, 1)), abs=SIX_DECIMALS)
    assert poses(left, "G0")[1] == pytest.approx(np.tile([0, half, tall], (2, 1)), abs=SIX_DECIMALS)


def test_lead_leans_forward_of_the_way_in_where_the_path_turns_back(box_job):
    there, back = ACROSS_THE_TOP[:2]
    leaning = {"ToolAxis": FROM_NORMAL, "Lead": 30, "ChordTolerance": 1}
    _, axes = poses(valid(dressed(box_job, lines([there, back, there]), **leaning)))
    assert axes[:, 0] == pytest.approx([0.5, 0.5, -0.5], abs=SIX_DECIMALS)


def test_each_cut_leans_its_own_way(box_job):
    code = [*lines(ACROSS_THE_TOP[:2]), *lines(ACROSS_THE_TOP[1:])]
    _, axes = poses(valid(dressed(box_job, code, ToolAxis=FROM_NORMAL, Lead=30)))
    assert axes[:, :2] == pytest.approx(np.array([(0.5, 0), (0.5, 0), (0, 0.5), (0, 0.5)]), abs=SIX_DECIMALS)


def test_cut_across_a_plane_keeps_to_itself(document):
    """A bull nose D10 r2: on the top its tip is at the point, at the wall its corner is, whatever was before."""
    job = job_on(document, Part.makeBox(20, 20, 20), **bull_nose(10, 2))
    wall = [(20.0, 5.0, 10.0), (20.0, 15.0, 10.0)]
    tips, _ = poses(valid(dressed(job, [*lines(wall), *lines(ACROSS_THE_TOP), *lines(wall)])))
    beside = np.array(wall) + (5, 0, -2)
    assert tips == pytest.approx(np.vstack([beside, ACROSS_THE_TOP, beside]), abs=SIX_DECIMALS)


# moves around the cuts


def test_rapid_moves_follow_sideways_and_never_go_lower(document):
    """On the slope the ball D10 has its tip 5 sin 45 to the side, and 5 (cos 45 - 1) below the point."""
    job = job_on(document, slope())
    dressup = valid(dressed(job, lines([(0, 0, 0), (0, 5, 0)])))
    sideways, down = 5 / math.sqrt(2), 5 / math.sqrt(2) - 5
    assert poses(dressup)[0] == pytest.approx(np.array([(sideways, 0, down), (sideways, 5, down)]), abs=SIX_DECIMALS)
    assert poses(dressup, "G0")[0] == pytest.approx(np.array([(sideways, 0, 60), (sideways, 5, 60)]), abs=SIX_DECIMALS)


def test_rapid_moves_are_lifted_when_the_tip_is(document):
    axis = (math.sqrt(0.5), 0, math.sqrt(0.5))
    job = job_on(document, Part.makeBox(20, 20, 20))
    code = lines(ACROSS_THE_TOP[:2], [axis, axis])
    dressup = valid(dressed(job, [line.replace("Z60", "Z20.5") for line in code]))
    lift = 5 * (1 - math.sqrt(0.5))
    assert poses(dressup)[0][:, 2] == pytest.approx(20 + lift, abs=SIX_DECIMALS)
    assert poses(dressup, "G0")[0][:, 2] == pytest.approx(20.5 + lift, abs=SIX_DECIMALS)


def test_leads_keep_their_shape(document):
    job = job_on(document, slope())
    cut = ["G0 X0 Y-5 Z60", "G0 X0 Y-2 Z3", "G1 X0 Y-1 Z1 F5", "G1 X0 Y0 Z0", "G1 Y5", "G1 Y6 Z2", "G0 Z60"]
    assert "N111" in refused(dressed(job, cut))
    job.Document.removeObject(job.Operations.Group[0].Name)
    job.Document.removeObject(job.Operations.Group[0].Name)
    tips, _ = poses(valid(dressed(job, cut, LeadLength=3)))
    programmed = np.array([(0, -1, 1), (0, 0, 0), (0, 5, 0), (0, 6, 2)])
    assert tips - programmed == pytest.approx(np.tile(tips[1], (4, 1)), abs=SIX_DECIMALS)


# refusals


def test_point_off_the_faces_is_told_with_its_place_and_distance(box_job):
    text = refused(dressed(box_job, lines([(5, 5, 20), (15, 5, 20.5), (15, 8, 20)])))
    assert "N111" in text
    assert f"part: Cut: line {COMMENTS + 3}" in text
    assert "X15 Y5 Z20.5 is 0.5 mm from" in text
    assert ".Face6, Tolerance 0.01 mm" in text


def test_wider_tolerance_takes_the_point(box_job):
    dressup = dressed(box_job, lines([(5, 5, 20), (15, 5, 20.5)]), Tolerance=0.6)
    assert poses(valid(dressup))[0][:, 2] == pytest.approx([20, 20.5], abs=SIX_DECIMALS)


def test_point_beyond_the_edge_of_a_face_is_off_it(box_job):
    text = refused(dressed(box_job, lines([(5, 5, 20), (25, 5, 20)])))
    assert "N111" in text
    assert "X25 Y5 Z20 is 5 mm from" in text


def test_point_over_a_hole_in_a_face_is_off_it(document):
    plate = Part.makeBox(20, 20, 20).cut(Part.makeCylinder(5, 30, App.Vector(10, 10, 0)))
    text = refused(dressed(job_on(document, plate), lines([(2, 2, 20), (10, 10, 20)])))
    assert "X10 Y10 Z20 is 5 mm from" in text


def test_point_beyond_the_edge_within_the_tolerance_is_on_the_face(document):
    """The surface of the face goes on there; over a hole the box about the face does not leave such points out."""
    plate = Part.makeBox(20, 20, 20).cut(Part.makeCylinder(5, 30, App.Vector(10, 10, 0)))
    job = job_on(document, plate)
    top = next(number for number, face in enumerate(plate.Faces, start=1) if face.CenterOfMass.z > 19.99)
    dressup = dressed(job, lines([(10, 4, 20), (10, 5.008, 20)]), Faces=[(job.Model.Group[0], f"Face{top}")])
    assert poses(valid(dressup))[0][1] == pytest.approx([10, 5.008, 20], abs=SIX_DECIMALS)
    dressup.Base.Gcode = lines([(10, 4, 20), (10, 5.012, 20)])
    document.recompute()
    assert "is 0.012 mm from" in refused(dressup)


def test_nearer_one_of_two_faces_is_told_first(box_job):
    name = box_job.Model.Group[0].Label
    text = refused(dressed(box_job, lines([(5, 5, 20), (19.995, 5, 20)])))
    assert f"is on {name}.Face6 and on {name}.Face2" in text


def test_point_at_an_edge_is_told_unless_its_face_is_chosen(box_job):
    dressup = dressed(box_job, lines([(5, 5, 20), (20, 5, 20)]))
    text = refused(dressup)
    assert "N112" in text
    assert f"part: Cut: line {COMMENTS + 3}" in text
    assert ".Face2" in text
    assert ".Face6" in text
    dressup.Faces = [(box_job.Model.Group[0], ("Face6",))]
    box_job.Document.recompute()
    assert poses(valid(dressup))[0] == pytest.approx(np.array([(5, 5, 20), (20, 5, 20)]), abs=SIX_DECIMALS)


def test_smooth_edge_is_no_edge(document):
    """Two cylinders of one radius on each other have two faces and one normal."""
    shape = Part.makeCylinder(10, 10).fuse(Part.makeCylinder(10, 10, App.Vector(0, 0, 10)))
    assert len(shape.Faces) == 4
    dressup = valid(dressed(job_on(document, shape), lines([(10, 0, 15), (10, 0, 10), (10, 0, 5)])))
    assert poses(dressup)[0] == pytest.approx(np.array([(15, 0, 10), (15, 0, 5), (15, 0, 0)]), abs=SIX_DECIMALS)


def test_cut_round_an_edge_without_a_point_on_it_is_told(box_job):
    """The centre of the ball would cut the corner by 5 (1 - cos 45) = 1.46 mm."""
    text = refused(dressed(box_job, lines([(19.9, 5, 20), (20, 5, 19.9)])))
    assert "N113" in text
    assert "the normal by 90, the axis by 0 degrees; half way the tool would be 1.46 mm off" in text
    assert f"part: Cut: line {COMMENTS + 3}" in text


def test_stock_makes_the_corner_that_is_cut_larger(box_job):
    text = refused(dressed(box_job, lines([(19.9, 5, 20), (20, 5, 19.9)]), StockToLeave=1))
    assert "the tool would be 1.76 mm off" in text  # (5 + 1) (1 - cos 45)


def test_flat_end_mill_would_jump_over_a_summit(document):
    """From one side of the pole to the other it is its other edge that touches: half way its tip is 5 mm off either."""
    angle = np.array([-0.3, -0.1, 0.1])
    points = SPHERE_RADIUS * np.column_stack([np.sin(angle), np.zeros(len(angle)), np.cos(angle)])
    text = refused(dressed(job_on(document, Part.makeSphere(SPHERE_RADIUS), "endmill.fcstd"), lines(points)))
    assert f"part: Cut: line {COMMENTS + 4}: error N113" in text
    assert "the normal by 11.5, the axis by 0 degrees; half way the tool would be 5 mm off" in text


def test_rapid_move_onto_a_face_may_come_from_another_one(box_job):
    code = ["G0 X5 Y5 Z60", "G0 Z20", "G1 X15 F10", "G0 X20 Z10", "G1 Y15", "G0 Z60"]
    dressup = valid(dressed(box_job, code))
    expected = [(5, 5, 60), (5, 5, 20), (25, 5, 5), (25, 15, 60)]
    assert poses(dressup, "G0")[0] == pytest.approx(np.array(expected), abs=SIX_DECIMALS)


def test_plane_that_looks_down_is_undercut(box_job):
    assert "N102" in refused(dressed(box_job, lines([(5, 5, 0), (15, 5, 0)])))


def test_axis_that_turns_lifts_the_tool(box_job):
    """The tip goes straight while the centre of the ball goes round it: 5 (1 - cos 10) = 0.076 mm in the middle."""
    axes = [(np.sin(angle), 0, np.cos(angle)) for angle in np.radians([10, -10])]
    dressup = dressed(box_job, lines(ACROSS_THE_TOP[:2], axes))
    assert "the normal by 0, the axis by 20 degrees; half way the tool would be 0.076 mm off" in refused(dressup)
    dressup.ChordTolerance = 0.08
    box_job.Document.recompute()
    valid(dressup)


def test_axis_that_turns_with_the_normal_keeps_a_ball_on_the_surface(document):
    """Both turn by 0.2 rad: the normal alone would take the ball 5 (1 - cos 0.1) = 0.025 mm off."""
    angle = np.arange(-1.0, 1.0, 0.2)
    points = SPHERE_RADIUS * np.column_stack([np.sin(angle), np.zeros(len(angle)), np.cos(angle)])
    job = job_on(document, Part.makeSphere(SPHERE_RADIUS))
    valid(dressed(job, lines(points), ToolAxis=FROM_NORMAL, ChordTolerance=0.001))
    assert "0.025 mm off" in refused(dressed(job, lines(points), ChordTolerance=0.001))


def test_operation_of_rapid_moves_stays_as_it_is(box_job):
    dressup = valid(dressed(box_job, ["G0 X5 Y5 Z60", "G0 X15"]))
    assert poses(dressup, "G0")[0] == pytest.approx(np.array([(5, 5, 60), (15, 5, 60)]))


def test_undercut_is_told_at_its_command(document):
    """Below its equator a sphere looks away from an upright tool."""
    angle = np.arange(1.0, 2.0, 0.05)
    points = SPHERE_RADIUS * np.column_stack([np.sin(angle), np.zeros(len(angle)), np.cos(angle)])
    text = refused(dressed(job_on(document, Part.makeSphere(SPHERE_RADIUS)), lines(points)))
    assert "N102" in text
    assert f"part: Cut: line {COMMENTS + 14}" in text  # 1.0 + 12 * 0.05 is the first angle beyond pi / 2


def test_lone_point_has_no_direction_to_lean(box_job):
    code = ["G0 X5 Y5 Z60", "G1 Z20 F5", "G0 Z60"]
    assert "N114" in refused(dressed(box_job, code, ToolAxis=FROM_NORMAL, Lead=5))
    assert poses(valid(dressed(box_job, code, ToolAxis=FROM_NORMAL)))[1] == pytest.approx(Z[None])


def test_face_that_is_gone_is_told(box_job):
    dressup = dressed(box_job, lines(ACROSS_THE_TOP))
    dressup.Faces = [(box_job.Model.Group[0], ("Face6",))]
    box_job.Proxy.baseObject(box_job, box_job.Model.Group[0]).Shape = Part.makeSphere(10)
    box_job.Document.recompute()
    text = refused(dressup)
    assert "N115" in text
    assert "Face6" in text


def test_drill_is_refused(document):
    job = job_on(document, Part.makeBox(20, 20, 20), "drill.fcstd")
    assert "N116" in refused(dressed(job, lines(ACROSS_THE_TOP)))


def test_stopped_computation_leaves_nothing(box_job, monkeypatch):
    """Headless nobody can press Escape; FreeCAD's bar raises this when somebody does."""

    class Bar:
        def start(self, text, steps):
            assert steps > 0

        def next(self, may_stop):
            raise RuntimeError("abort progress indicator")

        def stop(self):
            pass

    monkeypatch.setattr(progress, "Base", types.SimpleNamespace(ProgressIndicator=Bar))
    dressup = dressed(box_job, lines(ACROSS_THE_TOP))
    assert "Normal Compensation of Cut: stopped at 100 %" in refused(dressup)
    monkeypatch.undo()
    dressup.touch()
    box_job.Document.recompute()
    assert len(moves(valid(dressup))) == 5


# in the job


def test_dressup_takes_the_place_of_its_base_and_gives_it_back(box_job):
    before, base, after = (add_operation(box_job, lines(ACROSS_THE_TOP), label) for label in ("One", "Cut", "Three"))
    dressup = create_normal_compensation(base)
    assert box_job.Operations.Group == [before, dressup, after]
    assert (dressup.Label, base.Visibility) == ("Normal Compensation of Cut", False)
    assert baseOp(dressup) == base
    box_job.Document.removeObject(dressup.Name)
    assert box_job.Operations.Group == [before, base, after]
    assert base.Visibility


def test_base_below_two_dressups_is_not_lost(box_job):
    lower = dressed(box_job, lines(ACROSS_THE_TOP))
    upper = create_normal_compensation(lower)
    base = lower.Base
    box_job.Document.removeObject(lower.Name)
    assert box_job.Operations.Group == [upper, base]


def test_job_can_be_deleted_as_a_window_does(box_job):
    document, dressup = box_job.Document, dressed(box_job, lines(ACROSS_THE_TOP))
    names = (dressup.Name, dressup.Base.Name)
    box_job.Proxy.onDelete(box_job)
    document.removeObject(box_job.Name)
    assert [document.getObject(name) for name in names] == [None, None]


def test_undo_and_redo(box_job):
    document, base = box_job.Document, add_operation(box_job, lines(ACROSS_THE_TOP))
    document.UndoMode = 1
    document.openTransaction("Normal Compensation")
    name = create_normal_compensation(base).Name
    document.commitTransaction()
    document.undo()
    assert (box_job.Operations.Group, base.Visibility) == ([base], True)
    document.redo()
    document.recompute()
    assert box_job.Operations.Group == [valid(document.getObject(name))]
    assert not base.Visibility


def test_second_dressup_on_one_base_is_the_callers_fault(box_job):
    dressup = dressed(box_job, lines(ACROSS_THE_TOP))
    with pytest.raises(ValueError, match="in the list of a CAM job, got Cut"):
        create_normal_compensation(dressup.Base)
    assert box_job.Operations.Group == [dressup]


def test_tool_and_coolant_are_those_of_the_base(box_job):
    dressup = dressed(box_job, lines(ACROSS_THE_TOP))
    dressup.Base.CoolantMode = "Mist"
    assert toolControllerForOp(dressup) == dressup.Base.ToolController
    assert opProperty(dressup, "CoolantMode") == "Mist"


def test_inactive_base_or_dressup(box_job):
    dressup = dressed(box_job, lines(ACROSS_THE_TOP))
    dressup.Active = False
    box_job.Document.recompute()
    assert [command.Name for command in dressup.Path.Commands] == ["(inactive operation)"]
    dressup.Active, dressup.Base.Active = True, False
    box_job.Document.recompute()
    assert moves(valid(dressup)) == []
    assert [fault.code for fault in read_job(box_job)[1]] == ["J103"]


def test_dressup_follows_base_tool_model_and_its_own_properties(document):
    job = job_on(document, slope())
    dressup = valid(dressed(job, lines([(0, 0, 0), (0, 5, 0)])))
    tip = poses(dressup)[0][0]
    dressup.Base.Gcode = lines([(0, 1, 0), (0, 5, 0)])
    document.recompute()
    assert poses(dressup)[0][0] == pytest.approx(tip + Y, abs=SIX_DECIMALS)
    dressup.Base.Placement.Base = App.Vector(0, 2, 0)
    document.recompute()
    assert poses(dressup)[0][0] == pytest.approx(tip + 3 * Y, abs=SIX_DECIMALS)
    job.Tools.Group[0].Tool.Diameter = 20
    document.recompute()
    assert poses(dressup)[0][0] == pytest.approx(2 * tip + 3 * Y, abs=SIX_DECIMALS)
    dressup.StockToLeave = math.sqrt(2)
    document.recompute()
    assert poses(dressup)[0][0] == pytest.approx(2 * tip + 3 * Y + X + Z, abs=SIX_DECIMALS)
    job.Proxy.baseObject(job, job.Model.Group[0]).Shape = Part.makeBox(40, 40, 40, App.Vector(-20, -20, -40))
    dressup.StockToLeave = 0
    document.recompute()
    assert poses(dressup)[0][0] == pytest.approx([0, 3, 0], abs=SIX_DECIMALS)


def test_faces_of_the_original_are_those_of_its_clone(box_job):
    clone = box_job.Model.Group[0]
    clone.Placement.Base = App.Vector(0, 0, 7)
    original = box_job.Proxy.baseObject(box_job, clone)
    assert original != clone
    dressup = dressed(box_job, lines([(5, 5, 27), (20, 5, 27)]), Faces=[(original, "Face6")])
    assert poses(valid(dressup))[0][:, 2] == pytest.approx(27, abs=SIX_DECIMALS)


def test_posted_under_a_mirror(document, tmp_path):
    job = job_on(document, slope())
    dressup = dressed(job, lines([(0, 2, 0), (0, 5, 0)]))
    mirrored = create_mirror(dressup, (0, 1, 0))
    document.recompute()
    assert poses(valid(mirrored))[0] == pytest.approx(poses(dressup)[0] * [1, -1, 1], abs=SIX_DECIMALS)
    assert job.Operations.Group == [dressup, mirrored]
    program, faults = read_job(job)
    assert faults == ()
    assert program.operations == ("Normal Compensation of Cut", mirrored.Label)
    posted = post_job(
        job,
        "example_6tps",
        tmp_path,
        Options(work_offset=np.array([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 250], [0, 0, 0, 1.0]])),
    )
    assert posted.diagnostics == ()
    assert posted.program.stat().st_size > 0


@pytest.fixture
def saved(document, tmp_path):
    dressed(job_on(document, slope()), lines([(0, 0, 0), (0, 5, 0)]))
    return reopened(document, tmp_path / "saved part.FCStd")


def only(document):
    return document.getObjectsByLabel("Normal Compensation of Cut")[0]


def test_saved_dressup_lives_on(saved):
    dressup = only(saved)
    assert type(dressup.Proxy) is NormalCompensation
    tip = poses(dressup)[0][0]
    dressup.Base.Gcode = lines([(0, 1, 0), (0, 5, 0)])
    saved.recompute()
    assert poses(valid(dressup))[0][0] == pytest.approx(tip + Y, abs=2 * SIX_DECIMALS)


def test_names_in_saved_documents_are_a_file_format(saved):
    dressup = only(saved)
    proxy = type(dressup.Proxy)
    assert f"{proxy.__module__}.{proxy.__name__}" == "pkm_post.freecad_app.normal_compensation.NormalCompensation"
    assert "Dressup" in dressup.Name
    assert {
        "Base", "Active", "Model", "Faces", "Tolerance", "ChordTolerance", "StockToLeave", "LeadLength", "ToolAxis",
        "Lead", "Tilt",
    } <= set(dressup.PropertiesList)  # fmt: skip
    assert dressup.getEnumerationsOfProperty("ToolAxis") == ["Of the operation", "From the normal"]


_OPEN_AND_CHANGE = """
import sys, FreeCAD as App
document = App.openDocument(sys.argv[1])
dressup = document.getObjectsByLabel("Normal Compensation of Cut")[0]
dressup.Base.ToolController.Tool.Diameter = 20
document.recompute()
commands = [command for command in dressup.Path.Commands if command.Name == "G1"]
print("dressup:", type(dressup.Proxy).__name__, [round(commands[0].Parameters[letter], 4) for letter in "XYZ"])
"""


def test_saved_dressup_lives_on_in_a_fresh_freecad(saved, tmp_path):
    path, script = saved.FileName, tmp_path / "change.py"
    script.write_text(_OPEN_AND_CHANGE)
    App.closeDocument(saved.Name)
    # a ball of radius 10: 10 sin 45 to the side, 10 (cos 45 - 1) below
    assert "dressup: NormalCompensation [7.0711, 0.0, -2.9289]" in printed_by(script, path)
