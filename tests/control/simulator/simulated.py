# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the tests of the simulator share: a controller and a port to it, a machine that is ready to move, a motion."""

from dataclasses import dataclass

import numpy as np
from controller_settings import settings_for

from pkm_post.control.simulator import Controller, SerialPort, SimulatorSettings
from pkm_post.model import StrutMotion

LETTERS = "ABCUVW"
PROGRAM_SETTINGS = settings_for(approach_speed=100.0)
"""Of the machine that ``ready_machine`` makes."""


@dataclass
class Machine:
    """A controller and one port, asked in text."""

    controller: Controller
    line: SerialPort

    def bytes(self, data):
        return self.line.receive(data)

    def say(self, text):
        """What a line is answered, without the acknowledge."""
        answer = self.bytes(text.encode("ascii") + b"\r")
        assert answer.endswith(b"\x06"), f"{text!r}: {answer!r}"
        return answer[:-1].decode("ascii").removesuffix("\r")

    def error(self, text):
        """The number of the error that a line is refused with."""
        answer = self.bytes(text.encode("latin-1") + b"\r")
        assert answer.startswith(b"\x07ERR") and answer.endswith(b"\r"), f"{text!r}: {answer!r}"
        return int(answer[4:7])

    def lines(self, text):
        for line in text.splitlines():
            self.say(line)

    def wait(self, ms):
        self.controller.advance(ms)

    def status(self, motor):
        words = self.say(f"#{motor}?")
        return int(words[:6], 16), int(words[6:], 16)

    def system(self):
        words = self.say("&1??")
        return int(words[:6], 16), int(words[6:12], 16), int(words[12:], 16)

    def runs(self):
        return bool(self.system()[0] & 1)

    def position(self):
        """Where a program wants the axes, in their letters' order, mm."""
        axes = self.controller.systems[0].axes
        return [
            (self.controller.motors.commanded[motor - 1] - there.offset) / there.scale
            for motor, there in sorted(axes.definitions.items())
        ]


def make(**settings):
    controller = Controller(SimulatorSettings(**settings))
    machine = Machine(controller, SerialPort(controller))
    machine.line.attend()
    machine.bytes(b"I3=2 I6=1\r")
    return machine


def ready_machine(**settings):
    """Six struts in coordinate system 1, 10000 counts/mm, 500 mm at zero, all homed, fast enough."""
    machine = make(**settings)
    for motor, letter in enumerate(LETTERS, start=1):
        machine.say(f"&1#{motor}->10000{letter}-5000000")
        machine.say(f"I{motor}11=320000 I{motor}15=10 I{motor}16=2000 I{motor}17=20 I{motor}19=5 I{motor}22=200")
        machine.say(f"#{motor}J/ HMZ")
    return machine


def curved_motion(events=()):
    """Six struts that swing, at knots 20 ms and 37 ms apart, at rest at both ends and in the middle."""
    time = np.concatenate([np.arange(0, 1001, 20), 1000 + 37 * np.arange(1, 41)])
    turn = 2 * np.pi * (np.where(time <= 1000, time / 1000, (time - 1000) / 1480))
    swing = np.linspace(1, 6, 6)
    length = 502 + np.outer(1 - np.cos(turn), swing)
    rate = 2 * np.pi / np.where(time <= 1000, 1.0, 1.48)
    speed = np.outer(np.sin(turn) * rate, swing)
    speed[[0, 50, -1]] = 0.0
    return StrutMotion(time, length, speed, events)
