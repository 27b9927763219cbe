# SPDX-License-Identifier: LGPL-2.1-or-later
"""A policy gives a trajectory its spin; what is posted with one is certified like all else."""

import numpy as np
import pytest
from machines import direction
from programs import ON_PALLET, cone, program

from pkm_post.machine.description.presets import machine_named
from pkm_post.machine.spin.apply import with_spin
from pkm_post.machine.spin.policy import SpinPolicy, SpinRule
from pkm_post.options import Options
from pkm_post.posting import post
from pkm_post.toolpath.place import place


@pytest.fixture(scope="module")
def machine():
    return machine_named("example_6tps")[0]


def test_zero_torsion_and_the_file_leave_or_clear_the_spin(machine):
    placed, _ = place(cone(), machine, ON_PALLET)
    turned, _ = with_spin(placed, machine, SpinPolicy(SpinRule.X_IN_PLANE, heading=0.1))
    assert np.ptp(turned.spin) > 0
    assert with_spin(turned, machine, SpinPolicy(SpinRule.FILE))[0] is turned
    assert not with_spin(turned, machine, SpinPolicy(SpinRule.ZERO))[0].spin.any()


def test_a_rule_that_leaves_the_spin_open_is_refused_with_its_place(machine):
    axis = np.array([[0, 0, 1.0], direction(89.99999, 90.0), [0, 0, 1.0]])
    placed, _ = place(program([[0, 0, 30], [10, 0, 30], [20, 0, 30]], axis), machine, ON_PALLET)
    turned, faults = with_spin(placed, machine, SpinPolicy(SpinRule.X_IN_PLANE))
    assert turned is None
    assert [(fault.code, fault.place.line) for fault in faults] == [("K120", 2)]


@pytest.mark.slow
@pytest.mark.parametrize(
    "policy",
    [
        SpinPolicy(SpinRule.X_IN_PLANE),
        SpinPolicy(SpinRule.Y_IN_PLANE, heading=0.2),
        SpinPolicy(SpinRule.OPTIMISED, objective="weighted"),
    ],
    ids=lambda policy: policy.rule.value,
)
def test_every_policy_is_posted_and_certified(tmp_path, machine, policy):
    options = Options(work_offset=ON_PALLET, spin=policy)
    posted = post(cone(60), machine, tmp_path / "cone.pmc", options)
    assert posted.report["certificate"]["holds"]
