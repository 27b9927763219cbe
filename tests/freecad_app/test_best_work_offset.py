# SPDX-License-Identifier: LGPL-2.1-or-later
"""The reach of a job from a macro: what is reported, and the work offset that is set."""

import pytest
from cam_jobs import add_operation, new_job

from pkm_post.freecad_app.arguments import job_arguments
from pkm_post.freecad_app.job_setup import set_best_work_offset, study_job
from pkm_post.freecad_app.post_job import post_job
from pkm_post.model import Refused
from pkm_post.model.diagnostics import errors


@pytest.fixture
def job(document):
    job = new_job(document)
    job.PostProcessor = "hexapod_pmac"
    # Where there is most room, the box is about the home pose, and the way from there to it goes through the box.
    job.PostProcessorArgs = (
        "--machine example_6tps --work-offset=600,0,200,10 --tip-tolerance 0.01 --part none --stock none"
    )
    add_operation(job)
    return job


def test_a_job_out_of_reach_is_placed_and_posted(job, tmp_path):
    assert errors(study_job(job).reach.faults())
    with pytest.raises(Refused):
        post_job(job, out=tmp_path)
    found = set_best_work_offset(job)
    assert not errors(found.reach.faults())
    assert [name for name, _ in found.stages] == ["as it is, zero torsion", "moved in x, y, z, c"]
    chosen = job_arguments(job, job.PostProcessorArgs)
    assert (chosen.machine, chosen.tip_tolerance) == ("example_6tps", 0.01)
    assert chosen.work_offset[:3] == pytest.approx(found.machine_from_work[:3, 3], abs=1e-3)
    assert post_job(job, out=tmp_path).report["certificate"]["holds"]


def test_an_offset_behind_a_blank_is_replaced(job):
    job.PostProcessorArgs = "--work-offset 100,0,200 --spin zero"
    set_best_work_offset(job, "xy")
    assert job.PostProcessorArgs.count("--work-offset") == 1
    assert job.PostProcessorArgs.startswith("--spin zero ")


def test_what_cannot_be_said_is_a_fault_of_the_caller(job):
    with pytest.raises(ValueError, match="expected letters of 'xyzc'"):
        set_best_work_offset(job, "xa")
    job.PostProcessor = "linuxcnc"
    with pytest.raises(ValueError, match="expected a job for hexapod_pmac"):
        set_best_work_offset(job)


def test_a_job_that_cannot_be_read_is_refused(job):
    job.PostProcessorArgs = "--machine no_such_machine"
    with pytest.raises(Refused) as refused:
        study_job(job)
    assert [fault.code for fault in refused.value.diagnostics] == ["M101"]


def test_the_model_of_the_job_is_the_part(job):
    # The box of the job is 20 mm high; with a tool of 15 mm the holder would be in it.
    job.PostProcessorArgs = "--work-offset=0,0,250 --tool-length 1=15"
    reported = [fault for fault in study_job(job).reach.faults() if fault.code == "K117"]
    assert reported
    job.PostProcessorArgs = "--work-offset=0,0,250 --tool-length 1=120"
    assert "K117" not in [fault.code for fault in study_job(job).reach.faults()]
