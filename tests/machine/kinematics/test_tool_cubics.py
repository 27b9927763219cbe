# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the cubics of struts do beside the cubics of the tool, by forward kinematics at dense instants."""

import dataclasses

import numpy as np
import pytest
from machines import example, screwed
from test_rates import wandering_poses

from pkm_post.geometry import hermite_accelerations, hermite_lengths, hermite_speeds, norm
from pkm_post.geometry.vectors import cross, unit
from pkm_post.machine.kinematics.forward import forward
from pkm_post.machine.kinematics.inverse import ToolPoses
from pkm_post.machine.kinematics.jacobian import jacobian_of_tip, scaled_jacobian
from pkm_post.machine.kinematics.strut_cubics import KnotState
from pkm_post.machine.kinematics.tool_cubics import DRIFT_SHARES, ToolCubics, bounded_demand, measured_demand
from pkm_post.model import Poses

SHARE = np.linspace(0, 1, 41)
FORWARD = 1e-9
"""mm: forward kinematics ends when the struts are right to 1e-10 mm."""
STROKED = dataclasses.replace(example(), strut_stroke=(750.0, 2000.0))
LEVER = 120.0


def by_time(tip, tip_1, axis, axis_1, spin, spin_1):
    zero = np.zeros_like(tip)
    tool = np.full(len(tip), LEVER)
    return Poses(tip, tip_1, zero, axis, axis_1, zero, spin, spin_1, zero[:, 0], tool, np.zeros(len(tip)))


def steady(seed, count=400):
    """Poses at both ends of intervals whose attitude stays: gentle curves, and ends with nothing in common."""
    rng = np.random.default_rng(seed)
    duration = 10 ** rng.uniform(-2.5, -0.7, count)
    first, rate = rng.uniform(-60, 60, (count, 3)) + [0, 0, 200], rng.normal(size=(count, 3)) * 100
    bend = rng.normal(size=(count, 3)) * 10 ** rng.uniform(0, 4, (count, 1))
    span = duration[:, None]
    last, last_rate = first + span * (rate + span * bend / 2), rate + span * bend
    last_rate[::3] = rng.normal(size=last_rate[::3].shape) * 100
    lean = np.tile(unit(np.array([[0.2, -0.1, 1.0]])), (count, 1))
    still, spin = np.zeros((count, 3)), np.full(count, 0.3)
    ends = (by_time(tip, tip_1, lean, still, spin, 0 * spin) for tip, tip_1 in ((first, rate), (last, last_rate)))
    return *ends, duration


def cubics_between(start, end, duration, columns=7):
    def stacked(tip, axis, spin):
        return np.concatenate([tip.T, axis.T, spin[None]])[:columns]

    first, rate = stacked(start.tip, start.axis, start.spin), stacked(start.tip_1, start.axis_1, start.spin_1)
    last, last_rate = stacked(end.tip, end.axis, end.spin), stacked(end.tip_1, end.axis_1, end.spin_1)
    return ToolCubics.from_ends(first, rate, last, last_rate, duration)


def everywhere(cubics):
    """Tip, axis and spin of cubics at all shares, (N, S, ...)."""
    places = np.stack([cubics.at(share) for share in SHARE], axis=-1)
    return np.moveaxis(places[:3], 0, -1), unit(np.moveaxis(places[3:6], 0, -1)), places[6]


def played(machine, start, end, cubics, duration):
    """What the controller makes of intervals at its worst: drifts of tip and axis, tip speed, strut load."""
    first, last = KnotState.of(machine, start), KnotState.of(machine, end)
    struts = first.length, first.speed, last.length, last.speed, duration
    tip, axis, spin = everywhere(cubics)
    flat = tip.reshape(-1, 3), axis.reshape(-1, 3), spin.ravel()
    tool = np.full(len(flat[0]), LEVER)
    pose = forward(machine, hermite_lengths(*struts, SHARE).reshape(-1, 6), tool, *flat)
    assert pose.converged.all()
    speed = hermite_speeds(*struts, SHARE)
    jacobian = jacobian_of_tip(machine, *flat, tool)
    twist = np.linalg.solve(jacobian, speed.reshape(-1, 6, 1))[..., 0]
    load = np.abs(speed).max(axis=(1, 2)) / machine.strut_speed
    acceleration = np.abs(hermite_accelerations(*struts)).max(axis=(0, 2)) / machine.strut_acceleration
    drifts = norm(pose.tip - flat[0]), norm(cross(pose.axis, flat[1])), norm(twist[:, :3])
    return *(one.reshape(tip.shape[:2]).max(axis=1) for one in drifts), np.maximum(load, acceleration)


def test_the_cubics_have_the_ends_they_were_made_for():
    start, end, duration = steady(1)
    cubics = cubics_between(start, end, duration)
    np.testing.assert_allclose(cubics.at(0.0)[:3].T, start.tip, atol=1e-10)
    np.testing.assert_allclose(cubics.at(1.0)[:3].T, end.tip, atol=1e-10)
    step = 1e-6
    for share, pose, sign in ((0.0, start, 1), (1.0, end, -1)):
        moved = sign * (cubics.at(share + sign * step) - cubics.at(share))[:3].T / (step * duration[:, None])
        np.testing.assert_allclose(moved, pose.tip_1, rtol=1e-4, atol=1e-2)
    np.testing.assert_array_equal(cubics[np.arange(3)].powers, cubics.powers[:, :, :3])


def test_no_derivative_is_larger_than_its_bound():
    cubics = cubics_between(*steady(2))
    tip = np.stack([cubics.at(share)[:3] for share in np.linspace(0, 1, 1001)])
    for order, bound in enumerate(cubics.sizes(), start=1):
        sizes = np.linalg.norm(np.diff(tip, order, axis=0), axis=1).max(axis=0) * 1000**order
        rounding = 2**order * 1e-13 * 1000**order
        assert np.all(sizes <= bound + rounding)
        reported = bound > 100 * rounding
        assert np.median(sizes[reported] / bound[reported]) > 0.9


def test_nothing_exceeds_the_bounds_where_the_attitude_stays():
    start, end, duration = steady(3)
    cubics = cubics_between(start, end, duration)
    tip, axis, spin = everywhere(cubics)
    jacobian = scaled_jacobian(
        STROKED, tip.reshape(-1, 3), axis.reshape(-1, 3), spin.ravel(), np.full(spin.size, LEVER)
    )
    machine = dataclasses.replace(STROKED, least_singular_value=np.linalg.svd(jacobian, compute_uv=False).min())
    bound = bounded_demand(machine, LEVER, cubics_between(start, end, duration, 3), duration)
    drift, _, speed, struts = played(machine, start, end, cubics, duration)
    assert KnotState.of(machine, start).length.min() > machine.strut_stroke[0]
    assert np.all(drift <= bound.tip + FORWARD)
    assert np.all(speed <= bound.tip_speed * (1 + 1e-4) + FORWARD / duration)  # by the Jacobian beside the drift
    assert np.all(struts <= bound.limits * (1 + 1e-9))
    reported = drift > 100 * FORWARD
    assert reported.sum() > 50
    assert np.median(bound.tip[reported] / drift[reported]) < 40
    assert np.median(struts / bound.limits) > 0.3


@pytest.mark.parametrize(
    "machine",
    [screwed(STROKED), dataclasses.replace(STROKED, strut_stroke=(0.0, 2000.0)), example()],
    ids=["screw without a key", "no shortest strut", "no limit of singular poses"],
)
def test_what_has_no_bound_says_so(machine):
    start, end, duration = steady(4, 5)
    bound = bounded_demand(machine, LEVER, cubics_between(start, end, duration, 3), duration)
    assert all(np.isinf(column).all() for column in bound)


@pytest.mark.slow
@pytest.mark.parametrize("long", [0.02, 0.1, 0.3, 0.6])
@pytest.mark.parametrize("machine", [example(), screwed(example())], ids=["keyed", "screwed"])
def test_the_drift_at_three_shares_stands_for_the_whole_interval(machine, long):
    # the tip of the wandering poses runs at some 90 mm by unit of time while the platform turns: 2 to 27 mm
    time, duration = np.random.default_rng(5).uniform(0, 6, 300), np.full(300, long)
    start, end = wandering_poses(time), wandering_poses(time + long)
    cubics = cubics_between(start, end, duration)
    places = np.stack([cubics.at(share) for share in DRIFT_SHARES], axis=2).reshape(7, -1)
    inside = ToolPoses(places[:3].T, unit(places[3:6].T), places[6], np.repeat(start.tool_length, len(DRIFT_SHARES)))
    found = measured_demand(machine, KnotState.of(machine, start), KnotState.of(machine, end), cubics, inside, duration)
    tip, axis, speed, struts = played(machine, start, end, cubics, duration)
    for most, reported in ((tip, found.tip), (axis, found.axis)):
        assert np.mean(most > reported + FORWARD) < 0.05
        assert np.all(most <= reported + 0.2 * reported.max() + FORWARD)
        assert np.median(most) > 0.8 * np.median(reported)
    assert np.all(speed <= found.tip_speed * (1 + 1e-3))
    assert np.all(struts <= found.limits * (1 + 1e-9))


def test_some_rows_of_a_demand_are_replaced():
    start, end, duration = steady(6, 9)
    cubics = cubics_between(start, end, duration, 3)
    machine = dataclasses.replace(STROKED, least_singular_value=0.3)
    demand = bounded_demand(machine, LEVER, cubics, duration)
    rows = np.array([1, 4])
    other = bounded_demand(machine, LEVER, cubics[rows], duration[rows] / 2)
    mixed = demand.with_rows(rows, other)
    np.testing.assert_array_equal(mixed.limits[rows], other.limits)
    np.testing.assert_array_equal(np.delete(mixed.limits, rows), np.delete(demand.limits, rows))
    assert np.all(demand.limits[rows] < mixed.limits[rows])
