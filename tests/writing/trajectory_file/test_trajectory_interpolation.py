# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is computed in advance gives the way that the rest of the house goes, and the lines where it begins."""

import dataclasses

import numpy as np
import pytest
from trajectories import PROGRAMS, placed, random_trajectory, two_tools

from pkm_post.model import Kind
from pkm_post.toolpath.segments import Segments
from pkm_post.writing.trajectory_file.interpolation import blocks, interpolation

ROUNDING = 1e-11
"""mm and rad, of coordinates of some hundred mm."""


@pytest.fixture(params=PROGRAMS)
def trajectory(request):
    return placed(request.param)


def poses(trajectory, u):
    """Tip, axis and spin of all segments at one share, by the formula of docs/trajectory-format.md."""
    made = interpolation(trajectory)
    column = {name: value[:, None] if value.ndim == 1 else value for name, value in made.items()}
    turned, tilted = u * trajectory.sweep[:, None], u * trajectory.angle[:, None]
    tip = (
        column["start_tip"]
        + u * column["shift"]
        + (1 + u * column["growth"]) * (np.cos(turned) * column["radius"] + np.sin(turned) * column["quarter"])
        - column["radius"]
    )
    axis = np.cos(tilted) * column["start_axis"] + np.sin(tilted) * column["axis_quarter"]
    return tip, axis, made["start_spin"] + u * (trajectory.spin - made["start_spin"])


def test_segments_begin_where_the_ones_before_end(trajectory):
    tip, axis, spin = poses(trajectory, 0.0)
    np.testing.assert_allclose(tip, trajectory.tip_before(), atol=ROUNDING)
    np.testing.assert_array_equal(axis, trajectory.axis_before())
    np.testing.assert_array_equal(spin, trajectory.spin_before())


def test_segments_end_where_they_say(trajectory):
    tip, axis, spin = poses(trajectory, 1.0)
    np.testing.assert_allclose(tip, trajectory.tip, atol=ROUNDING)
    np.testing.assert_allclose(axis, trajectory.axis, atol=ROUNDING)
    np.testing.assert_allclose(spin, trajectory.spin, atol=ROUNDING)


@pytest.mark.parametrize("u", [0.1, 0.5, 0.93])
def test_between_they_go_as_the_planner_does(trajectory, u):
    planned = Segments.of(trajectory)
    rows = np.arange(len(trajectory))
    tip, axis, spin = poses(trajectory, u)
    at = u * planned.extent
    np.testing.assert_allclose(tip, planned.tip_at(rows, at)[0], atol=ROUNDING)
    np.testing.assert_allclose(axis, planned.axis_at(rows, at)[0], atol=ROUNDING)
    np.testing.assert_allclose(spin, planned.spin + at * planned.spin_rate, atol=ROUNDING)


def test_directions_are_unit_vectors_across_the_start_or_zero(trajectory):
    made = interpolation(trajectory)
    turns = trajectory.angle > 0
    size = np.linalg.norm(made["axis_quarter"], axis=1)
    np.testing.assert_allclose(size, turns.astype(float), atol=ROUNDING)
    across = np.einsum("ij,ij->i", made["axis_quarter"], made["start_axis"])
    np.testing.assert_allclose(across, 0, atol=1e-9)
    line = trajectory.kind != Kind.ARC
    for name in ("radius", "quarter", "growth"):
        assert not made[name][line].any()


def test_a_longer_tool_starts_where_it_reaches():
    trajectory = placed(two_tools)
    jump = interpolation(trajectory)["start_tip"][1:] - trajectory.tip[:-1]
    # 30 mm along the axis (0.6, 0, 0.8), down, where the tool is changed.
    np.testing.assert_allclose(jump, [[0, 0, 0], [-18, 0, -24], [0, 0, 0]], atol=ROUNDING)


def naive_blocks(trajectory):
    first = {}
    for row, key in enumerate(zip(trajectory.operation.tolist(), trajectory.line.tolist(), strict=True)):
        first.setdefault(key, row)
    return [(*key, row) for key, row in sorted(first.items())]


@pytest.mark.parametrize("seed", range(5))
def test_blocks_have_the_first_segment_of_every_line_by_rising_line(seed):
    rng = np.random.default_rng(seed)
    trajectory = random_trajectory(seed, count=300)
    repeated = dataclasses.replace(trajectory, line=np.repeat(rng.integers(0, 2**31 - 1, 20), 15)[rng.permutation(300)])
    for each in (trajectory, repeated):
        assert blocks(each).tolist() == naive_blocks(each)


def test_a_trajectory_without_segments_has_no_blocks():
    assert len(blocks(random_trajectory(1, count=0))) == 0
