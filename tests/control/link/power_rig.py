# SPDX-License-Identifier: LGPL-2.1-or-later
"""A simulated Power PMAC behind a link in memory, with a clock that passes when somebody waits, and with faults."""

from controller_settings import settings_for

from pkm_post.control.link.errors import LinkLostError
from pkm_post.control.link.gpascii_protocol import GpasciiProtocol
from pkm_post.control.link.program import PmacProgram
from pkm_post.control.link.session import Session
from pkm_post.control.simulator import GpasciiShell, PowerPmac
from pkm_post.control.simulator.gpascii_shell import refused_line
from pkm_post.writing.controllers.power_pmac import setup_text

SETTINGS = settings_for("power_pmac")
STROKE = (450.0, 550.0)
FIRST = (500.0,) * 6
DRIVES = (
    "FatalFeLimit=200000", "WarnFeLimit=100000", "AbortTa=-0.1", "MaxSpeed=6000", "InvAmax=0.05", "JogTa=-0.2",
    "JogSpeed=200",
)  # fmt: skip


def power_pmac(memory_words=None):
    """Set up for the example machine, with struts that are homed at the zero of their counts."""
    machine = PowerPmac(memory_words)
    assert refused_line(machine, setup_text(SETTINGS, "example", STROKE).splitlines()) is None
    words = [f"Motor[{motor}].{drive}" for motor in range(1, 7) for drive in DRIVES]
    assert refused_line(machine, [*words, *(f"#{motor}j/ #{motor}hmz" for motor in range(1, 7))]) is None
    machine.controller.advance(100)
    return machine


def small_program(knots=6, number=10):
    """Some lines of every kind that programs have."""
    lines = ["abs", "frax(A,B,C,U,V,W)", "linear", "ta500 ts0 F10"]
    lines += [" ".join(f"{letter}500.000000" for letter in SETTINGS.letters), "dwell0", "S1200.5 M3", "pvt20"]
    lines += [
        " ".join(f"{letter}500.{knot:05d}{strut}:{-knot * strut / 8:.4f}" for strut, letter in enumerate("ABCUVW", 1))
        for knot in range(1, knots + 1)
    ]
    lines += [" ".join(f"{letter}500.000000:0.0000" for letter in SETTINGS.letters), "dwell0", "linear"]
    return PmacProgram(number, tuple(lines))


class Wire:
    """What is between client and controller.

    Attributes:
        machine: the controller.
        now: seconds of its clock.
        cut_at: how many bytes may go to the controller until the link is cut; None for all.
        mends: whether it can be opened again after the cut.
        said: every line that arrived.
        answered: changes what the controller says.
    """

    silence, name = 0.1, ""

    def __init__(self, machine):
        self.machine, self.now, self.cut_at, self.mends = machine, 0.0, None, True
        self.passed, self.said, self.answered = 0, [], lambda line, answer: answer

    def link(self):
        return _Link(self)

    def protocol(self):
        return GpasciiProtocol(self.silence)

    def sleep(self, seconds):
        self.now += seconds
        self.machine.controller.advance(1000 * seconds)

    def session(self):
        return Session(self, 0.5, 0.1, clock=lambda: self.now, sleep=self.sleep)


class _Link:
    def __init__(self, wire):
        self._wire, self._shell, self._coming, self._line = wire, None, b"", b""

    def restart(self):
        wire = self._wire
        if wire.cut_at is not None and wire.passed >= wire.cut_at:
            if not wire.mends:
                raise LinkLostError("cut")
            wire.cut_at = None
        self.close()
        self._shell, self._line = GpasciiShell(wire.machine), b""
        self._coming = self._shell.greeting()

    def write(self, data):
        wire = self._wire
        self._check()
        for code in data:
            if wire.cut_at is not None and wire.passed >= wire.cut_at:
                self._check()
            wire.passed += 1
            answer = self._shell.receive(bytes([code]))
            self._line += bytes([code])
            if code == 0x0A:
                line, self._line = self._line.decode("ascii").strip(), b""
                wire.said.append(line)
                answer = wire.answered(line, answer)
            self._coming += answer

    def read(self, timeout):
        self._check()
        if not self._coming:
            self._wire.sleep(max(timeout, 1e-3))
        said, self._coming = self._coming[:100], self._coming[100:]
        return said

    def _check(self):
        wire = self._wire
        if self._shell is None or (wire.cut_at is not None and wire.passed >= wire.cut_at):
            self.close()
            raise LinkLostError("cut")

    def close(self):
        if self._shell is not None:
            self._shell.end()
        self._shell = None
