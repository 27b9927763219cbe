# SPDX-License-Identifier: LGPL-2.1-or-later
"""Normal Compensation in CAM's own terms: dressed, followed, undone, posted, saved and opened."""

import math

import FreeCAD as App
import numpy as np
import Part
import pytest
from another_freecad import printed_by
from cam_jobs import add_operation, moves, reopened
from normal_compensations import ACROSS_THE_TOP, SIX_DECIMALS, X, Y, Z, dressed, lines, poses, slope, valid
from part_jobs import job_on
from Path.Base.Util import opProperty, toolControllerForOp
from Path.Dressup.Utils import baseOp

from pkm_post.freecad_app.job import read_job
from pkm_post.freecad_app.normal_compensation import NormalCompensation, create_normal_compensation
from pkm_post.freecad_app.post_job import post_job
from pkm_post.freecad_app.symmetry import create_mirror
from pkm_post.options.choices import Options


@pytest.fixture
def box_job(document):
    return job_on(document, Part.makeBox(20, 20, 20))


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
    assert [reported.code for reported in posted.diagnostics] == ["J125"], "the offset stands in for the job's fixture"
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
