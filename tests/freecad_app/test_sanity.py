# SPDX-License-Identifier: LGPL-2.1-or-later
"""What CAM's sanity report of a job says of our checks, and of the program that was written last."""

import FreeCAD
import pytest
from cam_jobs import ON_EXAMPLE, add_operation, job_in_reach
from Path.Main.Sanity.Sanity import CAMSanity
from Path.Post.Processor import PostProcessorFactory


@pytest.fixture
def job():
    document = FreeCAD.newDocument("sanity")
    made = job_in_reach(document, top=-5.0)
    add_operation(made)
    yield made
    FreeCAD.closeDocument(document.Name)


def output_data(job, folder):
    return CAMSanity(job, str(folder / "sanity.html"))._outputData()


def remarks(data, kind):
    return [each["Note"] for each in data["squawkData"] if each["squawkType"] == kind]


def test_the_report_names_the_machine_and_says_that_it_can_follow(job, tmp_path):
    data = output_data(job, tmp_path)
    assert data["machine"] == "example_6tps"
    assert not remarks(data, "WARNING")


def test_the_report_has_the_errors_of_reach(job, tmp_path):
    job.PostProcessorArgs = ON_EXAMPLE.format("600,0,200")
    job.Document.recompute()
    assert any("error K102" in text and "Cut: line" in text for text in remarks(output_data(job, tmp_path), "WARNING"))


def test_arguments_without_a_meaning_are_remarks_as_well(job, tmp_path):
    job.PostProcessorArgs = "--no-such-argument"
    assert any("J117" in text for text in remarks(output_data(job, tmp_path), "WARNING"))


def test_jobs_of_other_post_processors_are_as_cam_has_them(job, tmp_path):
    job.PostProcessor = "linuxcnc"
    data = output_data(job, tmp_path)
    assert data["machine"] == "" and not remarks(data, "WARNING")


@pytest.mark.filterwarnings("ignore:unclosed file:ResourceWarning")  # CAM counts its lines, and leaves it open
def test_a_posted_job_knows_its_last_program_and_is_not_touched(job, tmp_path):
    job.PostProcessorOutputFile = str(tmp_path / "part.pmc")
    job.Document.recompute()
    ((_, text),) = PostProcessorFactory.get_post_processor(job, "hexapod_pmac").export()
    (tmp_path / "part.pmc").write_text(text, encoding="ascii")
    assert job.LastPostProcessOutput == str(tmp_path / "part.pmc")
    assert "Touched" not in job.State
    data = output_data(job, tmp_path)
    assert data["lastgcodefile"] == str(tmp_path / "part.pmc")
    assert int(data["linecount"]) == len(text.splitlines())


def test_a_refused_post_leaves_what_the_job_remembers(job, tmp_path):
    job.PostProcessorOutputFile = str(tmp_path / "part.pmc")
    job.PostProcessorArgs = ON_EXAMPLE.format("600,0,200")
    job.Document.recompute()
    with pytest.raises(Exception, match="K102"):
        PostProcessorFactory.get_post_processor(job, "hexapod_pmac").export()
    assert job.LastPostProcessOutput == "" and job.LastPostProcessDate == ""
