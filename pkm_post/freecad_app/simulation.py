# SPDX-License-Identifier: LGPL-2.1-or-later
"""Simulation: the planned motion of a CAM job, for display at any time, and the violations along it.

Takes a job and its machine; returns a ``Simulation``, which gives poses, strut lengths and speeds, block and tool at
times in s. These times exclude dwells. Nothing is written or certified: infeasible stretches are played as well, and
reported as problems, each with its start and its worst point.

Between two knots the struts follow the cubics that a controller executes, and so do spindle nose and tool axis here.
All queries search sorted times: a motion of a million knots costs little more than a short one.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import FreeCAD as App
import numpy as np

from pkm_post.freecad_app.document_checks import require_computed
from pkm_post.freecad_app.job_setup import PlacedJob, placed_job
from pkm_post.freecad_app.job_study import JobStudy
from pkm_post.freecad_app.progress import Progress
from pkm_post.geometry import Array, hermite_accelerations, hermite_lengths, hermite_speeds, norm, unit
from pkm_post.machine import ReachFinding, ReachReport, ToolPoses
from pkm_post.model import (
    EMPTY_SETUP,
    RULES,
    Diagnostic,
    EventKind,
    Machine,
    Motion,
    Phrase,
    Place,
    Setup,
    StrutMotion,
    Tool,
    Trajectory,
    errors,
    intervals_at,
    required,
)
from pkm_post.planning import interpolate, plan_feed

translate = App.Qt.translate

_BATCH = 16384
"""Cubics per pass: the working arrays of one pass stay in the processor's cache."""
_SAMPLES = 200
"""Samples per block, to find the time of a tip position."""
_MOMENT = 5e-4
"""s before and after an instant, for the speed."""
_FIRST_INSTANT = 1e-3
"""s: just after the start of the first block; at 0 there is no motion to stop yet."""


@dataclass(frozen=True)
class Problem:
    """A stretch of the path that the machine cannot follow.

    Attributes:
        time: start, s.
        place: place of its first block.
        worst_time: time of the worst violation, s.
        worst_place: place of the block with the worst violation.
        worst_tip: (3,) tool tip in {M} at that time.
        text: description of the worst violation.
        end: when the stretch ends, s.
        bodies: the two bodies that come too close, for such a violation.
    """

    time: float
    place: Place
    worst_time: float
    worst_place: Place
    worst_tip: Array
    text: str
    end: float
    bodies: tuple[str, ...]


@dataclass(frozen=True)
class Simulation:
    """A planned motion.

    Attributes:
        trajectory: the path, in {M}.
        motion: poses by time.
        struts: lengths and speeds by time.
        problems: violations and collisions, by time.
        study: the checks that found them; None before they ran.
        setup: part, stock and shanks, in {C}.
    """

    trajectory: Trajectory
    machine: Machine
    motion: Motion
    struts: StrutMotion
    problems: tuple[Problem, ...]
    study: JobStudy | None = None
    setup: Setup = EMPTY_SETUP

    @property
    def duration(self) -> float:
        """Duration of the motion, s."""
        return float(self.motion.time_ms[-1]) / 1000.0

    def operation_times(self) -> tuple[Array, Array]:
        """Moving time and dwell time of each operation of the trajectory, (O,) each, s."""
        trajectory, count = self.trajectory, len(self.trajectory.operations)
        driven = np.diff(self.motion.joint_time, prepend=0.0)
        moving = np.bincount(trajectory.operation, driven, count)
        dwells = [event for event in trajectory.events if event.kind == EventKind.DWELL]
        row = np.minimum([event.row for event in dwells], len(trajectory) - 1).astype(np.int64)
        return moving, np.bincount(trajectory.operation[row], [event.value for event in dwells], count)

    @cached_property
    def greatest_speeds(self) -> Array:
        """The greatest absolute speed of each strut, (6,) in mm/s, also between the knots."""
        greatest = np.abs(self.struts.speed).max(axis=0)
        last = len(self.struts) - 1
        for begin in range(0, last, _BATCH):
            greatest = np.maximum(
                greatest, self._greatest_within_intervals(np.arange(begin, min(begin + _BATCH, last)))
            )
        return greatest

    def _greatest_within_intervals(self, rows: Array) -> Array:
        """The same, inside the cubics that begin at some knots."""
        cubics = self.struts.cubics(rows)
        _, speed, _, _, duration = cubics
        starts, ends = hermite_accelerations(*cubics)
        turns = starts * ends < 0.0  # the speed of a cubic is extreme there
        share = np.divide(starts, starts - ends, out=np.zeros_like(starts), where=turns)
        reached = speed + starts * share * duration[:, None] / 2.0
        greatest: Array = np.abs(reached).max(axis=0)
        return greatest

    def pose_at(self, seconds: Array) -> ToolPoses:
        """Poses in {M} at times (T,)."""
        start, share, duration = self._between(seconds)
        motion, end = self.motion, start + 1

        def at(value: Array, rate: Array) -> Array:
            return hermite_lengths(value[start], rate[start], value[end], rate[end], duration, share[:, None])[:, 0]

        nose = hermite_lengths(*_noses(motion, start), *_noses(motion, end), duration, share[:, None])[:, 0]
        axis = unit(at(motion.axis, motion.axis_rate))
        spin = at(motion.spin[:, None], motion.spin_rate[:, None])[:, 0]
        length = motion.tool_length[end]  # at a tool change the spindle is at rest, and the tip jumps
        return ToolPoses(nose - length[:, None] * axis, axis, spin, length)

    def struts_at(self, seconds: Array) -> tuple[Array, Array]:
        """Strut lengths and speeds at times (T,), (T, 6) each."""
        start, share, _ = self._between(seconds)
        cubics = self.struts.cubics(start)
        return hermite_lengths(*cubics, share[:, None])[:, 0], hermite_speeds(*cubics, share[:, None])[:, 0]

    def block_at(self, seconds: float) -> int:
        """The segment of the trajectory that is active at a time; the earlier one where two meet."""
        return min(int(np.searchsorted(self.motion.joint_time, seconds)), len(self.trajectory) - 1)

    def tool_at(self, seconds: float) -> Tool:
        """The tool in the spindle at a time."""
        return self.trajectory.tools[int(self.trajectory.tool[self.block_at(seconds)])]

    def operation_begins(self, number: int) -> tuple[int, float]:
        """The first segment of an operation, and its start time; those of the next one if it has no moves."""
        rows = np.flatnonzero(self.trajectory.operation >= number)
        row = int(rows[0]) if len(rows) else len(self.trajectory) - 1
        return row, self._block_begins(row)

    def next_block(self, seconds: float) -> float:
        """End time of the block after a time."""
        after = self.motion.joint_time[np.searchsorted(self.motion.joint_time, seconds, side="right") :]
        return float(after[0]) if len(after) else self.duration

    def block_before(self, seconds: float) -> float:
        """Start time of the block before a time."""
        before = self.motion.joint_time[: np.searchsorted(self.motion.joint_time, seconds)]
        return float(before[-1]) if len(before) else 0.0

    def line_begins(self, operation: int, line: int) -> float:
        """Start time of an operation's first block at or after a line; the operation's end if there is none, s."""
        rows = np.flatnonzero(self.trajectory.operation == operation)
        if not len(rows):
            return self.operation_begins(operation)[1]
        behind = rows[self.trajectory.line[rows] >= line]
        return self._block_begins(int(behind[0]) if len(behind) else int(rows[-1]) + 1)

    def _block_begins(self, row: int) -> float:
        """Start time of a segment, s."""
        return float(self.motion.joint_time[row - 1]) if row else 0.0

    def feed_at(self, seconds: float) -> float:
        """Speed of the tool tip at a time, mm/s."""
        ends = np.clip(seconds + np.array([-_MOMENT, _MOMENT]), 0.0, self.duration)
        nose, axis, _, length = self.pose_at(ends)
        tip = nose + (length - length[1])[:, None] * axis  # of the same tool, also near a tool change
        return float(norm(tip[1] - tip[0]) / max(ends[1] - ends[0], _MOMENT))

    def problems_at(self, seconds: float) -> list[Problem]:
        """The problems whose stretch includes a time."""
        return [problem for problem in self.problems if problem.time <= seconds <= problem.end]

    def problem_between(self, start: float, end: float) -> Problem | None:
        """The first problem after a time, up to another time."""
        return next((problem for problem in self.problems if start < problem.time <= end), None)

    def envelope(self, columns: int) -> tuple[Array, Array]:
        """Least and largest of lengths and speeds, (2, columns, 6) each, over equal time intervals.

        Uses the knots and the interval boundaries, so that long cubics are covered, too.
        """
        edges = np.linspace(0.0, self.duration, columns + 1)
        at_edges = self.struts_at(edges)
        first = np.searchsorted(self.motion.time_ms / 1000.0, edges)
        lengths = _extremes(self.struts.length, first, at_edges[0])
        return lengths, _extremes(self.struts.speed, first, at_edges[1])

    def _between(self, seconds: Array) -> tuple[Array, Array, Array]:
        """Knot before each time (T,), the elapsed share of the interval (T,), and its duration (T,)."""
        ms = np.clip(np.asarray(seconds, dtype=np.float64) * 1000.0, 0.0, self.motion.time_ms[-1])
        whole_ms = ms.astype(np.int64)  # searching integers for floats would copy the whole array first
        start = intervals_at(self.motion.time_ms, whole_ms)
        whole = self.motion.time_ms[start + 1] - self.motion.time_ms[start]
        return start, (ms - self.motion.time_ms[start]) / whole, whole / 1000.0


def _noses(motion: Motion, knot: Array) -> tuple[Array, Array]:
    """Position and velocity of the spindle nose at knots: unlike the tip, it does not jump at tool changes."""
    length = motion.tool_length[knot][:, None]
    return motion.tip[knot] + length * motion.axis[knot], motion.tip_rate[knot] + length * motion.axis_rate[knot]


def _extremes(knots: Array, first: Array, ends: Array) -> Array:
    """Least and largest rows (2, C, 6) of knots by interval; an interval without a knot uses its two ends."""
    least, largest = np.minimum(ends[:-1], ends[1:]), np.maximum(ends[:-1], ends[1:])
    full = np.flatnonzero(first[1:] > first[:-1])
    if len(full):
        least[full] = np.minimum(least[full], np.minimum.reduceat(knots, first[full], axis=0))
        largest[full] = np.maximum(largest[full], np.maximum.reduceat(knots, first[full], axis=0))
    return np.stack([least, largest])


def simulate_job(job: Any, machine_object: Any = None) -> Simulation:
    """Plan the motion of a CAM job.

    Args:
        job: the CAM job; its document is recomputed.
        machine_object: from ``create_machine``; without one the arguments of the job define the machine.

    Raises:
        Refused: the job cannot be read or placed. The simulation reports stretches that cannot be followed.
    """
    require_computed(job.Document)
    return simulation_of(placed_job(job, machine_object))


def simulation_of(placed: PlacedJob) -> Simulation:
    """Plan the motion of a job on its machine."""
    trajectory, machine, tolerances = placed.trajectory, placed.machine, placed.tolerances
    with Progress(translate("PKM_Simulate", "Simulation"), 3) as bar:
        # the reach check reports all other faults, less precisely
        feed_plan = required(*plan_feed(trajectory, machine, tolerances))
        bar.step()
        plan = interpolate(feed_plan)
        bar.step()
        planned = Simulation(trajectory, machine, plan.motion, plan.struts, (), setup=placed.setup)
        study = placed.study()
        problems = _problems(study, planned)
        bar.step()
    return replace(planned, problems=problems, study=study)


def _problems(study: JobStudy, planned: Simulation) -> tuple[Problem, ...]:
    """One problem for each check and stretch of violating blocks, and one for each collision without a margin."""
    problems = [problem for finding in study.margins for problem in _problem_ranges(finding, study.reach, planned)]
    shown = {finding.subject.code for finding in study.margins}
    problems += [_collision(each, study, planned) for each in errors(study.findings) if each.code not in shown]
    return tuple(sorted(problems, key=lambda problem: (problem.time, problem.text)))


def _collision(found: Diagnostic, study: JobStudy, planned: Simulation) -> Problem:
    row = study.row_of(found)
    segment = int(study.reach.segment[row])
    return Problem(
        time=float(planned.motion.joint_time[segment - 1]) if segment else _FIRST_INSTANT,
        place=found.place,
        worst_time=_time_of(row, segment, study.reach, planned),
        worst_place=found.place,
        worst_tip=study.reach.tip[row],
        text=Phrase("{}: {}", Phrase(RULES[found.code].cause), found.found),
        end=float(planned.motion.joint_time[segment]),
        bodies=tuple(found.found.split(", ")[:2]),
    )


def _problem_ranges(finding: ReachFinding, checked: ReachReport, planned: Simulation) -> list[Problem]:
    rows = np.flatnonzero(finding.margin < 0.0)
    groups = np.split(rows, np.flatnonzero(np.diff(checked.segment[rows]) > 1) + 1) if len(rows) else []
    problems = []
    for group in groups:
        first, worst = int(group[0]), int(group[np.argmin(finding.margin[group])])
        begins, is_worst = (int(checked.segment[row]) for row in (first, worst))
        text = finding.subject.describe(int(finding.part[worst]), float(finding.margin[worst]))
        problem = Problem(
            time=_time_of(first - 1, begins, checked, planned),
            place=checked.trajectory.place(begins),
            worst_time=_time_of(worst, is_worst, checked, planned),
            worst_place=checked.trajectory.place(is_worst),
            worst_tip=checked.tip[worst],
            text=Phrase("{}: {}", finding.subject.name, text),
            end=float(planned.motion.joint_time[int(checked.segment[group[-1]])]),
            bodies=pair_of(finding, int(finding.part[worst])),
        )
        problems.append(problem)
    return problems


_PAIRS = {
    "K113": ("strut {}", "strut {}"),
    "K114": ("strut {}", "{}"),
    "K115": ("strut {}", "{}"),
    "K116": ("{}", "{}"),
    "K117": ("{}", "part"),
    "K121": ("strut {}", "part"),
}
"""Names of the two bodies by the code of a check; each of its parts has a number or a name for each body."""


def pair_of(finding: ReachFinding, part: int) -> tuple[str, ...]:
    """The two bodies of a check of clearance; none for other checks."""
    forms, names = _PAIRS.get(finding.subject.code, ()), finding.subject.parts[part].split(" and ", 1)
    return tuple(form.format(*names[row : row + 1]) for row, form in enumerate(forms))


def _time_of(row: int, segment: int, checked: ReachReport, planned: Simulation) -> float:
    """Time at which the tip passes a row in its block; the block's start if it dwells or lacks the row."""
    begins = float(planned.motion.joint_time[segment - 1]) if segment else _FIRST_INSTANT
    if row < 0 or checked.segment[row] != segment:
        return begins
    seconds = np.linspace(begins, float(planned.motion.joint_time[segment]), _SAMPLES)
    away = norm(planned.pose_at(seconds)[0] - checked.tip[row])
    return float(seconds[np.argmin(away)])
