# SPDX-License-Identifier: LGPL-2.1-or-later
"""Files appear together, complete, or not at all."""

import errno
import itertools
import os
import stat

import pytest

from pkm_post.system import staged
from pkm_post.system.staged import MixedError


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


def write_generation(folder, text, count=4):
    """Files a, b and so on with the same text; the last of them is the one that comes last."""
    with staged(folder, last="c") as private:
        for name in "abcd"[:count]:
            (private / name).write_text(text)


def failing(monkeypatch, name, when):
    """Let a function of ``os`` fail at the calls for which ``when`` holds, as that of a system would."""
    real = getattr(os, name)

    def call(*arguments):
        if when(*arguments):
            raise PermissionError(errno.EACCES, "used by another process", str(arguments[0]))
        return real(*arguments)

    monkeypatch.setattr(f"os.{name}", call)


OLD = dict.fromkeys("abcd", "old")


def test_a_folder_is_never_replaced_by_a_file(tmp_path):
    (tmp_path / "a").write_text("old")
    (tmp_path / "c").mkdir()
    (tmp_path / "c" / "inside").write_text("kept")
    with pytest.raises(IsADirectoryError):
        write_generation(tmp_path, "new")
    assert contents(tmp_path) == {"a": "old", os.path.join("c", "inside"): "kept"}
    assert names(tmp_path) == ["a", "c"]


@pytest.mark.parametrize("name", "abcd")
@pytest.mark.parametrize("is_new", [True, False])
def test_all_is_as_it_was_when_one_file_cannot_be_moved(tmp_path, monkeypatch, name, is_new):
    write_generation(tmp_path, "old")
    failing(
        monkeypatch,
        "replace",
        lambda source, target: source.name == name and source.parent.name == ("new" if is_new else tmp_path.name),
    )
    with pytest.raises(PermissionError, match="used by another process"):
        write_generation(tmp_path, "new")
    assert contents(tmp_path) == OLD
    assert names(tmp_path) == list("abcd")


@pytest.mark.parametrize("which", range(3))
def test_all_is_as_it_was_when_names_cannot_be_stored(tmp_path, monkeypatch, which):
    write_generation(tmp_path, "old")
    folders = itertools.count()

    def is_the_one(descriptor):
        return stat.S_ISDIR(os.fstat(descriptor).st_mode) and next(folders) == which

    failing(monkeypatch, "fsync", is_the_one)
    with pytest.raises(PermissionError):
        write_generation(tmp_path, "new")
    assert contents(tmp_path) == OLD
    assert names(tmp_path) == list("abcd")


def test_an_interrupt_while_files_are_moved_leaves_all_as_it_was(tmp_path, monkeypatch):
    replace = os.replace
    for moves in itertools.count():
        write_generation(tmp_path, "old")
        left = itertools.count(moves, -1)

        def interrupted(source, target, left=left):
            replace(source, target)
            if next(left) == 0:
                raise KeyboardInterrupt

        with monkeypatch.context() as patched:
            patched.setattr("os.replace", interrupted)
            try:
                write_generation(tmp_path, "new")
            except KeyboardInterrupt:
                assert contents(tmp_path) == OLD
            else:
                break
    assert moves == 8
    assert contents(tmp_path) == dict.fromkeys("abcd", "new")


def test_files_that_cannot_be_put_back_are_named_and_the_last_is_not_there(tmp_path, monkeypatch):
    write_generation(tmp_path, "old")

    def b_does_not_come_and_a_does_not_go(source, target):
        return "new" in (source if source.name == "b" else target if source.name == "a" else tmp_path).parent.name

    failing(monkeypatch, "replace", b_does_not_come_and_a_does_not_go)
    with pytest.raises(MixedError, match="could not be restored: a$"):
        write_generation(tmp_path, "new")
    assert contents(tmp_path) == {"a": "new", "b": "old", "d": "old"}


def test_what_is_replaced_goes_before_anything_comes(tmp_path, monkeypatch):
    write_generation(tmp_path, "old")
    seen, replace = [], os.replace

    def looking(source, target):
        replace(source, target)
        seen.append("".join(sorted(f"{name}{text[0]}" for name, text in contents(tmp_path).items() if len(name) == 1)))

    monkeypatch.setattr("os.replace", looking)
    write_generation(tmp_path, "new", count=3)
    assert seen == ["aobodo", "aodo", "do", "ando", "anbndo", "anbncndo"]


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


def test_a_file_in_place_of_the_folder_is_reported(tmp_path):
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
    assert calls[:7] == ["fsync", "fsync", "fsync", "fsync", "replace a", "replace b", "replace c"]


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
