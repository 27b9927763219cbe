# SPDX-License-Identifier: LGPL-2.1-or-later
"""What CAM's own dress-ups, arrays and copies make of an operation is read as it is."""

import importlib

import FreeCAD as App
import numpy as np
import Part
import Path
import pytest
from cam_jobs import FIVE_AXIS, add_operation, add_tool_controller, moves
from part_jobs import job_on

from pkm_post.freecad_app.job import read_job
from pkm_post.freecad_app.tools import preselected
from pkm_post.model import Kind


@pytest.fixture
def job(document):
    block = Part.makeBox(40, 30, 20).cut(Part.makeBox(20, 14, 10, App.Vector(10, 8, 10)))
    return job_on(document, block, "endmill.fcstd", Diameter=6)


def operation_on(job, name, chosen):
    """A stock operation of CAM on faces of the model."""
    made = importlib.import_module(f"Path.Op.{name}")
    with preselected(job.Tools.Group[0]):
        operation = made.Create(name, parentJob=job)
    model = job.Model.Group[0]
    faces = [f"Face{number}" for number, face in enumerate(model.Shape.Faces, start=1) if chosen(face.BoundBox)]
    operation.ToolController, operation.Base = job.Tools.Group[0], [(model, faces)]
    job.Document.recompute()
    return operation


def profile(job):
    return operation_on(job, "Profile", lambda box: box.ZMax < 0.01)


def pocket(job):
    return operation_on(job, "PocketShape", lambda box: box.ZLength < 0.01 and abs(box.ZMax - 10) < 0.01)


def dressed(module):
    """A maker of a dress-up in place of its base, as its button makes it; the button's own function needs a window."""

    def make(base, job):
        made = job.Document.addObject("Path::FeaturePython", "Dressup")
        made.Proxy = importlib.import_module(module).ObjectDressup(made)
        made.Base = base
        job.Proxy.addOperation(made, base, True)
        made.Proxy.setup(made)
        return made

    return make


def created(module):
    """The same by the function that works without a window."""

    def make(base, job):
        made = importlib.import_module(module).Create(base)
        if base in job.Operations.Group:
            job.Proxy.addOperation(made, base, True)
        return made

    return make


def array_of(base, job):
    made = job.Document.addObject("Path::FeaturePython", "Array")
    importlib.import_module("Path.Op.Gui.Array").ObjectArray(made)
    made.Base, made.Offset, made.Copies = [base], App.Vector(60, 0, 0), 2
    job.Proxy.addOperation(made)
    return made


def copied(base, job):
    with preselected(base.ToolController):
        made = importlib.import_module("Path.Op.Custom").Create("Copy", parentJob=job)
    made.ToolController, made.Gcode = base.ToolController, [each.toGCode() for each in base.Path.Commands]
    return made


@pytest.mark.parametrize(
    ("below", "make"),
    [
        (pocket, created("Path.Dressup.Boundary")),
        (profile, created("Path.Dressup.Tags")),
        (profile, created("Path.Dressup.DogboneII")),
        (profile, dressed("Path.Dressup.Gui.LeadInOut")),
        (profile, dressed("Path.Dressup.Gui.RampEntry")),
        (profile, array_of),
        (profile, copied),
    ],
    ids=["boundary", "tags", "dogbone", "lead", "ramp", "array", "copy"],
)
def test_what_stands_on_an_operation_is_read_command_by_command(job, below, make):
    made = make(below(job), job)
    job.Document.recompute()
    assert made.isValid(), made.getStatusString()
    program, faults = read_job(job)
    assert program is not None, [str(each) for each in faults]
    rows = program.operation == program.operations.index(made.Label)
    last, ends = dict.fromkeys("XYZ", np.nan), []
    for name, words in moves(made):
        if name in ("G0", "G1", "G2", "G3"):
            last |= {letter: words[letter] for letter in "XYZ" if letter in words}
            ends.append([last[letter] for letter in "XYZ"])
    ends = np.array(ends)
    known = np.isfinite(ends).all(axis=1)
    assert len(ends) > 10 and (program.kind[rows] != Kind.RAPID).any()
    np.testing.assert_allclose(program.position[rows][-known.sum() :], ends[known], atol=1e-6)


@pytest.mark.parametrize(
    ("kind", "moved"),
    [
        ({"Type": "Linear1D", "Copies": 2, "Offset": App.Vector(30, 4, -1)}, [(30, 4, -1), (60, 8, -2)]),
        (
            {"Type": "Linear2D", "CopiesX": 1, "CopiesY": 1, "Offset": App.Vector(30, 20, 0)},
            [(0, 20, 0), (30, 20, 0), (30, 0, 0)],
        ),
    ],
    ids=["in a line", "to and fro"],
)
def test_tool_axes_stay_right_in_a_linear_array(job, kind, moved):
    """The law of the array: each copy is the original, moved; FreeCAD writes six decimals. The original stays."""
    base = add_operation(job)
    original = read_job(job)[0]
    made = array_of(base, job)
    for name, value in kind.items():
        setattr(made, name, value)
    job.Document.recompute()
    program, faults = read_job(job)
    assert not faults
    rows = program.operation == program.operations.index(made.Label)
    copies, each = len(moved), len(original.position)
    np.testing.assert_array_equal(program.tool_axis[rows], np.tile(original.tool_axis, (copies, 1)))
    expected = np.tile(original.position, (copies, 1)) + np.repeat(moved, each, axis=0)
    np.testing.assert_allclose(program.position[rows], expected, atol=2e-6)


LATE = ["G0 X0 Y0 Z30", "G1 Z5 F20", "G1 X10 I0.28 J0 K0.96", "G0 Z30"]
"""The first cut comes before the tool axis: in a copy it would have that of the end of the copy before."""


@pytest.mark.parametrize(("lines", "kind"), [(FIVE_AXIS, "Polar"), (LATE, "Linear1D")], ids=["polar", "late axis"])
def test_other_arrays_of_tool_axes_are_refused(job, lines, kind):
    base = add_operation(job, lines)
    made = array_of(base, job)
    made.Type, made.Angle = kind, 90
    assert "J108" in faults_of(job)


def faults_of(job):
    job.Document.recompute()
    return {fault.code for fault in read_job(job)[1]}


def z_correction(base, job):
    made = job.Document.addObject("Path::FeaturePython", "DressupZCorrect")
    made.Proxy = importlib.import_module("Path.Dressup.Gui.ZCorrect").ObjectDressup(made)
    made.Base = base
    job.Proxy.addOperation(made, base, True)
    return made


@pytest.mark.filterwarnings("ignore:unclosed file:ResourceWarning", "ignore:Exception ignored")  # CAM leaves it open
def test_a_z_correction_needs_the_heights_of_its_file(job, tmp_path):
    """CAM reads the file when the property is set, and corrects nothing without it."""
    made, probed = z_correction(profile(job), job), tmp_path / "probed.txt"
    assert faults_of(job) == {"J116"}

    def probe(height):
        points = [(x, y, height + 0.0123 * x + 0.001 * y * y) for x in range(-20, 71, 10) for y in range(-20, 61, 10)]
        probed.write_text("\n".join(f"{x} {y} {z}" for x, y, z in points))

    probe(0.0)
    made.probefile = str(probed)
    assert faults_of(job) == set()
    probe(0.02)
    assert faults_of(job) == {"J116"}
    made.probefile = ""
    made.probefile = str(probed)
    assert faults_of(job) == set()
    probed.write_text("1 2\n")
    assert faults_of(job) == {"J116"}
    probed.unlink()
    assert faults_of(job) == {"J116"}
    made.Base.Active = False
    assert faults_of(job) == {"J103"}


def test_holding_tags_that_cam_leaves_out_are_named(job):
    """CAM disables a tag that meets its neighbour and one off the path; where all fail it takes the path below."""
    made = created("Path.Dressup.Tags")(profile(job), job)
    made.Positions = [*made.Positions, made.Positions[0] + App.Vector(1, 0, 0), App.Vector(20, 15, 0)]
    array_of(made, job)
    assert faults_of(job) == {"J149"}
    expected = [("J149", made.Label, f"holding tags {', '.join(str(each + 1) for each in made.Disabled)} of 6")]
    assert len(made.Disabled) == 2 and [(f.code, f.place.operation, f.found) for f in read_job(job)[1]] == expected
    made.Positions, made.Disabled = [each for n, each in enumerate(made.Positions) if n not in made.Disabled], []
    assert faults_of(job) == set()
    made.Proxy.createPath = None
    made.touch()
    assert faults_of(job) == {"J149"}
    assert [fault.found for fault in read_job(job)[1]] == ["holding tags 1, 2, 3, 4 of 4"]
    made.Base.Active = False
    add_operation(job)
    assert faults_of(job) == set()


WIDE, NARROW, OTHER = 8.0, 2.0, 7.0
"""Radii of bores side by side; an end mill D6 does not fit into the second one."""
BORE = "Part::GeomCylinder", 20.0
RIM = "Part::GeomCircle", 0.0


@pytest.mark.parametrize(("name", "kind"), [("Profile", BORE), ("Profile", RIM), ("PocketShape", BORE)])
def test_bores_too_narrow_for_the_tool_are_named(document, name, kind):
    """CAM cuts the others without a word; that the tool is wider than the bore is the other opinion."""
    plate = Part.makeBox(80, 40, 20)
    for x, radius in ((20, WIDE), (50, NARROW), (65, OTHER)):
        plate = plate.cut(Part.makeCylinder(radius, 30, App.Vector(x, 20, -5)))
    job = job_on(document, plate, "endmill.fcstd", Diameter=6)
    with preselected(job.Tools.Group[0]):
        operation = importlib.import_module(f"Path.Op.{name}").Create(name, parentJob=job)
    model = job.Model.Group[0]
    listed = [f"{shape.ShapeType}{number}" for shapes in (model.Shape.Faces, model.Shape.Edges)
              for number, shape in enumerate(shapes, start=1) if is_chosen(shape, *kind)]  # fmt: skip
    operation.ToolController, operation.Base = job.Tools.Group[0], [(model, listed)]
    array_of(operation, job)
    narrow = [each for each in listed if radius_of(model.Shape.getElement(each)) == NARROW]
    assert len(listed) == 3 and len(narrow) == 1 and faults_of(job) == {"J149"}
    (fault,) = read_job(job)[1]
    found = f"{model.Label}.{narrow[0]}, where the tool cuts nothing"
    assert (fault.place.operation, fault.found) == (operation.Label, found)
    job.Tools.Group[0].Tool.Diameter = 3
    assert faults_of(job) == set()


def is_chosen(shape, kind, height):
    curve = shape.Surface if shape.ShapeType == "Face" else shape.Curve
    return curve.TypeId == kind and shape.BoundBox.ZMin < 0.01 and abs(shape.BoundBox.ZLength - height) < 0.01


def radius_of(shape):
    return pytest.approx((shape.Surface if shape.ShapeType == "Face" else shape.Curve).Radius)


def test_an_array_without_a_base_is_refused(job):
    """FreeCAD 1.0 keeps its path."""
    base = profile(job)
    array_of(base, job)
    assert faults_of(job) == set()
    job.Document.removeObject(base.Name)
    assert "J116" in faults_of(job)


def test_an_array_of_operations_with_two_tools_is_refused(job):
    """FreeCAD 1.0 cuts all of it with the first one, 1.1 clears its path."""
    first, second = profile(job), pocket(job)
    array_of(first, job).Base = [first, second]
    assert faults_of(job) == set()
    other = add_tool_controller(job, 7)
    other.Tool, other.HorizFeed, other.VertFeed = job.Tools.Group[0].Tool, "9 mm/s", "9 mm/s"
    second.ToolController = other
    assert "J116" in faults_of(job)


def test_an_array_of_an_operation_with_coolant_is_posted_or_points_to_the_report_view(job):
    """FreeCAD 1.1 computes none, whatever is recomputed, and says why there: "not compatible with coolant modes"."""
    base = profile(job)
    base.CoolantMode = "Flood"
    made = array_of(base, job)
    job.Document.recompute()
    faults = read_job(job)[1]
    assert [each.code for each in faults] == ([] if made.Path.Size else ["J132"])
    assert all("Report view" in str(each) for each in faults)
    base.CoolantMode = "None"
    assert faults_of(job) == set() and made.Path.Size > 10


def test_a_dress_up_above_an_operation_without_a_path_is_refused(job):
    """FreeCAD 1.1 clears the path of an array that it cannot make, and Dogbone above it keeps its own."""
    base = profile(job)
    below = array_of(base, job)
    made = job.Document.addObject("Path::FeaturePython", "DressupDogbone")
    made.Proxy = importlib.import_module("Path.Dressup.Gui.Dogbone").ObjectDressup(made, below)
    made.Base = below
    job.Proxy.addOperation(made, below, True)
    assert faults_of(job) == set() and made.Path.Size > 10
    below.Proxy = None
    below.Path = Path.Path()
    assert faults_of(job) == {"J132"} and made.Path.Size > 10
    below.Active = False
    assert faults_of(job) == set()


@pytest.mark.parametrize(
    ("label", "found"),
    [
        ("Side (1) rough", "nothing behind its label"),
        ("a)M8m98", "M8"),
        ("Bore (H7)M8x1", "M8 (1.000000"),
        ("Pocket (rough) B2", None),
    ],
)
def test_a_label_that_freecad_reads_as_commands_is_refused_until_it_is_renamed(job, tmp_path, label, found):
    """It writes the label as a comment of the path, which ends at the first bracket when it is read."""
    profile(job).Label = label
    job.Operations.Group[0].touch()
    operation = reopened(job, tmp_path)
    faults = read_job(operation.Document.Job)[1]
    expected = [("J148", found)] if found else []
    assert [(each.code, each.found) for each in faults] == expected
    operation.Label = "Side"
    renamed = {"J134"} if found == "nothing behind its label" else {code for code, _ in expected}
    assert {each.code for each in read_job(operation.Document.Job)[1]} == renamed
    operation.touch()
    assert not read_job(reopened(operation.Document.Job, tmp_path).Document.Job)[1]


def test_a_comment_that_freecad_reads_as_commands_is_refused(job, tmp_path):
    profile(job).Comment = "finish (H7)M8m98"
    operation = reopened(job, tmp_path)
    assert [(each.code, each.found) for each in read_job(operation.Document.Job)[1]] == [("J148", "M8")]
    operation.Comment = "finish H7"
    operation.touch()
    assert not read_job(reopened(operation.Document.Job, tmp_path).Document.Job)[1]


def reopened(job, folder):
    """The operation of a job, saved as it is now computed, in its document that was opened again."""
    document = job.Document
    document.recompute()
    document.saveAs(str(folder / "part.FCStd"))
    App.closeDocument(document.Name)
    return App.openDocument(str(folder / "part.FCStd")).Job.Operations.Group[0]
