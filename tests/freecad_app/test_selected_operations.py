# SPDX-License-Identifier: LGPL-2.1-or-later
"""Operations and fixtures that are chosen in CAM's dialog: FreeCAD newer than 1.1 hands them over with the job.

It calls the factory with a dictionary, then ``apply_configuration_bundle`` with what the dialog says, then ``export``,
or ``export2`` where the job has a machine of FreeCAD (``Path/Post/Gui/DlgPostProcess.py``, ``_generate_output``). The
factory of 1.0 and 1.1 hands the dictionary to the post-processor as it is, so the same calls are made here.
"""

import pytest
from cam_jobs import FIVE_AXIS, add_operation, new_job
from Path.Post.Processor import PostProcessorFactory

from pkm_post.freecad_app.job import Selection
from pkm_post.freecad_app.job_settings import settings_of
from pkm_post.freecad_app.job_setup import prepared_job
from pkm_post.model import Refused

POSTS = ["hexapod_pmac", "hexapod_linuxcnc", "hexapod_gcode"]


@pytest.fixture
def job(job, tmp_path):
    job.PostProcessorOutputFile = str(tmp_path / "part.ngc")
    job.PostProcessorArgs = "--work-offset=0,0,250"
    for name, x in (("First", 0), ("Second", 3), ("Third", 6)):
        add_operation(job, [f"G0 X{x} Y0 Z30", f"G1 X{x + 2} Y1 Z29 F20", "G0 Z30"], name)
    return job


def exported(name, handed, call="export", **dialog):
    made = PostProcessorFactory.get_post_processor(handed, name)
    if dialog:
        made.apply_configuration_bundle(overrides={"job_author": "", "comment": ""} | dialog)
    ((part, text),) = getattr(made, call)()
    assert part == "allitems"
    return text


def refused(*arguments, **more):
    with pytest.raises(Refused) as refusal:
        exported(*arguments, **more)
    return [fault.code for fault in refusal.value.diagnostics]


@pytest.mark.parametrize("name", POSTS)
def test_these_operations_alone_are_posted_in_the_order_of_the_job(job, name):
    job.PostProcessor = name
    first, second, third = job.Operations.Group
    whole = exported(name, job)
    some = exported(name, {"job": job, "operations": [third, first]})
    assert exported(name, {"job": job, "operations": [first, second, third]}) == whole
    assert exported(name, {"job": job, "operations": None}) == whole
    assert exported(name, [job]) == whole
    second.Active = False
    assert some == exported(name, job) != whole


def test_a_selection_is_read_as_a_job_that_has_nothing_else(job):
    _, second, _ = job.Operations.Group
    read = prepared_job(job, settings_of(job, selection=Selection([second])))
    assert read.program.operations == ("Second",)
    assert prepared_job(job, settings_of(job)).program.operations == ("First", "Second", "Third")


def test_nothing_chosen_is_refused_and_not_taken_for_everything(job):
    assert refused("hexapod_gcode", {"job": job, "operations": []}) == ["J103"]


def test_an_operation_of_another_job_is_refused_by_name(job):
    stranger = add_operation(new_job(job.Document), FIVE_AXIS, "Stranger")
    assert refused("hexapod_gcode", {"job": job, "operations": [job.Operations.Group[0], stranger]}) == ["J127"]


def test_the_fixture_of_the_dialog_is_the_work_offset(job, tmp_path):
    job.Fixtures = ["G54", "G55"]
    job.PostProcessorArgs = ""
    assert refused("hexapod_linuxcnc", job) == ["K108"]  # the example machine has G54 alone
    assert settings_of(job, selection=Selection(fixtures=["G55"])).options.work_offset == "G55"
    handed = {"job": job, "operations": list(job.Operations.Group)}
    assert "K108" in refused("hexapod_linuxcnc", handed, selected_fixtures=["G55"])
    assert refused("hexapod_linuxcnc", handed, selected_fixtures=[]) == ["K108"]


def test_a_machine_of_freecad_changes_nothing(job):
    job.PostProcessor = "hexapod_pmac"
    made = PostProcessorFactory.get_post_processor(job, "hexapod_pmac")
    assert made.get_file_extension() == "ngc"
    assert made.export2() == made.export()
