# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command line, in processes of its own: exit codes, texts, and what is left on the disk."""

import json
import os
import subprocess
import sys
from pathlib import Path

import FreeCAD as App
import pytest

ADDON = Path(__file__).parents[2]
sys.path.insert(0, str(Path(__file__).parents[1] / "freecad_app"))

from cam_jobs import ARC, FIVE_AXIS, add_operation, new_job  # noqa: E402

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


def test_post_starts_freecad_by_itself(tmp_path):
    part = saved_job(tmp_path / "my part.FCStd")
    reported = pkm_post("post", part, "--machine", "example_6tps", "--out", tmp_path / "out dir", *REACHED)
    assert reported.returncode == 0, reported.stderr
    made = sorted(path.name for path in (tmp_path / "out dir").iterdir())
    endings = ("-manifest.json", "-report.html", "-report.json", "-setup.pmc", ".pkmt", ".pmc")
    assert made == [f"my_part{ending}" for ending in endings]
    assert [Path(line).name for line in reported.stdout.splitlines()[-6:]] == made
    assert json.loads((tmp_path / "out dir" / "my_part-report.json").read_text())["certificate"]["holds"]


def test_relative_paths_mean_the_current_folder(tmp_path):
    saved_job(tmp_path / "part.FCStd")
    reported = pkm_post("post", "part.FCStd", "--out", "results", *REACHED, cwd=tmp_path)
    assert reported.returncode == 0, reported.stderr
    assert (tmp_path / "results" / "part.pmc").exists()


def test_two_documents_in_one_call(tmp_path):
    parts = [saved_job(tmp_path / name) for name in ("a.FCStd", "b.FCStd")]
    reported = pkm_post("post", *parts, "--out", tmp_path, *REACHED)
    assert reported.returncode == 0, reported.stderr
    assert {"a.pmc", "b.pmc"} <= {path.name for path in tmp_path.iterdir()}


def test_documents_in_processes_of_their_own_are_reported_in_order(tmp_path):
    parts = [saved_job(tmp_path / name) for name in ("a.FCStd", "c.FCStd")]
    parts.insert(1, saved_job(tmp_path / "b.FCStd", ["G0 X0 Y0 Z30", "G1 X10"]))
    reported = pkm_post("post", *parts, "--out", tmp_path / "out", "--jobs", 3, *REACHED)
    assert reported.returncode == 1
    assert [Path(line).name for line in reported.stdout.splitlines() if line.endswith(".pkmt")] == ["a.pkmt", "c.pkmt"]
    assert "b.FCStd: Cut: line 4: error J105" in reported.stderr
    assert {path.name[0] for path in (tmp_path / "out").iterdir()} == {"a", "c"}


def test_one_process_goes_on_behind_a_refused_document(tmp_path):
    parts = [saved_job(tmp_path / "a.FCStd", ["G0 X0 Y0 Z30", "G1 X10"]), saved_job(tmp_path / "b.FCStd")]
    reported = pkm_post("post", *parts, "--out", tmp_path / "out", "--jobs", 1, *REACHED)
    assert reported.returncode == 1
    assert (tmp_path / "out" / "b.pmc").exists()


def test_batch_from_inside_freecad(tmp_path):
    parts = [saved_job(tmp_path / name) for name in ("a.FCStd", "b.FCStd")]
    script = tmp_path / "batch.py"
    arguments = ["post", *map(str, parts), "--out", str(tmp_path / "out"), "--jobs", "2", *REACHED]
    script.write_text(f"import sys\nfrom pkm_post.cli import main\nsys.exit(main({arguments!r}))\n")
    command = [
        str(ADDON / "tools" / "freecad"),
        "-M",
        str(ADDON),
        str(ADDON / "tools" / "run_script.py"),
        "--",
        str(script),
    ]
    reported = subprocess.run(
        command, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=300, check=False
    )
    assert reported.returncode == 0, reported.stderr
    assert {"a.pmc", "b.pmc"} <= {path.name for path in (tmp_path / "out").iterdir()}


# CAM puts two comments before the lines of a Custom operation: its second line is command 4 of its path.
BAD_JOBS = {
    "unreachable pose": (["G0 X0 Y0 Z30", "G1 X900 F20"], "K102", "Cut: line 4"),
    "missing feed": (["G0 X0 Y0 Z30", "G1 X10"], "J105", "Cut: line 4"),
    "zero feed": (["G0 X0 Y0 Z30", "G1 X10 F0"], "J105", "Cut: line 4"),
    "unknown command": (["G0 X0 Y0 Z30", "G38.2 Z0 F10"], "J104", "Cut: line 4"),
    "drilling cycle": (["G0 X0 Y0 Z30", "G81 X1 Y1 Z0 F10"], "J122", "Cut: line 4"),
    "arc in another plane": (["G0 X0 Y0 Z30", "G18", "G2 X10 Z30 I5 K0 F10"], "J106", "Cut: line"),
    "rotary words": (["G0 X0 Y0 Z30", "G1 X10 A10 F10"], "J115", "Cut: line 4"),
    "half an axis": (["G0 X0 Y0 Z30 I0 J0 K1", "G1 X10 F10"], "J109", "Cut: line 4"),
}


@pytest.mark.parametrize(("lines", "code", "place"), BAD_JOBS.values(), ids=BAD_JOBS)
def test_bad_job_is_reported_with_place_and_leaves_nothing(tmp_path, lines, code, place):
    part = saved_job(tmp_path / "bad.FCStd", lines)
    reported = pkm_post("post", part, "--out", tmp_path / "out")
    assert reported.returncode == 1
    assert f"bad.FCStd: {place}" in reported.stderr
    assert f" error {code}: " in reported.stderr
    assert "Traceback" not in reported.stderr
    assert not (tmp_path / "out").exists() or list((tmp_path / "out").iterdir()) == []


def test_singular_path_is_refused(tmp_path):
    text = (ADDON / "resources" / "machines" / "example_6tps.toml").read_text()
    machine = tmp_path / "near.toml"
    machine.write_text(text.replace("least_singular_value = 0.1", "least_singular_value = 0.5"))
    reported = pkm_post(
        "post", saved_job(tmp_path / "part.FCStd"), "--machine", machine, "--out", tmp_path / "out", *REACHED
    )
    assert reported.returncode == 1
    assert "error K105: the path comes too close to a singular pose" in reported.stderr


@pytest.mark.parametrize(
    ("content", "code"), [(None, "M101"), ("name = ", "M102"), ("name = 'x'\n", "M103"), (b"\xff\xfe\x00", "M10")]
)
def test_unreadable_machine_file_is_reported(tmp_path, content, code):
    machine = tmp_path / "machine.toml"
    if content is not None:
        machine.write_bytes(content if isinstance(content, bytes) else content.encode())
    reported = pkm_post("post", saved_job(tmp_path / "part.FCStd"), "--machine", machine, "--out", tmp_path / "out")
    assert reported.returncode == 1
    assert f"machine.toml: line 1:8: error {code}" in reported.stderr or f"error {code}" in reported.stderr
    assert "Traceback" not in reported.stderr


def test_no_place_to_write_to(tmp_path):
    (tmp_path / "taken").write_text("a file where the folder should be")
    reported = pkm_post("post", saved_job(tmp_path / "part.FCStd"), "--out", tmp_path / "taken", *REACHED)
    assert reported.returncode == 1
    assert "error F101: the output cannot be written" in reported.stderr


def test_document_that_is_none(tmp_path):
    (tmp_path / "text.FCStd").write_text("no document")
    for name in ("text.FCStd", "missing.FCStd"):
        reported = pkm_post("post", tmp_path / name, "--out", tmp_path / "out")
        assert reported.returncode == 1
        assert "error J101" in reported.stderr
        assert "Traceback" not in reported.stderr


@pytest.mark.parametrize("arguments", [(), ("post",), ("post", "x.FCStd", "--tip-tolerance", "-1"), ("nonsense",)])
def test_arguments_that_make_no_sense_end_with_two(arguments):
    reported = pkm_post(*arguments)
    assert reported.returncode == 2
    assert "usage:" in reported.stderr


def test_arcs_are_posted(tmp_path):
    meshes = ("--part", "none", "--stock", "none")  # the path begins by a rapid move through the box
    reported = pkm_post("post", saved_job(tmp_path / "arc.FCStd", ARC), "--out", tmp_path, *REACHED, *meshes)
    assert reported.returncode == 0, reported.stderr


def test_machine_list_and_check(tmp_path):
    assert "example_6tps" in pkm_post("machine", "list").stdout.split()
    checked = pkm_post("machine", "check", "example_6tps")
    assert checked.returncode == 0
    assert "complete" in checked.stdout
    assert pkm_post("machine", "check", "no_such_machine").returncode == 1


def test_reach_of_what_is_no_document_is_refused(tmp_path):
    (tmp_path / "part.FCStd").write_text("no document")
    reported = pkm_post("reach", tmp_path / "part.FCStd")
    assert reported.returncode == 1
    assert "error J101" in reported.stderr
    assert "Traceback" not in reported.stderr


def test_reach_of_a_document_tells_where_it_could_lie_better(tmp_path):
    part = saved_job(tmp_path / "part.FCStd")
    reported = pkm_post("reach", part, "--place", "xy", "--json", *REACHED)
    assert reported.returncode == 0, reported.stderr
    (study,) = json.loads(reported.stdout)
    assert [stage["stage"] for stage in study["left"]] == ["as it is, zero torsion", "moved in x, y"]
    assert "spindle and part" in [check["name"] for check in study["checks"]]
