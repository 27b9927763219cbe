# SPDX-License-Identifier: LGPL-2.1-or-later
"""Trajectories played on a simulated Power PMAC over gpascii, in its own words."""

import numpy as np
import pytest
from playing import LONGEST_S, RECTANGLE, Playing, trajectory_of
from power_rig import DRIVES
from power_rig import Wire as PowerWire
from power_station import MACHINE, SETTINGS

from pkm_post.control.player.knot_list import Layout, resident_program
from pkm_post.control.player.orders import Order
from pkm_post.control.simulator import PowerPmac
from pkm_post.control.simulator.gpascii_shell import refused_line
from pkm_post.model import Event, EventKind
from pkm_post.writing.controllers.power_pmac import setup_text


class Wire(PowerWire):
    """With what a play asks of a wire."""

    @property
    def controller(self):
        return self.machine.controller


def power_playing(monkeypatch, *arguments):
    """A play on a Power PMAC that stands at its home, homed."""
    monkeypatch.setattr("playing.MACHINE", MACHINE)
    monkeypatch.setattr("playing.SETTINGS", SETTINGS)
    machine = PowerPmac()
    assert refused_line(machine, setup_text(SETTINGS, "example", MACHINE.strut_stroke).splitlines()) is None
    words = [f"Motor[{motor}].{drive}" for motor in range(1, 7) for drive in DRIVES]
    assert refused_line(machine, [*words, *(f"#{motor}j/ #{motor}hmz" for motor in range(1, 7))]) is None
    machine.controller.advance(100)
    wire = Wire(machine)
    made = Playing(wire, *arguments)
    wire.sleep = made._sleep
    return made


def test_the_resident_program_is_in_words_of_the_power_pmac():
    assert resident_program(Layout(), SETTINGS, 900).lines[:5] == (
        "abs",
        "while(P1000>0) {",
        "P1001=P1000",
        "pvt(P(P1001+1))",
        "A(P(P1001+2)):(P(P1001+8)) B(P(P1001+3)):(P(P1001+9)) C(P(P1001+4)):(P(P1001+10)) "
        "U(P(P1001+5)):(P(P1001+11)) V(P(P1001+6)):(P(P1001+12)) W(P(P1001+7)):(P(P1001+13))",
    )


@pytest.mark.slow
def test_a_program_is_played_with_overrides_and_a_hold(monkeypatch):
    orders = {5: [Order("override", 1.5)], 20: [Order("hold")], 21: [Order("resume")], 30: [Order("override", 0.6)]}
    playing = power_playing(monkeypatch, trajectory_of(RECTANGLE), orders)
    done = playing.play()
    playing.check()
    assert done.finished and done.log.holds and playing.arrived() < 1e-3 and not orders
    assert playing.wire.now < LONGEST_S and not playing.wire.controller.runs_program()


@pytest.mark.slow
def test_codes_between_moves_are_carried_out(monkeypatch):
    events = (Event(0, EventKind.SPINDLE, 3000.0), Event(1, EventKind.COOLANT, 1.0))
    playing = power_playing(monkeypatch, trajectory_of(events=events))
    done = playing.play()
    playing.check()
    assert done.finished and playing.arrived() < 1e-3
    assert any("M3" in line for line in playing.wire.said) and any(line == "M8" for line in playing.wire.said)


@pytest.mark.slow
def test_a_planner_that_is_too_late_ends_in_a_stop_on_the_path(monkeypatch):
    late = iter([0.0] * 4 + [1.0] * 2)
    playing = power_playing(monkeypatch, trajectory_of())
    done = playing.play(delay=lambda: next(late, 0.0))
    playing.check()
    assert done.finished and playing.arrived() < 1e-3
    assert np.isfinite(playing.tips()).all()
