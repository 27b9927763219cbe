# SPDX-License-Identifier: LGPL-2.1-or-later
"""Lines that slow the tool at their corners: when a wider tolerance is named, and that it helps.

What a tolerance has to be is known from how the points are made: on a circle of radius R with the sagitta e of its
chords, or off a smooth path by up to e. A curve may use 0.6 of the tolerance.
"""

import re
from dataclasses import replace

import numpy as np
import pytest
from machines import example
from programs import ON_PALLET, program

from pkm_post.model import Tolerances
from pkm_post.planning import interpolate, plan_feed, slow_corners
from pkm_post.report.summary import feed_shares
from pkm_post.toolpath.place import place

ASKED = Tolerances(1e-3, np.radians(1e-3))
MACHINE = example()


def warned(path, asked=ASKED, **changes):
    """The warnings of a path, and the share of its cutting time at what is possible."""
    trajectory = replace(place(path, MACHINE, ON_PALLET)[0], **changes)
    plan, _ = plan_feed(trajectory, MACHINE, asked)
    feed = interpolate(plan).feed
    return slow_corners(plan, feed), feed_shares(trajectory, feed)["as_possible"]


def rings(sagitta, radius=20.0, turns=2):
    """Circles in chords of this sagitta, after a rapid move."""
    chords = int(np.ceil(np.pi / np.arccos(1 - sagitta / radius)))
    turn = np.linspace(0.0, 2 * np.pi * turns, chords * turns + 1)
    points = np.column_stack([radius * np.cos(turn), radius * np.sin(turn), np.full(len(turn), 40.0)])
    return np.vstack([points[:1] + [0, 0, 10], points])


def scan(noise, axis_noise=0.0):
    """A wave of points 0.4 mm apart, off by up to so many mm, and the axis by so many degrees."""
    rng, x = np.random.default_rng(1), np.arange(-30.0, 30.0, 0.4)
    z = 40 + 2 * np.sin(x / 8) + rng.uniform(-noise, noise, len(x))
    tilt = np.radians(5 * np.sin(x / 10) + rng.uniform(-axis_noise, axis_noise, len(x)))
    axis = np.column_stack([np.sin(tilt), 0 * tilt, np.cos(tilt)])
    return program(np.column_stack([x, 0 * x, z]), axis if axis_noise else None, feed=60.0)


def named(warning):
    """The tolerances that a warning names."""
    assert warning.code == "K160"
    tip, *axis = (float(size) for size in re.findall(r"tolerance of ([0-9.]+) ", str(warning.found)))
    return Tolerances(tip, np.radians(axis[0]) if axis else ASKED.axis)


@pytest.mark.parametrize(
    ("path", "off", "degrees"),
    [
        (program(rings(0.01), feed=60.0), 0.01, 0.0),
        (program(rings(0.02), feed=60.0), 0.02, 0.0),
        (scan(0.02), 0.02, 0.0),
        (scan(0.001, 0.02), 0.001, 0.02),
    ],
    ids=["sagitta of 10 um", "sagitta of 20 um", "points off by 20 um", "axis off by 0.02 degrees"],
)
def test_the_tolerance_named_is_what_the_points_are_off_by_and_helps(path, off, degrees):
    (warning,), before = warned(path)
    tolerances = named(warning)
    assert max(off, degrees) / 2 <= tolerances.tip <= 5 * max(off, degrees)
    assert (tolerances.axis > ASKED.axis) == (degrees > 0)
    wider, after = warned(path, tolerances)
    assert not wider and before < 0.5 < 0.9 < after


def test_corners_that_are_meant_are_no_reason():
    zigzag = np.column_stack([np.arange(0, 60, 0.5), np.tile([0.0, 0.5], 60), np.full(120, 40.0)])
    found, share = warned(program(zigzag, feed=60.0))
    assert share < 0.5 and not found


def test_what_no_tolerance_changes_is_no_reason():
    asked = place(program(rings(0.01)), MACHINE, ON_PALLET)[0]
    own = np.full(len(asked), 1e-3)  # as by G64 P0.001
    found, share = warned(program(rings(0.01), feed=60.0), tip_tolerance=own)
    assert share < 0.5 and not found


def test_a_smooth_path_and_a_slow_one_have_no_warning():
    assert warned(scan(0.0))[0] == ()
    assert warned(program(rings(0.01), feed=1.0))[0] == ()
