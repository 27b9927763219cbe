# SPDX-License-Identifier: LGPL-2.1-or-later
"""Paths too long for Windows, simulated: private names make them no longer, and results are refused by name."""

import ntpath
import sys
from pathlib import Path

import pytest

from pkm_post.system import staged, write_fault
from pkm_post.system.file_names import prefixed, unusable_path

LONG = "C:\\" + "\\".join(["folder"] * 30)  # 212 characters


@pytest.mark.parametrize(
    ("folder", "found"),
    [
        ("C:\\parts", "C:\\parts"),
        ("C:/parts/../out", "C:\\out"),
        (LONG, f"\\\\?\\{LONG}"),
        (LONG.replace("\\", "/") + "/.", f"\\\\?\\{LONG}"),
        (f"\\\\?\\{LONG}", f"\\\\?\\{LONG}"),
        ("\\\\server" + LONG[2:], "\\\\?\\UNC\\server" + LONG[2:]),
    ],
)
def test_a_folder_is_prefixed_where_private_names_would_be_too_long(folder, found):
    assert prefixed(folder, 150) == found
    drive, _ = ntpath.splitdrive(found)
    assert ntpath.isabs(found) and drive


def test_the_limit_is_that_of_windows():
    path = LONG + "\\" + "x" * (259 - len(LONG) - 1)
    assert unusable_path(path, long_paths=False) == ""
    assert "260" in unusable_path(path + "x", long_paths=False)
    assert unusable_path(path + "x", long_paths=True) == ""


def test_results_go_through_the_prefixed_folder(tmp_path, monkeypatch):
    """The prefixed path names the same folder; a link does so here."""
    folder, other = tmp_path / "results", tmp_path / "by another name"
    folder.mkdir()
    other.symlink_to(folder)
    monkeypatch.setattr(sys.modules["pkm_post.system.staged"], "_any_length", lambda _: other)
    with staged(folder) as private:
        assert private.is_relative_to(other)
        (private / "part.pmc").write_text("new")
    assert {path.name: path.read_text() for path in folder.iterdir()} == {"part.pmc": "new"}


def test_a_result_that_nothing_could_open_is_refused_by_name(tmp_path, monkeypatch):
    monkeypatch.setattr("pkm_post.system.file_names.has_long_paths", lambda: False)
    folder = tmp_path
    while len(str(folder)) < 230:
        folder /= "folder"
    name = "x" * (260 - len(str(folder)) - 1)
    folder.mkdir(parents=True)
    with staged(folder) as private:
        (private / name[1:]).write_text("fits")
    with pytest.raises(OSError, match="259 characters, and this one has 260") as fault, staged(folder) as private:
        (private / name).write_text("does not")
    assert write_fault(folder / name, fault.value).code == "F114"
    assert [path.name for path in Path(folder).iterdir()] == [name[1:]]


def test_a_name_that_the_file_system_cannot_hold_is_refused_by_name(tmp_path):
    with pytest.raises(OSError) as fault, staged(tmp_path) as private:
        (private / f"{'x' * 300}.pmc").write_text("does not fit")
    assert write_fault(tmp_path / "long.pmc", fault.value).code == "F114"
