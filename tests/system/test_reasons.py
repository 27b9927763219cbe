# SPDX-License-Identifier: LGPL-2.1-or-later
"""Why a file could not be read or written, in plain words: no numbers of the operating system."""

import errno

import pytest

from pkm_post.model import Phrase
from pkm_post.system import read_fault, reason_of, staged, write_fault


def raised(act):
    with pytest.raises(OSError) as fault:
        act()
    return fault.value


def test_reasons_are_plain_words(tmp_path):
    file, missing = tmp_path / "a.ngc", tmp_path / "none.ngc"
    file.touch()
    for path, words in (
        (missing, "there is no such file or folder"),
        (tmp_path, "it is a folder, not a file"),
        (file / "b.ngc", "there is a file where a folder is named"),
    ):
        found = read_fault(path, raised(path.read_bytes))
        assert (found.code, found.place.file, found.found) == ("F103", str(path), words)
        assert isinstance(found.found, Phrase)


def test_a_folder_of_results_that_is_a_file_is_named(tmp_path):
    file = tmp_path / "out"
    file.touch()

    def write():
        with staged(file):
            pass

    found = write_fault(file / "part.pmc", raised(write))
    assert (found.code, found.found) == ("F101", f"{file}: it is a file, not a folder")


def test_any_other_reason_is_that_of_the_system():
    assert reason_of(OSError(24, "Too many open files")) == "Too many open files"
    assert reason_of(OSError("a device")) == "a device"
    assert reason_of(PermissionError(errno.EACCES, "used by another process")) == "used by another process"
    assert reason_of(ValueError("a zero byte")) == "a zero byte"


@pytest.mark.parametrize("name", ["", "..", "folder"])
def test_no_message_names_the_private_folder(tmp_path, name):
    """Its name means nothing to a user, and is gone with it."""
    (tmp_path / "folder").mkdir()

    def write():
        with staged(tmp_path) as folder:
            (folder / name).write_text("")

    found = str(write_fault(tmp_path / name, raised(write)))
    assert ".staged-" not in found and "it is a folder, not a file" in found
