# SPDX-License-Identifier: LGPL-2.1-or-later
"""Many files are posted at the same time, reported in their order, and none stops the others."""

import os
import re
import signal
import subprocess
import time
from pathlib import Path

import pytest
from interpreter import PYTHON

from pkm_post.cli.parallel import run_parallel

ADDON = Path(__file__).parents[2]
G_CODE = """\
T1 M6 G43 H1
G21 G90 G94 S8000 M3
G0 X0 Y0 Z30
G43.5 I0 J0 K1
G1 X10 Y0 Z20 I0.1 J0 K1 F600
M5
M30
"""
REACHED = ["--axis-words", "vector", "--tool-length", "1=60", "--work-offset=0,0,250"]


def says(text, error="", code=0, seconds=0.0):
    """A command that prints and ends."""
    script = (
        f"import sys, time; time.sleep({seconds}); print({text!r}); print({error!r}, file=sys.stderr); sys.exit({code})"
    )
    return [PYTHON, "-c", script]


def test_outputs_are_in_order_whatever_ends_first(capfd):
    assert run_parallel([says("first", seconds=0.5), says("second"), says("third")], 3, "said") == 0
    assert capfd.readouterr().out.split() == ["first", "second", "third"]


@pytest.mark.parametrize("at_a_time", [1, 2])
def test_a_failure_does_not_stop_the_others_and_decides_the_code(capfd, at_a_time):
    assert run_parallel([says("one"), says("two", "no", 2), says("three")], at_a_time, "said") == 1
    reported = capfd.readouterr()
    assert reported.out.split() == ["one", "two", "three"]
    assert reported.err.split() == ["no"]


def test_at_most_so_many_at_a_time(tmp_path):
    script = (
        "import pathlib, sys, time; here = pathlib.Path(sys.argv[1]); mine = here / sys.argv[2]; mine.touch();"
        "print(len(list(here.iterdir()))); time.sleep(0.2); mine.unlink()"
    )
    reported = subprocess.run(
        [PYTHON, "-c", f"""
import sys
from pkm_post.cli.parallel import run_parallel
commands = [[sys.executable, "-c", {script!r}, {str(tmp_path)!r}, str(number)] for number in range(6)]
sys.exit(run_parallel(commands, 2, "counted"))
"""],
        env=os.environ | {"PYTHONPATH": str(ADDON)}, capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert {int(count) for count in reported.stdout.split()} <= {1, 2}


def post(*arguments, **more):
    return subprocess.Popen(
        [PYTHON, "-m", "pkm_post", "post", *map(str, arguments)],
        env=os.environ | {"PYTHONPATH": str(ADDON)},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        **more,
    )


@pytest.fixture
def programs(tmp_path):
    files = [tmp_path / f"{name}.ngc" for name in "abc"]
    for file in files:
        file.write_text(G_CODE)
    return files


def test_batch_is_reported_file_by_file(programs, tmp_path):
    programs[1].write_text(G_CODE.replace("F600", "F0"))
    reported = post(*programs, *REACHED, "--out", tmp_path / "out", "--jobs", 3)
    printed, errors = reported.communicate(timeout=300)
    assert reported.returncode == 1
    written = [Path(line).name for line in printed.splitlines() if line.startswith(str(tmp_path))]
    assert written == [
        f"{name}{end}"
        for name in "ac"
        for end in ("-manifest.json", "-report.html", "-report.json", "-setup.pmc", ".pkmt", ".pmc")
    ]
    assert re.search(r"b\.ngc: line 5.* error G408", errors)
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == sorted(written)


def test_batch_gives_the_bytes_that_one_process_gives(programs, tmp_path):
    for jobs in (1, 2):
        reported = post(*programs, *REACHED, "--out", tmp_path / str(jobs), "--jobs", jobs)
        reported.communicate(timeout=300)
        assert reported.returncode == 0
    one, two = ({path.name: path.read_bytes() for path in (tmp_path / str(jobs)).iterdir()} for jobs in (1, 2))
    assert one == two


@pytest.mark.parametrize("jobs", ["0", "-1", "many"])
def test_number_of_processes_that_makes_no_sense(programs, jobs):
    reported = post(*programs, "--jobs", jobs)
    reported.communicate(timeout=300)
    assert reported.returncode == 2


def test_a_process_that_the_system_kills_or_does_not_start_is_reported_with_its_file(capfd, tmp_path):
    """As where memory runs out."""
    killed = [PYTHON, "-c", "import os, signal; os.kill(os.getpid(), signal.SIGKILL)"]
    commands, files = [says("one"), killed, [str(tmp_path / "none")]], ["a.ngc", "b.ngc", "c.ngc"]
    assert run_parallel(commands, 1, "said", files) == 1
    second, third = filter(None, capfd.readouterr().err.splitlines())
    assert second.startswith("b.ngc: error F144: ") and "exit code -9" in second
    assert third.startswith("c.ngc: error F144: ") and "No such file" in third


POOL = "concurrent.futures.ThreadPoolExecutor(2)"


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_ends_all(tmp_path, number):
    """Also the children of a job that a shell without a terminal started, which ignores SIGINT."""
    before = signal.signal(signal.SIGINT, signal.SIG_IGN if number != signal.SIGINT else signal.default_int_handler)
    try:
        parent, children = started(tmp_path, "run_parallel([COMMAND] * 3, 2, 'slept')")
    finally:
        signal.signal(signal.SIGINT, before)
    parent.send_signal(number)
    parent.communicate(timeout=300)
    assert parent.returncode == 130
    assert [pid for pid in children if Path(f"/proc/{pid}").exists()] == []


def test_termination_ends_the_processes_of_a_batch(tmp_path):
    run = f"list({POOL}.map(Child.run, [Child(COMMAND, {{}}, leads=False)] * 2))"
    parent, children = started(tmp_path, run)
    parent.send_signal(signal.SIGTERM)
    parent.communicate(timeout=300)
    assert [pid for pid in children if Path(f"/proc/{pid}").exists()] == []


def test_termination_removes_the_private_folder(tmp_path):
    script = f"""
import os, pathlib, time
from pkm_post.cli.terminal import interrupt_on_end
from pkm_post.system import staged
interrupt_on_end()
with staged(pathlib.Path({str(tmp_path / "out")!r})) as folder:
    (folder / "half").touch()
    pathlib.Path({str(tmp_path / "begun")!r}).touch()
    time.sleep(60)
"""
    process = subprocess.Popen(
        [PYTHON, "-c", script], env=os.environ | {"PYTHONPATH": str(ADDON)}, stderr=subprocess.DEVNULL
    )
    until(lambda: (tmp_path / "begun").exists())
    process.send_signal(signal.SIGTERM)
    process.wait(300)
    assert list((tmp_path / "out").iterdir()) == []


def until(is_so):
    end = time.monotonic() + 300
    while not is_so() and time.monotonic() < end:
        time.sleep(0.05)
    assert is_so()


def started(tmp_path, run):
    """A process that runs two commands, which sleep; it, and the numbers of theirs."""
    sleep = f"import os, pathlib, time; pathlib.Path({str(tmp_path)!r}, str(os.getpid())).touch(); time.sleep(60)"
    script = f"""
import sys
import concurrent.futures
from pkm_post.cli.parallel import Child, run_parallel
from pkm_post.cli.terminal import interrupt_on_end
interrupt_on_end()
COMMAND = [sys.executable, "-c", {sleep!r}]
sys.exit({run})
"""
    parent = subprocess.Popen(
        [PYTHON, "-c", script], env=os.environ | {"PYTHONPATH": str(ADDON)},
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    until(lambda: len(list(tmp_path.iterdir())) == 2)
    return parent, [int(path.name) for path in tmp_path.iterdir()]
