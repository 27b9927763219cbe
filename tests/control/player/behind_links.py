# SPDX-License-Identifier: LGPL-2.1-or-later
"""A simulated machine behind a real link, TCP, a pseudo terminal or ssh, in real time or step by step.

In real time a thread serves the machine, and the player plans in threads of its own. Step by step, all is done in one
thread, and the clock of machine and player passes only by what is waited for: by the sleeps of the player, by each
answer, and by the time that a piece is said to take to be planned. The bytes go through the same sockets. So a play of
minutes takes what it takes of the processor, whatever else the computer does, and the same seed plays the same.
"""

import os
import tempfile
import threading
import time
from concurrent.futures import Executor, Future
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path

from follower import Followed
from power_rig import DRIVES
from station import MACHINE
from station import SETTINGS as TURBO_SETTINGS

from pkm_post.control.link.errors import LinkLostError
from pkm_post.control.link.ports import port_named
from pkm_post.control.link.session import Session
from pkm_post.control.link.ssh_link import PASSWORD, ssh_package
from pkm_post.control.simulator import PowerPmac, Server, refused_line
from pkm_post.options import PLAYER_PROGRAM
from pkm_post.writing import pmac, power_pmac

PATIENCE_S = 30.0
"""An answer comes late when the computer is busy."""
DEAD_S = 20.0
"""Longer than a session tries by itself, which takes some eight seconds, and shorter than the player's patience."""
LONGEST_JOIN_S = 60.0
ANSWER_S = 0.002
"""By which the clock passes with each answer, step by step: of the order of what Ethernet and the controller take."""


@dataclass
class Clock:
    """The clock of a player and, step by step, of its machine.

    Attributes:
        machine: computes its motors while the clock is waited for; None in real time.
        passed: s, step by step.
    """

    machine: Followed | None = None
    passed: float = 0.0

    def now(self):
        return time.monotonic() if self.machine is None else self.passed

    def sleep(self, seconds):
        if self.machine is None:
            time.sleep(seconds)
        else:
            self.passed += seconds
            self.machine.advance(1000 * seconds)


class Later(Future):
    """Done from a time on."""

    def __init__(self, clock, due):
        super().__init__()
        self._clock, self._due = clock, due

    def done(self):
        return super().done() and self._clock.now() >= self._due


@dataclass
class PlannedInStep(Executor):
    """Plans at once, and says so after as much of the clock as a planning is said to take.

    Attributes:
        takes: s of the next planning.
        processor: s that planning took of the processor.
    """

    clock: Clock
    takes: object
    processor: float = 0.0

    def submit(self, function, *arguments):
        made, began = Later(self.clock, self.clock.now() + self.takes()), time.thread_time()
        try:
            made.set_result(function(*arguments))
        except Exception as fault:
            made.set_exception(fault)
        self.processor += time.thread_time() - began
        return made


@dataclass
class BreakablePort:
    """A port whose link can be dead for a while; everything else is the port's own.

    Attributes:
        port: the real one.
        clock: says how long it is dead.
        serve: lets the machine answer, step by step; None where a thread does.
    """

    port: object
    clock: Clock
    serve: object = None
    until: float = 0.0

    def __getattr__(self, name):
        return getattr(self.port, name)

    def die(self, seconds=DEAD_S):
        self.until = self.clock.now() + seconds

    def link(self):
        return BreakableLink(self, self.port.link())


class BreakableLink:
    """A link that raises while its port is dead."""

    def __init__(self, port, link):
        self._port, self._link = port, link

    def close(self):
        self._link.close()

    def restart(self):
        self._check()
        with _serving(self._port.serve):  # logging in takes several answers
            self._link.restart()

    def write(self, data):
        self._check()
        self._link.write(data)

    def read(self, timeout):
        self._check()
        return self._link.read(timeout) if self._port.serve is None else self._read_in_step(timeout)

    def _read_in_step(self, timeout):
        """Bytes, or none when none came within the timeout of the true clock as well."""
        end = time.monotonic() + timeout
        while True:
            self._port.serve()
            if data := self._link.read(0.0):
                self._port.clock.sleep(ANSWER_S)
                return data
            if time.monotonic() >= end:
                self._port.clock.sleep(max(timeout, 0.0))
                return b""

    def _check(self):
        if self._port.clock.now() < self._port.until:
            raise LinkLostError("the cable is out")


@contextmanager
def _serving(serve):
    """Serve by a thread for a while."""
    if serve is None:
        yield
        return
    ended = threading.Event()

    def run():
        while not ended.wait(1e-3):
            serve()

    thread = threading.Thread(target=run)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join(LONGEST_JOIN_S)
        assert not thread.is_alive()


def settings_of(kind):
    """Of the example's controller behind a link of this kind: over ssh it is a Power PMAC."""
    if kind != "ssh":
        return TURBO_SETTINGS
    settings, faults = power_pmac.settings_of(replace(MACHINE, controller=MACHINE.controller | {"kind": "power_pmac"}))
    assert not faults
    return settings


@dataclass
class Host:
    """What a player plays on.

    Attributes:
        made: the machine.
        port: of it.
        clock: of both.
        planning: where pieces are planned; None for threads of the player.
    """

    made: Followed
    port: BreakablePort
    clock: Clock
    planning: PlannedInStep | None = None
    sessions: list = field(default_factory=list)

    def session(self):
        return Session(self.port, PATIENCE_S, clock=self.clock.now, sleep=self.clock.sleep)


@contextmanager
def in_real_time(kind, follower):
    """A homed machine that is followed, behind a link, served by a thread."""
    made, outer = _set_up(kind, follower)
    server, ended, clock = Server(made), threading.Event(), Clock()
    with _door(server, outer, kind) as port:
        thread = threading.Thread(target=server.run, args=(ended.is_set,))
        thread.start()
        try:
            yield Host(made, BreakablePort(port, clock), clock)
        finally:
            ended.set()
            thread.join(LONGEST_JOIN_S)
            assert not thread.is_alive()


@contextmanager
def in_step(kind, follower, takes=lambda: 0.0):
    """A homed machine that is followed, behind a link, served by whoever waits for it.

    Args:
        kind: ``"tcp"``, ``"serial"`` or, for a Power PMAC, ``"ssh"``.
        follower: measures it.
        takes: gives the s that the next planning takes.
    """
    made, outer = _set_up(kind, follower)
    server, clock = Server(made), Clock(made)
    with _door(server, outer, kind) as port:
        yield Host(made, BreakablePort(port, clock, server.serve), clock, PlannedInStep(clock, takes))


def _set_up(kind, follower):
    """A machine that was set up and homed; over ssh the Power PMAC around it as well."""
    outer = PowerPmac(form=Followed) if kind == "ssh" else None
    made = outer.controller if outer else Followed()
    lines = (power_pmac if outer else pmac).setup_text(settings_of(kind), "test", MACHINE.strut_stroke).splitlines()
    for motor in range(1, 7):
        turbo = f"I{motor}11=320000 I{motor}15=10 I{motor}16=6000 I{motor}17=20 I{motor}19=5 I{motor}22=200"
        lines += [f"Motor[{motor}].{drive}" for drive in DRIVES] if outer else [turbo]
        lines += [f"#{motor}J/", f"#{motor}HMZ"]
    assert refused_line(outer or made, lines) is None
    made.advance(100)
    made.follower, made.number = follower, PLAYER_PROGRAM
    return made, outer


@contextmanager
def _door(server, outer, kind):
    """The port of a server; it is closed at the end."""
    with tempfile.TemporaryDirectory() as folder:
        try:
            yield _port(server, outer, kind, folder)
        finally:
            server.close()


def _port(server, outer, kind, folder):
    if outer is None:
        return port_named(f"tcp:127.0.0.1:{server.add_tcp(0)}" if kind == "tcp" else f"serial:{server.add_pty()}")
    os.environ[PASSWORD] = "of the simulated user"
    door = server.add_ssh(outer, ssh_package(), 0, os.environ[PASSWORD])
    known = Path(folder) / "known_hosts"
    known.write_text(f"{door.known_host}\n")
    return replace(port_named(f"ssh:{door.user}@127.0.0.1:{door.number}"), known_hosts=known)
