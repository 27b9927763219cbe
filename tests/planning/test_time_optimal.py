# SPDX-License-Identifier: LGPL-2.1-or-later
"""The plan against the shortest time that is possible, as TOPP-RA found it (tests/oracles/make_time_optimal.py)."""

import json
from pathlib import Path

import numpy as np
import pytest
from time_optimal_paths import LIMITS, PATHS, SPEED_SHARE, stations_of

from pkm_post.planning.profile.refinement import refined
from pkm_post.planning.profile.switches import with_lower_switches
from pkm_post.planning.rough_limits import DerivativeBounds, rough_limits
from pkm_post.planning.speed_limits import PLANNED_SHARE
from pkm_post.planning.speed_profile import cell_times

SHORTEST = json.loads((Path(__file__).parents[1] / "data" / "time_optimal.json").read_text(encoding="ascii"))
OPTIMUM_DIGITS = 1e-3
"""Relative: the shortest times have four decimals, and hold between grid points to about this."""
SAME = 1e-2
"""Relative: what stations that are no grid points of TOPP-RA, and cells that bend, make of the same problem."""
PLANNED = 1.06
"""What docs/feed.md says of these paths: with the share of acceleration that is planned."""


def profile_of(name, limits_name, speed_share, share):
    machine, path, _ = stations_of(name, limits_name, speed_share)
    close, shares = np.ones(len(path.feed), dtype=bool), np.full(len(path.feed), share)
    rough = rough_limits(path, machine, DerivativeBounds.of(path))
    return path, machine, refined(path, machine, close, rough, shares), shares


def time_of(profile):
    return float(cell_times(profile.marks.s, profile.square).sum())


@pytest.mark.slow
@pytest.mark.parametrize("limits_name", LIMITS)
@pytest.mark.parametrize("name", PATHS)
def test_under_whole_limits_the_plan_is_the_optimum(name, limits_name):
    shortest = SHORTEST[f"{name}, {limits_name}"]
    _, _, profile, _ = profile_of(name, limits_name, 1 / SPEED_SHARE, 1.0)
    assert time_of(profile) == pytest.approx(shortest, rel=SAME)


@pytest.mark.slow
@pytest.mark.parametrize("limits_name", LIMITS)
@pytest.mark.parametrize("name", PATHS)
def test_the_plan_is_no_faster_and_not_much_slower_than_the_optimum(name, limits_name):
    shortest = SHORTEST[f"{name}, {limits_name}"]
    planned = time_of(with_lower_switches(*profile_of(name, limits_name, 1.0, PLANNED_SHARE)))
    assert shortest * (1 - OPTIMUM_DIGITS) <= planned <= PLANNED * shortest
