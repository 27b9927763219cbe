# SPDX-License-Identifier: LGPL-2.1-or-later
"""Memory runs out for CAM's own post command, for document objects and for macros: F130, and nothing is written."""

import pytest
from cam_jobs import add_operation, new_job
from Path.Post.Processor import PostProcessorFactory

import pkm_post
from pkm_post.freecad_app.reach_object import create_reach
from pkm_post.model import Refused

WHAT = "Unable to allocate 7 GiB"
PLACED = "pkm_post.posting.placement.place"
CALLS = (
    "pkm_post.freecad_app.post_processor.program_path",
    "pkm_post.freecad_app.job_setup.machine_named",
    "pkm_post.freecad_app.job_setup.read_job",
    PLACED,
    "pkm_post.writing.trajectory_file.writer.blocks",
    "pkm_post.writing.trajectory_file.reader.bytes_of",
)
"""What posting calls, in its order."""


@pytest.fixture
def job(document, tmp_path):
    job = new_job(document)
    job.PostProcessorOutputFile = str(tmp_path / "made.ngc")
    job.PostProcessorArgs = "--work-offset=0,0,250"
    add_operation(job)
    return job


def lack(*_, **__):
    raise MemoryError(WHAT)


def only_fault(refused):
    (diagnostic,) = refused.value.diagnostics
    assert WHAT in diagnostic.found
    return diagnostic.code


@pytest.mark.parametrize("call", CALLS)
@pytest.mark.parametrize("name", ["hexapod_pmac", "hexapod_trajectory"])
def test_cam_is_given_nothing_to_write(job, tmp_path, monkeypatch, name, call):
    job.PostProcessor = name
    post = PostProcessorFactory.get_post_processor(job, name)
    monkeypatch.setattr(call, lack)
    with pytest.raises(Refused) as refused:
        post.export()
    assert only_fault(refused) == "F130"
    assert list(tmp_path.iterdir()) == []


def test_an_object_says_it_in_a_line(job, monkeypatch):
    job.PostProcessor = "hexapod_pmac"
    monkeypatch.setattr(PLACED, lack)
    reach = create_reach(job)
    job.Document.recompute()
    assert not reach.isValid()
    assert "F130" in reach.getStatusString()


def test_macros_get_a_refusal(job, tmp_path, monkeypatch):
    monkeypatch.setattr(PLACED, lack)
    with pytest.raises(Refused) as refused:
        pkm_post.post(job, out=tmp_path)
    assert only_fault(refused) == "F130"
    assert list(tmp_path.iterdir()) == []
