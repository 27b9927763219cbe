# SPDX-License-Identifier: LGPL-2.1-or-later
"""Follows a machine that plays, each ms of its struts, and measures how far the tool is from the program's own lines.

Poses come from forward kinematics; of planning, sections and certificates nothing is asked. What it keeps does not
grow with the play: it measures a second at a time.
"""

from dataclasses import dataclass, field

import numpy as np

from pkm_post.control.simulator import Controller
from pkm_post.geometry import norm
from pkm_post.machine import forward_along_path
from pkm_post.toolpath import ToolPose

AT_ONCE = 1000
"""ms that are measured together."""
IN_SEQUENCE = 16
"""Poses that are solved in sequence; that each follows from the one before is asserted."""
BESIDE = 3
"""Rows behind the last one that samples may still belong to: corners are rounded."""
AHEAD = 256
"""Rows ahead in which samples are looked for; more where they are not found."""
JERK_MS = 16
"""Over which third differences are taken: means of the jerk of a strut."""
NEAREST = 4
"""Rows, by distance of the tip, of which the one counts that fits best."""


@dataclass
class Follower:
    """Measures struts against a trajectory of lines.

    Attributes:
        machine, settings, trajectory: what plays.
        tip_tolerance, axis_tolerance: mm and rad, by which the better of two rows is chosen.
        tip, axis: worst deviations, mm and rad.
        speed, acceleration, jerk: worst of a strut, mm/s, mm/s^2 and mm/s^3, by differences; of jerk over some ms.
        samples: ms that were measured.
        row: which the last sample belongs to.
    """

    machine: object
    settings: object
    trajectory: object
    tip_tolerance: float
    axis_tolerance: float
    tip: float = 0.0
    axis: float = 0.0
    speed: float = 0.0
    acceleration: float = 0.0
    jerk: float = 0.0
    samples: int = 0
    row: int = 0
    waiting: list = field(default_factory=list)

    def __post_init__(self):
        made = self.trajectory
        self.tips = np.vstack([made.start_tip, made.tip])
        self.axes = np.vstack([made.start_axis, made.axis])
        self.lengths = made.tool_length()
        self._begin(0)

    def _begin(self, row):
        """Where the first sample of a run is looked for."""
        self.near = ToolPose(self.tips[row], self.axes[row], self.trajectory.start_spin)
        self.row, self.waiting = row, []

    def add(self, counts):
        """The commanded place of the motors, a ms after the one before; from any thread."""
        self.waiting.append(np.array(counts))

    def measure_if_enough(self):
        """Measure what waits, if there is enough of it."""
        while len(self.waiting) >= AT_ONCE:
            self.measure(AT_ONCE)

    def interrupt(self, row):
        """What comes next has nothing to do with what was: it begins at a row."""
        self.measure_all()
        self._begin(row)

    def measure_all(self):
        """Measure what is left."""
        self.measure_if_enough()
        self.measure(len(self.waiting))

    def measure(self, count):
        """Measure some of what waits; the last two samples stay, for the differences."""
        if count < 3:
            return
        struts = np.array(self.waiting[:count]) / self.settings.counts_per_mm + np.array(self.settings.zero_length)
        del self.waiting[: count - 2]
        self.speed = max(self.speed, 1e3 * np.abs(np.diff(struts, axis=0)).max())
        self.acceleration = max(self.acceleration, 1e6 * np.abs(np.diff(struts, 2, axis=0)).max())
        one, two, three = (number * JERK_MS for number in (1, 2, 3))
        third = struts[three:] - 3 * struts[two:-one] + 3 * struts[one:-two] - struts[:-three]
        self.jerk = max(self.jerk, np.abs(third).max(initial=0.0) / (JERK_MS / 1000) ** 3)
        still = np.append(False, (np.diff(struts, axis=0) == 0).all(axis=1))
        struts = struts[~still]
        if not len(struts):
            return
        tools = self.lengths[[self.row] * len(struts)]
        found = forward_along_path(self.machine, struts, tools, self.near, IN_SEQUENCE)
        assert found.converged.all()
        self.near = found.pose(-1)
        tip, axis = self._deviations(found.tip, found.axis)
        self.tip, self.axis = max(self.tip, tip), max(self.axis, axis)
        self.samples += len(struts)

    def _deviations(self, tip, axis):
        begin, ahead = max(self.row - BESIDE, 0), AHEAD
        while True:
            rows = np.arange(begin, min(begin + ahead, len(self.tips) - 1))
            off_tip, off_axis, best = self._nearest(tip, axis, rows)
            if rows[-1] == len(self.tips) - 2 or best[-1] < rows[-1] - BESIDE:
                self.row = int(best[-1])
                return float(off_tip.max()), float(off_axis.max())
            ahead *= 2

    def _nearest(self, tip, axis, rows):
        """Deviations of poses from the row that each fits best, (T,) each, and these rows."""
        begin, way = self.tips[rows], self.tips[rows + 1] - self.tips[rows]
        square = np.maximum((way**2).sum(axis=1), 1e-30)
        along = (tip @ way.T - (begin * way).sum(axis=1)) / square
        share = np.clip(np.where(square > 1e-20, along, 0.5), 0, 1)
        off = norm(tip[:, None] - begin - share[:, :, None] * way)
        number = min(NEAREST, len(rows))
        near = np.argpartition(off, number - 1, axis=1)[:, :number]
        each = np.arange(len(tip))[:, None]
        off, chosen = off[each, near], rows[near]
        apart = angle_from_arc(axis[:, None], self.axes[chosen], self.axes[chosen + 1])
        best = np.argmin(np.maximum(off / self.tip_tolerance, apart / self.axis_tolerance), axis=1)
        each = each[:, 0]
        return off[each, best], apart[each, best], chosen[each, best]


def angle_from_arc(axis, begin, end):
    """Angle of axes from the arcs of great circles between two others, rad."""
    normal = np.cross(begin, end)
    size = norm(normal)
    normal /= np.maximum(size, 1e-15)[..., None]
    sideways = (axis * np.cross(normal, begin)).sum(axis=-1)
    turned = np.arctan2(sideways, (axis * begin).sum(axis=-1))
    inside = (size > 1e-15) & (turned > 0) & (turned < np.arctan2(size, (begin * end).sum(axis=-1)))
    off_plane = np.arcsin(np.clip(np.abs((axis * normal).sum(axis=-1)), 0, 1))
    to_ends = 2 * np.arcsin(np.clip(np.minimum(norm(axis - begin), norm(axis - end)) / 2, 0, 1))
    return np.where(inside, off_plane, to_ends)


class Followed(Controller):
    """A controller that is followed while its program of a number runs; time may pass faster meanwhile."""

    follower = None
    number = 0
    is_followed = False
    rate = 1.0

    def advance(self, ms):
        super().advance(self.rate * ms if self.runs_program() else ms)

    def _tick(self, ms):
        super()._tick(ms)
        system = self.systems[0]
        runs = system.running and system.interpreter.counter.pointer == self.number
        if runs and self.follower is not None:
            self.follower.add(self.motors.commanded)
        self.is_followed = runs
