# SPDX-License-Identifier: LGPL-2.1-or-later
"""The path of a played program: its spin where a programmed place is passed twice."""

from dataclasses import replace

import numpy as np
import pytest
from posted_jobs import preset
from programs import ON_PALLET, program

from pkm_post.certificate import certify, reconstruct
from pkm_post.model import Event, EventKind, Kind
from pkm_post.model.certificate import Tolerances
from pkm_post.model.diagnostics import errors
from pkm_post.planning import plan
from pkm_post.toolpath.place import place

TOLERANCES = Tolerances(0.001, np.radians(0.001))


def around_a_circle(machine, turn):
    """A trajectory that ends with a full circle in which the platform turns by so much, and its plan."""
    centre, axis = np.full((2, 3, 3), np.nan)
    centre[2], axis[2] = [0, 0, 60], [0, 0, 1]
    ends, kinds = [[0, 0, 60], [8, 0, 60], [8, 0, 60]], np.array([Kind.RAPID, Kind.LINE, Kind.ARC])
    stop = (Event(2, EventKind.DWELL, 0.1),)
    trajectory, faults = place(program(ends, kind=kinds, centre=centre, turn=axis, events=stop), machine, ON_PALLET)
    assert not faults
    trajectory = replace(trajectory, spin=np.append(trajectory.spin[:-1], trajectory.spin[-2] + turn))
    return trajectory, plan(trajectory, machine, TOLERANCES)[0]


@pytest.mark.parametrize("turn", [0.01, -0.3])
def test_the_spin_at_the_end_of_a_full_circle_is_that_of_its_end(turn):
    """Start and end are one place, with the spin of the one or the other: the plan and the program were refused."""
    machine = preset("example_6tps")
    trajectory, made = around_a_circle(machine, turn)
    struts = replace(made.struts, length=np.round(made.struts.length, 6), speed=np.round(made.struts.speed, 4))
    assert not errors(certify(struts, "job.pmc", trajectory, machine, made.motion, TOLERANCES)[1])
    found, faults = reconstruct(struts, "job.pmc", trajectory, machine, TOLERANCES)
    assert not faults
    assert found.spin_deviation.max() < TOLERANCES.tip


def test_a_spin_between_those_of_both_ends_is_found():
    """Half of the turn is done before the circle begins: there the plan has neither the one spin nor the other."""
    machine = preset("example_6tps")
    trajectory, made = around_a_circle(machine, 0.01)
    early = replace(trajectory, spin=trajectory.spin - np.append(np.zeros(len(trajectory) - 2), [0.005, 0.0]))
    faults = certify(made.struts, "job.pmc", early, machine, made.motion, TOLERANCES)[1]
    assert {fault.code for fault in errors(faults)} == {"V111"}
