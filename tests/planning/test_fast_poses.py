# SPDX-License-Identifier: LGPL-2.1-or-later
import dataclasses

import numpy as np
import pytest
from machines import example
from programs import BALL, ON_PALLET, cone, program, square_with_arc

from pkm_post.model import Event, EventKind
from pkm_post.planning.fast_poses import fast_poses, fast_poses_within
from pkm_post.planning.tool_path import ToolPath
from pkm_post.toolpath.place import place

ROUNDING = 1e-11
"""mm, rad and plain numbers: two ways to one place half a metre from the origin."""


def longer_tool_in_between():
    made = program([[0, 0, 60], [10, 0, 60], [10, 20, 60], [30, 20, 60]])
    tools = {1: BALL, 2: dataclasses.replace(BALL, number=2, length=BALL.length + 30)}
    change = (Event(0, EventKind.TOOL_CHANGE, 1.0), Event(2, EventKind.TOOL_CHANGE, 2.0))
    return dataclasses.replace(made, tools=tools, events=change)


def upright_scan():
    """A surface of sine waves, scanned with three axes."""
    x = np.linspace(-20, 20, 101)
    return program(np.column_stack([x, 5 * np.cos(x / 9), 30 + 4 * np.sin(x / 3)]))


PATHS = {
    "lines that turn": cone,
    "arcs and a helix": square_with_arc,
    "another tool": longer_tool_in_between,
    "three axes": upright_scan,
}


def path_of(make, tip, axis):
    trajectory, faults = place(make(), example(), ON_PALLET)
    assert not faults
    return ToolPath.of(trajectory, tip, axis)


def places_on(path):
    """Path lengths all over a path, its joints and the edges of its blends."""
    s = np.concatenate([np.random.default_rng(6).uniform(0, path.starts[-1], 3000), path.starts])
    return np.sort(np.concatenate([s, path.starts + path.blend, path.starts - path.blend]).clip(0, path.starts[-1]))


@pytest.mark.parametrize("make", PATHS.values(), ids=PATHS)
@pytest.mark.parametrize("rounded", [(1e-3, 1e-5), (0.5, 0.05), (1e-9, 1e-9)], ids=["fine", "coarse", "sharp"])
def test_a_glimpse_agrees_with_the_poses(make, rounded):
    path = path_of(make, *rounded)
    s = places_on(path)
    seen, poses = fast_poses(path, s), path.at(s)
    for name in ("tip", "axis", "spin"):
        np.testing.assert_allclose(getattr(seen, name), getattr(poses, name), rtol=0, atol=ROUNDING)
    np.testing.assert_allclose(seen.tip_1, poses.tip_1, rtol=0, atol=1e-6 if rounded[0] < 1e-6 else ROUNDING)
    np.testing.assert_array_equal(seen.tool_length, poses.tool_length)
    np.testing.assert_array_equal(seen.segment, poses.segment)


@pytest.mark.slow
@pytest.mark.parametrize("make", PATHS.values(), ids=PATHS)
def test_what_is_seen_of_a_place_does_not_depend_on_the_other_places(make):
    path = path_of(make, 1e-3, 1e-5)
    s = places_on(path)
    whole = fast_poses(path, s)
    for size in (1, 7, 500):
        parts = [fast_poses(path, s[first : first + size]) for first in range(0, len(s), size)]
        for column, of_parts in zip(whole, zip(*parts, strict=True), strict=True):
            np.testing.assert_array_equal(np.concatenate(of_parts), column)


def test_what_rounding_puts_beyond_a_rest_is_seen_at_the_rest():
    path = path_of(longer_tool_in_between, 1e-3, 1e-5)
    rests = np.flatnonzero(path.rests[1:])
    beyond = fast_poses_within(path, rests, path.segments.extent[rests] + 1e-13)
    before = fast_poses_within(path, rests, path.segments.extent[rests])
    np.testing.assert_allclose(beyond.tip, before.tip, rtol=0, atol=ROUNDING)
    np.testing.assert_array_equal(beyond.tip_1, before.tip_1)


def test_a_path_has_one_attitude_when_its_axis_its_spin_and_its_tool_stay_the_same():
    assert path_of(cone, 1e-3, 1e-5).attitude is None
    assert path_of(longer_tool_in_between, 1e-3, 1e-5).attitude is None
    path = path_of(upright_scan, 1e-3, 1e-5)
    poses = path.at(places_on(path))
    for found, each in zip(path.attitude, (poses.axis, poses.spin, poses.tool_length), strict=True):
        np.testing.assert_array_equal(np.repeat(found, len(each), axis=0), each)
