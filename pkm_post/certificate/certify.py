# SPDX-License-Identifier: LGPL-2.1-or-later
"""Certify: decide whether a program does what was programmed, within tolerances and limits.

Enters: the strut motion read back from the written program, the trajectory read back from its file, the machine, and
the planned motion, which says for each knot where on the trajectory it ought to be. Leaves: a certificate, and a
diagnostic for everything that does not hold.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from pkm_post.certificate.deviation import TrajectoryRuler
from pkm_post.certificate.instants import Task
from pkm_post.certificate.joints import Passed, pass_joints
from pkm_post.certificate.knots import Knots
from pkm_post.certificate.playback import Played, play
from pkm_post.certificate.struts import off_plan, strut_jerk
from pkm_post.certificate.tool_course import ToolCourse
from pkm_post.geometry.vectors import Array
from pkm_post.model import Diagnostic, Machine, Motion, Place, StrutMotion, Trajectory
from pkm_post.model.certificate import Certificate, Finding, Tolerances

_FEED_SHARE = 1.01
"""How far the cubic may swing about the planned speed where the acceleration changes."""
_FEED_ROUNDING = 0.05
"""mm/s: what rounding lengths to six decimals can do to the speed within one millisecond, with room to spare."""


def certify(
    struts: StrutMotion,
    program_name: str,
    trajectory: Trajectory,
    machine: Machine,
    motion: Motion,
    tolerances: Tolerances,
) -> tuple[Certificate | None, tuple[Diagnostic, ...]]:
    """Play a program and compare it with the trajectory it was made from.

    Args:
        struts: the program, read back.
        program_name: names the program in diagnostics.
        trajectory: what was programmed.
        machine: geometry and limits.
        motion: the plan; program and plan must have the same knots.
        tolerances: what was asked for.
    """
    faults = _structure_faults(struts, program_name, trajectory, machine, motion)
    if faults:
        return None, faults
    ruler, ceiling = TrajectoryRuler(trajectory, tolerances), _feed_ceiling(trajectory, motion)
    knots = Knots.of(machine, motion)
    course = ToolCourse.of(machine, struts, motion, knots)
    task = Task(struts, machine, ruler, motion, knots, course, ceiling)
    passed = pass_joints(task, trajectory)
    played = play(task, passed)
    findings = _findings(task, played, passed, trajectory, tolerances)
    certificate = Certificate(
        findings=findings,
        duration=float(struts.time_ms[-1]) / 1000,
        intervals=len(struts) - 1,
        instants=played.instants + len(trajectory),
        time=struts.time_ms[:-1] / 1000,
        tip_deviation=played.tip,
        tip_tolerance=played.tip_tolerance,
        axis_deviation=played.axis,
    )
    return certificate, tuple(finding.diagnostic() for finding in findings if not finding.holds)


def _findings(
    task: Task, played: Played, passed: Passed, trajectory: Trajectory, tolerances: Tolerances
) -> tuple[Finding, ...]:
    """One row for each quantity: code, name, unit, values, limit, and when and where they were taken."""
    struts, machine, motion = task.struts, task.machine, task.motion
    intervals = _Series(struts.time_ms[:-1] / 1000, motion.segment[1:])
    joints = _Series(motion.joint_time, np.arange(len(trajectory)))
    knots = _Series(struts.time_ms / 1000, motion.segment)
    at_ends = trajectory.tip_tolerances(tolerances.tip)
    axis_limit = math.degrees(tolerances.axis)
    rows: tuple[_Row, ...] = (
        ("V107", "instants without a pose", "", 1.0 - played.found, 0.0, intervals),
        ("V101", "deviation of the tool tip", "mm", played.tip, played.tip_tolerance, intervals),
        ("V102", "deviation of the tool axis", "degrees", np.degrees(played.axis), axis_limit, intervals),
        ("V110", "tool tip off a programmed point", "mm", passed.tip, at_ends, joints),
        ("V110", "tool axis off a programmed one", "degrees", np.degrees(passed.axis), axis_limit, joints),
        ("V111", "strut off its plan", "mm", off_plan(struts, task.knots), tolerances.tip, knots),
        ("V108", "tip speed above the feed", "mm/s", played.tip_speed - task.ceiling, 0.0, intervals),
        ("V103", "strut speed", "mm/s", played.strut_speed, machine.strut_speed, intervals),
        ("V104", "strut acceleration", "mm/s^2", played.strut_acceleration, machine.strut_acceleration, intervals),
        ("V106", "strut shorter than its stroke", "mm", machine.strut_stroke[0] - played.shortest, 0.0, intervals),
        ("V106", "strut longer than its stroke", "mm", played.longest - machine.strut_stroke[1], 0.0, intervals),
    )
    if math.isfinite(machine.strut_jerk):
        rows = (*rows, ("V112", "strut jerk", "mm/s^3", strut_jerk(struts), machine.strut_jerk, knots))
    return tuple(_worst(trajectory, *row) for row in rows)


@dataclass(frozen=True)
class _Series:
    """When and on which trajectory segment the values of a quantity were taken."""

    time: Array
    segment: Array


_Row = tuple[str, str, str, Array, Array | float, _Series]


def _worst(
    trajectory: Trajectory, code: str, name: str, unit: str, values: Array, limit: Array | float, series: _Series
) -> Finding:
    """The finding at the largest value, by its limit if limits differ; no number counts as beyond every limit."""
    values, limits = np.where(np.isnan(values), np.inf, values), np.broadcast_to(limit, values.shape)
    row = int(np.argmax(values if np.ndim(limit) == 0 else values / limits))
    value, most, place = float(values[row]), float(limits[row]), trajectory.place(int(series.segment[row]))
    return Finding(code, name, unit, value, most, value <= most, float(series.time[row]), place)


def _structure_faults(
    struts: StrutMotion, program_name: str, trajectory: Trajectory, machine: Machine, motion: Motion
) -> tuple[Diagnostic, ...]:
    """What makes a comparison pointless: another machine, other knots, other events, or motion at the ends."""
    place = Place(program_name)
    faults = []
    if trajectory.machine_fingerprint != machine.fingerprint:
        faults.append(Diagnostic("T104", place, f"made for {trajectory.machine}, checked on {machine.name}"))
    if not np.array_equal(struts.time_ms, motion.time_ms):
        found = f"{len(struts)} points in {struts.time_ms[-1]} ms, planned {len(motion)} in {motion.time_ms[-1]} ms"
        faults.append(Diagnostic("V110", place, found))
    if struts.events != motion.events:
        faults.append(Diagnostic("V109", place, f"{len(struts.events)} events, the job has {len(motion.events)}"))
    if struts.speed[[0, -1]].any():
        faults.append(Diagnostic("V105", place, f"last speeds {struts.speed[-1].tolist()} mm/s"))
    return tuple(faults)


def _feed_ceiling(trajectory: Trajectory, motion: Motion) -> Array:
    """Highest tip speed each interval may have: that of the fastest segment it touches, (K,)."""
    first, last = motion.segment[:-1], motion.segment[1:]
    # reduceat over pairs (first, last + 1): the maxima of the ranges are every second result.
    bounds = np.column_stack([first, last + 1]).ravel()
    fastest = np.maximum.reduceat(np.append(trajectory.feed, 0.0), bounds)[::2]
    return fastest * _FEED_SHARE + _FEED_ROUNDING
