# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command line: exit codes, texts, and what is left on the disk.

What is said of a document is what ``main`` says inside FreeCAD, where the tests are; that a process of its own starts
FreeCAD for it, and hands on its paths, its text and its exit code, is tested once for each way to get there.
"""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import FreeCAD as App
import pytest

ADDON = Path(__file__).parents[2]
sys.path.insert(0, str(Path(__file__).parents[1] / "freecad_app"))

from cam_jobs import ARC, FIVE_AXIS, add_operation, new_job  # noqa: E402

from pkm_post.cli import main  # noqa: E402

REACHED = ["--work-offset=0,0,250"]


def pkm_post(*arguments, cwd=None, python="python3"):
    return subprocess.run(
        [python, "-m", "pkm_post", *map(str, arguments)],
        cwd=cwd,
        env=os.environ | {"PYTHONPATH": str(ADDON)},
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )


def saved_job(path, lines=FIVE_AXIS, **operation):
    document = App.newDocument("made")
    try:
        made = add_operation(new_job(document), lines)
        for name, value in operation.items():
            setattr(made, name, value)
        document.recompute()
        document.saveAs(str(path))
    finally:
        App.closeDocument(document.Name)
    return path


def words(*arguments):
    return [str(argument) for argument in arguments]


@pytest.fixture(scope="module")
def five_axis_job(tmp_path_factory):
    """A document that can be posted at REACHED."""
    return saved_job(tmp_path_factory.mktemp("five axis") / "part.FCStd")


@pytest.fixture
def part(five_axis_job, tmp_path):
    """A copy of it in a folder of its own."""
    return shutil.copy(five_axis_job, tmp_path)


def test_post_starts_freecad_by_itself(five_axis_job, tmp_path):
    part = shutil.copy(five_axis_job, tmp_path / "my part.FCStd")
    reported = pkm_post("post", part, "--machine", "example_6tps", "--out", tmp_path / "out dir", *REACHED)
    assert reported.returncode == 0, reported.stderr
    made = sorted(path.name for path in (tmp_path / "out dir").iterdir())
    endings = ("-manifest.json", "-report.html", "-report.json", "-setup.pmc", ".pkmt", ".pmc")
    assert made == [f"my_part{ending}" for ending in endings]
    assert [Path(line).name for line in reported.stdout.splitlines()[-6:]] == made
    assert json.loads((tmp_path / "out dir" / "my_part-report.json").read_text())["certificate"]["holds"]


def test_two_documents_in_one_call_and_relative_paths_mean_the_current_folder(five_axis_job, tmp_path):
    for name in ("a.FCStd", "b.FCStd"):
        shutil.copy(five_axis_job, tmp_path / name)
    reported = pkm_post("post", "a.FCStd", "b.FCStd", "--out", "results", *REACHED, cwd=tmp_path)
    assert reported.returncode == 0, reported.stderr
    assert {"a.pmc", "b.pmc"} <= {path.name for path in (tmp_path / "results").iterdir()}


def test_documents_in_processes_of_their_own_are_reported_in_order(five_axis_job, tmp_path):
    parts = [shutil.copy(five_axis_job, tmp_path / name) for name in ("a.FCStd", "c.FCStd")]
    parts.insert(1, saved_job(tmp_path / "b.FCStd", ["G0 X0 Y0 Z30", "G1 X10"]))
    reported = pkm_post("post", *parts, "--out", tmp_path / "out", "--jobs", 3, *REACHED)
    assert reported.returncode == 1
    assert [Path(line).name for line in reported.stdout.splitlines() if line.endswith(".pkmt")] == ["a.pkmt", "c.pkmt"]
    assert "b.FCStd: Cut: line 4: error J105" in reported.stderr
    assert {path.name[0] for path in (tmp_path / "out").iterdir()} == {"a", "c"}


def test_one_process_goes_on_behind_a_refused_document_and_relative_paths_mean_the_current_folder(part, tmp_path):
    saved_job(tmp_path / "a.FCStd", ["G0 X0 Y0 Z30", "G1 X10"])
    reported = pkm_post("post", "a.FCStd", "part.FCStd", "--out", "out", "--jobs", 1, *REACHED, cwd=tmp_path)
    assert reported.returncode == 1
    assert (tmp_path / "out" / "part.pmc").exists()


def test_batch_from_inside_freecad(five_axis_job, tmp_path, capfd):
    parts = [shutil.copy(five_axis_job, tmp_path / name) for name in ("a.FCStd", "b.FCStd")]
    assert main(words("post", *parts, "--out", tmp_path / "out", "--jobs", 2, *REACHED)) == 0, capfd.readouterr().err
    assert {"a.pmc", "b.pmc"} <= {path.name for path in (tmp_path / "out").iterdir()}


# CAM puts two comments before the lines of a Custom operation: its second line is command 4 of its path.
BAD_JOBS = {
    "unreachable pose": (["G0 X0 Y0 Z30", "G1 X900 F20"], "K102", "Cut: line 4"),
    "missing feed": (["G0 X0 Y0 Z30", "G1 X10"], "J105", "Cut: line 4"),
    "zero feed": (["G0 X0 Y0 Z30", "G1 X10 F0"], "J105", "Cut: line 4"),
    "unknown command": (["G0 X0 Y0 Z30", "G12 Z0 F10"], "J104", "Cut: line 4"),
    "probing": (["G0 X0 Y0 Z30", "G38.2 Z0 F10"], "J142", "Cut: line 4"),
    "drilling cycle": (["G0 X0 Y0 Z30", "G81 X1 Y1 Z0 F10"], "J122", "Cut: line 4"),
    "arc in another plane": (["G0 X0 Y0 Z30", "G18", "G2 X10 Z30 I5 K0 F10"], "J106", "Cut: line"),
    "rotary words": (["G0 X0 Y0 Z30", "G1 X10 A10 F10"], "J115", "Cut: line 4"),
    "half an axis": (["G0 X0 Y0 Z30 I0 J0 K1", "G1 X10 F10"], "J109", "Cut: line 4"),
}


@pytest.mark.parametrize(("lines", "code", "place"), BAD_JOBS.values(), ids=BAD_JOBS)
def test_bad_job_is_reported_with_place_and_leaves_nothing(tmp_path, capsys, lines, code, place):
    part = saved_job(tmp_path / "bad.FCStd", lines)
    assert main(words("post", part, "--out", tmp_path / "out")) == 1
    errors = capsys.readouterr().err
    assert f"bad.FCStd: {place}" in errors
    assert f" error {code}: " in errors
    assert "Traceback" not in errors
    assert not (tmp_path / "out").exists() or list((tmp_path / "out").iterdir()) == []


def test_singular_path_is_refused(part, tmp_path, capsys):
    text = (ADDON / "resources" / "machines" / "example_6tps.toml").read_text()
    machine = tmp_path / "near.toml"
    machine.write_text(text.replace("least_singular_value = 0.1", "least_singular_value = 0.5"))
    assert main(words("post", part, "--machine", machine, "--out", tmp_path / "out", *REACHED)) == 1
    assert "error K105: the path comes too close to a singular pose" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("content", "code"), [(None, "M101"), ("name = ", "M102"), ("name = 'x'\n", "M103"), (b"\xff\xfe\x00", "M10")]
)
def test_unreadable_machine_file_is_reported(part, tmp_path, capsys, content, code):
    machine = tmp_path / "machine.toml"
    if content is not None:
        machine.write_bytes(content if isinstance(content, bytes) else content.encode())
    assert main(words("post", part, "--machine", machine, "--out", tmp_path / "out")) == 1
    errors = capsys.readouterr().err
    assert f"machine.toml: line 1:8: error {code}" in errors or f"error {code}" in errors
    assert "Traceback" not in errors


def test_no_place_to_write_to(part, tmp_path, capsys):
    (tmp_path / "taken").write_text("a file where the folder should be")
    assert main(words("post", part, "--out", tmp_path / "taken", *REACHED)) == 1
    assert "error F101: the output cannot be written" in capsys.readouterr().err


def test_document_that_is_none(tmp_path, capsys):
    (tmp_path / "text.FCStd").write_text("no document")
    for name in ("text.FCStd", "missing.FCStd"):
        assert main(words("post", tmp_path / name, "--out", tmp_path / "out")) == 1
        errors = capsys.readouterr().err
        assert "error J101" in errors
        assert "Traceback" not in errors


@pytest.mark.parametrize(
    ("arguments", "code", "found"),
    [
        ((), "U102", "COMMAND; "),
        (("post",), "U102", "FILE; "),
        (("post", "x.FCStd", "--tip-tolerance", "-1"), "U103", "--tip-tolerance: expected a number from 1e-06 to 100"),
        (("nonsense",), "U101", "COMMAND: expected one of post, reach, "),
    ],
)
def test_arguments_that_make_no_sense_end_with_two(arguments, code, found):
    reported = pkm_post(*arguments)
    assert reported.returncode == 2
    command = " ".join(("python3 -m pkm_post", *(word for word in arguments if word == "post")))
    (line,) = reported.stderr.splitlines()  # and no usage of 30 lines before it
    assert line.startswith(f"{command}: error {code}: ") and found in line


def test_arcs_are_posted(tmp_path, capsys):
    meshes = ("--part", "none", "--stock", "none")  # the path begins by a rapid move through the box
    part = saved_job(tmp_path / "arc.FCStd", ARC)
    assert main(words("post", part, "--out", tmp_path, *REACHED, *meshes)) == 0, capsys.readouterr().err


def test_machine_list_and_check(capsys):
    assert main(["machine", "list"]) == 0
    assert "example_6tps" in capsys.readouterr().out.split()
    assert main(["machine", "check", "example_6tps"]) == 0
    assert "complete" in capsys.readouterr().out
    assert main(["machine", "check", "no_such_machine"]) == 1


def test_reach_of_what_is_no_document_is_refused(tmp_path, capsys):
    (tmp_path / "part.FCStd").write_text("no document")
    assert main(words("reach", tmp_path / "part.FCStd")) == 1
    errors = capsys.readouterr().err
    assert "error J101" in errors
    assert "Traceback" not in errors


def test_reach_of_a_document_tells_where_it_could_lie_better(part):
    reported = pkm_post("reach", part, "--place", "xy", "--json", *REACHED)
    assert reported.returncode == 0, reported.stderr
    (study,) = json.loads(reported.stdout)
    assert [stage["stage"] for stage in study["left"]] == ["as it is, zero torsion", "moved in x, y"]
    assert "spindle and part" in [check["name"] for check in study["checks"]]
