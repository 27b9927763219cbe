# SPDX-License-Identifier: LGPL-2.1-or-later
"""Coverage: the hazards that a certificate covers, and those it does not.

Input: a machine and a trajectory. Output: a row for each hazard. A body whose size the machine file does not state is
not checked, so the rows differ from machine to machine. For approach, tool changes and spindle start, statements of the
machine file alone are not trusted: a row is covered if the trajectory confirms it. ``CERTIFIED`` and
``CHECKED_ELSEWHERE`` name the check behind each limit that a machine file can state. docs/certificate.md has the same
table for users.
"""

from __future__ import annotations

import math

import numpy as np

from pkm_post.geometry import norm
from pkm_post.machine import NO_SETUP, has_strut_bodies
from pkm_post.model import (
    Coverage,
    Event,
    EventKind,
    Extent,
    Machine,
    Phrase,
    Topic,
    Trajectory,
    cuts_by_speed,
    tool_change_rows,
)

_SAME = 1e-6
"""mm, rad, and of unit axes: a tool change this close to the pose in the machine file is at that pose."""
_SHORT = 1e-6
"""s: a wait this much too short is one of rounding."""
_UNPLANNED = "each strut moves by itself, on a way that is not planned"
_PLANNED_BY_HAND = f"{_UNPLANNED}; pmac approach and the panel plan one, loading the program by other means does not"
_Answer = tuple[str, str]
"""Method that covers a hazard, or nothing; and the reason if it is not covered."""


def approach_and_tool_change_coverage(machine: Machine, trajectory: Trajectory) -> tuple[Coverage, ...]:
    """Coverage of the approach to the first point, of moves to and from tool changes, and of spindle acceleration."""
    rows: tuple[tuple[Phrase, _Answer], ...] = (
        (Phrase("way to the start of the program"), ("", _to_the_start(machine))),
        (Phrase("approach from the start to the first point"), (_from_the_start(trajectory), "")),
        (Phrase("tool change"), _tool_change_answer(machine, trajectory)),
        (Phrase("spindle speed at the first cut"), _spindle(machine, trajectory)),
    )
    return tuple(
        Coverage(Topic.AUXILIARY, subject, Extent.PROVEN if how else Extent.NOT_COVERED, how or why_not)
        for subject, (how, why_not) in rows
    )


def _to_the_start(machine: Machine) -> str:
    return _UNPLANNED if machine.controller.get("kind") == "power_pmac" else _PLANNED_BY_HAND


def _from_the_start(trajectory: Trajectory) -> str:
    start = ", ".join(f"{value:g}" for value in trajectory.start_tip)
    tool = trajectory.tools[int(trajectory.tool[0])]
    return f"a move of the program, from the tip of T{tool.number} of {tool.length:g} mm at ({start}) mm"


def _tool_change_answer(machine: Machine, trajectory: Trajectory) -> _Answer:
    pose = machine.tool_change
    if pose is None:
        return "", "the machine file states no tool-change pose: tools change where the tip stands"
    rows = tool_change_rows(trajectory.events)
    spin = np.append(trajectory.start_spin, trajectory.spin)[rows]
    off = norm(trajectory.nose_before(rows) - pose.nose), norm(trajectory.axis_at(rows) - pose.axis), spin - pose.spin
    if (np.abs(off) > _SAME).any():
        return "", "the trajectory changes tools elsewhere than at the tool-change pose of the machine file"
    nose = ", ".join(f"{value:g}" for value in pose.nose)
    return f"there and back by moves of the program, to the spindle nose at ({nose}) mm", ""


def _spindle(machine: Machine, trajectory: Trajectory) -> _Answer:
    if machine.spin_up_time is None:
        return "", "the machine file states no spindle.spin_up_time: the motion does not wait for the spindle"
    down = machine.spin_up_time if machine.spin_down_time is None else machine.spin_down_time
    spindle = _Spindle(machine.spin_up_time / machine.spindle_speed, down / machine.spindle_speed)
    cuts, done = np.flatnonzero(cuts_by_speed(trajectory.kind, trajectory.events)), 0
    for event in (*trajectory.events, Event(len(trajectory), EventKind.STOP, 0.0)):
        before = int(np.searchsorted(cuts, event.row))
        fault = spindle.cut_fault() if before > done else ""
        if fault:
            return "", f"the program cuts {fault}, at line {int(trajectory.line[cuts[done]])}"
        done = before
        spindle.apply(event)
    return f"dwells for a spindle that takes {machine.spin_up_time:g} s to its highest speed", ""


class _Spindle:
    """The speeds that the spindle may have from event to event, in revolutions per minute.

    They are a range, since a spindle that was not waited for may be anywhere between its old speed and the new one.
    Only dwells count as waits: a trajectory has no times.
    """

    def __init__(self, up: float, down: float) -> None:
        self._up, self._down = up, down  # s for each revolution per minute gained, and lost
        self._least = self._most = self._commanded = self._wait = 0.0
        self._stopped = "before it starts the spindle"

    def cut_fault(self) -> str:
        """Why a cut here may not have its spindle speed, or nothing."""
        if self._stopped:
            return self._stopped
        if self._commanded and self._wait > _SHORT:
            return f"up to {self._wait:.3f} s before the spindle has its speed"
        return ""

    def apply(self, event: Event) -> None:
        if event.kind is EventKind.SPINDLE:
            self._turn_at(event.value)
        elif event.kind is EventKind.DWELL:
            self._wait -= event.value
        elif event.kind is EventKind.TOOL_CHANGE:
            self._turn_at(0.0)
            self._stopped = self._stopped or "after a tool change that stops the spindle"
        elif event.kind is EventKind.SPINDLE_AXIS:  # the code waits for rest: the turns count from there
            self._least = self._most = self._commanded = self._wait = 0.0
            self._stopped = self._stopped or "after a thread that stops the spindle"

    def _turn_at(self, speed: float) -> None:
        if self._wait <= _SHORT:
            self._least = self._most = self._commanded
        self._least, self._most = min(self._least, self._commanded), max(self._most, self._commanded)
        self._wait = max(self._seconds(before, speed) for before in (self._least, self._most))
        self._commanded = speed
        if speed:
            self._stopped = ""

    def _seconds(self, before: float, after: float) -> float:
        """Time from one speed to another: down to rest or to the lower one, and up from there."""
        turn = min(abs(before), abs(after)) if before * after > 0.0 else 0.0
        return (abs(before) - turn) * self._down + (abs(after) - turn) * self._up


_PATH = (
    (Phrase("tool tip and axis"), "the program as written, played at every moment against the trajectory"),
    (Phrase("feed"), "the speed of the tip at every moment against the programmed feed"),
    (Phrase("events"), "their order and their place on the path"),
)
_LIMITS = (
    (Phrase("strut length, speed and acceleration"), "the program as written, at every moment"),
    (Phrase("tip acceleration and turning rate of the tool axis"), "the program as written, at every moment"),
    (Phrase("intervals between points"), "none is shorter than controller.shortest_interval"),
    (Phrase("joints and singular poses"), "the planned path with its rounded corners, between its points as well"),
)
_SETUP = (
    (Phrase("geometry of the machine"), "taken from the machine file"),
    (Phrase("work offset and gauge lengths"), "taken from the job"),
    (Phrase("meaning of the part program"), "reading, compensation and copies made the trajectory it is compared with"),
    (Phrase("controller set-up, codes and override"), "the set-up file states what the program relies on"),
    (Phrase("stiffness, heat and cutting forces"), "no model of them is computed"),
)


_JERK = "the mean acceleration from one interval to the next"
_NO_LIMIT = "the machine file states no {}"
_STEPS = "none is stated; the report has the largest"


def coverage(
    machine: Machine, trajectory: Trajectory, collisions: tuple[Coverage, ...] = NO_SETUP
) -> tuple[Coverage, ...]:
    """The hazards, ordered by topic.

    Args:
        machine: the statements of its file determine what was checked.
        trajectory: determines the coverage outside the path.
        collisions: rows of checks against part, stock and fixtures, which are not in the machine file.
    """
    return (
        *_rows(Topic.PATH, Extent.PROVEN, _PATH),
        *_rows(Topic.LIMITS, Extent.PROVEN, _LIMITS),
        *_jerks(machine),
        _block_rate(machine),
        *_collisions(machine),
        *collisions,
        *approach_and_tool_change_coverage(machine, trajectory),
        *_rows(Topic.SETUP, Extent.NOT_COVERED, _SETUP),
        _following_error(machine),
    )


def _rows(topic: Topic, extent: Extent, rows: tuple[tuple[Phrase, str], ...]) -> tuple[Coverage, ...]:
    return tuple(Coverage(topic, subject, extent, detail) for subject, detail in rows)


def _block_rate(machine: Machine) -> Coverage:
    blocks, entry = Phrase("blocks in a second"), "controller.block_rate"
    if math.isfinite(machine.block_rate):
        return Coverage(Topic.LIMITS, blocks, Extent.PROVEN, "every second of the program")
    return Coverage(Topic.LIMITS, blocks, Extent.NOT_COVERED, _NO_LIMIT.format(entry))


def _following_error(machine: Machine) -> Coverage:
    """Following errors are reported as a contour error at the knots, without a limit."""
    error, entry = Phrase("following error"), "struts.velocity_gain"
    if machine.velocity_gain is None:
        return Coverage(Topic.SETUP, error, Extent.NOT_COVERED, _NO_LIMIT.format(entry))
    return Coverage(Topic.SETUP, error, Extent.SAMPLED, "struts as first-order lags; a figure, no limit")


def _jerks(machine: Machine) -> tuple[Coverage, ...]:
    """Jerk is checked from one interval to the next if a limit is stated; steps at the knots have no limit."""
    limits = (
        (Phrase("strut jerk"), "struts.jerk", machine.strut_jerk),
        (Phrase("tip jerk"), "tool_path.tip_jerk", machine.tip_jerk),
    )
    known = tuple(
        Coverage(Topic.LIMITS, subject, Extent.SAMPLED, _JERK)
        if math.isfinite(limit)
        else Coverage(Topic.LIMITS, subject, Extent.NOT_COVERED, _NO_LIMIT.format(entry))
        for subject, entry, limit in limits
    )
    return (*known, Coverage(Topic.LIMITS, Phrase("steps of acceleration at knots"), Extent.NOT_COVERED, _STEPS))


def _collisions(machine: Machine) -> tuple[Coverage, ...]:
    """The bodies in the machine file are checked on the planned path."""
    struts, bodies, fixtures = has_strut_bodies(machine), bool(machine.bodies), bool(machine.fixtures)
    pairs = (
        (Phrase("strut and strut"), struts, "tubes or rods of the struts"),
        (Phrase("strut and platform"), struts and bodies, "tubes or rods of the struts and bodies of the platform"),
        (Phrase("strut and fixture"), struts and fixtures, "tubes or rods of the struts and fixtures"),
        (Phrase("spindle and fixture"), bodies and fixtures, "bodies of the platform and fixtures"),
    )
    return tuple(
        Coverage(Topic.COLLISIONS, subject, Extent.PROVEN, "the planned path, between its points as well")
        if stated
        else Coverage(Topic.COLLISIONS, subject, Extent.NOT_COVERED, f"the machine file does not state {needed}")
        for subject, stated, needed in pairs
    )


CERTIFIED = {
    "struts.stroke": ("shortest strut", "longest strut"),
    "struts.speed": ("strut speed",),
    "struts.acceleration": ("strut acceleration",),
    "struts.jerk": ("strut jerk",),
    "controller.shortest_interval": ("shortest interval",),
    "controller.block_rate": ("blocks in one second",),
    "tool_path.rapid_speed": ("tip speed",),
    "tool_path.feed_speed": ("tip speed",),
    "tool_path.tip_acceleration": ("tip acceleration",),
    "tool_path.tip_jerk": ("tip jerk",),
    "tool_path.axis_speed": ("turning rate of the tool axis",),
    "spindle.axis.lead_tolerance": ("depth of a thread off its turns",),
    "spindle.axis.speed": ("spindle speed in a thread",),
    "spindle.axis.acceleration": ("spindle acceleration in a thread",),
}
"""Findings of the certificate, by name: figures of the written program."""

_ON_THE_PLAN = "proven on the planned path, between its points as well, before the program is written"
_BEFORE_PLANNING = "a job that asks for what is outside is refused, or warned of, before anything is planned"
_WAITS = "dwells that wait for it are events of the job, which the program is compared with"
_READ_BACK = "the reader of the program refuses what does not keep it"
_NOT_PLANNED = "the way to the first point is not planned; no strut can be faster than all six together"

CHECKED_ELSEWHERE = {
    "joints.base_cone": _ON_THE_PLAN,
    "joints.platform_cone": _ON_THE_PLAN,
    "interference.clearance": _ON_THE_PLAN,
    "singularity.least_singular_value": _ON_THE_PLAN,
    "spindle.speed": _BEFORE_PLANNING,
    "spindle.least_speed": _BEFORE_PLANNING,
    "spindle.largest_tool_diameter": _BEFORE_PLANNING,
    "spindle.longest_tool": _BEFORE_PLANNING,
    "spindle.spin_up_time": _WAITS,
    "spindle.spin_down_time": _WAITS,
    "tool_change.safe_height": "the way to the pose of the tool change is placed to keep it",
    "controller.line_limit": _READ_BACK,
    "controller.memory_words": "a program that is too long is cut into parts, or refused, before it is written",
    "controller.approach_speed": _NOT_PLANNED,
}
"""Limits without a finding, and the checks that enforce them."""
