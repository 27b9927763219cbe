# SPDX-License-Identifier: LGPL-2.1-or-later
"""Trajectories, programs for LinuxCNC and G-code by CAM's own post command."""

import FreeCAD as App
import numpy as np
import pytest
from cam_jobs import add_operation, new_job
from Path.Post.Processor import PostProcessorFactory

from pkm_post.freecad_app.job import read_job
from pkm_post.freecad_app.job_setup import study_job
from pkm_post.freecad_app.post_job import post_job
from pkm_post.model import Refused
from pkm_post.reading import gcode
from pkm_post.writing import trajectory_file


@pytest.fixture
def job(document, tmp_path):
    job = new_job(document)
    job.PostProcessorOutputFile = str(tmp_path / "made (by cam).ngc")
    job.PostProcessorArgs = "--work-offset=0,0,250"
    add_operation(job)
    return job


def exported(job, name):
    job.PostProcessor = name
    ((part, text),) = PostProcessorFactory.get_post_processor(job, name).export()
    assert part == "allitems"
    return text


def refused(job, name):
    job.PostProcessor = name
    with pytest.raises(Refused) as refusal:
        PostProcessorFactory.get_post_processor(job, name).export()
    return [fault.code for fault in refusal.value.diagnostics]


def test_trajectory_is_written_beside_a_text_that_names_it(job, tmp_path):
    text = exported(job, "hexapod_trajectory")
    assert text.splitlines()[0] == "(trajectory: made [by cam].pkmt)"
    assert {path.name for path in tmp_path.iterdir()} == {"made (by cam)-manifest.json", "made (by cam).pkmt"}
    trajectory, faults = trajectory_file.read(tmp_path / "made (by cam).pkmt")
    assert faults == ()
    assert f"(segments: {len(trajectory)})" in text
    program, _ = read_job(job)
    assert trajectory.tip == pytest.approx(program.position + [0, 0, 250], abs=1e-9)  # mm; a shift and no turn


def test_results_that_are_beside_another_trajectory_are_reported(job, tmp_path, monkeypatch):
    exported(job, "hexapod_pmac")
    reported = []
    monkeypatch.setattr(App.Console, "PrintWarning", reported.append)
    exported(job, "hexapod_trajectory")
    (warning,) = [line for line in reported if "F104" in line]
    assert "made (by cam)-report.html, made (by cam)-report.json, made (by cam)-setup.pmc;" in warning


def test_text_that_names_the_trajectory_is_a_legal_program(job):
    program, faults = gcode.read(exported(job, "hexapod_trajectory"), "text", gcode.ReadOptions())
    assert {fault.code[0] for fault in faults} <= {"G"}
    assert not any(fault.code.startswith(("G1", "G2")) for fault in faults)


def test_linuxcnc_gets_the_tips_in_the_machine_frame(job, tmp_path):
    text = exported(job, "hexapod_linuxcnc")
    program, faults = gcode.read(text, "text", gcode.ReadOptions(axis_words="RPY", tools=read_job(job)[0].tools))
    assert program is not None, faults
    wanted, _ = read_job(job)
    assert program.position == pytest.approx(wanted.position + [0, 0, 250], abs=1e-4)  # mm, its decimals
    assert np.abs(program.tool_axis - wanted.tool_axis).max() < 1e-7
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("form", ["vector", "AC", "BC"])
def test_gcode_says_the_program_of_the_job(job, form):
    job.PostProcessorArgs += f" --form {form}"
    text = exported(job, "hexapod_gcode")
    program, faults = gcode.read(text, "text", gcode.ReadOptions(axis_words=form, tools=read_job(job)[0].tools))
    assert program is not None, faults
    wanted, _ = read_job(job)
    assert program.position == pytest.approx(wanted.position, abs=1e-4)
    assert np.abs(program.tool_axis - wanted.tool_axis).max() < 2e-6


def test_gcode_in_inches(job):
    job.PostProcessorArgs = "--inch"
    assert "G20" in exported(job, "hexapod_gcode")


def test_what_a_form_cannot_say_is_refused(job):
    job.PostProcessorArgs = "--form 3axis"
    assert refused(job, "hexapod_gcode") == ["G501"]


@pytest.mark.parametrize("name", ["hexapod_trajectory", "hexapod_linuxcnc"])
def test_out_of_reach_is_refused_and_nothing_is_written(job, tmp_path, name):
    job.PostProcessorArgs = "--work-offset=900,0,200"
    assert all(code.startswith("K1") for code in refused(job, name))
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("name", ["hexapod_trajectory", "hexapod_linuxcnc", "hexapod_gcode"])
def test_what_has_no_meaning_is_refused(job, name):
    job.PostProcessorArgs = "--also csv"
    assert refused(job, name) == ["J117"]
    job.PostProcessorArgs = "--from vector"
    assert refused(job, name) == ["J117"]


def test_arguments_of_every_post_processor_are_understood_elsewhere(job, tmp_path):
    job.PostProcessor = "hexapod_gcode"
    job.PostProcessorArgs = "--form AC --work-offset=0,0,250"
    assert study_job(job).machine_from_work[2, 3] == 250
    assert post_job(job, out=tmp_path / "out").report["certificate"]["holds"]
