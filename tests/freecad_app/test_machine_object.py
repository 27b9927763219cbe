# SPDX-License-Identifier: LGPL-2.1-or-later
"""The machine in the document: lengths, limits, work offset; kept by saving, taken back by one undo."""

import math

import FreeCAD as App
import numpy as np
import pytest
from cam_jobs import add_operation, new_job, reopened

from pkm_post.freecad_app.frames import matrix_of
from pkm_post.freecad_app.machine_object import create_machine, machine_of
from pkm_post.machine import strut_lengths
from pkm_post.model import Refused

NANOMETRE = 1e-6
JOINTS = 1e-4
"""mm: the machine file gives its joints with four decimals."""
DECIMALS = 1e-9
"""mm: work offsets are placements, whose turns FreeCAD keeps as quaternions."""


@pytest.fixture
def machine(document):
    made = create_machine(document, "example_6tps")
    document.recompute()
    return made


def struts(obj):
    return np.array([getattr(obj, f"Strut{number}").Value for number in range(1, 7)])


def test_it_stands_at_home_with_the_work_offset_of_its_file(machine):
    # example_6tps: home (0, 0, 300) in {M}, G54 at (0, 0, 150), so 150 above the work frame
    assert tuple(machine.Tip) == pytest.approx((0.0, 0.0, 150.0), abs=DECIMALS)
    assert tuple(machine.WorkOffset.Base) == (0.0, 0.0, 150.0)
    assert tuple(machine.Frame.Base) == pytest.approx((0.0, 0.0, -150.0), abs=DECIMALS)
    assert list(machine.OutOfLimits) == []


def test_strut_lengths_follow_the_pose_as_quantities(document, machine):
    # From the ring formulas of example_6tps, without kinematics: the platform is upright, its plane 80 + 100 mm above
    # the tip at (10, 0, 200) in {M}; base ring 600 at z = 1400, first joints at 12 and 48 degrees.
    machine.Tip, machine.ToolLength = App.Vector(10, 0, 50), "100 mm"
    document.recompute()
    base = np.array([600 * math.cos(math.radians(12)), 600 * math.sin(math.radians(12)), 1400])
    platform = np.array([200 * math.cos(math.radians(48)) + 10, 200 * math.sin(math.radians(48)), 380])
    assert machine.Strut1.Value == pytest.approx(np.linalg.norm(platform - base), abs=JOINTS)
    assert machine.Strut1.Unit == App.Units.Length


def test_a_leaning_pose_in_a_turned_work_frame_is_the_same_pose_in_the_machine(document, machine):
    offset = App.Placement(App.Vector(30, -20, 180), App.Rotation(App.Vector(0, 0, 1), 30))
    machine.WorkOffset, machine.Spin = offset, 5
    machine.Tip, machine.ToolAxis = App.Vector(12, 7, 40), App.Vector(0.3, 0.1, 2.0)
    document.recompute()
    tip, axis = np.array(offset.multVec(machine.Tip)), np.array(offset.Rotation.multVec(machine.ToolAxis))
    axis /= np.linalg.norm(axis)
    expected = strut_lengths(machine_of(machine), tip[None], axis[None], np.radians([5.0]), np.array([120.0]))[0]
    np.testing.assert_allclose(struts(machine), expected, atol=NANOMETRE)


def test_what_is_out_of_limits_is_reported_and_reported_no_more(document, machine):
    machine.Tip = App.Vector(0, 0, -400)
    document.recompute()
    assert any(line.startswith("longest struts: strut ") for line in machine.OutOfLimits)
    assert machine.StrokeMargin.Value < 0
    assert machine.isValid()
    machine.Tip = App.Vector(0, 0, 100)
    document.recompute()
    assert list(machine.OutOfLimits) == []
    assert machine.StrokeMargin.Value > 0


def test_the_work_offset_of_a_job_is_taken_and_followed(document):
    job = new_job(document)
    job.PostProcessor = "hexapod_pmac"
    job.PostProcessorArgs = "--machine example_6tps --work-offset=60,0,200,90"
    machine = create_machine(document, job=job)
    document.recompute()
    assert tuple(machine.WorkOffset.multVec(App.Vector(10, 0, 0))) == pytest.approx((60, 10, 200), abs=DECIMALS)
    assert "ReadOnly" in machine.getEditorMode("WorkOffset")
    job.PostProcessorArgs = "--work-offset G54"
    document.recompute()
    assert tuple(machine.WorkOffset.Base) == (0.0, 0.0, 150.0)
    add_operation(job)
    assert machine.isValid()


def test_the_work_offset_places_an_object_of_the_model(document, machine):
    box = document.addObject("Part::Feature", "Box")
    box.Placement = App.Placement(App.Vector(100, 50, 0), App.Rotation(App.Vector(0, 0, 1), 90))
    machine.Reference = box
    document.recompute()
    document_from_work = matrix_of(machine.Frame) @ matrix_of(machine.WorkOffset)
    np.testing.assert_allclose(document_from_work, matrix_of(box.Placement), atol=DECIMALS)
    before = struts(machine)
    box.Placement.Base = App.Vector(0, 0, 77)
    document.recompute()
    assert machine.Frame.Base.z == pytest.approx(77 - 150, abs=DECIMALS)
    np.testing.assert_array_equal(struts(machine), before)


def test_it_survives_saving(document, machine, tmp_path):
    machine.Tip, machine.Spin = App.Vector(1, 2, 60), 3
    document.recompute()
    before = struts(machine)
    again = reopened(document, tmp_path / "machine.FCStd").getObject("Machine")
    assert type(again.Proxy).__module__ == "pkm_post.freecad_app.machine_object"
    np.testing.assert_array_equal(struts(again), before)
    again.Tip = App.Vector(1, 2, 61)
    again.Document.recompute()
    assert again.isValid()
    assert not np.array_equal(struts(again), before)


def test_one_undo_takes_it_back(document):
    document.UndoMode = 1
    document.openTransaction("Machine")
    create_machine(document)
    document.commitTransaction()
    document.recompute()
    document.undo()
    assert [item.Name for item in document.Objects if item.Name.startswith("Machine")] == []


def test_a_machine_that_is_not_there_is_refused_and_nothing_is_added(document):
    with pytest.raises(Refused) as refused:
        create_machine(document, "no_such_machine")
    assert [fault.code for fault in refused.value.diagnostics] == ["M101"]
    assert document.Objects == []


def test_a_reference_without_a_placement_is_reported_at_the_object(document, machine):
    machine.Reference = document.addObject("App::DocumentObjectGroup", "Group")
    document.recompute()
    assert not machine.isValid()


def test_a_machine_file_that_went_away_is_reported_at_the_object(document, machine):
    machine.MachineFile = "/nowhere/machine.toml"
    document.recompute()
    assert not machine.isValid()
    machine.MachineFile = "linuxcnc_genhexkins"
    document.recompute()
    assert machine.isValid()
