# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is proven by poses nearby holds at all poses of the way, and takes few of them."""

from dataclasses import replace

import numpy as np
import pytest
from machines import screwed
from pose_paths import bodied, counted, samples, upright, wandering, with_limit

from pkm_post.machine.kinematics.placed_machine import PlacedMachine
from pkm_post.machine.reach.path_bounds import unproven_checks
from pkm_post.machine.reach.path_checks import all_checks
from pkm_post.machine.reach.pose_path import PosePath

SHARES = np.linspace(0.0, 1.0, 150)[1:]
EXACT_ALONE = "K116"
"""Planes tell a lower bound of a distance: at a pose it may be less than what is proven by others."""


def scan(lines, step=0.5):
    """A square of 100 mm, scanned in so many lines to and fro over a wave."""
    along = np.linspace(-50, 50, int(100 / step) + 1)
    x = np.concatenate([along[:: 1 - 2 * (line % 2)] for line in range(lines)])
    y = np.repeat(np.linspace(-50, 50, lines), len(along))
    tips = np.column_stack([x, y, 200 + 5 * np.sin(x / 15)])
    return PosePath.straight(*upright(tips))


def poses_for(path):
    """How many poses the checks look at to prove that a way keeps all of them."""
    looked_at = []

    def checks_for(shortest):
        checks, looks = counted(all_checks(bodied(), path, shortest, None))
        looked_at.append(looks)
        return checks

    assert unproven_checks(bodied(), path, checks_for) == ()
    return sum(map(sum, looked_at))


@pytest.mark.slow
@pytest.mark.parametrize("machine", [bodied(), screwed(bodied())], ids=["keyed", "screwed"])
def test_what_is_proven_holds_everywhere(machine):
    # Limits of all checks are set to what they have on random ways, less or more by a little: two tools, any attitude.
    rng = np.random.default_rng(7)
    proven = broken = 0
    for _ in range(6):
        corners = wandering(rng, 8, tilt_deg=20)
        dense = PosePath.straight(*samples(corners, np.arange(1, 8), SHARES))
        for path in (corners, dense):
            placed = PlacedMachine.of(machine, dense.rows(slice(None)))
            exact = [check.margins(placed).min() for check in all_checks(machine, path, 500.0, None)]
            less = rng.uniform(-0.05, 0.3, len(exact)) * np.abs(exact)
            limits = np.array(exact) - less

            def checks_for(shortest, path=path, limits=limits):
                return tuple(map(with_limit, all_checks(machine, path, shortest, None), limits))

            left = unproven_checks(machine, path, checks_for)
            for number, check in enumerate(checks_for(500.0)):
                if less[number] < 0 and check.code != EXACT_ALONE:
                    assert number in left, check.name
            proven += len(exact) - len(left)
            broken += int(np.sum(less < 0))
    assert proven > 20 and broken > 5


def test_many_lines_take_as_many_poses_as_few():
    few, many = poses_for(scan(21)), poses_for(scan(201))
    assert few < 500 and many < 1.5 * few


def test_one_bad_row_among_many_is_doubtful():
    path = scan(101)
    tip = path.tip.copy()
    tip[7000] += [400.0, 0.0, 0.0]
    bad = PosePath.straight(tip, path.axis, path.spin, path.tool_length)
    placed = PlacedMachine.of(bodied(), bad.rows(slice(7000, 7001)))
    broken = {
        number for number, check in enumerate(all_checks(bodied(), bad, 500.0, None)) if check.margins(placed).min() < 0
    }
    left = unproven_checks(bodied(), bad, lambda shortest: all_checks(bodied(), bad, shortest, None))
    assert broken and broken <= set(left)


def test_a_longer_tool_at_the_same_places_lifts_the_platform():
    """Poses with one tip are far apart there: what the short tool keeps says nothing of the long one."""
    once = scan(21, step=2.0)
    tip = np.vstack([once.tip, once.tip[-1] - np.linspace(1, 0, 81)[:, None] * [0.0, 0.0, 80.0]])
    _, axis, spin, length = upright(tip)
    length[len(once) :] += 80
    path = PosePath.straight(tip, axis, spin, length)
    lengths = PlacedMachine.of(bodied(), path.rows(slice(None))).lengths().min(axis=1)
    assert lengths[: len(once)].min() > lengths.min() + 10
    assert "K101" in doubtful(replace(bodied(), strut_stroke=(lengths.min() + 0.1, 2000.0)), path)


def test_what_is_too_short_between_two_rows_is_doubtful():
    """From -80 to 10 degrees of spin some struts are shortest at -36, by more than 10 mm."""
    tip, axis, _, length = upright([[0.0, 0, 200]] * 2)
    path = PosePath.straight(tip, axis, np.radians([-80.0, 10.0]), length)
    least = PlacedMachine.of(bodied(), path.rows(slice(None))).lengths().min() - 10
    assert "K101" in doubtful(replace(bodied(), strut_stroke=(least, 2000.0)), path)


def doubtful(machine, path):
    """Codes of the checks that are not proven."""
    checks = all_checks(machine, path, 500.0, None)
    left = unproven_checks(machine, path, lambda shortest: all_checks(machine, path, shortest, None))
    return [checks[number].code for number in left]


def test_a_way_of_one_row_is_proven_by_itself():
    path = PosePath.straight(*upright([[0.0, 0, 200]]))
    assert poses_for(path) == len(all_checks(bodied(), path, 500.0, None))
