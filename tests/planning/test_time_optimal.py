# SPDX-License-Identifier: LGPL-2.1-or-later
"""The plan against the shortest time that is possible, as TOPP-RA found it (tests/oracles/make_time_optimal.py)."""

import json
from pathlib import Path

import pytest
from time_optimal_paths import LIMITS, PATHS, stations_of

from pkm_post.planning.speed_limits import feed_at, limited_quantities, limits
from pkm_post.planning.speed_profile import cell_times, speed_profile

SHORTEST = json.loads((Path(__file__).parents[1] / "data" / "time_optimal.json").read_text(encoding="ascii"))
FACTOR = 1.7
"""What docs/planning.md says of these paths."""
OPTIMUM_DIGITS = 1e-3
"""Relative: the shortest times have four decimals, and hold between grid points to about this."""


@pytest.mark.parametrize("limits_name", LIMITS)
@pytest.mark.parametrize("name", PATHS)
def test_the_plan_is_no_faster_and_not_much_slower_than_the_optimum(name, limits_name):
    machine, path, marks = stations_of(name, limits_name)
    poses = path.within(marks.segment, marks.u)
    feed = feed_at(path, poses, marks.u)
    square, along = limits(feed, limited_quantities(machine, poses))
    square[marks.rest] = 0.0
    time = float(cell_times(marks.s, speed_profile(marks.s, square, along)).sum())
    shortest = SHORTEST[f"{name}, {limits_name}"]
    assert shortest * (1 - OPTIMUM_DIGITS) <= time <= FACTOR * shortest
