# SPDX-License-Identifier: LGPL-2.1-or-later
"""A trajectory played over a real link while an operator never rests: overrides, holds, a dead link, an abort, a line.

What the operator does is drawn by chance of a seed, at rows of the trajectory; the machine is followed at each ms.
"""

import math
import random
import resource
from dataclasses import dataclass, field

import numpy as np
from behind_links import MACHINE, PATIENCE_S, TURBO_SETTINGS, Host, in_real_time, in_step, settings_of
from follower import Follower

from pkm_post.control.link import stopping
from pkm_post.control.link.errors import PmacError
from pkm_post.control.player.orders import Order, PlayOptions
from pkm_post.control.player.play import Callbacks, Player, PlayResult

HOLDS, OVERRIDES = 10, 12
HELD_STATES = 4
SLOWER = 0.1
"""Factor of simulated time while the operator is behind: a busy computer shows few states."""
SLOW_S = 10.0
"""After so long an override below 100 % becomes 100 %: at 5 % a twelfth of a program takes longer than all of it."""
BACK_S = 2.0
"""After a dead link so long nothing else happens."""
SHARE_BEFORE_ABORT = 0.6
PLANNING_S = 0.1, 0.35
"""That planning a piece takes, step by step: drawn between these."""
LAST_BITS_MM, LAST_BITS_DEG = 2e-6, 2e-5
"""The controller keeps numbers in 36 bits, and struts are sent with six decimals; a start may be half a count off."""


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
    assert follower.jerk <= machine.strut_jerk
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
    host: Host
    first: int
    end: int
    seed: int = 1
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
    _slow_until: float = math.inf

    def __post_init__(self):
        chance, self.began = random.Random(self.seed), self.host.clock.now()
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
        self.host.made.rate = SLOWER if overdue >= 2 and self.host.planning is None else 1.0
        self.row, order = state.row, self.player.order
        self.phases.add(state.phase)
        self.memory.append(resident_mib())
        if state.phase in ("held", "waits: hold"):
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
        if state.override < 1 and self.host.clock.now() > self._slow_until:
            self._slow_until = math.inf
            order(Order("override", 1.0))
        is_back = self.host.clock.now() > self.host.port.until + BACK_S  # a hold that gets no answer becomes an abort
        if self.todo and state.row >= self.todo[0][0] and state.phase == "runs" and is_back:
            _, kind = self.todo.pop(0)
            self.done.append(kind)
            self._do(kind, order)

    def _do(self, kind, order):
        if kind == "hold":
            self.host.made.rate = 1.0  # a hold that takes too long becomes an abort
            order(Order("hold"))
        elif kind == "override":
            self._slow_until = self.host.clock.now() + SLOW_S
            order(Order("override", self._factors.pop(0)))
        elif kind == "break":
            self.host.port.die()
        else:
            stopping.abort(self.player._session, self.player._settings, at_once=True)


def play_operated(trajectory, tolerances, kind, seed=1, is_in_step=True, first_row=0, machine=MACHINE, **numbers):
    """Play over a real link with an operator, abort before the end, and go on at a line; the follower and the logs.

    Returns:
        Follower, its operator, and the results of both plays (of one without an abort).
    """
    follower, results = follower_of(trajectory, tolerances), []
    count, chance = len(trajectory), random.Random(seed)
    follower.interrupt(first_row)
    served = (
        in_step(kind, follower, lambda: chance.uniform(*PLANNING_S)) if is_in_step else in_real_time(kind, follower)
    )
    with served as host, host.session() as session:

        def play(row, end, seed, **numbers):
            """Play from a row on; the operator, whose player has ended or was aborted."""
            operator = Operator(follower, host, row, end, seed, **numbers)
            choices = PlayOptions(first_row=row, patience_s=PATIENCE_S)
            played = session, machine, settings_of(kind), trajectory, tolerances, choices
            operator.player = player = Player(*played, Callbacks(operator.see), host.planning)
            try:
                results.append(player.play())
            except PmacError as fault:
                assert "ended from elsewhere" in str(fault) and operator.done[-1:] == ["abort"], fault
                results.append(PlayResult(player.log, player._stops, player._losses, False))
            return operator

        end = first_row + math.ceil(SHARE_BEFORE_ABORT * (count - first_row))
        operator, abrupt = play(first_row, end, seed, **numbers), 0
        if not results[0].finished:
            abrupt = host.made.systems[0].path.abrupt_stops
            row = int(np.flatnonzero(trajectory.line == trajectory.line[operator.row])[0])
            follower.interrupt(row)
            play(row, count - 1, seed + 1, holds=0, overrides=0, breaks=0, aborts=0)
        assert host.made.systems[0].path.abrupt_stops == abrupt
        follower.measure_all()
    assert sum(one.losses for one in results) == operator.done.count("break")
    return follower, operator, results
