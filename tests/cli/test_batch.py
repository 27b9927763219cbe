# SPDX-License-Identifier: LGPL-2.1-or-later
"""A list of files is posted by any executor to the same bytes, and goes on where it was interrupted."""

import csv
import re
import zipfile
from concurrent.futures import ThreadPoolExecutor

import pytest
from executors import EXECUTORS, AtOnce

from pkm_post.cli import batch as batch_command
from pkm_post.cli import main, run_batch
from pkm_post.model import Refused

G_CODE = "G21 G90\nT1 M6\nS8000 M3\nG0 X0 Y0 Z30\nG1 X{x} Y5 Z20 F600\nM5\nM30\n"
LIST = """
out = "results"
arguments = "--tool-length 1=120 --work-offset=0,0,250"
[[jobs]]
file = "a.ngc"
[[jobs]]
file = "b.ngc"
arguments = "--tip-tolerance 0.002"
"""


def write_programs(folder):
    for name, x in (("a.ngc", 5), ("b.ngc", 8)):
        (folder / name).write_text(G_CODE.format(x=x))


@pytest.fixture
def jobs(tmp_path):
    write_programs(tmp_path)
    (tmp_path / "jobs.toml").write_text(LIST)
    return tmp_path / "jobs.toml"


@pytest.fixture
def posted_files(monkeypatch):
    """Names of the files that are posted, with the variables of their processes."""
    posted, post_one = [], batch_command.post_one
    monkeypatch.setattr(
        batch_command,
        "post_one",
        lambda job, variables: posted.append((job.file, variables)) or post_one(job, variables),
    )
    return posted


def contents(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir()}


@pytest.fixture(scope="module")
def posted_alone(tmp_path_factory):
    """A folder with both files, and in ``alone`` what posting writes of each by itself; reports name the folder."""
    folder = tmp_path_factory.mktemp("batch")
    write_programs(folder)
    for file, more in (("a.ngc", []), ("b.ngc", ["--tip-tolerance", "0.002"])):
        words = ["post", str(folder / file), "--tool-length", "1=120", "--work-offset=0,0,250", *more]
        assert main([*words, "--out", str(folder / "alone")]) == 0
    return folder


@pytest.mark.slow
@pytest.mark.parametrize("name", EXECUTORS)
def test_the_bytes_are_those_of_any_executor_and_of_posting(posted_alone, name):
    jobs = posted_alone / f"{name}.toml"
    jobs.write_text(LIST.replace("results", f"by {name}"))
    with EXECUTORS[name]() as executor:
        rows = run_batch(jobs, executor, 2)
    assert [(row.file, row.state, row.programs) for row in rows] == [
        ("a.ngc", "posted", "a.pmc"),
        ("b.ngc", "posted", "b.pmc"),
    ]
    assert contents(posted_alone / f"by {name}") == contents(posted_alone / "alone")


@pytest.mark.slow
def test_it_goes_on_where_it_was_interrupted(jobs, tmp_path, posted_files, capsys):
    def stop(name, share):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run_batch(jobs, AtOnce(), progress=stop)
    (row,) = csv.DictReader((tmp_path / "jobs-results.csv").read_text().splitlines())
    assert row["programs"] == row["file"].replace(".ngc", ".pmc")
    posted_files.clear()
    assert main(["batch", str(jobs), "--jobs", "1"]) == 0
    assert [name for name, _ in posted_files] == [{"a.ngc": "b.ngc", "b.ngc": "a.ngc"}[row["file"]]]
    posted_files.clear()
    (tmp_path / "results" / "a.pmc").write_text("changed")
    (tmp_path / "b.ngc").write_text(G_CODE.format(x=9))
    assert main(["batch", str(jobs), "--jobs", "1"]) == 0
    assert sorted(name for name, _ in posted_files) == ["a.ngc", "b.ngc"]
    posted_files.clear()
    assert main(["batch", str(jobs)]) == 0
    assert posted_files == []
    assert "posted: a.ngc" in capsys.readouterr().out


@pytest.mark.slow
def test_a_changed_subprogram_is_posted_again_and_a_program_named_setup_is_in_the_table(tmp_path, posted_files):
    """The subprogram is beside the program, then in a folder that is searched first."""
    subprogram, folder = "O1234\nG1 X{x}. Y5. Z20. F600\nG0 Z30.\nM99\n", tmp_path / "sub"
    folder.mkdir()
    (tmp_path / "a-setup.ngc").write_text("G21 G90\nT1 M6\nS8000 M3\nG0 X0. Y0. Z30.\nM98 P1234\nM5\nM30\n")
    words = f"--tool-length 1=120 --work-offset=0,0,250 --flavour fanuc --subprograms={folder.as_posix()}"
    (tmp_path / "jobs.toml").write_text(f"arguments = '{words}'\n[[jobs]]\nfile = 'a-setup.ngc'\n")
    posted = []
    for path, x in ((tmp_path, 5), (tmp_path, 9), (folder, 7)):
        (path / "O1234.ngc").write_text(subprogram.format(x=x))
        for _ in range(2):
            posted_files.clear()
            (row,) = run_batch(tmp_path / "jobs.toml", AtOnce())
            assert (row.state, row.programs) == ("posted", "a-setup.pmc")
            posted.append((len(posted_files), (tmp_path / "a-setup.pmc").read_text()))
    assert [times for times, _ in posted] == [1, 0, 1, 0, 1, 0]
    assert len({text for _, text in posted}) == 3


def test_a_file_that_changes_while_it_is_posted_is_posted_again(jobs, tmp_path, monkeypatch):
    def change(child):
        (tmp_path / "a.ngc").write_text(G_CODE.format(x=9))
        return 0, "", ""

    monkeypatch.setattr(batch_command.Child, "run", change)
    job, _ = batch_command.read_list(jobs)
    assert batch_command.post_one(job, {}).fingerprint != job.fingerprint()


DOCUMENT = """<Document><Objects Count="1"><Object type="Path::FeaturePython" name="Job"/></Objects>
<ObjectData Count="1"><Object name="Job"><Properties>
<Property name="PostProcessorArgs"><String value="{}"/></Property>
<Property name="Proxy"><Python module="Path.Main.Job" class="ObjectJob"/></Property>
</Properties></Object></ObjectData></Document>"""


@pytest.mark.parametrize("changed", ["shop.toml", "shop.fctl", "Bit/end.fctb", "part.stl"])
@pytest.mark.parametrize("job", ["part.FCStd", "a.ngc"])
def test_a_file_that_another_input_names_is_an_input(tmp_path, monkeypatch, job, changed):
    """The job of a document names its machine file, that its tool table, and that its bits."""
    words = "--machine shop.toml --part part.stl,mm"
    with zipfile.ZipFile(tmp_path / "part.FCStd", "w") as archive:
        archive.writestr("Document.xml", DOCUMENT.format(words))
    write_programs(tmp_path)
    (tmp_path / "Bit").mkdir()
    (tmp_path / "shop.toml").write_text("[part_programs]\ntool_table = 'shop.fctl'\n")
    (tmp_path / "shop.fctl").write_text('{"tools": [{"nr": 1, "path": "end.fctb"}]}')
    for name in ("Bit/end.fctb", "part.stl"):
        (tmp_path / name).write_text("{}")
    (tmp_path / "jobs.toml").write_text(
        f"arguments = '{'' if job == 'part.FCStd' else words}'\n[[jobs]]\nfile = '{job}'"
    )
    monkeypatch.chdir(tmp_path)
    (one,) = batch_command.read_list(tmp_path / "jobs.toml")
    before = one.fingerprint()
    assert one.fingerprint() == before
    (tmp_path / changed).write_text((tmp_path / changed).read_text() + " ")
    assert one.fingerprint() != before


@pytest.mark.slow
def test_a_refused_file_stops_no_other_and_is_in_the_table(jobs, tmp_path, monkeypatch, posted_files):
    monkeypatch.setenv("PKM_THREADS", "6")
    (tmp_path / "a.ngc").write_text("G21 G90\nG1 X1\nM30\n")
    with ThreadPoolExecutor(2) as pool:
        rows = run_batch(jobs, pool, 2)
    assert [(row.file, row.state) for row in rows] == [("a.ngc", "refused"), ("b.ngc", "posted")]
    assert "a.ngc: line 2:1: error G436" in rows[0].messages
    assert {variables["PKM_THREADS"] for _, variables in posted_files} == {"3"}
    assert main(["batch", str(jobs)]) == 1


def test_a_list_may_begin_with_a_byte_order_mark(jobs):
    jobs.write_bytes(b"\xef\xbb\xbf" + jobs.read_bytes())
    assert [job.file for job in batch_command.read_list(jobs)] == ["a.ngc", "b.ngc"]


@pytest.mark.parametrize(("exists", "found"), [(False, "there is no such file"), (True, "Permission denied")])
def test_a_document_without_a_freecad_that_starts_is_a_refused_row(jobs, tmp_path, monkeypatch, exists, found):
    freecad = tmp_path / "freecadcmd"
    if exists:
        freecad.touch()
    monkeypatch.setenv("FREECADCMD", str(freecad))
    (tmp_path / "part.FCStd").touch()
    jobs.write_text("[[jobs]]\nfile = 'part.FCStd'\n")
    (row,) = run_batch(jobs, AtOnce())
    assert row.state == "refused" and "error F140: FreeCAD could not be started: " in row.messages
    assert found in row.messages


def test_a_table_that_cannot_be_read_is_written_again(jobs, monkeypatch):
    monkeypatch.setattr(batch_command.Child, "run", lambda child: (1, "", "refused"))
    table = batch_command.table_of(jobs)
    table.write_text("file\n" + "x" * (csv.field_size_limit() + 1) + "\n")
    rows = run_batch(jobs, AtOnce())
    assert [row.file for row in rows] == ["a.ngc", "b.ngc"]
    assert table.read_text().startswith("file,job,state")


JOBS = "[[jobs]]\nfile = '{}'\narguments = '{}'\n[[jobs]]\nfile = '{}'\n"


@pytest.mark.parametrize(
    ("text", "found"),
    [
        (JOBS.format("a.ngc", "--also csv,linuxcnc", "a-linuxcnc.ngc"), "a-linuxcnc.ngc would be replaced by a result"),
        (JOBS.format("a.ngc", "--also=cartesian", "a-tip.ngc"), "would both be posted as a-tip.pmc"),
        (JOBS.format("jobs-results.ngc", "--also csv", "a.ngc"), "jobs-results.csv would be replaced by a result"),
    ],
)
def test_no_job_replaces_a_source_a_result_of_another_one_or_the_table(jobs, text, found):
    """The law of `post`, F105 and F120."""
    jobs.write_text(text)
    with pytest.raises(Refused, match="F116") as refused:
        batch_command.read_list(jobs)
    assert found in str(refused.value)
    jobs.write_text(re.sub("--also[ =][a-z,]+", "", text))
    assert len(batch_command.read_list(jobs)) == 2


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("", "at least one job"),
        ("jobs = 1", "at least one job"),
        ("[[jobs]]\nname = 'a.ngc'", "expected a job with file"),
        ("[[jobs]]\nfile = 1", "file: expected a text"),
        ('[[jobs]]\nfile = "a\\u0000.ngc"', "file: expected a text without the character NUL"),
        ('[[jobs]]\nfile = "a.ngc"\narguments = "--part \\u0000.stl"', "arguments: expected a text without"),
        ("[[jobs]]\nfile = 'a.ngc'\n[[jobs]]\nfile = 'sub/A.ngc'", "would both be posted as"),
        ("speed = 3\n[[jobs]]\nfile = 'a.ngc'", "expected arguments, jobs, out"),
        ("[[jobs", "array declaration"),
    ],
)
def test_a_list_that_is_not_valid_is_refused(jobs, text, found, capsys):
    jobs.write_text(text)
    with pytest.raises(Refused) as refusal:
        run_batch(jobs, AtOnce())
    ((code, said),) = [(fault.code, fault.found) for fault in refusal.value.diagnostics]
    assert code == "F116" and found in said
    assert main(["batch", str(jobs)]) == 1
    assert "error F116" in capsys.readouterr().err
    assert main(["batch", str(jobs.parent)]) == 1
    assert "error F103" in capsys.readouterr().err
