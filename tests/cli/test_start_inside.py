# SPDX-License-Identifier: LGPL-2.1-or-later
"""Documents are posted by a FreeCAD that is started: whatever else is started, nothing passes for posted."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from interpreter import PYTHON

from pkm_post.cli import processes
from pkm_post.cli.processes import command_inside, inner_exit_code, outcome
from pkm_post.system import FreeCADCommand

ADDON = Path(__file__).parents[2]


def script(path, text):
    path.write_text(f"#!/bin/sh\n{text}\n")
    path.chmod(0o755)
    return str(path)


def started(tmp_path, freecad, *more, files=("part.FCStd",), **environment):
    """Posting documents where FREECADCMD names something."""
    for file in files:
        (tmp_path / file).touch()
    command = [PYTHON, "-m", "pkm_post", "post", *files, "--out", "out", *more]
    settings = os.environ | {"PYTHONPATH": str(ADDON), "FREECADCMD": str(freecad)} | environment
    return subprocess.run(
        command, env=settings, cwd=tmp_path, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=60
    )


def is_refused(ran, code, *words):
    assert ran.returncode == 1, ran.stderr
    assert f"error {code}" in ran.stderr
    assert [word for word in words if word not in ran.stderr] == []
    assert "Traceback" not in ran.stderr


def test_what_cannot_be_started(tmp_path):
    text = tmp_path / "text"
    text.write_text("no program")
    is_refused(started(tmp_path, "/no/such/freecadcmd"), "F140", "/no/such/freecadcmd", "no such file")
    is_refused(started(tmp_path, text), "F140", "Permission denied")
    is_refused(started(tmp_path, tmp_path), "F140", "Permission denied")
    text.chmod(0o755)
    is_refused(started(tmp_path, text), "F140", "Exec format error")


@pytest.mark.parametrize("code", [0, 1, 2, 63, 67, 127])
def test_what_is_no_freecad(tmp_path, code):
    other = script(tmp_path / "other", f"exit {code}")
    is_refused(started(tmp_path, other), "F141", f"exit code {code}", other)


def test_a_freecad_that_crashes(tmp_path):
    is_refused(started(tmp_path, script(tmp_path / "crash", "kill -SEGV $$")), "F141", "exit code -11")


@pytest.mark.parametrize("code", [1, 2, 130])
def test_the_exit_code_of_the_command_is_that_of_the_command_inside(tmp_path, code):
    ran = started(tmp_path, script(tmp_path / "inside", f"exit {inner_exit_code(code)}"))
    assert (ran.returncode, ran.stderr) == (code, "")


def test_results_that_are_not_there_where_the_command_ended_well(tmp_path):
    well = script(tmp_path / "inside", f"exit {inner_exit_code(0)}")
    missing = "part.pmc", "part.pkmt", "part-report.json", "part-report.html", "part-manifest.json"
    is_refused(started(tmp_path, well), "F142", *missing)
    (tmp_path / "out").mkdir()
    for name in ("part.pmc", "part.pkmt", "part-report.html", "part-manifest.json"):
        (tmp_path / "out" / name).touch()
    ran = started(tmp_path, well)
    is_refused(ran, "F142", "part-report.json")
    assert "part.pmc" not in ran.stderr
    (tmp_path / "out" / "part-report.json").touch()
    assert started(tmp_path, well).returncode == 0


def test_a_batch(tmp_path):
    files = ("a.FCStd", "b.FCStd")
    ran = started(tmp_path, "/no/such/freecadcmd", "--jobs", "2", files=files)
    is_refused(ran, "F140")
    assert ran.stderr.count("error F140") == 2
    ran = started(tmp_path, script(tmp_path / "other", "exit 0"), "--jobs", "2", files=files)
    is_refused(ran, "F141")
    well = script(tmp_path / "inside", f"exit {inner_exit_code(0)}")
    is_refused(started(tmp_path, well, "--jobs", "2", files=files), "F142", "a.pmc", "b.pmc")


def test_a_bash_of_another_system(tmp_path):
    """On the path of Windows there often is the bash of WSL, which starts nothing where it is not set up."""
    script(tmp_path / "bash", "echo no distribution is installed >&2; exit 1")
    path = {"PATH": f"{tmp_path}{os.pathsep}{os.environ['PATH']}"}
    is_refused(started(tmp_path, "", **path), "F141", "no distribution is installed")


def test_windows_runs_no_script_of_bash(tmp_path, monkeypatch, capsys):
    monkeypatch.delenv("FREECADCMD", raising=False)
    assert command_inside([])[0] == str(ADDON / "tools" / "freecad")
    monkeypatch.setattr(shutil, "which", lambda name, path=None: str(tmp_path / name) if name == "bash" else None)
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setattr(sys, "platform", "win32")
    assert command_inside([]) == []
    assert "there is none on the path" in capsys.readouterr().err


def test_no_freecad_at_all(monkeypatch, capsys):
    monkeypatch.setattr(processes, "_freecad_command", lambda: FreeCADCommand((), "there is none"))
    assert processes.run_inside(["post", "part.FCStd"]) == 1
    assert "error F140: FreeCAD could not be started: there is none" in capsys.readouterr().err


def test_without_numpy_it_is_said_in_short(tmp_path):
    (tmp_path / "numpy.py").write_text("raise ModuleNotFoundError('no numpy', name='numpy')")
    ran = started(tmp_path, "/no/such/freecadcmd", PYTHONPATH=f"{tmp_path}{os.pathsep}{ADDON}")
    is_refused(ran, "F140", "/no/such/freecadcmd", "no such file")


def test_what_is_not_started_for_freecad_ends_as_it_ends(tmp_path, monkeypatch):
    script(tmp_path / "freecadcmd", "exit 0")
    monkeypatch.setenv("PATH", f"{tmp_path}{os.pathsep}{os.environ['PATH']}")
    monkeypatch.setenv("FREECADCMD", "freecadcmd")
    inside = command_inside(["post", "part.FCStd"])
    assert inside[0] == str(tmp_path / "freecadcmd") and inside[-2:] == ["post", "part.FCStd"]
    assert [outcome(["python3"], code) for code in (0, 1, 2, 130)] == [(0, ""), (1, ""), (2, ""), (130, "")]
    code, found = outcome(["python3"], 64, "part.ngc")
    assert code == 1 and found.startswith("part.ngc: error F144: ") and "exit code 64" in found
    assert [outcome(inside, inner_exit_code(code)) for code in (0, 1, 2, 130)] == [(0, ""), (1, ""), (2, ""), (130, "")]


@pytest.mark.parametrize(
    ("files", "solids", "needed"),
    [
        (["a.ngc"], [], False),
        (["a.ngc", "b.FCStd"], [], True),
        (["a.ngc", "gone.FCStd"], [], False),
        (["a.cls"], ["wall.stl", "none"], False),
        (["a.cls"], ["wall.stl", "vice.STP"], True),
        (["a.cls"], ["wall.step"], True),
    ],
)
def test_names_of_files_that_are_there_say_it(monkeypatch, tmp_path, files, solids, needed):
    monkeypatch.chdir(tmp_path)
    for file in {*files} - {"gone.FCStd"}:
        Path(file).touch()
    monkeypatch.setattr(processes, "is_inside", lambda: False)
    assert processes.needs_freecad([Path(file) for file in files], solids) is needed


def test_nothing_is_needed_inside(monkeypatch):
    monkeypatch.setattr(processes, "is_inside", lambda: True)
    assert not processes.needs_freecad([Path("a.FCStd")], ["wall.step"])
