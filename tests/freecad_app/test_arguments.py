# SPDX-License-Identifier: LGPL-2.1-or-later
"""The arguments of a job are changed one by one and kept by the job."""

import pytest
from cam_jobs import add_operation
from Path.Post.Processor import PostProcessorFactory

from pkm_post.freecad_app.arguments import job_arguments, own_text, parse_arguments, replace_arguments, store_in_job
from pkm_post.freecad_app.post_job import post_job
from pkm_post.model import Place, Refused
from pkm_post.options import options_from, tool_lengths_from

TEXT = "--machine 'my machine.toml' --work-offset=-10,0,150 --tool-length 1=120 --keep-chip-load --tool-length 2=80"


def understood(text):
    return {name: value for name, value in vars(parse_arguments(text, Place("job"))).items() if name != "given"}


def test_nothing_chosen_leaves_the_meaning():
    assert understood(replace_arguments(TEXT, {})) == understood(TEXT)


@pytest.mark.parametrize(
    ("flag", "value", "meaning"),
    [
        ("--machine", "a b.toml", {"machine": "a b.toml"}),
        ("--work-offset", "-1,2,3", {"work_offset": (-1.0, 2.0, 3.0, 0.0)}),
        ("--spin", "optimise=joints", {"spin": ("optimise", 0.0, "joints")}),
        ("--also", "csv,linuxcnc", {"also": ("csv", "linuxcnc")}),
        ("--work-offset", None, {"work_offset": "job"}),
        ("--tool-length", "1=60", {"tool_length": [(1, 60.0)]}),
    ],
)
def test_one_is_set_anew_and_the_others_stay(flag, value, meaning):
    once = replace_arguments(TEXT, {flag: value})
    assert understood(once) == understood(TEXT) | meaning
    assert replace_arguments(once, {flag: value}) == once


def test_what_only_another_post_processor_understands_is_left_out(job):
    job.PostProcessor, job.PostProcessorArgs = "hexapod_gcode", "--form AC --inch --tip-tolerance 0.01"
    assert understood(own_text(job)) == understood("--tip-tolerance 0.01")
    job.PostProcessor, job.PostProcessorArgs = "linuxcnc", "--no-header"
    assert own_text(job) == ""


def test_a_quote_that_does_not_close_is_left_to_who_reads_it(job):
    job.PostProcessor, job.PostProcessorArgs = "hexapod_pmac", "--machine 'my machine.toml"
    assert own_text(job) == job.PostProcessorArgs


def test_cutters_of_part_programs_are_none_of_a_job(job):
    add_operation(job)
    assert parse_arguments("--tool 1=10,5", Place("part.ngc")).tools == [(1, (10.0, 5.0))]
    with pytest.raises(Refused) as refused:
        job_arguments(job, "--tool 1=10,5")
    assert [fault.code for fault in refused.value.diagnostics] == ["J117"]


def test_cam_posts_what_the_job_remembers(job, tmp_path):
    add_operation(job)
    job.PostProcessor, text = "linuxcnc", "--work-offset=0,0,250 --tip-tolerance=0.01"
    chosen = parse_arguments(text, Place("job"))
    posted = post_job(job, chosen.machine, tmp_path / "ours", options_from(chosen), tool_lengths_from(chosen))
    (tmp_path / "cams").mkdir()
    store_in_job(job, text, str(tmp_path / "cams" / posted.program.name))
    ((_, program),) = PostProcessorFactory.get_post_processor(job, job.PostProcessor).export()
    assert program.encode() == posted.program.read_bytes()
    assert (tmp_path / "cams" / f"{posted.program.stem}.pkmt").is_file()
