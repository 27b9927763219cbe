# SPDX-License-Identifier: LGPL-2.1-or-later
"""A trajectory played over a real link while an operator never rests: overrides, holds, a dead link, an abort, a line.

What the operator does is drawn by chance of a seed, at rows of the trajectory; the machine is followed at each ms.
"""

import math
import os
import random
import resource
import tempfile
import threading
import time
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from follower import Followed, Follower
from power_rig import DRIVES
from station import MACHINE
from station import SETTINGS as TURBO_SETTINGS

from pkm_post.control.link import stopping
from pkm_post.control.link.errors import LinkLostError, PmacError
from pkm_post.control.link.ports import port_named
from pkm_post.control.link.session import Session
from pkm_post.control.link.ssh_link import PASSWORD, ssh_package
from pkm_post.control.player.orders import Order, PlayOptions
from pkm_post.control.player.play import Player, PlayResult
from pkm_post.control.simulator import PowerPmac, Server, refused_line
from pkm_post.options import PLAYER_PROGRAM
from pkm_post.writing import pmac, power_pmac

PATIENCE_S = 30.0
"""An answer comes late when the computer is busy."""
DEAD_S = 2.0
LONGEST_JOIN_S = 60.0
HOLDS, OVERRIDES = 10, 12
HELD_STATES = 4
SLOWER = 0.1
"""Factor of simulated time while the operator is behind: a busy computer shows few states."""
SHARE_BEFORE_ABORT = 0.6
LAST_BITS_MM, LAST_BITS_DEG = 2e-6, 2e-5
"""The controller keeps numbers in 36 bits, and struts are sent with six decimals; a start may be half a count off."""


@dataclass
class BreakablePort:
    """A port whose link can be dead for a while; everything else is the port's own."""

    port: object
    until: float = 0.0

    def __getattr__(self, name):
        return getattr(self.port, name)

    def die(self, seconds=DEAD_S):
        self.until = time.monotonic() + seconds

    def link(self):
        return BreakableLink(self, self.port.link())


class BreakableLink:
    """A link that raises while its port is dead."""

    def __init__(self, port, link):
        self._port, self._link = port, link

    def __getattr__(self, name):
        if name in ("restart", "write", "read") and time.monotonic() < self._port.until:
            raise LinkLostError("the cable is out")
        return getattr(self._link, name)


def settings_of(kind):
    """Of the example's controller behind a link of this kind: over ssh it is a Power PMAC."""
    if kind != "ssh":
        return TURBO_SETTINGS
    settings, faults = power_pmac.settings_of(replace(MACHINE, controller=MACHINE.controller | {"kind": "power_pmac"}))
    assert not faults
    return settings


def _set_up(kind):
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
    return made, outer


def _port(server, outer, kind, folder):
    if outer is None:
        return port_named(f"tcp:127.0.0.1:{server.add_tcp(0)}" if kind == "tcp" else f"serial:{server.add_pty()}")
    os.environ[PASSWORD] = "of the simulated user"
    door = server.add_ssh(outer, ssh_package(), 0, os.environ[PASSWORD])
    known = Path(folder) / "known_hosts"
    known.write_text(f"{door.known_host}\n")
    return replace(port_named(f"ssh:{door.user}@127.0.0.1:{door.number}"), known_hosts=known)


@contextmanager
def served(kind, follower, rate=1.0):
    """A homed machine that is followed, behind a link; it and its port."""
    made, outer = _set_up(kind)
    made.follower, made.number, made.rate = follower, PLAYER_PROGRAM, rate
    server, ended = Server(made), threading.Event()
    with tempfile.TemporaryDirectory() as folder:
        port = _port(server, outer, kind, folder)
        thread = threading.Thread(target=server.run, args=(ended.is_set,))
        thread.start()
        try:
            yield made, BreakablePort(port)
        finally:
            ended.set()
            thread.join(LONGEST_JOIN_S)
            server.close()
            assert not thread.is_alive()


def resident_mib():
    """Most memory that the process had so far, MiB."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def check(follower, results, machine):
    """What was sampled is within what the certificates say, and they within their limits."""
    reported = {}
    for one in results:
        assert one.log.holds
        for finding in one.log.findings:
            reported[finding.name] = max(reported.get(finding.name, 0.0), finding.value)
    assert follower.tip <= reported["deviation of the tool tip"] + LAST_BITS_MM
    assert math.degrees(follower.axis) <= reported["deviation of the tool axis"] + LAST_BITS_DEG
    assert follower.speed <= machine.strut_speed and follower.acceleration <= machine.strut_acceleration
    assert follower.row == len(follower.trajectory) - 1


def follower_of(trajectory, tolerances):
    return Follower(MACHINE, TURBO_SETTINGS, trajectory, tolerances.tip, tolerances.axis)


@dataclass
class Operator:
    """What an operator does while a trajectory plays.

    Attributes:
        todo: rows and what is done there, in order.
        done: what was done.
        memory: MiB of the process, from time to time.
    """

    follower: Follower
    made: Followed
    port: BreakablePort
    first: int
    end: int
    seed: int = 1
    rate: float = 1.0
    holds: int = HOLDS
    overrides: int = OVERRIDES
    breaks: int = 1
    aborts: int = 1
    player: Player | None = None
    done: list = field(default_factory=list)
    phases: set = field(default_factory=set)
    memory: list = field(default_factory=list)
    row: int = 0
    _held: int = 0

    def __post_init__(self):
        chance = random.Random(self.seed)
        kinds = ["hold"] * self.holds + ["override"] * self.overrides + ["break"] * self.breaks
        chance.shuffle(kinds)
        rows = sorted(chance.sample(range(self.first + 2, self.end), len(kinds)))
        self.todo = list(zip(rows, kinds, strict=True))
        if self.aborts:
            self.todo.append((self.end, "abort"))
        self._factors = [0.0, 1.5, 0.05, 1.0, *(round(chance.uniform(0.1, 1.5), 2) for _ in range(self.overrides))]

    def see(self, state):
        """Called with each state of the player."""
        self.follower.measure_if_enough()
        overdue = sum(row <= state.row for row, _ in self.todo)
        self.made.rate = self.rate if overdue < 2 else SLOWER * self.rate
        self.row, order = state.row, self.player.order
        self.phases.add(state.phase)
        self.memory.append(resident_mib())
        if state.phase == "held":
            self._held += 1
            if self._held >= HELD_STATES:
                self._held = 0
                order(Order("resume"))
            return
        if state.phase.startswith("waits"):
            order(Order("override", 1.0)) if state.override == 0 else order(Order("start"))
            return
        if state.override == 0:
            return  # it comes to rest first
        is_back = time.monotonic() > self.port.until + DEAD_S  # a hold that gets no answer becomes an abort
        if self.todo and state.row >= self.todo[0][0] and state.phase == "runs" and is_back:
            _, kind = self.todo.pop(0)
            self.done.append(kind)
            self._do(kind, order)

    def _do(self, kind, order):
        if kind == "hold":
            self.made.rate = self.rate  # a hold that takes too long becomes an abort
            order(Order("hold"))
        elif kind == "override":
            order(Order("override", self._factors.pop(0)))
        elif kind == "break":
            self.port.die()
        else:
            stopping.abort(self.player._session, self.player._settings, at_once=True)


def play_operated(trajectory, tolerances, kind, seed=1, rate=1.0, first_row=0, **numbers):
    """Play over a real link with an operator, abort before the end, and go on at a line; the follower and the logs.

    Returns:
        Follower, its operator, and the results of both plays (of one without an abort).
    """
    follower, results = follower_of(trajectory, tolerances), []
    count = len(trajectory)
    with served(kind, follower, rate) as (made, port), Session(port, PATIENCE_S) as session:

        def player_of(row, see):
            choices = PlayOptions(first_row=row, patience_s=PATIENCE_S)
            return Player(session, MACHINE, settings_of(kind), trajectory, tolerances, choices, see)

        end = first_row + math.ceil(SHARE_BEFORE_ABORT * (count - first_row))
        operator = Operator(follower, made, port, first_row, end, seed, rate, **numbers)
        operator.player = player = player_of(first_row, operator.see)
        try:
            results.append(player.play())
        except PmacError as fault:
            assert "ended from elsewhere" in str(fault) and operator.done[-1:] == ["abort"], fault
            results.append(PlayResult(player.log, player._stops, player._losses, False))
            made.abrupt = made.systems[0].path.abrupt_stops
            row = int(np.flatnonzero(trajectory.line == trajectory.line[operator.row])[0])
            follower.interrupt(row)
            further = Operator(
                follower, made, port, row, count - 1, seed + 1, rate, holds=0, overrides=0, breaks=0, aborts=0
            )
            further.player = player_of(row, further.see)
            results.append(further.player.play())
        assert made.systems[0].path.abrupt_stops == getattr(made, "abrupt", 0)
        follower.measure_all()
    return follower, operator, results
