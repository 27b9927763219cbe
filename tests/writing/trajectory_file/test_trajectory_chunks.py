# SPDX-License-Identifier: LGPL-2.1-or-later
"""A trajectory in parts is the trajectory, and neither its file nor the memory for it depends on its length."""

import tracemalloc

import numpy as np
import pytest
from trajectories import random_trajectory

from pkm_post.model.trajectory import TRAJECTORY_COLUMNS
from pkm_post.writing.trajectory_file import invariants as module
from pkm_post.writing.trajectory_file import write
from pkm_post.writing.trajectory_file.invariants import chunks
from pkm_post.writing.trajectory_file.layout import SEGMENT

TRAJECTORY = random_trajectory(31, count=100)
"""Its tools have other lengths, and change often."""


@pytest.mark.parametrize("size", [1, 7, 99, 100, 101])
def test_parts_start_where_the_ones_before_end(monkeypatch, size):
    monkeypatch.setattr(module, "SEGMENTS_PER_CHUNK", size)
    found = list(chunks(TRAJECTORY))
    assert [begin for begin, _ in found] == list(range(0, 100, size))
    for name in TRAJECTORY_COLUMNS:
        joined = np.concatenate([getattr(part, name) for _, part in found])
        assert joined.tobytes() == getattr(TRAJECTORY, name).tobytes()
    for name in ("tip_before", "axis_before", "spin_before"):
        joined = np.concatenate([getattr(part, name)() for _, part in found])
        np.testing.assert_array_equal(joined, getattr(TRAJECTORY, name)())


@pytest.mark.parametrize("size", [1, 7, 100])
def test_the_file_does_not_depend_on_the_size_of_the_parts(tmp_path, monkeypatch, size):
    write(TRAJECTORY, tmp_path / "whole.pkmt")
    monkeypatch.setattr(module, "SEGMENTS_PER_CHUNK", size)
    write(TRAJECTORY, tmp_path / "parted.pkmt")
    assert (tmp_path / "whole.pkmt").read_bytes() == (tmp_path / "parted.pkmt").read_bytes()


def test_a_fault_is_reported_with_its_place_in_the_whole(tmp_path, monkeypatch):
    monkeypatch.setattr(module, "SEGMENTS_PER_CHUNK", 7)
    feed = TRAJECTORY.feed.copy()
    feed[[40, 41, 90]] = 0.0
    with pytest.raises(ValueError, match="segment 40 and 2 more: the feed is not a finite number above 0"):
        write(module.dataclasses.replace(TRAJECTORY, feed=feed), tmp_path / "part.pkmt")


def test_the_writer_has_no_copy_of_the_segments(tmp_path):
    """Twenty parts are written in the memory of a few; the index of lines takes its share, all lines being others."""
    count = 20 * module.SEGMENTS_PER_CHUNK
    trajectory = random_trajectory(32, count=count)
    tracemalloc.start()
    write(trajectory, tmp_path / "part.pkmt")
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 3 * module.SEGMENTS_PER_CHUNK * SEGMENT.itemsize + 60 * count
    assert peak < count * SEGMENT.itemsize / 2
