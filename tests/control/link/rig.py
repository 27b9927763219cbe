# SPDX-License-Identifier: LGPL-2.1-or-later
"""A simulated controller behind a link in memory, with a clock that passes when somebody waits, and with faults.

Nothing waits in truth: a silent controller costs no time, so thousands of faults can be tried.
"""

import copy
import functools
import random
import threading
from contextlib import contextmanager
from dataclasses import dataclass, field

from controller_settings import settings_for

from pkm_post.control.link.errors import LinkLostError
from pkm_post.control.link.ethernet_protocol import EthernetProtocol
from pkm_post.control.link.serial_protocol import SerialProtocol
from pkm_post.control.link.session import OpenBufferPolicy, Session
from pkm_post.control.simulator import Controller, EthernetPort, SerialPort, Server
from pkm_post.writing.controllers.pmac import setup_text

STROKE = (450.0, 550.0)
LONGEST_JOIN_S = 120.0
SETTINGS = settings_for()


def carried(data, out):
    """A line without faults."""
    return data


class Noise:
    """Bytes are lost, doubled or changed in one bit, by chance."""

    def __init__(self, seed, rate, kinds=("drop", "double", "flip")):
        self._random, self._rate, self._kinds = random.Random(seed), rate, kinds
        self.faults = 0

    def __call__(self, data, out):
        if self._random.random() > self._rate * len(data):
            return data  # the chance that one of them is hit, drawn once for all
        place, kind = self._random.randrange(len(data)), self._random.choice(self._kinds)
        self.faults += 1
        changed = {
            "drop": b"",
            "double": data[place : place + 1] * 2,
            "flip": bytes([data[place] ^ 1 << self._random.randrange(8)]),
        }[kind]
        return data[:place] + changed + data[place + 1 :]


@dataclass
class Wire:
    """What is between client and controller.

    Attributes:
        kind: ``"serial"`` or ``"tcp"``.
        fault: given bytes and whether they go out to the controller, the bytes that arrive.
        delay: gives the seconds by which bytes of the controller come later; None for never.
        piece: how many bytes come at once; None for all.
        cut_at: how many bytes pass until the link is cut; None for never.
        mends: whether it can be opened again after the cut.
        moves: whether the motors use the time that passes; to compute them takes long.
    """

    controller: Controller
    kind: str = "serial"
    fault: object = carried
    cut_at: int | None = None
    mends: bool = True
    moves: bool = False
    now: float = 0.0
    silence: float = 0.1
    delay: object = None
    piece: int | None = None
    passed: int = 0
    sent: bytearray = field(default_factory=bytearray)
    line: SerialPort = None
    name = ""

    def __post_init__(self):
        self.line = self.line or SerialPort(self.controller)

    def clock(self):
        """Seconds since the wire was made."""
        return self.now

    def sleep(self, seconds):
        self.now += seconds
        if self.moves:
            self.controller.advance(1000 * seconds)

    def link(self):
        return WiredLink(self)

    def protocol(self):
        return SerialProtocol(self.silence) if self.kind == "serial" else EthernetProtocol(self.silence)

    def session(self, answer_timeout=0.5, open_buffer=OpenBufferPolicy.LEAVE):
        return Session(self, answer_timeout, 0.1, open_buffer, self.clock, self.sleep)


class WiredLink:
    """The client's end of a wire."""

    def __init__(self, wire):
        self._wire, self._open, self._stream = wire, False, None
        self._coming = []

    def restart(self):
        wire = self._wire
        if wire.cut_at is not None and wire.passed >= wire.cut_at:
            if not wire.mends:
                raise LinkLostError("cut")
            wire.cut_at = None
        if wire.kind == "tcp" or self._stream is None:
            self._stream = wire.line if wire.kind == "serial" else EthernetPort(wire.line)
        if wire.kind == "tcp" or not self._open:
            self._coming.clear()
        self._coming = [(due, data) for due, data in self._coming if due > wire.now]
        self._open = True

    def write(self, data):
        wire = self._wire
        self._alive()
        wire.sent += data
        data = self._cut(wire.fault(bytes(data), True) if data else b"")
        step = wire.piece or len(data) or 1
        for first in range(0, len(data), step):
            said = self._stream.receive(data[first : first + step])
            if said:
                self._come(wire.fault(said, False))
        self._alive()

    def read(self, timeout):
        wire = self._wire
        self._alive()
        until = wire.now + max(timeout, 1e-3)
        if not self._coming or self._coming[0][0] > until:
            wire.sleep(until - wire.now)
            return wire.line.output() if wire.kind == "serial" else b""
        due, data = self._coming.pop(0)
        if due > wire.now:
            wire.sleep(due - wire.now)
        if wire.piece and len(data) > wire.piece:
            self._coming.insert(0, (due, data[wire.piece :]))
            data = data[: wire.piece]
        data = self._cut(data)
        if not data:
            self._alive()
        return data

    def close(self):
        self._open = False

    def _come(self, data):
        late = self._wire.delay() if self._wire.delay else 0.0
        last = self._coming[-1][0] if self._coming else 0.0
        self._coming.append((max(last, self._wire.now + late), data))

    def _alive(self):
        wire = self._wire
        if not self._open or (wire.cut_at is not None and wire.passed >= wire.cut_at):
            self._open = False
            raise LinkLostError("the link is cut")

    def _cut(self, data):
        wire = self._wire
        if wire.cut_at is not None:
            data = data[: max(wire.cut_at - wire.passed, 0)]
        wire.passed += len(data)
        return data


def controller():
    """A simulated controller that was set up for ``SETTINGS``, its struts homed and in closed loop."""
    made = _set_up()
    return copy.deepcopy(made, {id(made._kept): made._kept})  # what was saved is never changed, only replaced


@functools.cache
def _set_up():
    made = Controller()
    made.load(setup_text(SETTINGS, "test", STROKE).splitlines())
    line = SerialPort(made)
    for motor in range(1, 7):
        assert not line.refusal(f"#{motor}J/") and not line.refusal(f"#{motor}HMZ")
    made.advance(100)
    return made


def listed(made, number=10):
    """What the controller has under a number, without a link."""
    program = made.memory.programs.get(number)
    return [] if program is None or not program.line_starts else program.listing(True)


@contextmanager
def served(made, kind="tcp", speed=1.0):
    """A controller that serves in a thread; the name of its port.

    Args:
        made: the controller.
        kind: ``"serial"`` or ``"tcp"``.
        speed: simulated seconds in a second.
    """
    server, ended = Server(made, speed), threading.Event()
    port = f"tcp:127.0.0.1:{server.add_tcp(0)}" if kind == "tcp" else f"serial:{server.add_pty()}"
    thread = threading.Thread(target=server.run, args=(ended.is_set,))
    thread.start()
    try:
        yield port
    finally:
        ended.set()
        thread.join(LONGEST_JOIN_S)
        server.close()
        assert not thread.is_alive()
