# SPDX-License-Identifier: LGPL-2.1-or-later
"""Certify: decide whether a program follows its trajectory within tolerances and limits.

Enters: the strut motion read back from the written program, the trajectory read back from its file, the machine, and
the planned motion, which assigns each knot a place on the trajectory. Leaves: a certificate, and a diagnostic for every
finding that does not hold.
"""

from __future__ import annotations

import numpy as np

from pkm_post.certificate.coverage import coverage
from pkm_post.certificate.deviation import TrajectoryRuler
from pkm_post.certificate.fault_causes import fault_causes
from pkm_post.certificate.findings import figures, findings
from pkm_post.certificate.joints import pass_joints
from pkm_post.certificate.playback import play
from pkm_post.certificate.structure import structure_faults
from pkm_post.certificate.tool_at import Task
from pkm_post.certificate.tool_course import ToolCourse
from pkm_post.geometry import Array, norm
from pkm_post.machine import NO_SETUP
from pkm_post.model import Certificate, Coverage, Diagnostic, Machine, Motion, StrutMotion, Tolerances, Trajectory

_FEED_SHARE = 1.01
"""Factor by which the cubic may exceed the planned speed where the acceleration changes."""
_SWING = 1 / 3
"""Share of the change of speed within one millisecond, which cannot be divided by a knot: if the tip reaches its speed
long before the end, the cubic is faster by this in between, to cover the same distance."""
_FEED_ROUNDING = 0.05
"""mm/s: effect of rounding lengths to six decimals on the speed within one millisecond, with margin."""


def certify(
    struts: StrutMotion,
    program_name: str,
    trajectory: Trajectory,
    machine: Machine,
    motion: Motion,
    tolerances: Tolerances,
    collisions: tuple[Coverage, ...] = NO_SETUP,
    spin_off: Array | float = 0.0,
) -> tuple[Certificate | None, tuple[Diagnostic, ...]]:
    """Play a program and compare it with the trajectory it was made from.

    Args:
        struts: the program, read back.
        program_name: names the program in diagnostics.
        trajectory: the programmed trajectory.
        machine: geometry and limits.
        motion: the plan, or the recovered motion; program and plan must have the same knots.
        tolerances: the requested tolerances.
        collisions: coverage of the checks against part, stock and fixtures.
        spin_off: (K + 1,) mm, strut deviation due to spin error, if the motion was recovered and so has the spin of
            the program itself.
    """
    faults = structure_faults(struts, program_name, trajectory, machine, motion)
    if faults:
        return None, faults
    ruler, ceiling = TrajectoryRuler(trajectory, tolerances), _feed_ceiling(trajectory, motion)

    def measured(struts: StrutMotion) -> Certificate:
        course, knots = ToolCourse.of(machine, struts, motion)
        task = Task(struts, machine, ruler, motion, knots, course, ceiling, spin_off)
        return _certificate(task, trajectory, tolerances, collisions)

    certificate = measured(struts)
    return certificate, fault_causes(certificate, struts, machine, motion, measured)


def _certificate(
    task: Task, trajectory: Trajectory, tolerances: Tolerances, collisions: tuple[Coverage, ...]
) -> Certificate:
    """Play a program and measure it."""
    struts = task.struts
    passed = pass_joints(task, trajectory)
    played = play(task, passed)
    return Certificate(
        findings=findings(task, played, passed, trajectory, tolerances),
        duration=float(struts.time_ms[-1]) / 1000,
        intervals=len(struts) - 1,
        instants=played.instants + len(trajectory),
        time=struts.time_ms[:-1] / 1000,
        tip_deviation=played.tip,
        tip_tolerance=played.tip_tolerance,
        axis_deviation=played.axis,
        coverage=coverage(task.machine, trajectory, collisions),
        figures=figures(task, trajectory),
    )


def _feed_ceiling(trajectory: Trajectory, motion: Motion) -> Array:
    """Highest allowed tip speed of each interval: that of the fastest segment it touches, (K,)."""
    first, last = motion.segment[:-1], motion.segment[1:]
    # reduceat over pairs (first, last + 1): the maxima of the ranges are every second result.
    bounds = np.column_stack([first, last + 1]).ravel()
    fastest = np.maximum.reduceat(np.append(trajectory.feed, 0.0), bounds)[::2]
    speed = norm(motion.tip_rate)
    change = np.abs(np.minimum(speed[1:], fastest) - np.minimum(speed[:-1], fastest))
    indivisible = np.diff(motion.time_ms) == 1
    return fastest * _FEED_SHARE + _FEED_ROUNDING + np.where(indivisible, _SWING * change, 0.0)
