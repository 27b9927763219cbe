# SPDX-License-Identifier: LGPL-2.1-or-later
"""Jobs and documents are posted or refused as a whole, from Python and by CAM's own post command."""

import dataclasses
import os
import re
from pathlib import Path as FilePath

import FreeCAD as App
import Path.Main.Job
import pytest
from cam_jobs import FIVE_AXIS, add_operation, new_job, reopened
from Path.Post.Processor import PostProcessorFactory
from Path.Post.Utils import FilenameGenerator

import pkm_post
from pkm_post.cli import main
from pkm_post.freecad_app.arguments import job_arguments
from pkm_post.freecad_app.document import job_of
from pkm_post.freecad_app.post_job import find_job, find_jobs, post_document, post_job
from pkm_post.freecad_app.progress import Progress, Stopped
from pkm_post.freecad_app.symmetry import create_mirror
from pkm_post.machine import find_machine
from pkm_post.model import Refused
from pkm_post.options.choices import Options
from pkm_post.system import read_document
from pkm_post.writing import manifest

MACHINE = "example_6tps"
AT_FIXTURE = Options(work_offset="job")


@pytest.fixture
def ready(job):
    add_operation(job)
    return job


def refusal(call, *arguments, **more):
    with pytest.raises(Refused) as refused:
        call(*arguments, **more)
    return [fault.code for fault in refused.value.diagnostics]


def test_posted_files_are_named_after_the_document(ready, tmp_path):
    ready.Document.saveAs(str(tmp_path / "my part.FCStd"))
    posted = post_job(ready, MACHINE, tmp_path / "out", AT_FIXTURE)
    assert posted.program == tmp_path / "out" / "my_part.pmc"
    assert posted.program in posted.files
    assert all(path.stem.startswith("my_part") and path.stat().st_size for path in posted.files)


def test_posting_twice_gives_the_same_bytes(ready, tmp_path):
    first = {path.name: path.read_bytes() for path in post_job(ready, MACHINE, tmp_path, AT_FIXTURE).files}
    second = {path.name: path.read_bytes() for path in post_job(ready, MACHINE, tmp_path, AT_FIXTURE).files}
    assert first == second


def test_posting_before_and_after_saving_gives_the_same_bytes(job, tmp_path):
    """FreeCAD saves a path with six decimals."""
    add_operation(job, ["G0 X0 Y0 Z30", "G1 Z5.0078125 F20", "G1 X3.14159265358979 Y4 F7.7777777", "G0 Z30"])
    job.Document.saveAs(str(tmp_path / "part.FCStd"))
    made = [path.read_bytes() for path in post_job(job, MACHINE, tmp_path / "made", AT_FIXTURE).files]
    again = reopened(job.Document, tmp_path / "part.FCStd").getObject("Job")
    assert made == [path.read_bytes() for path in post_job(again, MACHINE, tmp_path / "stored", AT_FIXTURE).files]


def test_document_is_brought_up_to_date_first(ready, tmp_path):
    operation = ready.Operations.Group[0]
    copy = create_mirror(operation, (0, 1, 0))
    operation.Gcode = [*FIVE_AXIS, "G0 Z40"]
    posted = post_job(ready, MACHINE, tmp_path, AT_FIXTURE)
    assert len(copy.Path.Commands) == 5
    assert {fault.code for fault in posted.diagnostics} == {"K132"}  # the box that is cut is the part as well


def test_log_tells_the_steps(ready, tmp_path):
    lines = []
    post_job(ready, MACHINE, tmp_path, AT_FIXTURE, log=lines.append)
    assert any(line.startswith("certificate") for line in lines)


def test_work_offset_is_the_fixture_of_the_job(ready, tmp_path):
    ready.Fixtures = ["G59"]
    assert refusal(post_job, ready, MACHINE, tmp_path) == ["K108"]
    assert refusal(post_job, ready, MACHINE, tmp_path, AT_FIXTURE) == ["K108"]
    assert list(tmp_path.iterdir()) == []
    assert post_job(ready, MACHINE, tmp_path, dataclasses.replace(AT_FIXTURE, work_offset="G54")).files


def test_faults_of_job_and_machine_are_reported_together_and_nothing_is_written(ready, tmp_path):
    ready.Tools.Group[0].GaugeLength = 0
    assert refusal(post_job, ready, "no_such_machine", tmp_path / "out") == ["M101", "J113"]
    assert not (tmp_path / "out").exists()


def test_warnings_of_the_job_are_handed_on(job, tmp_path):
    add_operation(job, ["G0 X0 Y0 Z30", "G1 X1 I0 J0 K2 F10"])
    assert [fault.code for fault in post_job(job, MACHINE, tmp_path, AT_FIXTURE).diagnostics] == ["J118"]


def test_warnings_of_the_job_are_reported_when_it_is_refused(job, tmp_path):
    add_operation(job, ["G0 X0 Y0 Z30", "G1 X1000 I0 J0 K2 F10"])
    codes = refusal(post_job, job, MACHINE, tmp_path, AT_FIXTURE)
    assert codes[0] == "J118"
    assert codes[1].startswith("K")


def test_gauge_length_by_tool_number(ready, tmp_path):
    ready.Tools.Group[0].GaugeLength = 0
    assert post_job(ready, MACHINE, tmp_path, AT_FIXTURE, tool_lengths={1: 120.0}).files


# Documents


def saved(document, folder):
    path = folder / "part.FCStd"
    document.saveAs(str(path))
    App.closeDocument(document.Name)
    return path


def test_document_is_opened_posted_and_closed(ready, tmp_path):
    path = saved(ready.Document, tmp_path)
    before = path.read_bytes()
    (posted,) = post_document(path, MACHINE, tmp_path / "out", AT_FIXTURE)
    assert posted.program.name == "part.pmc"
    assert App.listDocuments() == {}
    assert path.read_bytes() == before


def test_open_document_stays_open(ready, tmp_path):
    ready.Document.saveAs(str(tmp_path / "part.FCStd"))
    post_document(tmp_path / "part.FCStd", MACHINE, tmp_path, AT_FIXTURE)
    assert ready.Document.Name in App.listDocuments()


def test_all_jobs_of_a_document_or_one_of_them(ready, tmp_path):
    second = Path.Main.Job.Create("Second", [ready.Model.Group[0]], None)
    second.Label = "Other side"
    second.Operations.Group = []
    path = saved(ready.Document, tmp_path)
    assert refusal(post_document, path, MACHINE, tmp_path, AT_FIXTURE)[-1] == "J103"  # the second has no operations
    (posted,) = post_document(path, MACHINE, tmp_path, AT_FIXTURE, job_name="Job")
    assert posted.program.name == "part-Job.pmc"
    assert refusal(post_document, path, MACHINE, tmp_path, AT_FIXTURE, job_name="Other side") == ["J103"]
    assert refusal(post_document, path, MACHINE, tmp_path, AT_FIXTURE, job_name="Third") == ["J102"]


@pytest.mark.parametrize(
    ("label", "other"), [("Op 1", "Op_1"), ("Side", "SIDE"), ("Side", "Side-setup"), ("A", "A-part2")]
)
def test_jobs_whose_results_would_have_one_name_are_refused_at_every_door(ready, tmp_path, label, other, capsys):
    second = new_job(ready.Document)
    add_operation(second)
    ready.Label, second.Label = label, other
    assert refusal(post_job, ready, MACHINE, tmp_path / "out", AT_FIXTURE) == ["F105"]
    assert refusal(post_job, second, out=tmp_path / "out") == ["F105"]
    path = saved(ready.Document, tmp_path)
    assert [(job.name, job.label) for job in read_document(path).jobs] == [("Job", label), ("Job001", other)]
    assert refusal(post_document, path, MACHINE, tmp_path / "out", AT_FIXTURE) == ["F105"]
    assert main(["post", str(path), "--out", str(tmp_path / "out")]) == 2
    assert main(["post", str(path), "--job", label, "--out", str(tmp_path / "out")]) == 1
    assert "F105" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_jobs_with_names_of_their_own_are_posted_side_by_side(ready, tmp_path):
    second = new_job(ready.Document)
    add_operation(second, [*FIVE_AXIS, "G0 Z40"])
    ready.Label, second.Label = "Op 1", "Op 2"
    path = saved(ready.Document, tmp_path)
    assert main(["post", str(path), "--out", str(tmp_path / "out")]) == 0
    assert {"part-Op_1.pmc", "part-Op_2.pmc"} < {each.name for each in (tmp_path / "out").iterdir()}


def test_file_that_is_no_document(tmp_path):
    (tmp_path / "text.FCStd").write_text("no document")
    assert refusal(post_document, tmp_path / "text.FCStd", MACHINE, tmp_path) == ["J101"]
    assert refusal(post_document, tmp_path / "missing.FCStd", MACHINE, tmp_path) == ["J101"]
    odd = tmp_path / os.fsdecode(b"odd\xe9.FCStd")
    odd.write_bytes((FilePath(__file__).parents[1] / "data" / "saved" / "pkm_post-0.1.0.FCStd").read_bytes())
    assert refusal(post_document, odd, MACHINE, tmp_path) == ["J101"]


def test_document_without_a_job(document):
    assert refusal(find_job, document) == ["J102"]


def test_job_by_name_or_label(ready):
    other = new_job(ready.Document)
    other.Label = "Other"
    assert [find_job(ready.Document, name) for name in (ready.Name, "Other", other.Name)] == [ready, other, other]
    assert refusal(find_job, ready.Document) == ["J147"]
    other.Label = ready.Name
    assert find_job(ready.Document, other.Name) is other
    with pytest.raises(Refused, match=r"J147.*: Job given, the document has Own \(Job\), Job \(Job001\); name one"):
        ready.Label, other.Label = "Own", ready.Name
        find_job(ready.Document, ready.Name)


def test_link_to_a_job_is_no_second_job(ready, tmp_path):
    link = ready.Document.addObject("App::Link", "Link")
    link.LinkedObject = ready
    ready.Document.recompute()
    assert find_jobs(ready.Document) == [ready] and job_of(ready.Operations.Group[0]) == ready
    assert job_of(link) is None


# CAM's post command


@pytest.fixture
def cam_post_of(tmp_path):
    """What CAM makes to post a job, which has a place for its output, with arguments."""

    def made(job, arguments):
        job.PostProcessor = "hexapod_pmac"
        job.PostProcessorOutputFile = str(tmp_path / "made by cam.ngc")
        job.PostProcessorArgs = arguments
        return PostProcessorFactory.get_post_processor(job, "hexapod_pmac")

    return made


@pytest.fixture
def cam_post(ready, cam_post_of):
    return cam_post_of(ready, "--tip-tolerance 0.001 --axis-tolerance 0.001")


def name_by_cam(job):
    generator = FilenameGenerator(job=job)
    generator.set_subpartname("")
    return next(generator.generate_filenames())


def test_cam_gets_the_text_and_finds_the_other_files_beside(ready, cam_post, tmp_path):
    ((part, text),) = cam_post.export()
    assert part == "allitems"
    assert name_by_cam(ready) == str(tmp_path / "made by cam.ngc")
    assert (tmp_path / "made by cam.ngc").read_text(encoding="ascii") == text
    assert (tmp_path / "made by cam.pkmt").is_file()
    assert "OPEN PROG" in text


@pytest.mark.parametrize("line_end", ["\n", "\r\n"])
def test_what_cam_writes_is_what_the_manifest_lists(cam_post, tmp_path, line_end):
    ((_, text),) = cam_post.export()
    written = tmp_path / "made by cam.ngc"
    written.write_text(text, encoding="ascii", newline=line_end)  # as CAM does, on Windows with CR LF
    listed, faults = manifest.check(written)
    assert faults == () and {"made by cam.ngc", "made by cam.pkmt"} < set(listed.files)


def test_cam_writes_nothing_when_the_job_is_refused(ready, cam_post, tmp_path):
    ready.Tools.Group[0].GaugeLength = 0
    assert refusal(cam_post.export) == ["J113"]
    assert list(tmp_path.iterdir()) == []
    ready.PostProcessorArgs += " --tool-length 1=120"
    assert cam_post.export()


@pytest.mark.parametrize(
    "arguments",
    [
        "--no-such-thing",
        "--tip-tolerance",
        "--tip-tolerance -1",
        "'--machine",
        "-h",
        "--tip 1",
        "extra",
        "--tool-length 1",
    ],
)
def test_arguments_that_make_no_sense_are_a_fault_of_the_job(ready, cam_post, arguments):
    ready.PostProcessorArgs = arguments
    assert refusal(cam_post.export) == ["J117"]


def test_arguments_may_be_quoted(ready):
    assert job_arguments(ready, "--machine 'my machines/a.toml'").machine == "my machines/a.toml"


def test_arguments_for_another_post_processor_are_left_alone(ready, tmp_path):
    ready.PostProcessor = "linuxcnc"
    ready.PostProcessorArgs = "--no-show-editor"
    assert post_job(ready, out=tmp_path).files
    ready.PostProcessor = "hexapod_pmac"
    assert refusal(post_job, ready, out=tmp_path) == ["J117"]


def in_parts(folder):
    """A machine whose controller can hold a part of a small program only."""
    text = find_machine(MACHINE).read_text(encoding="utf-8")
    machine = folder / "small.toml"
    machine.write_text(re.sub(r"memory_words = \d+", "memory_words = 1000", text))
    return machine


def test_cam_gets_the_first_part_and_the_user_is_reported_of_the_others(job, cam_post_of, tmp_path, monkeypatch):
    reported = []
    monkeypatch.setattr(App.Console, "PrintMessage", reported.append)
    add_operation(job, [*FIVE_AXIS, "G4 P0.5", *FIVE_AXIS])
    ((_, text),) = cam_post_of(job, f"--machine {in_parts(tmp_path)}").export()
    others = sorted(path.name for path in tmp_path.glob("made by cam-part*"))
    assert others
    assert f"; part 1 of {len(others) + 1}" in text
    assert ", ".join(["made by cam.ngc", *others]) in "".join(reported)


def test_a_stopped_post_gives_cam_nothing(job, cam_post_of, tmp_path, monkeypatch):
    def stop(_bar):
        raise Stopped("stopped")

    add_operation(job)
    monkeypatch.setattr(Progress, "step", stop)
    assert cam_post_of(job, "").export() == []
    assert list(tmp_path.iterdir()) == []


# From macros


def test_one_call_posts_jobs_documents_and_part_programs(ready, tmp_path):
    document = tmp_path / "part.FCStd"
    ready.Document.saveAs(str(document))
    program = tmp_path / "lines.ngc"
    program.write_text("T1 M6 G43 H1\nG21 G90 G94 S8000 M3\nG0 X0 Y0 Z30\nG1 X10 F600\nM5\nM30\n")
    steps = []
    (of_job,) = pkm_post.post(ready, MACHINE, tmp_path / "job", options=AT_FIXTURE)
    (of_document,) = pkm_post.post(document, MACHINE, tmp_path / "document", job_name="Job")
    (of_program,) = pkm_post.post(
        str(program), MACHINE, tmp_path, tool_lengths={1: 60.0}, progress=lambda step, share: steps.append(step)
    )
    assert of_job.program.read_bytes() == of_document.program.read_bytes()
    assert of_program.program == tmp_path / "lines.pmc"
    assert (steps[0], steps[-2], steps[-1]) == ("reading", "report", "")
    with pytest.raises(ValueError, match="doc"):
        pkm_post.post(tmp_path / "a.doc", MACHINE, tmp_path)
