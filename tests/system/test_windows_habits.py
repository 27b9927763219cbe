# SPDX-License-Identifier: LGPL-2.1-or-later
"""What Windows does otherwise, simulated: files that are open cannot be moved, and some names are no files."""

import os
from pathlib import Path

import pytest

from pkm_post.system import require_usable, staged, unusable_name, write_fault

SHARING_VIOLATION, ACCESS_DENIED = 32, 5


@pytest.fixture
def clock(monkeypatch):
    """A clock that goes on only where somebody sleeps."""
    seconds = [0.0]
    monkeypatch.setattr("time.monotonic", lambda: seconds[0])
    monkeypatch.setattr("time.sleep", lambda pause: seconds.__setitem__(0, seconds[0] + pause))


@pytest.fixture
def open_elsewhere(monkeypatch):
    """Let files of a name be open in another program for a number of attempts to move them."""
    replace = os.replace

    def hold(name, attempts, code=SHARING_VIOLATION):
        left = [attempts]

        def held(source, target):
            if os.path.basename(source) == name and left[0] > 0:
                left[0] -= 1
                fault = PermissionError(13, "The process cannot access the file", str(source))
                fault.winerror = code
                raise fault
            replace(source, target)

        monkeypatch.setattr(os, "replace", held)

    return hold


def put(folder, text):
    with staged(folder, "part-manifest.json") as private:
        for name in ("part.pmc", "part-manifest.json"):
            (private / name).write_text(text)


def texts(folder):
    return {path.name: path.read_text() for path in folder.iterdir()}


@pytest.mark.parametrize("code", [SHARING_VIOLATION, ACCESS_DENIED])
def test_a_file_that_a_scanner_has_open_for_a_moment_is_moved_then(tmp_path, clock, open_elsewhere, code):
    put(tmp_path, "old")
    open_elsewhere("part.pmc", 20, code)
    put(tmp_path, "new")
    assert texts(tmp_path) == {"part.pmc": "new", "part-manifest.json": "new"}


def test_a_file_that_stays_open_is_named_and_everything_is_as_before(tmp_path, clock, open_elsewhere):
    put(tmp_path, "old")
    open_elsewhere("part.pmc", 10**6)
    with pytest.raises(OSError, match="part.pmc is open in another program") as fault:
        put(tmp_path, "new")
    assert write_fault(tmp_path / "part.pmc", fault.value).code == "F113"
    assert texts(tmp_path) == {"part.pmc": "old", "part-manifest.json": "old"}


def test_other_faults_are_not_waited_for(tmp_path, clock, open_elsewhere):
    open_elsewhere("part.pmc", 1, code=19)  # the medium is write-protected
    with pytest.raises(PermissionError) as fault:
        put(tmp_path, "new")
    assert write_fault(tmp_path / "part.pmc", fault.value).code == "F101"


@pytest.mark.parametrize(
    ("name", "word"),
    [
        ("CON", "device"),
        ("nul.pmc", "device"),
        ("Com1.report.json", "device"),
        ("LPT9 .pmc", "device"),
        ("aux.", "device"),
        ("part:1.pmc", "':'"),
        ("what?.pmc", "'?'"),
        ("part.", "end"),
        ("part ", "end"),
    ],
)
def test_names_that_windows_takes_for_something_else(name, word):
    assert word in unusable_name(name, "win32")
    assert unusable_name(name, "linux") == unusable_name(name, "darwin") == ""
    with pytest.raises(OSError) as fault:
        require_usable(name, "win32")
    assert write_fault(Path(name), fault.value).code == "F114"


@pytest.mark.parametrize(
    "name", ["part.pmc", "console.pmc", "com10.pmc", "part-con.pmc", "con-report.json", ".pmc", "n\u00fal.pmc"]
)
def test_names_that_are_fine(name):
    assert unusable_name(name, "win32") == ""
