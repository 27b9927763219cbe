# SPDX-License-Identifier: LGPL-2.1-or-later
"""A simulated machine that is set up as the example, homed, and stands at its home, behind a wire in memory."""

import copy
import functools
import sys
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "link"))

import numpy as np  # noqa: E402
from rig import Wire  # noqa: E402

from pkm_post.control.link.program import read_job  # noqa: E402
from pkm_post.control.numerical_control.control import NumericalControl  # noqa: E402
from pkm_post.control.simulator import Controller, SerialPort  # noqa: E402
from pkm_post.machine import machine_named  # noqa: E402
from pkm_post.model import StrutMotion  # noqa: E402
from pkm_post.writing.controllers.pmac import program_text, settings_of, setup_text  # noqa: E402

MACHINE, _ = machine_named("example_6tps")
SETTINGS, _ = settings_of(MACHINE)
TOOL = 120.0
"""mm; with this tool the struts are as long at home as the motors count from."""

START = 1007.8869
"""mm: the struts of the example at home."""
PER_BLOCK = 25


@functools.cache
def set_up():
    made = Controller()
    made.load(setup_text(SETTINGS, "test", MACHINE.strut_stroke).splitlines())
    line = SerialPort(made)
    for motor in range(1, 7):
        fast = f"I{motor}11=320000 I{motor}15=10 I{motor}16=2000 I{motor}17=20 I{motor}19=5 I{motor}22=200"
        assert not line.refusal(fast) and not line.refusal(f"#{motor}J/") and not line.refusal(f"#{motor}HMZ")
    made.advance(100)
    return made


@dataclass
class Station:
    """A machine and what operates it; time passes when somebody waits."""

    wire: Wire
    control: NumericalControl
    machine = MACHINE
    settings = SETTINGS

    @property
    def motors(self):
        return self.wire.controller.motors

    def wait(self, seconds):
        self.wire.sleep(seconds)
        return self.control.poll()

    def to_rest(self, longest=60.0):
        """The state when no program runs any more."""
        until = self.wire.now + longest
        while (state := self.wait(0.1)).status.running or not state.status.standing:
            assert self.wire.now < until
        return state

    def sent(self):
        return bytes(self.wire.sent)


def new_station(kind="tcp"):
    """A station in its initial state."""
    wire = Wire(copy.deepcopy(set_up()), kind, moves=True)
    session = wire.session()
    return Station(wire, NumericalControl(session, MACHINE, SETTINGS, TOOL))


def job(settings, events):
    """All struts out, to rest, back, to rest, and out again: half a second each."""
    share = np.arange(PER_BLOCK + 1) / PER_BLOCK
    out, rate = (1 - np.cos(np.pi * share)) / 2, np.pi / 2 * np.sin(np.pi * share) / 0.5
    rate[[0, -1]] = 0.0
    length = np.concatenate([out, 1 - out[1:], out[1:]])[:, None] * np.linspace(1, 2, 6) + START
    speed = np.concatenate([rate, -rate[1:], rate[1:]])[:, None] * np.linspace(1, 2, 6)
    motion = StrutMotion(20 * np.arange(3 * PER_BLOCK + 1), length, speed, events)
    made, faults = read_job(program_text(motion, settings, ["job"]), settings, "job.pmc")
    assert not faults
    return made
