# SPDX-License-Identifier: LGPL-2.1-or-later
"""Messages and folder content when results cannot replace earlier ones."""

import errno
import importlib
import os

import pytest

from pkm_post.cli import main
from pkm_post.system.lock import try_lock
from pkm_post.writing import manifest

PART = "G21 G90 G17\nT1 M6\nS5000 M3\nG0 X0 Y0 Z300\nG1 X10 F600\nM5\nM30\n"
OPEN = "used by another process"


@pytest.fixture
def posted(tmp_path):
    """The folder with the results of ``part.ngc``, which is another program by now."""
    part = tmp_path / "part.ngc"
    part.write_text(PART, encoding="ascii")
    assert post(tmp_path) == 0
    part.write_text(PART.replace("X10", "X20"), encoding="ascii")
    return tmp_path / "out"


def post(folder):
    return main(["post", str(folder / "part.ngc"), "--out", str(folder / "out"), "--tool-length", "1=120"])


def contents(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def refusal(folder, capsys):
    """What the command writes to the standard error when it ends with 1."""
    capsys.readouterr()
    assert post(folder) == 1
    return capsys.readouterr().err


def locked_by_another_program(monkeypatch, when):
    """Windows moves no file that a program has open: let moving fail where ``when`` holds for source and target."""
    replace = os.replace

    def call(source, target):
        if when(source, target):
            raise PermissionError(errno.EACCES, OPEN, str(source))
        replace(source, target)

    monkeypatch.setattr("os.replace", call)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["part.pmc", "part.pkmt", "part-report.html", "part-manifest.json"])
def test_earlier_results_stay_whole_when_one_is_open_elsewhere(posted, tmp_path, monkeypatch, capsys, name):
    before = contents(posted)
    locked_by_another_program(monkeypatch, lambda source, target: source == posted / name)
    output = refusal(tmp_path, capsys)
    assert "part.pmc: error F101" in output and OPEN in output and name in output
    assert contents(posted) == before
    assert main(["verify", str(posted / "part.pmc"), "--against", str(posted / "part.pkmt")]) == 0


def test_a_folder_that_another_process_does_not_leave_is_reported(posted, tmp_path, monkeypatch, capsys):
    before = contents(posted)
    monkeypatch.setattr(importlib.import_module("pkm_post.system.staged"), "_PATIENCE", 0.02)
    with try_lock(posted / ".staged-lock"):
        assert "part.pmc: error F109" in refusal(tmp_path, capsys)
    assert contents(posted) == before


def test_results_that_are_mixed_are_named_and_no_reader_accepts_them(posted, tmp_path, monkeypatch, capsys):
    def program_stays_and_trajectory_does_not_come(source, target):
        back = source.parent == posted and target.parent.name == "new"
        return back or (source.name == "part.pmc" and source.parent.name == "new")

    locked_by_another_program(monkeypatch, program_stays_and_trajectory_does_not_come)
    output = refusal(tmp_path, capsys)
    assert "part.pmc: error F110" in output and output.rstrip().endswith("try again")
    assert "could not be restored: part.pkmt, part-setup.pmc, part-report.json, part-report.html;" in output
    for name in contents(posted):
        found, (fault,) = manifest.check(posted / name)
        assert found is None and fault.code == "F107"
