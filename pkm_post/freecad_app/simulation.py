# SPDX-License-Identifier: LGPL-2.1-or-later
"""Simulation: the motion of a CAM job as it is planned, to be looked at at any time.

A job and its machine enter; a plan leaves, and from it poses, strut lengths and speeds and the block at times in s.
Dwells do not count in these times. Between two knots the struts follow the cubics that a controller plays, and so do
spindle nose and tool axis here. All by search in sorted times: a motion of a million knots costs little more than a
short one. Nothing is written, and nothing certified: what cannot be followed is played all the same, and told.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from pkm_post import planning
from pkm_post.freecad_app.job_on_machine import JobOnMachine, job_on_machine
from pkm_post.freecad_app.progress import Progress
from pkm_post.geometry import hermite_lengths, hermite_speeds, unit
from pkm_post.geometry.vectors import Array, norm
from pkm_post.kinematics import Finding
from pkm_post.kinematics.way import Pose
from pkm_post.model import RULES, Machine, Motion, Place, StrutMotion, Tool, Trajectory
from pkm_post.model.diagnostics import Severity
from pkm_post.reach import Reach, reach

_LOOKED_AT = 200
"""Instants of a block, to find when the tip is somewhere."""
_BEGUN = 1e-3
"""s: when the first block has begun; at 0 nothing has been driven that could be stopped."""


@dataclass(frozen=True)
class Problem:
    """A stretch of the way that the machine cannot follow.

    Attributes:
        time: when it begins, s.
        text: the worst of it.
        place: of its first block.
    """

    time: float
    text: str
    place: Place


@dataclass(frozen=True)
class Simulation:
    """The plan.

    Attributes:
        trajectory: what is driven, in {M}.
        machine: by which machine.
        motion: poses by time.
        struts: lengths and speeds by time.
        problems: what cannot be followed, by time.
    """

    trajectory: Trajectory
    machine: Machine
    motion: Motion
    struts: StrutMotion
    problems: tuple[Problem, ...]

    @property
    def duration(self) -> float:
        """How long it takes, s."""
        return float(self.motion.time_ms[-1]) / 1000.0

    def pose_at(self, seconds: Array) -> Pose:
        """Poses in {M} at times (T,)."""
        start, share, duration = self._between(seconds)
        motion, end = self.motion, start + 1

        def at(value: Array, rate: Array) -> Array:
            return hermite_lengths(value[start], rate[start], value[end], rate[end], duration, share[:, None])[:, 0]

        nose = hermite_lengths(*_noses(motion, start), *_noses(motion, end), duration, share[:, None])[:, 0]
        axis = unit(at(motion.axis, motion.axis_rate))
        spin = at(motion.spin[:, None], motion.spin_rate[:, None])[:, 0]
        length = motion.tool_length[end]  # at a tool change the spindle stands still, and the tip jumps
        return nose - length[:, None] * axis, axis, spin, length

    def struts_at(self, seconds: Array) -> tuple[Array, Array]:
        """Strut lengths and speeds at times (T,), (T, 6) each."""
        start, share, duration = self._between(seconds)
        p, v = self.struts.length, self.struts.speed
        cubic = p[start], v[start], p[start + 1], v[start + 1], duration
        return hermite_lengths(*cubic, share[:, None])[:, 0], hermite_speeds(*cubic, share[:, None])[:, 0]

    def block_at(self, seconds: float) -> int:
        """The segment of the trajectory that is driven at a time; the earlier one where two meet."""
        return min(int(np.searchsorted(self.motion.joint_time, seconds)), len(self.trajectory) - 1)

    def tool_at(self, seconds: float) -> Tool:
        """The tool in the spindle at a time."""
        return self.trajectory.tools[int(self.trajectory.tool[self.block_at(seconds)])]

    def next_block(self, seconds: float) -> float:
        """When the block ends that is driven behind a time."""
        after = self.motion.joint_time[np.searchsorted(self.motion.joint_time, seconds, side="right") :]
        return float(after[0]) if len(after) else self.duration

    def block_before(self, seconds: float) -> float:
        """When the block begins that is driven before a time."""
        before = self.motion.joint_time[: np.searchsorted(self.motion.joint_time, seconds)]
        return float(before[-1]) if len(before) else 0.0

    def problem_between(self, start: float, end: float) -> Problem | None:
        """The first problem behind a time, up to another time."""
        return next((problem for problem in self.problems if start < problem.time <= end), None)

    def envelope(self, columns: int) -> tuple[Array, Array]:
        """Least and largest of lengths and speeds, (2, columns, 6) each, over equal stretches of time.

        Made of the knots and of the instants between the stretches, so that long cubics are drawn as well.
        """
        edges = np.linspace(0.0, self.duration, columns + 1)
        at_edges = self.struts_at(edges)
        first = np.searchsorted(self.motion.time_ms / 1000.0, edges)
        lengths = _extremes(self.struts.length, first, at_edges[0])
        return lengths, _extremes(self.struts.speed, first, at_edges[1])

    def _between(self, seconds: Array) -> tuple[Array, Array, Array]:
        """Knot before each time (T,), the share of the interval that has gone (T,), and its duration (T,)."""
        ms = np.clip(np.asarray(seconds, dtype=np.float64) * 1000.0, 0.0, self.motion.time_ms[-1])
        start = np.clip(np.searchsorted(self.motion.time_ms, ms, side="right") - 1, 0, len(self.motion) - 2)
        whole = self.motion.time_ms[start + 1] - self.motion.time_ms[start]
        return start, (ms - self.motion.time_ms[start]) / whole, whole / 1000.0


def simulate_job(job: Any, machine_object: Any = None) -> Simulation:
    """Plan the motion of a CAM job.

    Args:
        job: the CAM job; its document is recomputed.
        machine_object: what ``create_machine`` made; without one the arguments of the job say what it runs on.

    Raises:
        Refused: the job cannot be read or placed. What of it cannot be followed is told by the simulation.
    """
    job.Document.recompute()
    return simulation_of(job_on_machine(job, machine_object))


def simulation_of(placed: JobOnMachine) -> Simulation:
    """Plan the motion of a job on its machine."""
    trajectory, machine, tolerances = placed.trajectory, placed.machine, placed.tolerances
    with Progress("Simulation", 3) as bar:
        path = planning.tool_path(trajectory, tolerances)
        schedule, _ = planning.plan_feed(path, trajectory, machine)  # its faults are those of the reach, less precise
        bar.step()
        motion = planning.interpolate(path, schedule, trajectory.events, machine, tolerances)
        bar.step()
        planned = Simulation(trajectory, machine, motion, planning.strut_motion(motion, machine), ())
        problems = _problems(reach(trajectory, machine, placed.part), planned)
        bar.step()
    return replace(planned, problems=problems)


def _noses(motion: Motion, knot: Array) -> tuple[Array, Array]:
    """Where the spindle nose is at knots, and its velocity: unlike the tip, it does not jump at tool changes."""
    length = motion.tool_length[knot][:, None]
    return motion.tip[knot] + length * motion.axis[knot], motion.tip_rate[knot] + length * motion.axis_rate[knot]


def _problems(checked: Reach, planned: Simulation) -> tuple[Problem, ...]:
    """One for each check and stretch of blocks that violate it."""
    graves = [item for item in checked.findings if RULES[item.subject.code].severity is Severity.ERROR]
    found = [problem for finding in graves for problem in _stretches(finding, checked, planned)]
    return tuple(sorted(found, key=lambda problem: (problem.time, problem.text)))


def _stretches(finding: Finding, checked: Reach, planned: Simulation) -> list[Problem]:
    rows = np.flatnonzero(finding.margin < 0.0)
    groups = np.split(rows, np.flatnonzero(np.diff(checked.segment[rows]) > 1) + 1) if len(rows) else []
    problems = []
    for group in groups:
        first, worst = int(checked.segment[group[0]]), int(group[np.argmin(finding.margin[group])])
        begins = _time_of(int(group[0]) - 1, first, checked, planned)
        told = finding.subject.tell(int(finding.part[worst]), float(finding.margin[worst]))
        problems.append(Problem(begins, f"{finding.subject.name}: {told}", checked.trajectory.place(first)))
    return problems


def _time_of(row: int, segment: int, checked: Reach, planned: Simulation) -> float:
    """When the tip passes the row before a violation in its block; where the tip stands, when the block begins."""
    begins = float(planned.motion.joint_time[segment - 1]) if segment else _BEGUN
    if row < 0 or checked.segment[row] != segment:
        return begins
    seconds = np.linspace(begins, float(planned.motion.joint_time[segment]), _LOOKED_AT)
    away = norm(planned.pose_at(seconds)[0] - checked.tip[row])
    return float(seconds[np.argmin(away)])


def _extremes(knots: Array, first: Array, ends: Array) -> Array:
    """Least and largest rows (2, C, 6) of knots by stretch; a stretch without a knot has its two ends."""
    least, largest = np.minimum(ends[:-1], ends[1:]), np.maximum(ends[:-1], ends[1:])
    full = np.flatnonzero(first[1:] > first[:-1])
    if len(full):
        least[full] = np.minimum(least[full], np.minimum.reduceat(knots, first[full], axis=0))
        largest[full] = np.maximum(largest[full], np.maximum.reduceat(knots, first[full], axis=0))
    return np.stack([least, largest])
