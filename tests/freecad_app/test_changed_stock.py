# SPDX-License-Identifier: LGPL-2.1-or-later
"""Operations that CAM does not compute when their stock or model changes are named: it links them to chosen faces only.

CAM itself is the oracle: an operation that is named has another path once it is marked and computed.
"""

import cmath
import math

import FreeCAD as App
import numpy as np
import Part
import Path
import Path.Op.Adaptive as Adaptive
import Path.Op.MillFace as MillFace
import Path.Op.Profile as Profile
from part_jobs import job_on

from pkm_post.freecad_app import document_checks
from pkm_post.freecad_app.document import job_for
from pkm_post.freecad_app.job import read_job
from pkm_post.freecad_app.symmetry import create_mirror


def found(job):
    return [(each.code, each.place.operation, str(each.found)) for each in read_job(job)[1]]


def profiled(document):
    """A job with a profile around a box of 40 x 30 x 10 mm, and its part."""
    job = job_on(document, Part.makeBox(40, 30, 10), "endmill.fcstd", Diameter=5)
    operation = Profile.Create("Profile", parentJob=job)
    operation.ToolController = job.Tools.Group[0]
    document.recompute()
    return job, operation, job.Proxy.baseObject(job, job.Model.Group[0])


class Changes(list):
    """The properties that anything in FreeCAD sets while this observes."""

    def slotChangedObject(self, item, name):  # noqa: N802
        self.append((item.Name, name))

    def __enter__(self):
        App.addDocumentObserver(self)
        return self

    def __exit__(self, *_):
        App.removeDocumentObserver(self)


def test_an_operation_computed_for_another_stock_is_named(document):
    job, operation, part = profiled(document)
    create_mirror(operation, (1, 0, 0), label="Mirrored")
    document.recompute()
    assert found(job) == []
    part.Shape, before = Part.makeBox(40, 30, 14), operation.Path.toGCode()
    document.recompute()
    assert operation.Path.toGCode() == before
    text = "from Z -1.00 mm to 11.00 mm, now from Z -1.00 mm to 15.00 mm"
    assert found(job) == [("J150", "Profile", text)]  # once, also for its copy
    operation.touch()
    document.recompute()
    assert found(job) == [] and operation.Path.toGCode() != before


def test_sideways_growth_of_the_stock_and_inactive_operations_are_not_named(document):
    job, operation, _ = profiled(document)
    job.Stock.ExtXpos = job.Stock.ExtYneg = 7
    document.recompute()
    assert found(job) == []  # CAM goes around the model, whatever the sides of the stock
    job.Stock.ExtZpos = 7
    operation.Active = False
    document.recompute()
    assert "J150" not in {code for code, *_ in found(job)}


def test_an_operation_on_a_model_that_has_grown_sideways_is_named_and_left_as_it_is(document):
    job, operation, part = profiled(document)
    create_mirror(operation, (1, 0, 0), label="Mirrored")
    document.recompute()
    assert found(job) == []
    part.Shape, kept = Part.makeBox(50, 30, 10), operation.Path.toGCode()
    document.recompute()
    with Changes() as changes:
        ((code, name, text),) = found(job)  # once, also for its copy
    assert changes == [] and operation.Path.toGCode() == kept and "Touched" not in operation.State
    with Changes() as changes:
        operation.touch()
        document.recompute()
    assert found(job) == [] and ("Profile", "Path") in changes
    lengths = [3 * (2 * (length + 30) + 5 * math.pi) for length in (40, 50)]  # at Z 6, 1 and -1, 2.5 mm beside it
    old, new = (
        f"{each:.3f} mm{long} around X {x}.000 mm Y 15.000 mm Z 2.000 mm"
        for each, x, long in zip(lengths, (20, 25), (" long", ""), strict=True)
    )
    assert (code, name, text) == ("J151", "Profile", f"{old}, now {new}")


def test_a_path_read_from_a_file_is_compared_as_the_computed_one(document, tmp_path):
    _, _, part = profiled(document)
    file = str(tmp_path / "part.FCStd")
    part.Shape = Part.makeCylinder(19.7, 10, App.Vector(1 / 3, 2 / 7, 0))
    document.getObject("Profile").touch()
    document.recompute()
    document.saveAs(file)
    App.closeDocument(document.Name)
    opened = App.openDocument(file)
    job = job_for((), opened)
    assert found(job) == []
    opened.getObject("Part").Shape = Part.makeCylinder(19.8, 10)
    opened.recompute()
    assert [code for code, *_ in found(job)] == ["J151"]


def test_a_contour_that_is_divided_elsewhere_is_the_same(document):
    """CAM begins and divides round contours elsewhere each time it computes them."""
    job, operation, part = profiled(document)
    part.Shape = Part.makeCylinder(20, 10)
    operation.touch()
    document.recompute()
    commands = operation.Path.Commands
    row, last = next((row, each) for row, each in enumerate(commands) if each.Name == "G2")
    x, y, z = (commands[row - 1].Parameters[letter] for letter in "XYZ")
    centre, start = complex(x + last.Parameters["I"], y + last.Parameters["J"]), complex(x, y)
    between = centre + (start - centre) * cmath.exp(-0.1j)
    rest = centre - between
    first = {"X": between.real, "Y": between.imag, "Z": z, "I": last.Parameters["I"], "J": last.Parameters["J"]}
    second = last.Parameters | {"I": rest.real, "J": rest.imag}
    operation.Path = Path.Path([*commands[:row], *(Path.Command("G2", each) for each in (first, second)),
                                *commands[row + 1 :]])  # fmt: skip
    operation.purgeTouched()
    assert found(job) == []
    operation.Path = Path.Path([*commands[:row], *commands[row + 1 :]])
    operation.purgeTouched()
    assert [code for code, *_ in found(job)] == ["J151"]


def test_a_face_milled_to_the_sides_of_a_stock_that_has_grown_is_named(document):
    job = job_on(document, Part.makeBox(40, 30, 10), "endmill.fcstd", Diameter=5)
    model = job.Model.Group[0]
    operation = MillFace.Create("Facing", parentJob=job)
    top = next(name for name, face in enumerate(model.Shape.Faces, 1) if face.BoundBox.ZMin > 9)
    operation.ToolController, operation.Base = job.Tools.Group[0], [(model, [f"Face{top}"])]
    operation.BoundaryShape = "Stock"
    document.recompute()
    assert found(job) == []
    job.Stock.ExtXpos, before = 7, operation.Path.toGCode()
    document.recompute()
    assert operation.Path.toGCode() == before
    assert [each[:2] for each in found(job)] == [("J151", "Facing")]
    operation.touch()
    document.recompute()
    assert found(job) == [] and operation.Path.toGCode() != before


def adaptive(document):
    """A job that clears around a box of 40 x 30 x 10 mm."""
    job = job_on(document, Part.makeBox(40, 30, 10), "endmill.fcstd", Diameter=5)
    model = job.Model.Group[0]
    operation = Adaptive.Create("Adaptive", parentJob=job)
    bottom = next(name for name, face in enumerate(model.Shape.Faces, 1) if face.BoundBox.ZMax < 1)
    operation.ToolController, operation.Base = job.Tools.Group[0], [(model, [f"Face{bottom}"])]
    operation.Side = "Outside"
    document.recompute()
    return job, operation


def test_adaptive_on_the_outside_of_a_stock_that_has_grown_is_named(document):
    job, operation = adaptive(document)
    assert found(job) == []
    job.Stock.ExtXpos, before = 6, operation.Path.toGCode()
    document.recompute()
    assert operation.Path.toGCode() == before
    sides = (f"from X -1.00 mm Y -1.00 mm to X {each} mm Y 31.00 mm" for each in ("41.00", "46.00"))
    assert found(job) == [("J150", "Adaptive", ", now ".join(sides))]
    operation.touch()
    document.recompute()
    assert found(job) == [] and operation.Path.toGCode() != before


def test_a_path_that_cam_computes_now_and_then_is_the_same(document, monkeypatch):
    """Around a box fused with a cylinder, CAM adds an inner contour in some computations, but not in most."""
    job, operation, _ = profiled(document)
    computed, turns = operation.Proxy.opExecute, []

    def now_and_then(item):
        computed(item)
        turns.append(item)
        if len(turns) < wrong:
            operation.Proxy.commandlist += [Path.Command("G1", {"X": 0, "Y": 0, "Z": 0})]

    monkeypatch.setattr(operation.Proxy, "opExecute", now_and_then, raising=False)
    wrong = 3
    assert found(job) == []
    wrong = math.inf
    assert [code for code, *_ in found(job)] == ["J151"]


def test_an_operation_is_computed_again_once_for_all_its_fixtures_and_copies(document, monkeypatch):
    job, operation, _ = profiled(document)
    job.Fixtures = ["G54", "G55"]
    create_mirror(operation, (1, 0, 0), label="Mirrored")
    document.recompute()
    computed = []
    monkeypatch.setattr(document_checks, "outdated_path", lambda each: computed.append(each.Label) or "")
    places = {"G54": np.eye(4), "G55": np.eye(4)}
    program, faults = read_job(job, places=places)
    assert faults == () and len(program.operations) == 4
    assert computed == ["Profile"]


def test_an_operation_that_cam_can_compute_no_more_is_named(document, monkeypatch):
    job, operation, _ = profiled(document)

    def fails(_):
        raise RuntimeError("no outline")

    monkeypatch.setattr(operation.Proxy, "areaOpShapes", fails, raising=False)
    assert found(job) == [("J151", "Profile", "no outline")]


def test_a_chosen_face_that_is_gone_is_named(document):
    block = Part.makeBox(40, 30, 10)
    job = job_on(document, block.cut(Part.makeBox(20, 14, 5, App.Vector(10, 8, 5))), "endmill.fcstd", Diameter=5)
    model = job.Model.Group[0]
    operation = Profile.Create("Profile", parentJob=job)
    bottom = next(name for name, face in enumerate(model.Shape.Faces, 1) if abs(face.BoundBox.ZMax - 5) < 1e-6)
    operation.ToolController, operation.Base = job.Tools.Group[0], [(model, [f"Face{bottom}"])]
    document.recompute()
    assert found(job) == []
    job.Proxy.baseObject(job, model).Shape = block
    document.recompute()
    assert found(job) == [("J116", "Profile", f"{model.Label}.?Face{bottom} no longer exists")]
