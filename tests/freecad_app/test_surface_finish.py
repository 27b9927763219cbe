# SPDX-License-Identifier: LGPL-2.1-or-later
"""Surface Finish in CAM's own terms: made, recomputed, saved, opened, posted."""

import math

import numpy as np
import Part
import pytest
from another_freecad import printed_by
from cam_jobs import add_tool_controller, moves, reopened
from part_jobs import job_on
from Path.Base.Util import opProperty, toolControllerForOp
from surface_finishes import AT_G54, MICRON, SIX_DECIMALS, coarse, finish, plate_with_hole, poses, valid

from pkm_post.freecad_app import surface_check
from pkm_post.freecad_app.job import read_job
from pkm_post.freecad_app.post_job import find_job, post_job
from pkm_post.freecad_app.surface_finish import SurfaceFinish, create_surface_finish
from pkm_post.freecad_app.symmetry import create_mirror
from pkm_post.model import Kind


@pytest.fixture(autouse=True)
def few_close_points(monkeypatch):
    """What is measured is none of these tests' matter; ``test_surface_finish_measured`` has it whole."""
    monkeypatch.setattr(surface_check, "_MOST_CLOSE", 1000)


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
    operation = valid(coarse(job, Lead=5.0))
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
    operation = valid(coarse(job, Stepover=2.0, Lead=5.0))
    tips, axes = poses(operation, ("G1",))
    contact = tips + 5.0 * axes - [0.0, 0.0, 5.0]  # of a ball on a plane
    cutting = np.abs(contact[:, 2] - 20.0) < MICRON
    away = np.hypot(contact[:, 0] - 20.0, contact[:, 1] - 15.0)[cutting]
    assert away.min() == pytest.approx(5.0, abs=MICRON)
    inside = [operation.Base[0][0].Shape.distToShape(Part.Vertex(*point))[0] for point in contact[cutting]]
    assert max(inside) < MICRON


def test_heights_and_feeds_are_those_of_cam(job):
    operation = valid(coarse(job, Lead=5.0))
    operation.setExpression("SafeHeight", "31 mm")
    operation.setExpression("ClearanceHeight", "47 mm")
    job.Document.recompute()
    rapid = [words for name, words in moves(valid(operation)) if name == "G0" and "K" in words]
    assert {round(words["Z"], 6) for words in rapid if words["K"] == 1.0} == {31.0, 47.0}
    assert {words["F"] for name, words in moves(operation) if name == "G1"} == {20.0, 5.0}


def test_recomputes_when_a_property_changes(job):
    operation = valid(coarse(job, Stepover=2.0))
    before = len(moves(operation))
    operation.Stepover = 5.0
    job.Document.recompute()
    assert operation.PassCount == 7
    assert len(moves(valid(operation))) < before


def test_recomputes_when_the_tool_changes(job):
    operation = valid(coarse(job, Lead=10.0))
    before, _ = poses(operation, ("G1",))
    job.Tools.Group[0].Tool.Diameter = 6
    job.Document.recompute()
    after, _ = poses(valid(operation), ("G1",))
    # the tip of a ball on a plane is R (1 - cos(lead)) above it
    assert before[:, 2].min() == pytest.approx(20.0 + 5.0 * (1 - math.cos(math.radians(10.0))), abs=MICRON)
    assert after[:, 2].min() == pytest.approx(20.0 + 3.0 * (1 - math.cos(math.radians(10.0))), abs=MICRON)


def test_recomputes_when_the_model_changes(job):
    operation = valid(coarse(job, Lead=10.0))
    part = job.Proxy.baseObject(job, job.Model.Group[0])
    part.Shape = plate_with_hole(height=23)
    job.Document.recompute()
    tips, _ = poses(valid(operation), ("G1",))
    assert tips[:, 2].min() == pytest.approx(23.0 + 5.0 * (1 - math.cos(math.radians(10.0))), abs=MICRON)


def test_several_faces_follow_each_other(job):
    sides = lambda face: abs(face.normalAt(0.5, 0.5).z) < 0.1 and face.Surface.TypeId == "Part::GeomPlane"  # noqa: E731
    operation = valid(coarse(job, sides, ConeLimit=30.0))
    assert operation.ClampedAxes > 0
    _, axes = poses(operation)
    assert np.degrees(np.arccos(axes[:, 2].min())) == pytest.approx(30.0, abs=1e-4)
    x, y = (np.unique(np.sign(np.round(axes[:, column], 6))) for column in (0, 1))
    assert (x.tolist(), y.tolist()) == ([-1, 0, 1], [-1, 0, 1])


def test_inactive_operation_has_no_moves(job):
    operation = coarse(job)
    operation.Active = False
    job.Document.recompute()
    assert [command.Name for command in operation.Path.Commands] == ["(inactive operation)"]


def test_one_undo_takes_it_back(job):
    document = job.Document
    document.UndoMode = 1
    document.openTransaction("Surface Finish")
    name = coarse(job).Name
    document.commitTransaction()
    document.undo()
    assert document.getObject(name) is None
    assert job.Operations.Group == []


def test_mirror_of_it_follows(job):
    operation = valid(coarse(job, Lead=5.0))
    copy = create_mirror(operation, (0, 1, 0))
    job.Document.recompute()
    for found, expected in zip(poses(copy), poses(operation), strict=True):
        np.testing.assert_allclose(found[: len(expected)], expected * [1, -1, 1], rtol=0, atol=SIX_DECIMALS)


def test_saved_operation_lives_on(job, tmp_path):
    operation = valid(coarse(job, Lead=5.0, Lines="Along V", CutMode="Climb", Order="One way"))
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
    operation = valid(coarse(job))
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
    coarse(job, Stepover=10.0, CheckSpacing=5.0)
    path, script = tmp_path / "saved.FCStd", tmp_path / "change.py"
    job.Document.saveAs(str(path))
    script.write_text(_OPEN_AND_CHANGE)
    assert "finish: SurfaceFinish True 7" in printed_by(script, str(path))


def test_lifts_between_passes_are_posted(job, tmp_path):
    operation = valid(coarse(job, Stepover=15.0, Order="One way", Lead=10.0, LeadMove="Tangent"))
    program, faults = read_job(job)
    assert faults == ()
    assert np.count_nonzero(np.diff((program.kind == Kind.RAPID).astype(int)) == 1) == 4  # the hole cuts one pass
    assert operation.PassCount == 3
    assert post_job(job, "example_6tps", tmp_path, AT_G54).program.exists()
