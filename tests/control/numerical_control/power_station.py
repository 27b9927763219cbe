# SPDX-License-Identifier: LGPL-2.1-or-later
"""The station with a simulated Power PMAC behind gpascii."""

import dataclasses

from power_rig import DRIVES
from power_rig import Wire as GpasciiWire
from station import TOOL, Station

from pkm_post.control.numerical_control.control import NumericalControl
from pkm_post.control.simulator import PowerPmac
from pkm_post.control.simulator.gpascii_shell import refused_line
from pkm_post.machine import machine_named
from pkm_post.writing.controllers.power_pmac import settings_of, setup_text

STATED = machine_named("example_6tps")[0]
MACHINE = dataclasses.replace(STATED, controller={**STATED.controller, "kind": "power_pmac"})
SETTINGS, _ = settings_of(MACHINE)


class Wire(GpasciiWire):
    """With what a station asks of a wire."""

    @property
    def controller(self):
        return self.machine.controller

    @property
    def sent(self):
        return "\n".join(self.said).encode("ascii")


class PowerStation(Station):
    """A station of its own machine."""

    machine, settings = MACHINE, SETTINGS


def power_station():
    """A machine that is homed and stands at its home."""
    machine = PowerPmac()
    assert refused_line(machine, setup_text(SETTINGS, "example", MACHINE.strut_stroke).splitlines()) is None
    words = [f"Motor[{motor}].{drive}" for motor in range(1, 7) for drive in DRIVES]
    assert refused_line(machine, [*words, *(f"#{motor}j/ #{motor}hmz" for motor in range(1, 7))]) is None
    machine.controller.advance(100)
    wire = Wire(machine)
    return PowerStation(wire, NumericalControl(wire.session(), MACHINE, SETTINGS, TOOL))
