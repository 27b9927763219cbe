# SPDX-License-Identifier: LGPL-2.1-or-later
"""A reader in C, made of the header in resources/trajectory alone, agrees with the one in Python on every field."""

import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from made_files import newer
from plain_text import lines_of
from trajectories import PROGRAMS, placed, random_trajectory

from pkm_post.toolpath.segments import Segments
from pkm_post.writing.trajectory_file import write

HERE = Path(__file__).parent
INCLUDE = HERE.parents[2] / "resources" / "trajectory"
STRICT = ("-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror")
ROUNDING = 1e-11
"""mm and rad, of coordinates of some hundred mm."""


@pytest.fixture(scope="module")
def compiler():
    found = shutil.which("gcc") or shutil.which("cc")
    assert found, "there is no C compiler, gcc or cc, on PATH; Debian has it in gcc and libc6-dev"
    return found


@pytest.fixture(scope="module")
def program(compiler, tmp_path_factory):
    made = tmp_path_factory.mktemp("made") / "read_trajectory"
    source = HERE / "read_trajectory.c"
    command = [compiler, "-std=c11", "-O1", *STRICT, "-I", INCLUDE, source, "-o", made, "-lm"]
    subprocess.run(command, check=True, timeout=300)
    return made


def reported(program, *arguments):
    """What the program prints, by line."""
    run = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True, check=True, timeout=300)
    assert run.stderr == ""
    return run.stdout.splitlines()


@pytest.mark.parametrize("seed", range(4))
def test_every_field_is_the_same(program, tmp_path, seed):
    path = tmp_path / "part.pkmt"
    write(random_trajectory(seed, count=(0, 1, 30, 300)[seed], events=9 * seed), path)
    found = [line for line in reported(program, path) if not line.startswith("middle ")]
    assert found == list(lines_of(path.read_bytes()))


@pytest.mark.parametrize("part", PROGRAMS)
def test_the_tool_is_in_the_middle_of_segments_where_the_planner_has_it(program, tmp_path, part):
    trajectory = placed(part)
    write(trajectory, tmp_path / "part.pkmt")
    found = [line.split() for line in reported(program, tmp_path / "part.pkmt") if line.startswith("middle ")]
    words = np.array(found)
    assert words.shape == (len(trajectory), 11)
    assert {*words[:, 1]} == {"tip"} and {*words[:, 5]} == {"axis"} and {*words[:, 9]} == {"spin"}
    planned, rows = Segments.of(trajectory), np.arange(len(trajectory))
    half = planned.extent / 2
    np.testing.assert_allclose(words[:, 2:5].astype(float), planned.tip_at(rows, half)[0], atol=ROUNDING)
    np.testing.assert_allclose(words[:, 6:9].astype(float), planned.axis_at(rows, half)[0], atol=ROUNDING)
    spin = planned.spin + half * planned.spin_rate
    np.testing.assert_allclose(words[:, 10].astype(float), spin, atol=ROUNDING)


def test_the_segment_of_a_line_is_found_by_halving(program, tmp_path):
    trajectory = random_trajectory(5, count=40)
    write(trajectory, tmp_path / "part.pkmt")
    keys = list(zip(trajectory.operation.tolist(), trajectory.line.tolist(), strict=True))
    asked = [*keys[::4], (0, 0), (1, 0), (2, 0), (1, 2**31 - 1), (2, 2**31 - 1)]
    for key in asked:
        behind = [one for one in keys if one >= key]
        expected = keys.index(min(behind)) if behind else len(keys)
        assert reported(program, tmp_path / "part.pkmt", *key) == [str(expected)]


def test_a_newer_minor_version_is_read_without_what_it_adds(program, tmp_path):
    path = tmp_path / "part.pkmt"
    write(random_trajectory(7), path)
    older, lines = list(lines_of(path.read_bytes())), slice(1, None)
    path.write_bytes(newer(path.read_bytes()))
    found = [line for line in reported(program, path) if not line.startswith("middle ")]
    assert " minor 2 " in found[0]
    assert found[lines] == older[lines]


def refused(program, path, content):
    path.write_bytes(content)
    run = subprocess.run([program, str(path)], capture_output=True, text=True, timeout=300, check=False)
    return run.returncode == 1 and run.stderr.startswith("not read: ") and run.stdout == ""


def test_a_damaged_file_is_refused(program, tmp_path):
    path = tmp_path / "part.pkmt"
    write(random_trajectory(6), path)
    sound = path.read_bytes()
    for length in (0, 7, 8, 511, 512, len(sound) - 1):
        assert refused(program, path, sound[:length])
    assert refused(program, path, sound + b"\0")
    for at in (0, 8, 12, 20, 25, 30, 40, 300, 500, len(sound) - 1):
        damaged = bytearray(sound)
        damaged[at] ^= 64
        assert refused(program, path, bytes(damaged))
    assert refused(program, tmp_path / "none.pkmt", b"")


def compiles(compiler, folder, header):
    """Whether a program that includes a header, and nothing before it, compiles."""
    (folder / "own.h").write_text(header)
    (folder / "alone.c").write_text('#include "own.h"\nint main(void) { return 0; }\n')
    command = [compiler, "-std=c11", *STRICT, "-fsyntax-only", folder / "alone.c"]
    run = subprocess.run(command, capture_output=True, text=True, check=False, timeout=300)
    assert run.returncode == 0 or "static assertion failed" in run.stderr
    return run.returncode == 0


def test_the_header_compiles_by_itself_and_not_when_a_field_has_moved(compiler, tmp_path):
    header = (INCLUDE / "pkmt.h").read_text()
    assert compiles(compiler, tmp_path, header)
    assert not compiles(compiler, tmp_path, header.replace("    double shift[3];", "    double shift[2];"))
    assert not compiles(compiler, tmp_path, header.replace("    int32_t line;\n", "", 1))
