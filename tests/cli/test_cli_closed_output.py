# SPDX-License-Identifier: LGPL-2.1-or-later
"""Who reads what the command line prints may go before it is done, as ``head`` does."""

import os
import subprocess
from pathlib import Path

import pytest

ADDON = Path(__file__).parents[2]
PART = "G21 G90 G17\nT1 M6\nS5000 M3\nG0 X0 Y0 Z300\nG1 X10 F600\nM5\nM30\n"


def run_unread(*arguments, python=("python3",)):
    """Run a command whose output is closed from the beginning."""
    reads, writes = os.pipe()
    os.close(reads)
    try:
        command = [*python, "-m", "pkm_post", *map(str, arguments)]
        found = os.environ | {"PYTHONPATH": str(ADDON)}
        return subprocess.run(
            command, env=found, stdout=writes, stderr=subprocess.PIPE, text=True, timeout=300, check=False
        )
    finally:
        os.close(writes)


@pytest.mark.parametrize("python", [("python3",), ("python3", "-u")])
def test_output_that_nobody_reads_ends_a_command_without_a_word(python):
    ran = run_unread("machine", "check", "example_6tps", python=python)
    assert (ran.returncode, ran.stderr) == (1, "")


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="only Linux has a file on a full disk")
@pytest.mark.parametrize("python", [("python3",), ("python3", "-u")])
@pytest.mark.parametrize("command", [("machine", "check", "example_6tps"), ("post", "--tool-length", "1=120")])
def test_output_on_a_full_disk_is_said_in_one_line(tmp_path, python, command):
    part = tmp_path / "part.ngc"
    part.write_text(PART, encoding="ascii")
    files = [part, "--out", tmp_path / "out"] if command[0] == "post" else []
    with open("/dev/full", "w", encoding="ascii") as full:
        ran = subprocess.run(
            [*python, "-m", "pkm_post", *command, *map(str, files)],
            env=os.environ | {"PYTHONPATH": str(ADDON)}, stdout=full, stderr=subprocess.PIPE, text=True, timeout=300,
            check=False,
        )  # fmt: skip
    assert ran.returncode == 1
    assert ran.stderr.splitlines()[-1].startswith(
        "standard output: error F101: the output cannot be written: No space left"
    )
    assert "Traceback" not in ran.stderr and "Exception ignored" not in ran.stderr


def test_posting_that_nobody_follows_leaves_nothing(tmp_path):
    part = tmp_path / "part.ngc"
    part.write_text(PART, encoding="ascii")
    ran = run_unread("post", part, "--tool-length", "1=120", "--out", tmp_path / "out", python=("python3", "-u"))
    assert (ran.returncode, ran.stderr) == (1, "")
    assert list((tmp_path / "out").iterdir()) == []
