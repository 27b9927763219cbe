# SPDX-License-Identifier: LGPL-2.1-or-later
"""The calls that FreeCAD newer than 1.1 makes, replayed on 1.0 and 1.1.

From the sources of FreeCAD's main branch: ``PostProcessDialog._generate_output`` (Path/Post/Gui/DlgPostProcess.py,
commit 012dd316), ``PostProcessorFactory`` and ``PostProcessor.build_configuration_bundle`` (Path/Post/Processor.py,
commit 02f93101), ``classifyPostProcessor`` (Path/Preferences.py, commit 171ab3df), ``Machine.from_dict``
(Machine/models/machine.py, commit 27fe2290), and what Path/Post/TiltedWorkPlane.py (commit 27fe2290) says of operations
on work planes: their path is in the frame of the plane, which is their Placement.
"""

import json
import math
from types import SimpleNamespace

import FreeCAD as App
import numpy as np
import pytest
from another_freecad import ROOT
from cam_jobs import add_operation
from Path.Post.Processor import PostProcessorFactory

from pkm_post.freecad_app import startup
from pkm_post.freecad_app.job import read_job
from pkm_post.model import Refused

FCM = json.loads((ROOT / "resources" / "machines" / "example_6tps.fcm").read_text(encoding="utf-8"))


@pytest.fixture
def machine_kind(monkeypatch):
    """The folder that newer versions search for posts of machines."""
    import Path.Preferences

    search = Path.Preferences.searchPathsPost
    monkeypatch.setattr(Path.Preferences, "searchPathsPost", lambda: [*search(), startup.MACHINE_FOLDER])


@pytest.fixture
def job(job, tmp_path):
    job.PostProcessorOutputFile = str(tmp_path / "part.pmc")
    job.PostProcessorArgs = "--work-offset=0,0,250"
    add_operation(job, ["G0 X0 Y0 Z30", "G1 X2 Y1 Z29 F20", "G0 Z30"])
    return job


def generated(job, name, machine=None, **properties):
    """The text and the post of ``_generate_output``."""
    post = PostProcessorFactory.get_post_processor({"job": job, "operations": list(job.Operations.Group)}, name)
    if machine is not None:
        post._machine = machine
    dialog = {"job_author": "", "comment": "", "selected_fixtures": list(job.Fixtures)}
    post.apply_configuration_bundle(overrides=properties | dialog)
    post._dialog_handled = post._bundle_applied = True
    ((part, text),) = post.export2() if machine is not None else post.export()
    assert part == "allitems"
    assert post.get_file_extension() == "pmc"
    return text


def a_machine(**properties):
    return SimpleNamespace(postprocessor_properties=properties)


def refused(*arguments, **properties):
    with pytest.raises(Refused) as refusal:
        generated(*arguments, **properties)
    return [(fault.code, fault.found) for fault in refusal.value.diagnostics]


def test_generate_output_leaves_no_files_and_gives_the_program_that_posting_writes(job, tmp_path):
    text = generated(job, "hexapod_pmac")
    assert list(tmp_path.iterdir()) == []
    ((_, posted),) = PostProcessorFactory.get_post_processor(job, "hexapod_pmac").export()
    assert text == posted
    assert (tmp_path / "part-report.json").is_file()


def test_a_result_of_several_files_is_refused_by_name(job, tmp_path):
    assert refused(job, "hexapod_trajectory") == [("F111", "it needs part.pkmt beside it")]
    assert list(tmp_path.iterdir()) == []


def test_a_job_with_a_machine_is_certified_and_not_written_by_the_inherited_form(job, machine_kind):
    properties = FCM["postprocessor"]["properties"]
    assert generated(job, FCM["postprocessor"]["file_name"], a_machine(**properties)) == generated(job, "hexapod_pmac")


def test_properties_of_machine_job_and_dialog_are_arguments_in_this_order(job):
    chosen = {"hexapod_tip_tolerance": "0.01"}
    assert generated(job, "hexapod_linuxcnc", a_machine(**chosen)) == generated(job, "hexapod_linuxcnc", **chosen)
    assert generated(job, "hexapod_linuxcnc", a_machine(**chosen)) != generated(job, "hexapod_linuxcnc")
    job.addProperty("App::PropertyString", "PostProcessorPropertyOverrides")
    job.PostProcessorPropertyOverrides = '{"hexapod_tip_tolerance": ""}'
    assert generated(job, "hexapod_linuxcnc", a_machine(**chosen)) == generated(job, "hexapod_linuxcnc")
    assert generated(job, "hexapod_linuxcnc", **chosen) == generated(job, "hexapod_linuxcnc", None, **chosen)
    job.PostProcessorPropertyOverrides = "{"
    assert [code for code, _ in refused(job, "hexapod_linuxcnc")] == ["J117"]


def test_a_bad_property_is_refused_with_its_argument(job):
    ((code, found),) = refused(job, "hexapod_gcode", hexapod_form="Q")
    assert code == "J117" and "--form" in found


@pytest.mark.parametrize("name", ["hexapod_pmac", "hexapod_trajectory", "hexapod_linuxcnc", "hexapod_gcode"])
def test_schema_has_what_the_dialog_reads(name):
    kind = type(PostProcessorFactory.get_post_processor(None, name))
    schema = {row["name"]: row for row in kind.get_property_schema()}
    for row in schema.values():
        assert row["runtime"] and row["label"].startswith("--") and isinstance(row["help"], str)
    assert schema["hexapod_corners"]["choices"] == ["", "chord", "arc"]
    assert schema["hexapod_keep_climb"] | {"type": "bool", "default": False} == schema["hexapod_keep_climb"]
    assert schema["hexapod_work_offset"]["type"] == "string"
    assert "hexapod_flavour" not in schema  # for part programs
    assert ("hexapod_also" in schema, "hexapod_form" in schema) == (name == "hexapod_pmac", name == "hexapod_gcode")
    assert kind.get_common_property_schema() == []  # a preamble that the editor took would do nothing


def test_posts_of_machines_are_in_a_folder_of_their_own(monkeypatch):
    added = []
    stand_in = SimpleNamespace(searchPathsPost=lambda: [], addAddonPostPath=added.append)
    startup._add_folder(stand_in)
    assert added == [startup.FOLDER, startup.MACHINE_FOLDER]


def test_the_machine_of_freecad_has_what_main_requires():
    axes = FCM["machine"]["axes"]
    assert {axis["type"] for axis in axes.values()} == {"linear", "rotary"}
    assert all(axis["parent"] is None or axis["parent"] in axes for axis in axes.values())
    assert FCM["machine"]["kinematics"]["rotation_strategy"] in ("none", "dwo", "twp", "post_transform")
    assert (ROOT / "postprocessors" / "machine" / f"{FCM['postprocessor']['file_name']}_post.py").is_file()


def test_an_operation_on_a_tilted_plane_is_posted_with_the_tool_square_to_it(job):
    tilt = math.radians(12)
    plane = App.Placement(App.Vector(5, -4, 2), App.Rotation(App.Vector(1, 0, 0), 12))
    flat = ["G0 Z30", "G0 X1 Y2", "G1 Z1 F5", "G2 X5 Y2 I2 J0", "G0 Z30"]
    add_operation(job, flat, "Tilted").Placement = plane
    job.Document.recompute()
    program, faults = read_job(job)
    assert not [fault for fault in faults if fault.code.startswith("J1")], faults
    tilted = program.operation == program.operations.index("Tilted")
    # in the plane: X1 Y2 Z1, turned about x by the tilt, and moved
    cos, sin = math.cos(tilt), math.sin(tilt)
    expected = [5 + 1, -4 + 2 * cos - 1 * sin, 2 + 2 * sin + 1 * cos]
    np.testing.assert_allclose(program.position[tilted][2], expected, atol=1e-9)
    np.testing.assert_allclose(program.tool_axis[tilted], np.tile([0, -sin, cos], (tilted.sum(), 1)), atol=1e-12)
    text = generated(job, "hexapod_pmac", a_machine())
    assert len(text.splitlines()) > 20
