# SPDX-License-Identifier: LGPL-2.1-or-later
"""Certify: decide whether a program follows its trajectory within tolerances and limits.

Input: the strut motion read back from the written program, the trajectory read back from its file, the machine, and
the planned motion, which locates each knot on the trajectory. Output: a certificate with each quantity at its
worst, its limit, a time and a source line; figures without a limit; and a diagnostic for every finding that does not
hold. docs/certificate.md has the table; ``coverage`` assigns entries of the machine file to rows.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial

import numpy as np

from pkm_post.certificate.consistency import structure_faults
from pkm_post.certificate.coverage import coverage
from pkm_post.certificate.deviation import FeedRuler, TrajectoryRuler
from pkm_post.certificate.diagnosis import diagnose
from pkm_post.certificate.dynamics import contour_error, count_at_tip, tip_jerk, tool_limits
from pkm_post.certificate.playback import PlaybackBounds, Quantity, play, when_worst
from pkm_post.certificate.struts import (
    AdjacentMotion,
    ProgramPoints,
    acceleration_ramps,
    acceleration_steps,
    blocks_in_a_second,
    off_plan,
    strut_jerk,
)
from pkm_post.certificate.tool_spline import ToolSpline
from pkm_post.certificate.tool_states import PlaybackTask
from pkm_post.geometry import Array
from pkm_post.machine import NO_SETUP
from pkm_post.model import (
    Certificate,
    Coverage,
    Diagnostics,
    EventKind,
    Figure,
    Finding,
    Kind,
    Machine,
    Motion,
    Phrase,
    StrutMotion,
    Tolerances,
    Trajectory,
    checkpoint,
)


def findings(task: PlaybackTask, played: PlaybackBounds) -> tuple[Finding, ...]:
    """One row for each quantity: code, name, unit, values, limit, and the time and place of each value."""
    rows = [
        *_deviations(task, played),
        *_rates(task, played),
        *_lengths_and_intervals(task, played),
        *_jerks(task),
    ]
    if any(event.kind is EventKind.SPINDLE_AXIS for event in task.ruler.trajectory.events):
        rows += _of_threads(task)
    return tuple(_worst(task.ruler.trajectory, *row) for row in rows)


def _deviations(task: PlaybackTask, played: PlaybackBounds) -> list[_Row]:
    """Rows of the deviations of tip, tool axis and struts."""
    ruler, passed = task.ruler, played.joints
    joints = partial(_of_columns, task.motion.joint_time, np.arange(len(ruler.trajectory)))
    at_worst = partial(_largest_sample, task, played)
    axis, axis_limit = np.degrees(played.axis), math.degrees(ruler.axis_tolerance)
    checkpoint()
    off = off_plan(task.struts, task.knots) + task.spin_deviation
    checkpoint()
    return [
        ("V107", Phrase("interval without a pose"), "", 1.0 - played.found, 0.0, _at_starts(task)),
        ("V101", Phrase("deviation of the tool tip"), "mm", *at_worst(Quantity.TIP, played.tip, played.tip_tolerance)),
        ("V102", Phrase("deviation of the tool axis"), "degrees", *at_worst(Quantity.AXIS, axis, axis_limit)),
        ("V110", Phrase("tool tip off a programmed point"), "mm", passed.tip, ruler.tip_tolerance, joints),
        ("V110", Phrase("tool axis off a programmed one"), "degrees", np.degrees(passed.axis), axis_limit, joints),
        ("V111", Phrase("strut off its plan"), "mm", off, ruler.tolerances.tip, _at_knots(task)),
    ]


def _rates(task: PlaybackTask, played: PlaybackBounds) -> list[_Row]:
    """Rows of the speeds and accelerations of tip, tool axis and struts."""
    machine, starts = task.machine, _at_starts(task)
    tip_speed = _largest_sample(task, played, Quantity.SPEED, played.tip_speed, played.ceiling)
    axis_speed, tip_acceleration = tool_limits(task)
    turning, most_turning = np.degrees(axis_speed), math.degrees(machine.axis_speed)
    return [
        ("V108", Phrase("tip speed"), "mm/s", *tip_speed),
        ("V103", Phrase("strut speed"), "mm/s", played.strut_speed, machine.strut_speed, starts),
        ("V104", Phrase("strut acceleration"), "mm/s^2", played.strut_acceleration, machine.strut_acceleration, starts),
        ("V113", Phrase("turning rate of the tool axis"), "degrees/s", turning, most_turning, starts),
        ("V114", Phrase("tip acceleration"), "mm/s^2", tip_acceleration, machine.tip_acceleration, starts),
    ]


def _lengths_and_intervals(task: PlaybackTask, played: PlaybackBounds) -> list[_Row]:
    """Rows of the strut lengths, and of the intervals between the points of the program."""
    machine, starts, time_ms = task.machine, _at_starts(task), task.struts.time_ms
    rows: list[_Row] = [
        ("V106", Phrase("shortest strut"), "mm", played.shortest, machine.strut_stroke[0], starts),
        ("V106", Phrase("longest strut"), "mm", played.longest, machine.strut_stroke[1], starts),
        ("V116", Phrase("shortest interval"), "ms", np.diff(time_ms), machine.shortest_interval, starts),
    ]
    if math.isfinite(machine.block_rate):
        blocks = blocks_in_a_second(time_ms)
        rows.append(("V117", Phrase("blocks in one second"), "1/s", blocks, machine.block_rate, _at_knots(task)))
    return rows


def _jerks(task: PlaybackTask) -> list[_Row]:
    """Rows of the jerks that the machine limits."""
    machine, knots, rows = task.machine, _at_knots(task), list[_Row]()
    if math.isfinite(machine.strut_jerk):
        jerk = strut_jerk(task.struts, task.adjacent, task.points)
        rows.append(("V112", Phrase("strut jerk"), "mm/s^3", jerk, machine.strut_jerk, knots))
    if math.isfinite(machine.tip_jerk):
        rows.append(("V115", Phrase("tip jerk"), "mm/s^3", tip_jerk(task), machine.tip_jerk, knots))
    return rows


def _of_threads(task: PlaybackTask) -> list[_Row]:
    """Rows of a spindle as an axis; a machine without one has been refused (T107)."""
    from pkm_post.certificate.lead import thread_bounds

    axis, bounds = task.machine.spindle_axis, thread_bounds(task)
    if axis is None:
        raise ValueError("machine: expected a spindle that is an axis, as the trajectory has threads, got none")
    starts, rise = _at_starts(task), Phrase("spindle acceleration in a thread")
    return [
        ("V120", Phrase("depth of a thread off its turns"), "mm", bounds.lead, axis.lead_tolerance, starts),
        ("V121", Phrase("spindle speed in a thread"), "1/min", 60 * bounds.speed, 60 * axis.speed, starts),
        ("V122", rise, "turns/s^2", bounds.acceleration, axis.acceleration, starts),
    ]


def figures(task: PlaybackTask) -> tuple[Figure, ...]:
    """Measured quantities without a limit."""
    checkpoint()
    machine, struts, knots, trajectory = task.machine, task.struts, _at_knots(task), task.ruler.trajectory
    steps = acceleration_steps(struts) if task.points is None else acceleration_ramps(struts)
    rows = [
        (Phrase("step of strut acceleration at a knot"), "mm/s^2", steps, knots),
    ]
    if not math.isfinite(machine.block_rate):
        rows.append((Phrase("blocks in one second"), "1/s", blocks_in_a_second(struts.time_ms), knots))
    counts = machine.controller.get("counts_per_mm")
    if counts is not None:
        rows.append((Phrase("tip moved by one count of each strut"), "um", count_at_tip(task, counts), knots))
    checkpoint()
    if machine.velocity_gain is not None:
        cuts = trajectory.kind[task.motion.segment[1:]] != Kind.RAPID
        checkpoint()
        error = np.where(cuts, contour_error(task, machine.velocity_gain), 0.0)
        rows.append((Phrase("contour error by following errors"), "um", error, _at_starts(task)))
    return tuple(_figure(trajectory, *row) for row in rows)


def _figure(trajectory: Trajectory, name: Phrase, unit: str, values: Array, when: _When) -> Figure:
    checkpoint()
    row = int(np.argmax(values))
    time, segment = when(row)
    return Figure(name, unit, float(values[row]), time, trajectory.place(segment))


_When = Callable[[int], tuple[float, int]]
"""Time of a row of a quantity, s, and the trajectory segment executed then. Evaluated for the worst row only."""
_Row = tuple[str, Phrase, str, Array, Array | float, _When]


def _largest_sample(
    task: PlaybackTask, played: PlaybackBounds, quantity: Quantity, values: Array, limit: Array | float
) -> tuple[Array, float, _When]:
    """The largest figure by its limit, in the interval with the largest measured value; with limit and time.

    The figure may belong to another interval, due to its bound between samples, whose time is unknown.
    """
    there = float(np.broadcast_to(limit, values.shape)[played.most_found[quantity]])
    figure = np.max(values / limit, keepdims=True) * there
    return figure, there, lambda _: when_worst(task, played, quantity)


def _start(motion: Motion, interval: int) -> tuple[float, int]:
    """The start of an interval, s, and the segment executed just after it."""
    time = float(motion.time_ms[interval]) / 1000
    return time, int(np.searchsorted(motion.joint_time, time, side="right"))


def _at_starts(task: PlaybackTask) -> _When:
    return partial(_start, task.motion)


def _at_knots(task: PlaybackTask) -> _When:
    return partial(_of_columns, task.struts.time_ms / 1000, task.motion.segment)


def _of_columns(time: Array, segment: Array, row: int) -> tuple[float, int]:
    return float(time[row]), int(segment[row])


def _worst(
    trajectory: Trajectory, code: str, name: Phrase, unit: str, values: Array, limit: Array | float, when: _When
) -> Finding:
    """The finding at the worst value, by its limit if limits differ; NaN counts as a violation."""
    checkpoint()
    is_least = name in _LEAST
    sign = -1.0 if is_least else 1.0
    values, limits = sign * np.where(np.isnan(values), sign * np.inf, values), np.broadcast_to(limit, values.shape)
    checkpoint()
    row = int(np.argmax(values if np.ndim(limit) == 0 else values / limits))
    value, bound, (time, segment) = sign * float(values[row]), float(limits[row]), when(row)
    holds = value >= bound if is_least else value <= bound
    return Finding(code, name, unit, value, bound, holds, time, trajectory.place(segment), is_least)


_LEAST = ("shortest strut", "shortest interval")
"""Findings whose limit is a least value."""


_WHOLE = AdjacentMotion()
"""No motion before or after: a whole program."""


def certify(
    struts: StrutMotion,
    program_name: str,
    trajectory: Trajectory,
    machine: Machine,
    motion: Motion,
    tolerances: Tolerances,
    collisions: tuple[Coverage, ...] = NO_SETUP,
    spin_deviation: Array | None = None,
    adjacent: AdjacentMotion = _WHOLE,
    points: ProgramPoints | None = None,
) -> tuple[Certificate | None, Diagnostics]:
    """Play a program and compare it with the trajectory it was made from.

    Args:
        struts: the program, read back.
        program_name: names the program in diagnostics.
        trajectory: the programmed trajectory.
        machine: geometry and limits.
        motion: the plan, or the recovered motion; program and plan must have the same knots.
        tolerances: the requested tolerances.
        collisions: coverage of the checks against part, stock and fixtures.
        spin_deviation: (K + 1,) mm of a strut due to spin error, if the motion was reconstructed; by default that of
            the plan at its knots. A piece of a motion has none: its first segment does not show how it was rounded.
        adjacent: the motion before and after a piece of a motion, which need not be at rest there; none by default.
        points: of the program, if the struts have knots between them; all knots by default.
    """
    faults = structure_faults(struts, program_name, trajectory, machine, motion, adjacent.rests)
    if faults:
        return None, faults
    ruler = TrajectoryRuler(trajectory, tolerances)
    feeds = FeedRuler(trajectory, motion, (2 * machine.shortest_interval - 1) / 1000)
    off = _planned_spin(machine, motion, ruler, adjacent) if spin_deviation is None else spin_deviation

    def measured(struts: StrutMotion) -> Certificate:
        spline, knots = ToolSpline.of(machine, struts, motion)
        task = PlaybackTask(struts, machine, ruler, motion, knots, spline, feeds, off, adjacent, points)
        return _certificate(task, collisions)

    certificate = measured(struts)
    if points is not None:  # no decimals are printed at its knots, and no shorter interval would cut their intervals
        return certificate, tuple(row.diagnostic() for row in certificate.findings if not row.holds)
    return certificate, diagnose(certificate, struts, machine, motion, measured)


def _planned_spin(machine: Machine, motion: Motion, ruler: TrajectoryRuler, adjacent: AdjacentMotion) -> Array | float:
    """Deviation of the spin of a plan, mm of a strut: limits are proven for the programmed one."""
    trajectory, spin = ruler.trajectory, ruler.trajectory.start_spin
    if not all(adjacent.rests) or ((trajectory.spin == spin).all() and (motion.spin == spin).all()):
        return 0.0
    from pkm_post.certificate.played_path import planned_spin_deviation  # only a changing spin needs it

    return planned_spin_deviation(motion, trajectory, machine, ruler)


def _certificate(task: PlaybackTask, collisions: tuple[Coverage, ...]) -> Certificate:
    """Play a program and measure it."""
    struts, trajectory, played = task.struts, task.ruler.trajectory, play(task)
    return Certificate(
        findings=findings(task, played),
        duration=float(struts.time_ms[-1]) / 1000,
        intervals=len(struts) - 1,
        instants=played.instants + len(trajectory),
        time=struts.time_ms[:-1] / 1000,
        tip_deviation=played.tip,
        tip_tolerance=played.tip_tolerance,
        axis_deviation=played.axis,
        coverage=coverage(task.machine, trajectory, collisions),
        figures=figures(task),
    )
