# SPDX-License-Identifier: LGPL-2.1-or-later
"""A player on a simulated machine behind a wire in memory: each ms of the struts is kept, and measured afterwards.

The poses come from forward kinematics, and their distances from the lines of the test's own program: nothing of the
planning or of the certificate is asked.
"""

import copy
import sys
from concurrent.futures import Executor, Future
from dataclasses import dataclass, field, replace
from pathlib import Path

sys.path += [str(Path(__file__).parents[1] / room) for room in ("link", "numerical_control")]

import numpy as np  # noqa: E402
import pytest  # noqa: E402
from machines import without_jerk  # noqa: E402
from programs import ON_PALLET, program  # noqa: E402
from rig import Wire  # noqa: E402
from station import MACHINE, SETTINGS, set_up  # noqa: E402

from pkm_post.control.player.orders import Order, PlayOptions  # noqa: E402
from pkm_post.control.player.play import Callbacks, Player  # noqa: E402
from pkm_post.geometry import norm  # noqa: E402
from pkm_post.machine import forward_along_path  # noqa: E402
from pkm_post.model import StrutMotion, Tolerances  # noqa: E402
from pkm_post.toolpath import ToolPose  # noqa: E402
from pkm_post.toolpath.place import place  # noqa: E402

JERK = 4e4
SMOOTH = replace(MACHINE, strut_jerk=JERK, tip_jerk=JERK)
JUMPING = without_jerk(MACHINE)
BOTH = pytest.mark.parametrize("machine", [MACHINE, JUMPING], ids=["as shipped", "without limits of jerk"])
"""For what the two ways of planning do differently: windows of the one cannot be left anywhere."""
TOLERANCES = Tolerances(1e-3, np.radians(1e-3))
TOOL = 120.0
RECTANGLE = [[0, 0, 60], [30, 0, 60], [30, 20, 60], [0, 20, 60], [0, 0, 60]]
LEAP_MS = 60
"""Poses this far apart are solved in sequence; that each follows from the one before is asserted."""
LONGEST_S = 300.0
"""A play that takes longer by the clock of its wire stands."""
HOOK = [[0, 0, 90], [25, 0, 90], [25, 15, 90]]


def trajectory_of(position=HOOK, feed=80.0, events=(), **arguments):
    made, _ = place(program(position, feed=feed, events=events, **arguments), MACHINE, ON_PALLET)
    return made


class AtOnce(Executor):
    """Plans when asked; the simulated time stands meanwhile, but for delays.

    Attributes:
        delay: s that pass at each planning.
    """

    def __init__(self, wire=None, delay=lambda: 0.0):
        self.wire, self.delay = wire, delay

    def submit(self, function, *arguments):
        made = Future()
        if late := self.delay():
            self.wire.sleep(late)
        try:
            made.set_result(function(*arguments))
        except Exception as fault:
            made.set_exception(fault)
        return made


@dataclass
class Playing:
    """A play and what the machine did.

    Attributes:
        wire: the link, with its faults.
        trajectory: what is played.
        at: orders by the number of the state at which they are given.
        machine: what plays; by default the example.
    """

    wire: Wire
    trajectory: object
    at: dict = field(default_factory=dict)
    machine: object = None
    states: list = field(default_factory=list)
    lengths: list = field(default_factory=list)

    @classmethod
    def of(cls, trajectory=None, at=None, kind="tcp", machine=None, **arguments):
        wire = Wire(copy.deepcopy(set_up()), kind, moves=True, **arguments)
        made = cls(wire, trajectory or trajectory_of(), at or {}, machine)
        wire.sleep = made._sleep
        return made

    def play(self, delay=None, planning=None, **choices):
        planning = planning or (AtOnce(self.wire, delay) if delay else AtOnce())
        with self.wire.session() as session:
            machine = self.machine or MACHINE
            self.player = Player(
                session,
                machine,
                SETTINGS,
                self.trajectory,
                TOLERANCES,
                PlayOptions(**choices),
                Callbacks(self._show),
                planning,
            )
            return self.player.play()

    def _show(self, state):
        self.states.append(state)
        for order in self.at.pop(len(self.states), ()):
            order(self.player) if callable(order) else self.player.order(order)
        if state.phase.startswith("waits") and len(self.states) > 3 and self.states[-3].phase == state.phase:
            self.answer(self.player)

    def answer(self, player):
        """What the operator does when the player waits."""
        player.order(Order("start"))

    def _sleep(self, seconds):
        for _ in range(max(1, round(1000 * seconds))):
            self.wire.now += 1e-3
            assert self.wire.now < LONGEST_S, "it stands"
            self.wire.controller.advance(1.0)
            self.lengths.append(np.array(self.wire.controller.motors.commanded))

    def rest(self):
        """Let it go on by itself."""
        self._sleep(3.0)

    def struts(self):
        """Commanded strut lengths at every ms, (T, 6) mm."""
        return np.array(self.lengths) / SETTINGS.counts_per_mm + np.array(SETTINGS.zero_length)

    def tips(self):
        """Tool tips while anything moves, (T, 3) mm."""
        struts = self.struts()
        moving = np.append(True, (np.abs(np.diff(struts, axis=0)) > 1e-9).any(axis=1))
        struts = struts[moving]
        tools = np.full(len(struts), TOOL)
        found = forward_along_path(MACHINE, struts, tools, ToolPose.at_home(MACHINE), len(struts) // LEAP_MS + 1)
        assert found.converged.all()
        return found.tip

    def check(self):
        """The tool stayed on the path, the struts within their limits, and no move ended at speed."""
        assert self.wire.controller.systems[0].path.abrupt_stops == 0
        off = distance(self.tips(), np.vstack([self.trajectory.start_tip, self.trajectory.tip]))
        assert off.max() < TOLERANCES.tip, off.max()
        struts = self.struts()
        assert np.abs(np.diff(struts, axis=0)).max() * 1e3 <= MACHINE.strut_speed
        assert np.abs(np.diff(struts, 2, axis=0)).max() * 1e6 <= MACHINE.strut_acceleration

    def mean_jerk(self, ms=16):
        """Third differences of strut lengths over some ms, means of their jerk; the largest, mm/s^3."""
        struts, one, two, three = self.struts(), ms, 2 * ms, 3 * ms
        third = struts[three:] - 3 * struts[two:-one] + 3 * struts[one:-two] - struts[:-three]
        return np.abs(third).max() / (ms / 1000) ** 3

    def arrived(self):
        """How far the tip is from the end of the program at last, mm."""
        return float(norm(self.tips()[-1] - self.trajectory.tip[-1]))


def distance(points, corners):
    """Distance of points, (T, 3), from a chain of lines, (T,) mm."""
    nearest = np.full(len(points), np.inf)
    for begin, end in zip(corners[:-1], corners[1:], strict=True):
        way = end - begin
        share = np.clip((points - begin) @ way / (way @ way), 0, 1)
        nearest = np.minimum(nearest, norm(points - begin - share[:, None] * way))
    return nearest


def joined(motions):
    """One motion of many."""
    begin = np.cumsum([0, *(motion.struts.time_ms[-1] for motion in motions)])
    rows = [slice(0 if number == 0 else 1, None) for number in range(len(motions))]
    time = np.concatenate(
        [at + motion.struts.time_ms[row] for at, motion, row in zip(begin, motions, rows, strict=False)]
    )
    length, speed = (
        np.concatenate([getattr(motion.struts, name)[row] for motion, row in zip(motions, rows, strict=True)])
        for name in ("length", "speed")
    )
    return StrutMotion(time, length, speed, ())
