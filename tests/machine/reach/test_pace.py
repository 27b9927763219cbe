# SPDX-License-Identifier: LGPL-2.1-or-later
"""Strut speeds along a way: against differences at many places, and for peaks between two rows."""

import dataclasses

import numpy as np
import pytest
from machines import example, screwed
from pose_paths import bodied, samples, upright, wandering

from pkm_post.machine.kinematics.inverse import strut_lengths
from pkm_post.machine.reach.limit_checks import shortest_distance, strut_speed_finding
from pkm_post.machine.reach.pose_path import PosePath

SHARES = np.linspace(0.0, 1.0, 2001)


def fastest(machine, path, cell, duration):
    """Highest speed of any strut in a cell, by differences."""
    lengths = strut_lengths(machine, *samples(path, np.array([cell]), SHARES))
    return np.abs(np.diff(lengths, axis=0)).max() / (SHARES[1] * duration)


@pytest.mark.parametrize("machine", [bodied(), screwed(bodied())], ids=["keyed", "screwed"])
def test_speeds_agree_with_differences_everywhere(machine):
    rng = np.random.default_rng(1)
    path, duration = wandering(rng, 12), rng.uniform(0.2, 5.0, 12)
    highest = np.array([fastest(machine, path, cell, duration[cell]) for cell in range(1, 12)])
    for limit in (0.5 * highest.max(), 0.999 * highest.max(), 1.003 * highest.max()):
        limited = dataclasses.replace(machine, strut_speed=limit)
        finding = strut_speed_finding(limited, path, shortest_distance(machine, path), duration)
        np.testing.assert_array_equal(finding.margin[1:] < 0, highest > limit)
        assert np.all(limit - finding.margin[1:] <= highest * (1 + 1e-6))
        assert finding.at_least <= limit - highest.max() + 1e-6
    assert finding.at_least > 0


def test_a_peak_between_two_rows_is_found():
    # The struts go slower and faster while the platform turns evenly: the mean speed of the cell is within the limit.
    tip, axis, _, length = upright([[0.0, 0, 200]] * 2)
    path = PosePath.straight(tip, axis, np.radians([-76.0, 4.0]), length)
    duration = np.array([0.0, 1.0])
    lengths = strut_lengths(example(), *path.rows(slice(None)))
    mean = np.abs(np.diff(lengths, axis=0))[0]
    peak = fastest(example(), path, 1, 1.0)
    assert peak > 1.1 * mean.max()
    finding = strut_speed_finding(dataclasses.replace(example(), strut_speed=0.98 * peak), path, 700.0, duration)
    assert finding.first_bad_row == 1
    finding = strut_speed_finding(dataclasses.replace(example(), strut_speed=1.01 * peak), path, 700.0, duration)
    assert finding.first_bad_row is None and finding.at_least >= 0
