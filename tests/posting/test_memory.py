# SPDX-License-Identifier: LGPL-2.1-or-later
"""Posting in pieces: their size changes nothing, and memory for a line stays below a stated number of bytes."""

import gc
import json
import sys
import tracemalloc
from pathlib import Path

import numpy as np
import pytest
from long_programs import ALL, PIECES, scan
from machines import text_without_jerk

from pkm_post.options.choices import Options
from pkm_post.posting.post_file import post_file
from pkm_post.posting.run import give_back_memory
from pkm_post.reading.part_program import ReadingOptions

resource = pytest.importorskip("resource")  # POSIX

BYTES_PER_LINE = 1600
"""Of a rough surface with 1.4 points of the motion to a line, at most: it takes 1300, and took 3100 in one piece.

That is without limits of jerk: with them, a window is searched in one piece, which is as long as these programs."""
ON_PALLET = np.eye(4)
ON_PALLET[2, 3] = 200.0


def post(folder, lines, leans=False, name="scan", machine="example_6tps"):
    """Post a scan; the files by name."""
    file = folder / "scan.ngc"
    file.write_text(scan(lines, leans))
    reading = ReadingOptions(axis_words="vector" if leans else "none")
    options = Options(work_offset=ON_PALLET)
    made = post_file(file, machine, folder / name, options, {1: 120.0, 2: 100.0}, reading)
    return {path.name: path for path in made.files}


@pytest.mark.slow
@pytest.mark.parametrize("leans", [False, True])
def test_pieces_of_any_size_give_the_same_files(monkeypatch, tmp_path, leans):
    def posted(size):
        for module, name in PIECES:
            monkeypatch.setattr(module, name, size)
        return post(tmp_path, 100, leans, str(size))

    whole = posted(ALL)
    expected = json.loads(whole["scan-report.json"].read_text())
    for size in (1, 7, 1000):
        found = posted(size)
        assert found.keys() == whole.keys()
        for name in ("scan.pkmt", "scan.pmc"):
            assert found[name].read_bytes() == whole[name].read_bytes(), (name, size)
        assert_alike(json.loads(found["scan-report.json"].read_text()), expected)


def assert_alike(found, expected):
    """The same report; numbers that are sums of many may differ in their last digits."""
    if isinstance(expected, dict):
        assert found.keys() == expected.keys()
        for key in expected:
            assert_alike(found[key], expected[key])
    elif isinstance(expected, list):
        assert len(found) == len(expected)
        for one, other in zip(found, expected, strict=True):
            assert_alike(one, other)
    elif isinstance(expected, float):
        assert found == pytest.approx(expected, rel=1e-6, abs=1e-9)
    else:
        assert found == expected


@pytest.mark.slow
def test_memory_for_a_line_is_bounded(tmp_path):
    """The difference of two jobs: what does not depend on their length, as the pieces themselves, is in both."""
    few, many = 4000, 12000
    machine = tmp_path / "jumping.toml"
    machine.write_text(text_without_jerk(), encoding="utf-8")
    post(tmp_path, 500, machine=machine)  # what is imported and kept for later jobs is there then
    peaks = [peak_of(tmp_path, lines, machine) for lines in (few, many)]
    assert (peaks[1] - peaks[0]) / (many - few) < BYTES_PER_LINE


def peak_of(folder: Path, lines: int, machine: Path) -> int:
    """The most memory that posting takes, bytes."""
    gc.collect()
    tracemalloc.start()
    try:
        post(folder, lines, machine=machine)
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


@pytest.mark.skipif(sys.platform != "linux", reason="it asks the C library and the kernel of Linux")
def test_what_is_free_between_columns_is_given_back_to_the_system():
    columns = [np.ones(12_000) for _ in range(2000)]
    kept = columns[::10]
    free = sum(column.nbytes for column in columns) - sum(column.nbytes for column in kept)
    del columns
    before = resident()
    give_back_memory()
    assert before - resident() > free / 2
    assert all(column.all() for column in kept)


def resident() -> int:
    """Memory that this process has, bytes."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * resource.getpagesize()
