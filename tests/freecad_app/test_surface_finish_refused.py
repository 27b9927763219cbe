# SPDX-License-Identifier: LGPL-2.1-or-later
"""What Surface Finish refuses, and what a machine allows it."""

import FreeCAD as App
import numpy as np
import Part
import pytest
from cam_jobs import moves
from part_jobs import job_on
from surface_finishes import coarse, plate_with_hole, poses, valid
from test_tools import stock_bit

from pkm_post.freecad_app import progress
from pkm_post.freecad_app.job import read_job
from pkm_post.freecad_app.surface_finish import create_surface_finish
from pkm_post.model import Refused


@pytest.fixture
def job(document):
    return job_on(document, plate_with_hole())


REFUSED = {
    "no stepover": ({"Stepover": 0.0}, "N309"),
    "lead too flat": ({"Lead": 90.0}, "N309"),
    "spiral over an open face": ({"Order": "Spiral"}, "N301"),
    "safe height below": ({"Lead": 5.0}, "N307"),
}


@pytest.mark.parametrize("fault", REFUSED)
def test_fault_is_shown_at_the_operation_and_its_path_is_empty(job, fault):
    operation = valid(coarse(job))
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


def test_tool_controller_that_lacks_something_is_reported(job):
    operation = valid(coarse(job))
    job.Tools.Group[0].HorizFeed = 0
    job.Document.recompute()
    assert "J105" in operation.getStatusString()
    operation.ToolController = None
    job.Document.recompute()
    assert "J112" in operation.getStatusString()
    assert moves(operation) == []


@pytest.mark.parametrize("gone", ["Tools", "Tool"])
def test_job_without_a_tool_gets_no_operation(job, gone):
    controller, document = job.Tools.Group[0], job.Document
    document.removeObject(controller.Tool.Name if gone == "Tool" else controller.Name)
    before = len(document.Objects)
    with pytest.raises(Refused) as refused:
        create_surface_finish(job)
    assert [each.code for each in refused.value.diagnostics] == ["J112"]
    assert len(document.Objects) == before


def test_operation_without_faces_is_reported(job):
    operation = valid(coarse(job))
    operation.Base = []
    job.Document.recompute()
    assert "N308" in operation.getStatusString()


def test_drill_finishes_no_surface(job):
    operation = valid(coarse(job))
    job.Tools.Group[0].Tool = stock_bit(job.Document, "drill.fcstd", Diameter=10)
    job.Document.recompute()
    assert "N116" in operation.getStatusString()


def test_user_can_stop_it_and_nothing_old_is_left(job, monkeypatch):
    operation = valid(coarse(job))
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


def test_machine_limits_the_tilt(job):
    operation = valid(coarse(job, Tilt=70.0, Machine="example_6tps"))
    assert 5.0 < operation.UsedConeLimit.Value < 60.0
    _, axes = poses(operation)
    assert np.degrees(np.arccos(axes[:, 2])).max() == pytest.approx(operation.UsedConeLimit.Value, abs=1e-4)
    operation.ConeLimit = 3.0
    job.Document.recompute()
    assert operation.UsedConeLimit.Value == pytest.approx(3.0)


def test_machine_that_cannot_be_used_is_reported(job):
    operation = valid(coarse(job, Machine="example_6tps"))
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


def test_part_out_of_reach_is_reported(document):
    far = Part.makeBox(10, 10, 10, App.Vector(3000, 0, 0))
    operation = coarse(job_on(document, far), lambda face: face.BoundBox.ZMin > 9.9, Machine="example_6tps")
    assert "N310" in operation.getStatusString()
