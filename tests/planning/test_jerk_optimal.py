# SPDX-License-Identifier: LGPL-2.1-or-later
"""Plans with jerk limits against the shortest times, as tests/oracles/make_jerk_limited.py found them."""

import dataclasses
import json
from pathlib import Path

import numpy as np
import pytest
from time_optimal_paths import stations_of

from pkm_post.planning.jerk.profile import jerk_limited
from pkm_post.planning.rough_limits import DerivativeBounds
from pkm_post.planning.speed_spline import durations

SHORTEST = json.loads((Path(__file__).parents[1] / "data" / "jerk_limited.json").read_text(encoding="ascii"))
FACTOR = 1.05
"""What docs/planning.md says of these paths: the reference has the whole limits of acceleration."""
OPTIMUM_DIGITS = 5e-3
"""Relative: the limits of the reference hold at its nodes only."""


@pytest.mark.slow
@pytest.mark.parametrize("case", SHORTEST)
def test_the_plan_is_no_faster_and_little_slower_than_the_optimum(case):
    name, limits, jerk = case.split(", ")
    machine, path, marks = stations_of(name, limits)
    limited = dataclasses.replace(machine, strut_jerk=float(jerk))
    profile = jerk_limited(path, marks, limited, DerivativeBounds.of(path))
    time = durations(np.diff(profile.s), profile.square, profile.acceleration).sum()
    assert SHORTEST[case] * (1 - OPTIMUM_DIGITS) <= time <= FACTOR * SHORTEST[case]
