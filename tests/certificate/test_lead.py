# SPDX-License-Identifier: LGPL-2.1-or-later
"""The deviation of threads by their turns: never above its bound, on a tilted axis and with few decimals."""

from dataclasses import replace

import numpy as np
import pytest
from machines import direction, spindle_axis_text
from posted_jobs import NARROW, WIDE, finding, of
from programs import ON_PALLET, program

from pkm_post.certificate import certify
from pkm_post.geometry import hermite_lengths
from pkm_post.machine import forward
from pkm_post.machine.description.reader import machine_of
from pkm_post.model import Event, EventKind, Kind, SpindleTurns, threads
from pkm_post.model.certificate import Tolerances
from pkm_post.planning import plan
from pkm_post.toolpath.place import place

INSTANTS = 400
LEAD = -1.75


def tilted_thread(tilt, depth=9.0):
    """A left-hand thread along a tilted tool axis."""
    axis, start = direction(tilt, 40.0), np.array([12.0, -7.0, 60.0])
    position = [start, start - depth * axis, start, start + 5 * axis]
    kind = [Kind.RAPID, Kind.LINE, Kind.LINE, Kind.RAPID]
    thread = Event(1, EventKind.SPINDLE_AXIS, LEAD), Event(3, EventKind.SPINDLE_AXIS, 0.0)
    events = (Event(0, EventKind.TOOL_CHANGE, 1), *thread)
    return program(position, np.tile(axis, (4, 1)), kind=kind, feed=20.0, events=events)


def tapping_machine():
    machine, faults = machine_of(spindle_axis_text().encode(), "machine.toml")
    assert not faults
    return machine


def densely(machine, trajectory, motion, struts):
    """The largest deviation of the depth at many instants, by forward kinematics; the spin of the job is constant."""
    thread, knots = threads(trajectory.events)[0], threads(struts.events)[0]
    start, axis = trajectory.tip_before()[thread.first], trajectory.axis_before()[thread.first]
    share = np.broadcast_to(np.linspace(0, 1, INSTANTS), (1, INSTANTS))
    angle, speed = np.append(0.0, struts.turns.angle), np.append(0.0, struts.turns.speed)
    worst = 0.0
    for number, knot in enumerate(range(knots.first, knots.end)):
        row = np.array([knot])
        cubic = struts.cubics(row)
        ends = (np.array([[one[number + later]]]) for later in (0, 1) for one in (angle, speed))
        turns = hermite_lengths(*ends, cubic[-1], share)[0, :, 0]
        near = np.full(INSTANTS, knot + 1)
        pose = forward(
            machine, hermite_lengths(*cubic, share)[0], motion.tool_length[near], motion.tip[near], motion.axis[near],
            motion.spin[near],
        )  # fmt: skip
        assert pose.converged.all()
        off = (start - pose.tip) @ axis - LEAD * turns
        worst = max(worst, float(np.abs(off).max()))
    return worst


def bound_of(struts, trajectory, machine, motion, tolerances):
    asked = Tolerances(tolerances[0], np.radians(tolerances[1]))
    certificate, _ = certify(struts, "x.pmc", trajectory, machine, motion, asked)
    return finding(certificate, "depth of a thread off its turns").value


@pytest.mark.slow
@pytest.mark.parametrize("tilt", [0.0, 17.0])
@pytest.mark.parametrize(("decimals", "tolerances"), [((6, 4), NARROW), ((3, 2), WIDE)], ids=["fine", "coarse"])
def test_the_deviation_is_never_above_its_bound_and_not_far_below(tilt, decimals, tolerances):
    machine = tapping_machine()
    _, trajectory, motion, struts, _, _ = of(machine, tilted_thread(tilt), tolerances, decimals)
    rounded = SpindleTurns(
        struts.turns.knot, struts.turns.angle.round(decimals[0]), struts.turns.speed.round(decimals[1])
    )
    struts = replace(struts, turns=rounded)
    stated = bound_of(struts, trajectory, machine, motion, tolerances)
    found = densely(machine, trajectory, motion, struts)
    assert found <= stated <= 1.3 * found


def test_a_platform_that_turns_in_a_thread_counts_against_the_spindle():
    """It turns counterclockwise by 0.1 rad on the way down: turns that leave that out are off by LEAD 0.1 / 2 pi."""
    machine, asked = tapping_machine(), Tolerances(0.001, np.radians(0.001))
    trajectory, faults = place(tilted_thread(17.0), machine, ON_PALLET)
    assert not faults
    thread, spin = threads(trajectory.events)[0], trajectory.spin.copy()
    spin[thread.first] += 0.1
    trajectory = replace(trajectory, spin=spin)
    made = plan(trajectory, machine, asked)[0]
    turns, start = made.struts.turns, trajectory.spin_before()[thread.first]
    alone = turns.angle - (made.motion.spin[turns.knot] - start) / (2 * np.pi)
    for angle, expected in ((turns.angle, 0.0), (alone, 0.1 * abs(LEAD) / (2 * np.pi))):
        struts = replace(made.struts, turns=replace(turns, angle=angle))
        certificate, _ = certify(struts, "x.pmc", trajectory, machine, made.motion, asked)
        assert finding(certificate, "depth of a thread off its turns").value == pytest.approx(expected, abs=1e-3)
