# SPDX-License-Identifier: LGPL-2.1-or-later
"""Surface Finish in CAM's own terms: made, computed anew, saved, opened, refused, posted; measured on the column."""

import importlib.util
import math
import sys
from pathlib import Path

import FreeCAD as App
import numpy as np
import Part
import Path.Main.Job as CamJob
import pytest
from another_freecad import printed_by
from cam_jobs import add_tool_controller, moves, reopened
from Path.Base.Util import opProperty, toolControllerForOp
from test_tools import stock_bit

from pkm_post.freecad_app import progress
from pkm_post.freecad_app.face_surface import face_surface
from pkm_post.freecad_app.job import read_job, set_gauge_length
from pkm_post.freecad_app.post_job import find_job, post_job
from pkm_post.freecad_app.surface_finish import SurfaceFinish, create_surface_finish
from pkm_post.freecad_app.symmetry import create_mirror
from pkm_post.model import Kind
from pkm_post.pipeline import Options

ROOT = Path(__file__).resolve().parents[2]
MICRON = 1e-3
SIX_DECIMALS = 1e-6
AT_G54 = Options(work_offset="G54")


def load_example():
    spec = importlib.util.spec_from_file_location("tapered_column_shape", ROOT / "examples/tapered_column/build.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


def job_on(document, shape, bit="ballend.fcstd", **sizes):
    """A job on a part of this shape, with a ball end mill D10 unless another cutter is told."""
    part = document.addObject("Part::Feature", "Part")
    part.Shape = shape
    job = CamJob.Create("Job", [part], None)
    controller = job.Tools.Group[0]
    controller.Tool = stock_bit(document, bit, **({"Diameter": 10} | sizes))
    controller.SpindleSpeed, controller.SpindleDir = 9000, "Forward"
    controller.HorizFeed, controller.VertFeed = "1200 mm/min", "300 mm/min"
    set_gauge_length(controller, 120)
    return job


def corner(diameter, radius):
    """The size that says the corner of a bull nose in this FreeCAD."""
    return {"FlatRadius": diameter / 2 - radius} if int(App.Version()[1]) == 0 else {"CornerRadius": radius}


def plate_with_hole(height=20):
    return Part.makeBox(40, 30, height).cut(Part.makeCylinder(5, 50, App.Vector(20, 15, -5)))


def face_names(shape, chosen):
    return [f"Face{number}" for number, face in enumerate(shape.Faces, start=1) if chosen(face)]


def is_top(face):
    return face.BoundBox.ZMin > 19.9


def finish(job, chosen=is_top, **properties):
    """The operation over some faces of the model, computed."""
    clone = job.Model.Group[0]
    operation = create_surface_finish(job, [(clone, face_names(clone.Shape, chosen))])
    for name, value in properties.items():
        setattr(operation, name, value)
    job.Document.recompute()
    return operation


def valid(operation):
    assert operation.isValid(), operation.getStatusString()
    return operation


def poses(operation, codes=("G0", "G1")):
    """Tips and tool axes of the moves that name all of both."""
    words = [words for name, words in moves(operation) if name in codes and {*"XYZIJK"} <= set(words)]
    table = np.array([[each[letter] for letter in "XYZIJK"] for each in words])
    return table[:, :3], table[:, 3:] / np.linalg.norm(table[:, 3:], axis=1, keepdims=True)


@pytest.fixture
def job(document):
    return job_on(document, plate_with_hole())


def test_operation_is_one_of_cams_own(job):
    operation = valid(finish(job, Lead=5.0, CoolantMode="Flood"))
    assert job.Operations.Group == [operation]
    assert toolControllerForOp(operation) == job.Tools.Group[0]
    assert opProperty(operation, "CoolantMode") == "Flood"
    assert operation.Active
    assert (operation.Label, operation.PassCount, operation.ClampedAxes) == ("Surface Finish", 31, 0)


def test_tool_controller_can_be_chosen_where_there_are_several(job):
    second = add_tool_controller(job, 2)
    clone = job.Model.Group[0]
    first, other = (create_surface_finish(job, [(clone, ["Face1"])], controller=each) for each in (None, second))
    assert (first.ToolController, other.ToolController) == (job.Tools.Group[0], second)


def test_operation_can_be_copied(job):
    operation = valid(finish(job, Stepover=5.0, Lead=5.0))
    copy = job.Document.copyObject(operation)
    job.Proxy.addOperation(copy)
    copy.Reversed = True
    job.Document.recompute()
    assert isinstance(copy.Proxy, SurfaceFinish)
    assert valid(copy).PassCount == valid(operation).PassCount == 7
    assert not np.array_equal(poses(copy)[0], poses(operation)[0])


def test_new_operation_has_no_fault_and_no_path_before_it_has_faces(job):
    operation = create_surface_finish(job)
    assert moves(operation) == []
    assert operation.isValid()


def test_trimmed_face_is_covered_round_its_hole(job):
    operation = valid(finish(job, Stepover=2.0, Lead=5.0))
    tips, axes = poses(operation, ("G1",))
    contact = tips + 5.0 * axes - [0.0, 0.0, 5.0]  # of a ball on a plane
    cutting = np.abs(contact[:, 2] - 20.0) < MICRON
    away = np.hypot(contact[:, 0] - 20.0, contact[:, 1] - 15.0)[cutting]
    assert away.min() == pytest.approx(5.0, abs=MICRON)
    inside = [operation.Base[0][0].Shape.distToShape(Part.Vertex(*point))[0] for point in contact[cutting]]
    assert max(inside) < MICRON


def test_heights_and_feeds_are_those_of_cam(job):
    operation = valid(finish(job, Lead=5.0))
    operation.setExpression("SafeHeight", "31 mm")
    operation.setExpression("ClearanceHeight", "47 mm")
    job.Document.recompute()
    rapid = [words for name, words in moves(valid(operation)) if name == "G0" and "K" in words]
    assert {round(words["Z"], 6) for words in rapid if words["K"] == 1.0} == {31.0, 47.0}
    assert {words["F"] for name, words in moves(operation) if name == "G1"} == {20.0, 5.0}


def test_recomputes_when_a_property_changes(job):
    operation = valid(finish(job))
    before = len(moves(operation))
    operation.Stepover = 5.0
    job.Document.recompute()
    assert operation.PassCount == 7
    assert len(moves(valid(operation))) < before


def test_recomputes_when_the_tool_changes(job):
    operation = valid(finish(job, Lead=10.0))
    before, _ = poses(operation, ("G1",))
    job.Tools.Group[0].Tool.Diameter = 6
    job.Document.recompute()
    after, _ = poses(valid(operation), ("G1",))
    # the tip of a ball on a plane is R (1 - cos(lead)) above it
    assert before[:, 2].min() == pytest.approx(20.0 + 5.0 * (1 - math.cos(math.radians(10.0))), abs=MICRON)
    assert after[:, 2].min() == pytest.approx(20.0 + 3.0 * (1 - math.cos(math.radians(10.0))), abs=MICRON)


def test_recomputes_when_the_model_changes(job):
    operation = valid(finish(job, Lead=10.0))
    part = job.Proxy.baseObject(job, job.Model.Group[0])
    part.Shape = plate_with_hole(height=23)
    job.Document.recompute()
    tips, _ = poses(valid(operation), ("G1",))
    assert tips[:, 2].min() == pytest.approx(23.0 + 5.0 * (1 - math.cos(math.radians(10.0))), abs=MICRON)


def test_several_faces_follow_each_other(job):
    sides = lambda face: abs(face.normalAt(0.5, 0.5).z) < 0.1 and face.Surface.TypeId == "Part::GeomPlane"  # noqa: E731
    operation = valid(finish(job, sides, ConeLimit=30.0, Stepover=5.0))
    assert operation.ClampedAxes > 0
    _, axes = poses(operation)
    assert np.degrees(np.arccos(axes[:, 2].min())) == pytest.approx(30.0, abs=1e-4)
    x, y = (np.unique(np.sign(np.round(axes[:, column], 6))) for column in (0, 1))
    assert (x.tolist(), y.tolist()) == ([-1, 0, 1], [-1, 0, 1])


def test_inactive_operation_has_no_moves(job):
    operation = finish(job)
    operation.Active = False
    job.Document.recompute()
    assert [command.Name for command in operation.Path.Commands] == ["(inactive operation)"]


REFUSED = {
    "no stepover": ({"Stepover": 0.0}, "N309"),
    "lead too flat": ({"Lead": 90.0}, "N309"),
    "spiral over an open face": ({"Order": "Spiral"}, "N301"),
    "safe height below": ({"Lead": 5.0}, "N307"),
}


@pytest.mark.parametrize("fault", REFUSED)
def test_fault_is_shown_at_the_operation_and_its_path_is_empty(job, fault):
    operation = valid(finish(job, Stepover=5.0))
    properties, code = REFUSED[fault]
    for name, value in properties.items():
        setattr(operation, name, value)
    if code == "N307":
        operation.setExpression("SafeHeight", "1 mm")
    job.Document.recompute()
    assert not operation.isValid()
    assert code in operation.getStatusString()
    assert moves(operation) == []
    assert [each.code for each in read_job(job)[1]] == ["J116"]


def test_tool_controller_that_lacks_something_is_told(job):
    operation = valid(finish(job))
    job.Tools.Group[0].HorizFeed = 0
    job.Document.recompute()
    assert "J105" in operation.getStatusString()
    operation.ToolController = None
    job.Document.recompute()
    assert "J112" in operation.getStatusString()
    assert moves(operation) == []


def test_operation_without_faces_is_told(job):
    operation = valid(finish(job))
    operation.Base = []
    job.Document.recompute()
    assert "N308" in operation.getStatusString()


def test_drill_finishes_no_surface(job):
    operation = valid(finish(job))
    job.Tools.Group[0].Tool = stock_bit(job.Document, "drill.fcstd", Diameter=10)
    job.Document.recompute()
    assert "N116" in operation.getStatusString()


def test_user_can_stop_it_and_nothing_old_is_left(job, monkeypatch):
    operation = valid(finish(job))
    steps = []

    def stop(self):
        steps.append(self)
        raise progress.Stopped("Surface Finish: 2 % done")

    monkeypatch.setattr(progress.Progress, "step", stop)
    operation.touch()
    job.Document.recompute()
    assert len(steps) == 1
    assert not operation.isValid()
    assert "2 % done" in operation.getStatusString()
    assert moves(operation) == []


def test_one_undo_takes_it_back(job):
    document = job.Document
    document.UndoMode = 1
    document.openTransaction("Surface Finish")
    name = finish(job).Name
    document.commitTransaction()
    document.undo()
    assert document.getObject(name) is None
    assert job.Operations.Group == []


def test_mirror_of_it_follows(job):
    operation = valid(finish(job, Lead=5.0))
    copy = create_mirror(operation, (0, 1, 0))
    job.Document.recompute()
    for found, expected in zip(poses(copy), poses(operation), strict=True):
        np.testing.assert_allclose(found[: len(expected)], expected * [1, -1, 1], atol=1e-9)


def test_saved_operation_lives_on(job, tmp_path):
    operation = valid(finish(job, Lead=5.0, Lines="Along V", CutMode="Climb", Order="One way"))
    before = poses(operation)
    document = reopened(job.Document, tmp_path / "saved part.FCStd")
    (operation,) = find_job(document).Operations.Group
    assert f"{type(operation.Proxy).__module__}.{type(operation.Proxy).__name__}" == (
        "pkm_post.freecad_app.surface_finish.SurfaceFinish"
    )
    assert isinstance(operation.Proxy, SurfaceFinish)
    assert (operation.Lines, operation.CutMode, operation.Order) == ("Along V", "Climb", "One way")
    for found, expected in zip(poses(operation), before, strict=True):
        np.testing.assert_allclose(found, expected, atol=2 * SIX_DECIMALS)
    operation.touch()
    document.recompute()
    for found, expected in zip(poses(valid(operation)), before, strict=True):
        np.testing.assert_allclose(found, expected, atol=1e-9)


def test_document_of_an_older_version_gets_the_missing_properties(job, tmp_path):
    operation = valid(finish(job))
    operation.removeProperty("LeadMove")
    operation.removeProperty("ClampedAxes")
    document = reopened(job.Document, tmp_path / "old.FCStd")
    (operation,) = find_job(document).Operations.Group
    assert (operation.LeadMove, operation.ClampedAxes) == ("None", 0)
    operation.touch()
    document.recompute()
    valid(operation)


_OPEN_AND_CHANGE = """
import sys, FreeCAD as App
document = App.openDocument(sys.argv[1])
operation = document.getObject("SurfaceFinish")
operation.Stepover = 5.0
document.recompute()
print("finish:", type(operation.Proxy).__name__, operation.isValid(), operation.PassCount)
"""


def test_saved_operation_lives_on_in_a_fresh_freecad(job, tmp_path):
    finish(job)
    path, script = tmp_path / "saved.FCStd", tmp_path / "change.py"
    job.Document.saveAs(str(path))
    script.write_text(_OPEN_AND_CHANGE)
    assert "finish: SurfaceFinish True 7" in printed_by(script, str(path))


def step():
    """A floor at z = 10 beside a wall at x = 10."""
    return Part.makeBox(40, 20, 10).fuse(Part.makeBox(10, 20, 30)).removeSplitter()


def test_gouge_and_material_left_are_reported_with_their_places(document):
    # A ball of R 5, upright over a floor up to the wall beside it: its axis comes to the wall, and it cuts R deep.
    floor = lambda face: face.BoundBox.XMin > 9.9 and abs(face.BoundBox.ZMax - 10) < 0.1 and face.normalAt(0, 0).z > 0.9  # noqa: E731,E501
    job = job_on(document, step())
    operation = valid(finish(job, floor, Stepover=2.0, CheckSpacing=1.0))
    assert operation.MaximumGouge == pytest.approx(5.0, abs=0.01)
    assert operation.GougePoint.x == pytest.approx(10.0)
    assert operation.GougePoint.z > 10.0
    assert operation.MaximumExcess < 5.0 - math.sqrt(5.0**2 - 1.0) + MICRON
    assert operation.ExcessPoint.z == pytest.approx(10.0)
    operation.CheckSpacing = 0
    job.Document.recompute()
    assert (operation.MaximumGouge, operation.MaximumExcess) == (-1.0, -1.0)


def test_machine_limits_the_tilt(job):
    operation = valid(finish(job, Tilt=70.0, Stepover=5.0, Machine="example_6tps"))
    assert 5.0 < operation.UsedConeLimit.Value < 60.0
    _, axes = poses(operation)
    assert np.degrees(np.arccos(axes[:, 2])).max() == pytest.approx(operation.UsedConeLimit.Value, abs=1e-4)
    operation.ConeLimit = 3.0
    job.Document.recompute()
    assert operation.UsedConeLimit.Value == pytest.approx(3.0)


def test_machine_that_cannot_be_used_is_told(job):
    operation = valid(finish(job, Machine="example_6tps"))
    for change, code in (
        (lambda: setattr(operation, "ConeAxis", App.Vector(1, 0, 1)), "N309"),
        (lambda: setattr(job, "Fixtures", ["G59"]), "K108"),
        (lambda: setattr(job.Tools.Group[0], "GaugeLength", 0), "J113"),
        (lambda: setattr(operation, "Machine", "no_such_machine"), "M101"),
    ):
        change()
        operation.touch()
        job.Document.recompute()
        assert code in operation.getStatusString()
        operation.ConeAxis = App.Vector(0, 0, 1)


def test_part_out_of_reach_is_told(document):
    far = Part.makeBox(10, 10, 10, App.Vector(3000, 0, 0))
    operation = finish(job_on(document, far), lambda face: face.BoundBox.ZMin > 9.9, Machine="example_6tps")
    assert "N310" in operation.getStatusString()


def test_closed_and_trimmed_faces_are_known_as_such():
    ball, cone = Part.makeSphere(10).Faces[0], Part.makeCone(10, 5, 20).Faces[0]
    for face in (ball, cone):
        surface = face_surface(face)
        assert (surface.u.closed, surface.v.closed) == (True, False)
    ring = face_surface(Part.makeTorus(30, 5).Faces[0])
    assert (ring.u.closed, ring.v.closed) == (True, True)
    half = face_surface(Part.makeSphere(10, App.Vector(), App.Vector(0, 0, 1), -90, 90, 180).Faces[0])
    assert not half.u.closed
    top = face_surface(plate_with_hole().Faces[[is_top(face) for face in plate_with_hole().Faces].index(True)])
    u, v = (np.linspace(span.first, span.last, 41) for span in (top.u, top.v))
    held = top.holds(*(each.ravel() for each in np.meshgrid(u, v)))
    assert 0.9 < held.mean() < 0.97


def bspline_faces():
    """A loft, a ball as B-splines with its poles, a placed piece of a loft, and one that is a hole."""
    example = load_example()
    loft = example.solid(example.Column())
    moved = loft.common(Part.makeBox(100, 100, 50, App.Vector(0, -50, 10)))
    moved.Placement = App.Placement(App.Vector(5, -6, 7), App.Rotation(App.Vector(1, 2, 3), 40))
    hole = Part.makeBox(200, 200, 60, App.Vector(-100, -100, 10)).cut(loft)
    for shape in (loft, Part.makeSphere(10).toNurbs(), moved, hole):
        yield next(face for face in shape.Faces if face.Surface.TypeId == "Part::GeomBSplineSurface")


@pytest.mark.parametrize("number", range(4), ids=["loft", "ball", "moved", "hole"])
def test_poles_give_what_opencascade_gives(number):
    face = list(bspline_faces())[number]
    surface = face_surface(face)
    u, v = (np.linspace(span.first, span.last, 9) for span in (surface.u, surface.v))
    u, v = (each.ravel() for each in np.meshgrid(u, v))
    patch = surface.at(u, v)
    pairs = [(surface.u.within(a[None])[0], surface.v.within(b[None])[0]) for a, b in zip(u, v, strict=True)]
    vectors = [[face.valueAt(*pair), face.normalAt(*pair), *face.derivative1At(*pair)] for pair in pairs]
    expected = np.array([[tuple(vector) for vector in row] for row in vectors])
    for column, found in enumerate((patch.point, patch.normal, patch.along_u, patch.along_v)):
        assert found == pytest.approx(expected[:, column], abs=1e-9)


def test_flipped_normals_point_the_other_way():
    face = Part.makeSphere(10).Faces[0]
    u, v = np.array([1.0]), np.array([0.5])
    out, in_ = (face_surface(face, flipped).at(u, v) for flipped in (False, True))
    assert out.normal == pytest.approx(-in_.normal)
    assert out.normal == pytest.approx(out.point / 10.0)


def test_lifts_between_passes_are_posted(job, tmp_path):
    operation = valid(finish(job, Stepover=15.0, Order="One way", Lead=10.0, LeadMove="Tangent"))
    program, faults = read_job(job)
    assert faults == ()
    assert np.count_nonzero(np.diff((program.kind == Kind.RAPID).astype(int)) == 1) == 4  # the hole cuts one pass
    assert operation.PassCount == 3
    assert post_job(job, "example_6tps", tmp_path, AT_G54).program.exists()


CHORD = 0.005


@pytest.fixture(scope="module")
def column():
    """The wall of the column finished with its bull nose, 31 degrees off it and 8 degrees forward."""
    example = load_example()
    document = App.newDocument("column")
    solid = example.solid(example.Column())
    job = job_on(document, solid, "bullnose.fcstd", Diameter=16, **corner(16.0, 4.0))
    operation = finish(
        job,
        lambda face: face.Surface.TypeId != "Part::GeomPlane",
        Lead=8.0,
        Tilt=59.0,
        Stepover=4.0,
        ChordTolerance=CHORD,
        Reversed=True,
        Order="One way",
        CutMode="Climb",
        LeadMove="Arc",
    )
    yield valid(operation), job, example.wall(solid)
    App.closeDocument(document.Name)


LEAD_ROWS = 20
"""More than a quarter circle of 2 mm has chords."""


def cutting(operation):
    """Tips and axes at the ends and in the middle of the moves with the cutter on the wall: one run without lifts."""
    words = [words for name, words in moves(operation) if name == "G1"][LEAD_ROWS:-LEAD_ROWS]
    table = np.array([[each[letter] for letter in "XYZIJKF"] for each in words])
    tip, axis = table[:, :3], table[:, 3:6]
    return np.vstack([tip, (tip[1:] + tip[:-1]) / 2]), np.vstack([axis, (axis[1:] + axis[:-1]) / 2])


def gap_to(wall, tip, axis):
    """How far the corner is from the wall: a tube of 4 mm about the corner circle, negative where it cuts in."""
    along = App.Vector(*axis).normalize()
    circle = Part.Circle(App.Vector(*tip) + along * 4.0, along, 4.0).toShape()
    found = circle.distToShape(wall)[0] - 4.0
    if found < CHORD:
        return found
    # OpenCASCADE may miss the nearest places of two curved shapes, but not the foot of a point.
    return min(wall.distToShape(Part.Vertex(point))[0] for point in circle.discretize(Number=721)) - 4.0


def test_column_is_neither_gouged_nor_left_beyond_the_tolerance(column):
    """Measured by OpenCASCADE, at the ends and in the middle of moves."""
    operation, _, wall = column
    gaps = [gap_to(wall, tip, axis) for tip, axis in list(zip(*cutting(operation), strict=True))[::23]]
    assert len(gaps) > 200
    assert min(gaps) > -CHORD
    assert max(gaps) < CHORD


def test_column_is_checked_by_the_operation_itself(column):
    operation, job, _ = column
    operation.CheckSpacing = 6.0
    job.Document.recompute()
    assert valid(operation).MaximumGouge < CHORD
    # scallops of passes 4 mm apart, cut by a corner of 4 mm
    assert operation.MaximumExcess < 4.0 - math.sqrt(4.0**2 - 2.0**2) + CHORD


def test_column_is_climbed_round_from_the_top(column):
    tips, _ = poses(column[0], ("G1",))
    turn = np.cross(tips[:-1], tips[1:])[:, 2]
    assert np.mean(turn < 0) > 0.99
    assert tips[100, 2] > tips[-100, 2]


def test_column_keeps_its_tilt_from_the_wall(column):
    operation, _, _ = column
    _, axes = poses(operation, ("G1",))
    tilt = np.degrees(np.arccos(axes[:, 2]))
    assert tilt.max() < 25.0


def test_column_is_posted_to_a_certified_program(column, tmp_path):
    operation, job, _ = column
    posted = post_job(job, "example_6tps", tmp_path, AT_G54)
    assert {"pmc", "pkmt", "json"} <= {path.suffix[1:] for path in posted.files}
    assert posted.program.stat().st_size > 100_000
    assert operation.isValid()
