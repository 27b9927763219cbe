# SPDX-License-Identifier: LGPL-2.1-or-later
"""A list of files is posted by any executor to the same bytes, and goes on where it was interrupted."""

import csv
import sys
from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor

import pytest

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


@pytest.fixture
def jobs(tmp_path):
    for name, x in (("a.ngc", 5), ("b.ngc", 8)):
        (tmp_path / name).write_text(G_CODE.format(x=x))
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


class AtOnce(Executor):
    """An executor that does the work when it is submitted."""

    def submit(self, function, /, *arguments, **more):
        future = Future()
        future.set_result(function(*arguments, **more))
        return future


def contents(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def test_the_bytes_are_those_of_any_executor_and_of_posting(jobs, tmp_path):
    tables, results = [], []
    # Python starts the processes of a pool with the running program, which in FreeCAD is FreeCAD.
    pool = ThreadPoolExecutor(2) if "FreeCAD" in sys.modules else ProcessPoolExecutor(2)
    for executor in (AtOnce(), pool):
        with executor:
            rows = run_batch(jobs, executor, 2)
        assert [row.state for row in rows] == ["posted", "posted"], rows
        tables.append((tmp_path / "jobs-results.csv").read_bytes())
        results.append(contents(tmp_path / "results"))
        for path in (tmp_path / "results").iterdir():
            path.unlink()
    assert tables[0] == tables[1]
    assert results[0] == results[1]
    words = ["post", str(tmp_path / "a.ngc"), "--tool-length", "1=120", "--work-offset=0,0,250"]
    assert main([*words, "--out", str(tmp_path / "alone")]) == 0
    assert {name: results[0][name] for name in contents(tmp_path / "alone")} == contents(tmp_path / "alone")


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


def test_a_refused_file_stops_no_other_and_is_in_the_table(jobs, tmp_path, monkeypatch, posted_files):
    monkeypatch.setenv("PKM_THREADS", "6")
    (tmp_path / "a.ngc").write_text("G21 G90\nG1 X1\nM30\n")
    with ThreadPoolExecutor(2) as pool:
        rows = run_batch(jobs, pool, 2)
    assert [(row.file, row.state) for row in rows] == [("a.ngc", "refused"), ("b.ngc", "posted")]
    assert "a.ngc: line 1:1: error G420" in rows[0].messages
    assert {variables["PKM_THREADS"] for _, variables in posted_files} == {"3"}
    assert main(["batch", str(jobs)]) == 1


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("", "at least one job"),
        ("jobs = 1", "at least one job"),
        ("[[jobs]]\nname = 'a.ngc'", "expected a job with file"),
        ("[[jobs]]\nfile = 1", "file: expected a text"),
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
