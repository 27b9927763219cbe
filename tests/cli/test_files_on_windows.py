# SPDX-License-Identifier: LGPL-2.1-or-later
"""What holds of every file that the command line writes, since Windows needs it, and of files with its ends of lines.

Files are written in private folders only, so that a file that another program has open is waited for, or named.
"""

import os
import re
import sys
from pathlib import Path

import numpy as np
import pytest

from pkm_post.cli import main
from pkm_post.machine import machine_named, strut_lengths
from pkm_post.machine.calibration.calibrate_file import COLUMNS

SHARING_VIOLATION = 32
G_CODE = "G21 G90\nT1 M6\nS8000 M3\nG0 X0 Y0 Z30\nG1 X5 Y5 Z20 F600\nG2 X15 Y5 I5 J0\nM5\nM30\n"
CL_DATA = """UNITS/MM
LOADTL/1,LENGTH,120
SPINDL/RPM,8000,CLW
FEDRAT/600,MMPM
RAPID
GOTO/0,0,30,0,0,1
GOTO/5,5,20,0,0,1
FINI
"""
ALSO = ["--also", "csv,halstreamer,linuxcnc,picture"]
PLACED = ["--tool-length", "1=120", "--work-offset=0,0,250"]
COMMANDS = {
    "post": ["post", "part.ngc", *PLACED, *ALSO, "--out", "out"],
    "post CL data": ["post", "part.cls", "--work-offset=0,0,250", "--out", "out"],
    "convert": ["convert", "part.ngc", "--to", "gcode:vector", "--out", "out/part.ngc"],
    "reach-map": ["reach-map", "example_6tps", "--x=0:50:50", "--y=0:0:1", "--z=200:200:1", "--out", "out"],
    "export": ["machine", "export", "example_6tps", "--to", "linuxcnc", "--out", "out"],
    "calibrate": ["machine", "calibrate", "example_6tps", "poses.csv", "--out", "out/mine.toml"],
    "batch": ["batch", "jobs.toml", "--jobs", "1"],
}


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """The current folder, with the inputs."""
    monkeypatch.chdir(tmp_path)
    inputs(Path("."), "\n")
    return tmp_path


def inputs(folder, newline):
    folder.mkdir(exist_ok=True)
    machine, _ = machine_named("example_6tps")
    random = np.random.default_rng(1)
    tip = random.uniform([-100, -100, 150], [100, 100, 300], (12, 3))
    axis = random.normal(0, 0.1, (12, 3)) + [0, 0, 1]
    pose = tip, axis / np.linalg.norm(axis, axis=1)[:, None], random.uniform(-0.2, 0.2, 12), np.full(12, 120.0)
    table = np.column_stack([*pose[:2], np.degrees(pose[2]), pose[3], strut_lengths(machine, *pose)])
    rows = "\n".join([",".join(COLUMNS), *(",".join(f"{value:.9f}" for value in row) for row in table), ""])
    jobs = f'out = "out"\narguments = "{" ".join(PLACED)}"\n[[jobs]]\nfile = "part.ngc"\n'
    machine_file = (
        Path(__file__).parents[2].joinpath("resources/machines/example_6tps.toml").read_text(encoding="utf-8")
    )
    texts = {"part.ngc": G_CODE, "part.cls": CL_DATA, "poses.csv": rows, "jobs.toml": jobs, "mine.toml": machine_file}
    for name, text in texts.items():
        (folder / name).write_text(text, encoding="utf-8", newline=newline)


class Opened:
    """Files that were opened to be written, as Python's audit events name them; a hook cannot be taken away again."""

    def __init__(self):
        self.paths = None
        sys.addaudithook(self._hear)

    def _hear(self, event, arguments):
        if self.paths is None or event != "open" or not isinstance(arguments[0], str | os.PathLike):
            return
        if arguments[2] & (os.O_WRONLY | os.O_RDWR):
            self.paths.append(Path(os.path.abspath(arguments[0])))


@pytest.fixture(scope="module")
def opened():
    return Opened()


@pytest.mark.parametrize("command", COMMANDS)
def test_every_file_is_written_in_a_private_folder(folder, opened, command):
    opened.paths = []
    try:
        assert main(COMMANDS[command]) == 0
    finally:
        paths, opened.paths = opened.paths, None
    below = [path.relative_to(folder).parts for path in paths if path.is_relative_to(folder)]
    assert below
    assert [parts for parts in below if not any(part.startswith(".staged-") for part in parts)] == []


def without_fingerprints(path):
    """A result without the SHA-256 of its inputs; of a trajectory file, which has them in bytes, the size."""
    return path.stat().st_size if path.suffix == ".pkmt" else re.sub(rb"[0-9a-f]{16,64}", b"#", path.read_bytes())


def hold(monkeypatch, attempts):
    """Let another program have each result open for a number of attempts to move it."""
    replace, left = os.replace, {}

    def held(source, target):
        name = os.path.basename(target)
        if left.setdefault(name, attempts) > 0:
            left[name] -= 1
            fault = PermissionError(13, "The process cannot access the file", str(source))
            fault.winerror = SHARING_VIOLATION
            raise fault
        replace(source, target)

    monkeypatch.setattr(os, "replace", held)


@pytest.mark.parametrize("command", [name for name in COMMANDS if name != "batch"])
def test_files_that_are_open_elsewhere_are_waited_for_and_then_named(folder, monkeypatch, capsys, command):
    staged = sys.modules["pkm_post.system.staged"]
    assert main(COMMANDS[command]) == 0
    before = {path.name: path.read_bytes() for path in Path("out").iterdir()}
    seconds = [0.0]
    clock = type(
        "Clock", (), {"monotonic": lambda: seconds[0], "sleep": lambda s: seconds.__setitem__(0, seconds[0] + s)}
    )
    monkeypatch.setattr(staged, "time", clock)
    with monkeypatch.context() as held:
        hold(held, 20)
        assert main(COMMANDS[command]) == 0
    assert {path.name: path.read_bytes() for path in Path("out").iterdir()} == before
    capsys.readouterr()
    with monkeypatch.context() as held:
        hold(held, 10**9)
        assert main(COMMANDS[command]) == 1
    assert "error F113" in capsys.readouterr().err
    assert {path.name: path.read_bytes() for path in Path("out").iterdir()} == before


@pytest.mark.parametrize("command", [name for name in COMMANDS if name not in ("reach-map", "export")])
def test_ends_of_lines_of_windows_change_nothing_but_fingerprints(tmp_path, monkeypatch, command):
    results = []
    for newline in ("\n", "\r\n"):
        inputs(tmp_path / "work", newline)
        monkeypatch.chdir(tmp_path / "work")
        assert main(COMMANDS[command]) == 0
        results.append({path.name: without_fingerprints(path) for path in Path("out").iterdir()})
        monkeypatch.chdir(tmp_path)
        (tmp_path / "work").rename(tmp_path / f"work {len(results)}")
    assert results[0] == results[1]


def test_a_machine_file_and_a_program_that_an_editor_of_windows_saved(folder):
    assert main(["post", "part.ngc", "--machine", "mine.toml", *PLACED, "--out", "out"]) == 0
    program = Path("out/part.pmc").read_bytes()
    plain = without_fingerprints(Path("out/part.pmc"))
    inputs(Path("."), "\r\n")
    assert b"\r\n" in Path("mine.toml").read_bytes()
    assert main(["post", "part.ngc", "--machine", "mine.toml", *PLACED, "--out", "other"]) == 0
    assert without_fingerprints(Path("other/part.pmc")) == plain
    inputs(Path("."), "\n")  # a machine is known by the bytes of its file
    Path("out/part.pmc").write_bytes(program.replace(b"\n", b"\r\n"))
    assert main(["verify", "out/part.pmc", "--against", "out/part.pkmt", "--machine", "mine.toml"]) == 0
