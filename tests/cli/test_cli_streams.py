# SPDX-License-Identifier: LGPL-2.1-or-later
"""Commands of services and of other locales: streams that are missing or cannot show a name, and Ctrl-C."""

import json
import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from interpreter import PYTHON

ADDON = Path(__file__).parents[2]
PART = "G21 G90 G17\nT1 M6\nS5000 M3\nG0 X0 Y0 Z300\nG1 X10 F600\nM5\nM30\n"
TOOL = ("--tool-length", "1=120")
ODD = os.fsdecode(b"\xff\xfe.ngc")
needs_any_name = pytest.mark.skipif(sys.platform != "linux", reason="file names are Unicode here")


def command(*arguments):
    return [PYTHON, "-m", "pkm_post", *map(str, arguments)]


def run(*arguments, cwd=None, **environment):
    return subprocess.run(
        command(*arguments), cwd=cwd, env=os.environ | {"PYTHONPATH": str(ADDON)} | environment,
        stdin=subprocess.DEVNULL, capture_output=True, timeout=300, check=False,
    )  # fmt: skip


def run_without(closed, *arguments):
    """Run a command with some of its streams closed, as a shell does with ``<&-``; the exit code and its errors."""
    script = f"import os, sys\nfor number in {closed!r}: os.close(number)\nos.execvp(sys.argv[1], sys.argv[1:])"
    ran = subprocess.run(
        [PYTHON, "-c", script, *command(*arguments)],
        env=os.environ | {"PYTHONPATH": str(ADDON)},
        stderr=subprocess.PIPE,
        timeout=300,
        check=False,
    )
    return ran.returncode, ran.stderr.decode()


@pytest.fixture
def part(tmp_path):
    file = tmp_path / "part.ngc"
    file.write_text(PART, encoding="ascii")
    return file


@pytest.mark.slow
@pytest.mark.parametrize("closed", [(0, 1, 2), (2,), (1,)])
def test_posting_needs_no_streams(part, tmp_path, closed):
    assert run_without(closed, "post", part, *TOOL, "--out", tmp_path / "out") == (0, "")
    assert (tmp_path / "out" / "part.pmc").exists()


def test_who_reads_lines_without_an_input_gets_none():
    script = f"""
import sys
sys.path.insert(0, {str(ADDON)!r})
sys.stdin = None
from pkm_post.cli import main
assert main(["machine", "list"]) == 0
assert list(sys.stdin) == [] and sys.stdin.readline() == ""
"""
    ran = subprocess.run([PYTHON, "-c", script], capture_output=True, text=True, timeout=300, check=False)
    assert ran.returncode == 0, ran.stderr


def test_a_byte_that_is_no_character_does_not_end_the_lines_of_the_input():
    """An operator's orders are read from it, the stops among them."""
    script = f"""
import sys
sys.path.insert(0, {str(ADDON)!r})
from pkm_post.cli import main
assert main(["machine", "list"]) == 0
lines = list(sys.stdin)
assert lines[1:] == ["hold\\n"], lines
"""
    environment = os.environ | {"PYTHONIOENCODING": "utf-8:strict"}
    ran = subprocess.run(
        [PYTHON, "-c", script],
        input=b"gr\xfc\xdfe\nhold\n",
        env=environment,
        capture_output=True,
        timeout=300,
        check=False,
    )
    assert ran.returncode == 0, ran.stderr


@needs_any_name
def test_a_name_that_is_no_unicode_is_posted_as_it_is_checked(tmp_path):
    file = tmp_path / ODD
    file.write_text(PART, encoding="ascii")
    for arguments in (("check", file), ("post", file, *TOOL, "--out", tmp_path / "out")):
        ran = run(*arguments)
        assert (ran.returncode, b"Traceback" in ran.stderr) == (0, False)
    assert (tmp_path / "out" / ODD).with_suffix(".pmc").exists()


ODD_NAMES = {
    0: [
        "check a@.ngc", "reach a@.ngc +", "reach --json a@.ngc +", "convert a@.ngc --to gcode:vector --out o@.nc",
        "post a@.ngc + --out o@ --also csv,halstreamer,linuxcnc", "post a@.ngc b.ngc + --out o@ --jobs 2",
        "post a@.ngc + --out o@ --machine machine@.toml", "verify m@.pmc --against m@.pkmt",
        "machine check machine@.toml",
    ],
    1: [
        "check --json a@.ngc bad@.ngc", "check bad@.ngc", "reach bad@.ngc +", "post bad@.ngc + --out o@",
        "convert bad@.ngc --to gcode:BC --out o@/b.nc", "post b.ngc + --out o@ --part none@.stl",
        "post b.ngc + --out o@ --machine bad@.ngc", "post b.ngc + --out a@.ngc", "verify a@.ngc --against m@.pkmt",
        "verify none@.pmc --against a@.ngc", "machine check bad@.ngc",
    ],
    2: ["post a@.ngc a@.cls + --out o@"],
}  # fmt: skip
"""By exit code, commands with a byte that is no UTF-8 for each @, and what posting needs for +."""


IN_FOLDERS = """
import json, os, sys, traceback
from pkm_post.cli import main
codes = []
for folder, words in json.loads(sys.stdin.read()):
    os.chdir(folder)
    for stream, name in ((1, "answer"), (2, "errors")):
        file = os.open(name, os.O_WRONLY | os.O_CREAT, 0o666)
        os.dup2(file, stream)
        os.close(file)
    try:
        codes.append(main(words))
    except SystemExit as leaving:
        codes.append(leaving.code)
    except BaseException:
        codes.append(traceback.print_exc())
    sys.stdout.flush()
    sys.stderr.flush()
with open(sys.argv[1], "w") as file:
    json.dump(codes, file)
"""
"""One command in each folder, in one process; their exit codes go into a file, what they print into the folders."""


@pytest.fixture(scope="module")
def answers(tmp_path_factory):
    """By its words, the exit code and the folder of each of ``ODD_NAMES``."""
    top = tmp_path_factory.mktemp("odd")
    contents = {"a@.ngc": PART, "b.ngc": PART, "bad@.ngc": "G0 X1..2\nM2\n", "a@.cls": PART}
    contents["machine@.toml"] = (ADDON / "resources/machines/example_6tps.toml").read_text(encoding="utf-8")
    (top / odd("m@.ngc")).write_text(PART, encoding="utf-8")
    assert run("post", odd("m@.ngc"), *TOOL, cwd=top).returncode == 0
    posted = [odd("m@.pmc"), odd("m@.pkmt")]
    commands = [words for each in ODD_NAMES.values() for words in each]
    folders = [top / str(number) for number, _ in enumerate(commands)]
    for folder in folders:
        folder.mkdir()
        for name, text in contents.items():
            (folder / odd(name)).write_text(text, encoding="utf-8")
        for name in posted:
            shutil.copy(top / name, folder)
    words = [odd(each.replace("+", " ".join(TOOL))).split() for each in commands]
    subprocess.run(
        [PYTHON, "-c", IN_FOLDERS, top / "codes.json"],
        env=os.environ | {"PYTHONPATH": str(ADDON)},
        input=json.dumps(list(zip(map(str, folders), words, strict=True))),
        text=True, timeout=240, check=True,
    )  # fmt: skip
    codes = json.loads((top / "codes.json").read_text(encoding="ascii"))
    return dict(zip(commands, zip(codes, folders, strict=True), strict=True))


@pytest.mark.slow
@needs_any_name
@pytest.mark.parametrize(("code", "words"), [(code, each) for code in ODD_NAMES for each in ODD_NAMES[code]])
def test_no_name_is_a_traceback(answers, code, words):
    left, folder = answers[words]
    errors = (folder / "errors").read_bytes()
    assert (left, b"Traceback" in errors) == (code, False), errors
    if "--json" in words:
        json.loads((folder / "answer").read_bytes())
    for program in folder.glob("o*/*.pmc"):
        program.read_bytes().decode("ascii")


def odd(text):
    """A text with a byte that is no UTF-8 in the place of each @."""
    return os.fsdecode(text.encode().replace(b"@", b"\xe9"))


@pytest.mark.slow
@pytest.mark.parametrize("jobs", [1, 2])
def test_a_name_that_the_terminal_cannot_show_is_reported_by_codes(tmp_path, jobs):
    files = [tmp_path / f"{name}.ngc" for name in "日b"]
    for file in files:
        file.write_text(PART, encoding="ascii")
    ran = run("post", *files, *TOOL, "--out", "made", "--jobs", jobs, PYTHONIOENCODING="cp1252", cwd=tmp_path)
    assert ran.returncode == 0, ran.stderr
    assert rb"\u65e5.pmc" in ran.stdout


def test_a_name_that_is_too_long_is_no_file():
    ran = run("check", "a" * 300 + ".ngc")
    assert ran.returncode == 1
    assert b"aaa.ngc: error F103: " in ran.stdout and b"Traceback" not in ran.stderr


SLOW = """
import sys, time
sys.path.insert(0, {addon!r})
from pkm_post.cli import main, machine
def sleep(*_):
    print("asleep", flush=True)
    while True:
        time.sleep(0.01)  # a signal that comes just before a long sleep would wait for its end
machine._list = sleep
sys.exit(main(["machine", "list"]))
"""


def test_ctrl_c_ends_a_command_quietly():
    ran = subprocess.Popen(
        [PYTHON, "-c", SLOW.format(addon=str(ADDON))], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert ran.stdout.readline() == "asleep\n"
    ran.send_signal(signal.SIGINT)
    _, errors = ran.communicate(timeout=300)
    assert (ran.returncode, errors) == (130, "")
