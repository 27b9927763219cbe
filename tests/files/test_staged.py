# SPDX-License-Identifier: LGPL-2.1-or-later
"""Files appear together, complete, or not at all."""

import os
import stat

import pytest

from pkm_post.files import staged


def contents(folder):
    """Everything below a folder, hidden names too, with its text."""
    return {str(path.relative_to(folder)): path.read_text() for path in folder.rglob("*") if path.is_file()}


def names(folder):
    return sorted(os.listdir(folder))


def test_files_appear_when_the_block_ends(tmp_path):
    with staged(tmp_path) as private:
        (private / "part.pmc").write_text("program")
        (private / "part.json").write_text("report")
        assert not (tmp_path / "part.pmc").exists()
    assert contents(tmp_path) == {"part.pmc": "program", "part.json": "report"}
    assert names(tmp_path) == ["part.json", "part.pmc"]


def test_a_missing_folder_is_made(tmp_path):
    with staged(tmp_path / "new" / "out") as private:
        (private / "part.pmc").write_text("program")
    assert contents(tmp_path) == {os.path.join("new", "out", "part.pmc"): "program"}


def test_a_relative_folder_is_fine(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with staged(type(tmp_path)()) as private:
        (private / "part.pmc").write_text("program")
    assert names(tmp_path) == ["part.pmc"]


def test_nothing_is_left_when_the_block_raises(tmp_path):
    (tmp_path / "part.pmc").write_text("old")
    with pytest.raises(KeyError, match="wrong"), staged(tmp_path) as private:
        (private / "part.pmc").write_text("new")
        (private / "part.json").write_text("report")
        raise KeyError("wrong")
    assert names(tmp_path) == ["part.pmc"]
    assert contents(tmp_path) == {"part.pmc": "old"}


def test_existing_files_are_replaced_and_others_kept(tmp_path):
    (tmp_path / "part.pmc").write_text("old")
    (tmp_path / "other.pmc").write_text("other")
    with staged(tmp_path) as private:
        (private / "part.pmc").write_text("new")
    assert contents(tmp_path) == {"part.pmc": "new", "other.pmc": "other"}


def test_new_files_are_taken_back_when_one_cannot_be_moved(tmp_path):
    (tmp_path / "a-old").write_text("old")
    (tmp_path / "c-folder").mkdir()
    with pytest.raises(OSError, match="c-folder"), staged(tmp_path) as private:
        for name in ("a-old", "b-new", "c-folder", "d-new"):
            (private / name).write_text("new")
    assert names(tmp_path) == ["a-old", "c-folder"]
    assert contents(tmp_path) == {"a-old": "new"}  # what was replaced is not changed back


def test_new_files_are_taken_back_when_the_names_cannot_be_stored(tmp_path, monkeypatch):
    fsync = os.fsync

    def fail_on_folders(descriptor):
        if stat.S_ISDIR(os.fstat(descriptor).st_mode):
            raise OSError("no space for names")
        fsync(descriptor)

    monkeypatch.setattr("os.fsync", fail_on_folders)
    with pytest.raises(OSError, match="no space for names"), staged(tmp_path) as private:
        (private / "part.pmc").write_text("program")
    assert names(tmp_path) == []


def test_nothing_appears_when_a_file_cannot_be_stored(tmp_path, monkeypatch):
    def fail(descriptor):
        raise OSError("disk full")

    monkeypatch.setattr("os.fsync", fail)
    with pytest.raises(OSError, match="disk full"), staged(tmp_path) as private:
        (private / "part.pmc").write_text("program")
    assert names(tmp_path) == []


def test_a_folder_among_the_files_is_refused(tmp_path):
    with pytest.raises(OSError, match="inside"), staged(tmp_path) as private:
        (private / "a-file").write_text("text")
        (private / "inside").mkdir()
    assert names(tmp_path) == []


def test_a_file_in_place_of_the_folder_is_told(tmp_path):
    (tmp_path / "out").write_text("a file")
    with pytest.raises(OSError, match="out"), staged(tmp_path / "out"):
        raise AssertionError("the block must not run")
    assert contents(tmp_path) == {"out": "a file"}


def test_every_file_is_stored_before_the_first_is_moved(tmp_path, monkeypatch):
    calls = []
    fsync, replace = os.fsync, os.replace

    def recording_fsync(descriptor):
        calls.append("fsync")
        fsync(descriptor)

    def recording_replace(source, target):
        calls.append(f"replace {target.name}")
        replace(source, target)

    monkeypatch.setattr("os.fsync", recording_fsync)
    monkeypatch.setattr("os.replace", recording_replace)
    with staged(tmp_path) as private:
        for name in ("b", "c", "a"):
            (private / name).write_text(name)
    assert calls[:6] == ["fsync", "fsync", "fsync", "replace a", "replace b", "replace c"]


@pytest.mark.parametrize("mask", [0o022, 0o077])
def test_permissions_follow_the_umask(tmp_path, mask):
    before = os.umask(mask)
    try:
        with staged(tmp_path) as private:
            (private / "part.pmc").write_text("program")
    finally:
        os.umask(before)
    assert stat.S_IMODE((tmp_path / "part.pmc").stat().st_mode) == 0o666 & ~mask


def test_stages_nest(tmp_path):
    with staged(tmp_path) as outer:
        with staged(outer) as inner:
            (inner / "part.pkmt").write_text("trajectory")
        assert names(outer) == ["part.pkmt"]
        (outer / "part.pmc").write_text("program")
    assert names(tmp_path) == ["part.pkmt", "part.pmc"]
