# SPDX-License-Identifier: LGPL-2.1-or-later
"""Settings of the controller of the example machine, in round numbers, with what a test changes of them."""

from dataclasses import replace

from machines import spindle_axis_text

from pkm_post.machine import machine_named
from pkm_post.machine.description.reader import machine_of
from pkm_post.writing.controllers import CONTROLLERS

ROUND = {"counts_per_mm": 10000.0, "zero_length": (500.0,) * 6, "approach_speed": 10.0}


def settings_for(kind="turbo_pmac", **changes):
    """The settings that a machine file with these entries gives."""
    machine, _ = machine_named("example_6tps")
    settings, faults = CONTROLLERS[kind].settings_of(replace(machine, controller=machine.controller | {"kind": kind}))
    assert not faults
    return replace(settings, **ROUND | changes)


def threading_settings(**changes):
    """Those of a machine whose spindle is an axis."""
    machine, faults = machine_of(spindle_axis_text().encode(), "machine.toml")
    assert not faults
    settings, faults = CONTROLLERS["turbo_pmac"].settings_of(machine)
    assert not faults
    return replace(settings, **ROUND | changes)
