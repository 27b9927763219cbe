# SPDX-License-Identifier: LGPL-2.1-or-later
"""A thread on the simulated controller, which knows nothing of threads: the spindle is one more axis in PVT mode."""

import numpy as np
import pytest
from machines import spindle_axis_text
from posted_jobs import NARROW, of, offset
from programs import tapped_hole

from pkm_post.control.simulator import Controller, SimulatorSettings, function_programs
from pkm_post.control.simulator.programs import LETTERS
from pkm_post.machine import forward
from pkm_post.machine.description.reader import machine_of
from pkm_post.writing.controllers.pmac import program_text, settings_of, setup_text

LEAD = 1.25
START = 62.0
"""Height of the start of the thread in {C}."""
SPINDLE = LETTERS.index("Z")


@pytest.mark.slow
@pytest.mark.parametrize("override", [100, 40])
def test_the_spindle_keeps_the_lead_at_every_moment_and_at_any_override(override):
    machine, faults = machine_of(spindle_axis_text().encode(), "machine.toml")
    assert not faults
    settings, _ = settings_of(machine)
    *_, struts, certificate, _ = of(machine, tapped_hole(LEAD), NARROW)
    assert certificate.holds
    controller = Controller(SimulatorSettings())
    controller.load(setup_text(settings, "simulated", machine.strut_stroke).splitlines())
    controller.load(function_programs((28, 29)))
    for motor in range(1, 7):
        controller.load(
            [f"I{motor}11=0 I{motor}16=9999 I{motor}17=99 I{motor}15=99 I{motor}19=99 I{motor}22=9999", f"#{motor}J/"]
        )
    controller.load(program_text(struts, settings, []).splitlines())
    home = np.round(struts.length[0], 6)
    controller.load(
        [
            f"#{motor}J={(at - zero) * 10000:.0f}"
            for motor, at, zero in zip(range(1, 7), home, settings.zero_length, strict=True)
        ]
    )
    controller.advance(3000)
    controller.load([f"&1%{override}B10R"])
    system, places = controller.systems[0], []
    while system.running and len(places) < 60_000:
        controller.advance(1.0)
        position = system.path.position()
        if position is not None and position[SPINDLE]:
            places.append(position)
    places = np.array(places)
    lengths = places[:, [LETTERS.index(letter) for letter in settings.letters]]
    count, tip = len(places), [0.0, 0.0, offset(machine)[2, 3] + 56]
    pose = forward(
        machine,
        lengths,
        np.full(count, 120.0),
        np.tile(tip, (count, 1)),
        np.tile([0, 0, 1.0], (count, 1)),
        np.zeros(count),
    )
    assert pose.converged.all()
    depth = offset(machine)[2, 3] + START - pose.tip[:, 2]
    assert depth.max() > 11.99
    assert np.abs(depth - LEAD * places[:, SPINDLE]).max() < 1e-4
    assert count > 1500 * 100 / override
