# SPDX-License-Identifier: LGPL-2.1-or-later
"""No result takes the place of another one or of a source; the names are those that posting writes."""

import random
import zipfile
from pathlib import Path

import pytest

from pkm_post.cli import main, parallel, post
from pkm_post.options import SIDE_OUTPUTS
from pkm_post.options.result_names import (
    _POSSIBLE,
    PostItem,
    job_stem,
    overwritten_sources,
    result_conflicts,
    result_names,
)
from pkm_post.system import result_files
from pkm_post.writing.controllers import CONTROLLERS, TABLES, power_pmac

PART = "G21 G90 G17\nT1 M6\nS5000 M3\nG0 X0 Y0 Z300\nG1 X10 F600\nM5\nM30\n"
OUT = Path("out")


@pytest.fixture
def part(tmp_path):
    file = tmp_path / "part.ngc"
    file.write_text(PART, encoding="ascii")
    return file


@pytest.mark.slow
def test_everything_that_is_written_is_named(part, tmp_path):
    out = tmp_path / "out"
    assert main(["post", str(part), "--out", str(out), "--tool-length", "1=120", "--also", ",".join(SIDE_OUTPUTS)]) == 0
    written = {path.name for path in out.iterdir()}
    named = set(result_names(PostItem("part.ngc", "part")))
    assert named - written == {"part" + power_pmac.SETUP_SUFFIX}
    assert written <= named


def test_every_side_output_and_controller_has_its_ending():
    assert set(TABLES) < set(result_files.SIDE_OUTPUTS)
    assert set(CONTROLLERS) == set(result_files.SETUPS)


def lost(files, out=OUT, also=SIDE_OUTPUTS):
    """What posting these would lose, as the command line asks for it."""
    files = list(map(Path, files))
    items = [item for file in files for item in post.items_of(file, None, also)]
    return [*result_conflicts(items), *overwritten_sources(files, items, out)]


LOST = {
    "case": (["x/Part.ngc", "y/part.cls"], "x/Part.ngc and y/part.cls would both be posted as part.pmc"),
    "set-up": (["job.ngc", "job-setup.ngc"], "job.ngc and job-setup.ngc would both be posted as job-setup.pmc"),
    "document": (["my part.FCStd", "my_part.cls"], "my part.FCStd and my_part.cls would both be posted as my_part.pmc"),
    "part": (["j-part12.ngc", "j.ngc"], "j-part12.ngc would be posted as j-part12.pmc, as would a part of j.ngc"),
    "source": (["out/a.ngc", "out/a-linuxcnc.ngc"], "out/a-linuxcnc.ngc would be replaced by a result of out/a.ngc"),
}  # fmt: skip


@pytest.mark.parametrize(("files", "reported"), LOST.values(), ids=LOST)
def test_what_would_be_lost_is_reported(files, reported):
    assert lost(files) == [reported]


@pytest.mark.parametrize(
    "files",
    [
        ["a.ngc", "b.cls", "c.FCStd"],
        ["job.ngc", "job-report.ngc", "job-linuxcnc.ngc", "job-halstreamer.ngc"],
        ["job-part2.ngc", "job-part3.ngc"],
        ["job.ngc", "job-partner.ngc", "job-setup-part2.ngc"],
    ],
)
def test_what_lies_beside_each_other_can_be_posted_together(files):
    assert lost(files) == []


def test_a_source_is_replaced_by_what_is_asked_for_alone():
    files = ["out/a.ngc", "out/a-linuxcnc.ngc"]
    assert lost(files, also=["csv"]) == []
    assert lost(files, out=Path("elsewhere")) == []


def test_nothing_is_posted_when_something_would_be_lost(part, tmp_path, capsys):
    other = part.with_name("part-setup.ngc")
    other.write_text(PART, encoding="ascii")
    assert main(["post", str(part), str(other), "--out", str(tmp_path / "out")]) == 2
    errors = capsys.readouterr().err
    assert "error F105: results of two jobs would have the same name: " in errors
    assert "would both be posted as part-setup.pmc; " in errors and "or post to different folders" in errors
    assert not (tmp_path / "out").exists()


def test_a_process_of_its_own_has_one_file_also_after_two_dashes(part, monkeypatch, capsys):
    other = part.with_name("other.ngc")
    other.write_text(PART, encoding="ascii")
    started = []
    monkeypatch.setattr(
        parallel, "run_parallel", lambda commands, at_a_time, doing, files: started.extend(commands) or 1
    )
    assert main(["post", "--jobs", "2", "--", str(part), str(other)]) == 1
    for number, command in enumerate(started):
        assert command[command.index("post") :] == [
            "post", f"--only={number}", "--jobs", "2", "--", str(part), str(other),
        ]  # fmt: skip
    assert len(started) == 2
    assert main(["post", "--only=2", str(part), str(other)]) == 2
    assert "--only: error U103: an argument is not valid: expected a number below 2, got 2" in capsys.readouterr().err
    with pytest.raises(SystemExit) as ended:
        main(["post", "--only=-1", str(part)])
    assert ended.value.code == 2


JOBS = [("Job", "Op 1"), ("Job001", "Op_1"), ("Job002", "Other")]


def document(path, jobs):
    """A FreeCAD document as far as its jobs are concerned, laid out as FreeCAD 1.0 writes them."""
    objects = "".join(
        f'<Object name="{name}"><Properties Count="2"><Property name="Label" type="App::PropertyString">'
        f'<String value="{label}"/></Property><Property name="Proxy" type="App::PropertyPythonObject">'
        '<Python value="bnVsbA==" encoded="yes" module="Path.Main.Job" class="ObjectJob"/>'
        "</Property></Properties></Object>"
        for name, label in jobs
    )
    count, listed = f'Count="{len(jobs)}"', "".join(f'<Object name="{name}"/>' for name, _ in jobs)
    lists = f"<Objects {count}>{listed}</Objects><ObjectData {count}>{objects}</ObjectData>"
    with zipfile.ZipFile(path, "w") as container:
        container.writestr("Document.xml", f"<Document>{lists}</Document>")
    return path


def test_jobs_of_documents_are_counted_in_a_batch(tmp_path, capsys):
    several = document(tmp_path / "a.FCStd", JOBS[1:])
    (tmp_path / "A-other.ngc").write_text(PART, encoding="ascii")
    assert main(["post", str(several), str(tmp_path / "A-other.ngc"), "--out", str(tmp_path / "out")]) == 2
    errors = capsys.readouterr().err
    assert "error F105: results of two jobs would have the same name: " in errors
    assert "would both be posted as A-other.pmc; " in errors and "or post to different folders" in errors
    assert not (tmp_path / "out").exists()


def test_two_jobs_of_a_document_with_one_name_are_reported(tmp_path, capsys):
    file = document(tmp_path / "a.FCStd", JOBS)
    assert main(["post", str(file), "--out", str(tmp_path / "out")]) == 2
    assert f"Op 1 of {file} and Op_1 of {file} would both be posted as a-Op_1.pmc" in capsys.readouterr().err


@pytest.mark.parametrize("seed", range(50))
def test_whatever_is_not_refused_has_names_of_its_own(seed):
    """Second opinion: all names that can be written, parts as well, as a file system that knows no case sees them."""
    chance = random.Random(seed)
    labels = ["".join(chance.choices(["a", "A", "_", " ", "-part2", "-setup", "-report", "1"], k=3)) for _ in range(4)]
    items = [PostItem(label, job_stem("d", label, 4)) for label in labels]
    written = []
    for item in items:
        names = {f"{item.stem}{ending}" for ending in (*_POSSIBLE, *result_files.SIDE_OUTPUTS.values())}
        names |= {f"{item.stem}-part{n}{e}" for n in (2, 3) for e in (".pmc",)}
        names |= {f"{item.stem}-halstreamer-part{n}.txt" for n in (2, 3)}
        written += [name.lower() for name in names]
    assert bool(result_conflicts(items)) == (len(set(written)) < len(written))
