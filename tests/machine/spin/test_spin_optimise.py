# SPDX-License-Identifier: LGPL-2.1-or-later
"""The search for the spin: golden numbers, laws of an optimum, and limits that hold between its nodes."""

import dataclasses

import numpy as np
import pytest
from machines import direction
from programs import program

from pkm_post.geometry import norm
from pkm_post.machine.description.presets import machine_named
from pkm_post.machine.kinematics.inverse import strut_lengths
from pkm_post.machine.spin.normalised_margins import normalised_margins
from pkm_post.machine.spin.optimise import least_normalised_margins, optimise_spin
from pkm_post.machine.spin.policy import JOINTS, SINGULAR, STROKE, SpinPolicy, SpinRule
from pkm_post.toolpath.place import place

DEGREE = np.pi / 180


@pytest.fixture(scope="module")
def machine():
    model, faults = machine_named("example_6tps")
    assert not faults
    # The published example has no joint limits and its stroke alone decides.
    return dataclasses.replace(model, base_cone=np.pi, platform_cone=np.pi, least_singular_value=0.05)


def off_centre(machine, count=60):
    """A path beside the middle of the machine with the tool leaning 25 degrees along x."""
    axis = np.tile(direction(25.0, 0.0), (count, 1))
    tip = np.column_stack([np.linspace(-0.5, 0.5, count), np.full(count, 150.0), np.full(count, 200.0)])
    trajectory, faults = place(program(tip, axis), machine, np.eye(4))
    assert not [fault for fault in faults if fault.code != "K110"]
    return trajectory


def excursion(machine, trajectory, spin):
    """The largest distance of a strut length from the middle of the stroke on the cutting moves, mm."""
    lengths = strut_lengths(machine, trajectory.tip, trajectory.axis, spin, trajectory.tool_length())[1:]
    return np.abs(lengths - np.mean(machine.strut_stroke)).max()


def before_and_after(machine, policy):
    """The least shares of the path beside the middle, without spin and with the one that was found."""
    trajectory = off_centre(machine)
    return least_normalised_margins(trajectory, machine), least_normalised_margins(
        optimise_spin(trajectory, machine, policy), machine
    )


def test_the_part_beside_the_middle_is_turned_by_21_degrees(machine):
    # Golden numbers for this machine, tip (0, 150, 200), tilt 25 along x: 216 mm without spin, 170 mm at -21 degrees.
    trajectory = off_centre(machine)
    found = optimise_spin(trajectory, machine, SpinPolicy(SpinRule.OPTIMISED))
    assert excursion(machine, trajectory, trajectory.spin) == pytest.approx(216.3, abs=0.5)
    assert excursion(machine, trajectory, found.spin) == pytest.approx(170.0, abs=0.5)
    assert found.spin[1:] / DEGREE == pytest.approx(-21.0, abs=0.5)


def test_what_stroke_gains_singular_loses(machine):
    before, after = before_and_after(machine, SpinPolicy(SpinRule.OPTIMISED))
    assert after[STROKE] > before[STROKE] + 0.1
    assert after[SINGULAR] < before[SINGULAR]


@pytest.mark.parametrize(("objective", "column"), [("stroke", STROKE), ("joints", JOINTS), ("singular", SINGULAR)])
def test_the_objective_gets_no_worse(machine, objective, column):
    before, after = before_and_after(machine, SpinPolicy(SpinRule.OPTIMISED, objective=objective))
    assert after[column] >= before[column] - 1e-9


def test_least_shares_are_those_of_the_worst_pose(machine):
    made = optimise_spin(off_centre(machine), machine, SpinPolicy(SpinRule.OPTIMISED))
    at_ends = normalised_margins(machine, made.tip, made.axis, made.spin, made.tool_length())
    assert (least_normalised_margins(made, machine) <= at_ends.min(axis=0) + 1e-12).all()


def test_the_spin_turns_no_faster_than_it_may(machine):
    policy = SpinPolicy(SpinRule.OPTIMISED, rate=0.1 * DEGREE)
    trajectory = off_centre(machine)
    found = optimise_spin(trajectory, machine, policy)
    extent = np.maximum(norm(found.tip - found.tip_before()), np.degrees(found.angle))
    assert (np.abs(np.diff(found.spin, prepend=0.0)) <= policy.rate * extent + 1e-9).all()


def test_no_spin_where_none_helps(machine):
    tip = np.column_stack([np.zeros(20), np.zeros(20), np.linspace(220, 200, 20)])
    trajectory, _ = place(program(tip), machine, np.eye(4))
    found = optimise_spin(trajectory, machine, SpinPolicy(SpinRule.OPTIMISED))
    assert found.spin == pytest.approx(np.zeros(len(found)), abs=0.2 * DEGREE)


def test_a_pose_that_zero_torsion_cannot_reach_is_reached(machine):
    # The stroke is cut down to what only a turned platform can do.
    short = dataclasses.replace(machine, strut_stroke=(800.0, 1200.0))
    before, after = before_and_after(short, SpinPolicy(SpinRule.OPTIMISED))
    assert before.min() < 0 < after.min()
