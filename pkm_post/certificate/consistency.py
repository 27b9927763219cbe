# SPDX-License-Identifier: LGPL-2.1-or-later
"""Consistency: preconditions for comparing a program with its plan, trajectory and machine.

Input: a strut motion as read back, the plan it was made from, a trajectory as read from its file, and the machine it
names. Output: diagnostics, each with the first difference, as found and as planned; and the values of a trajectory that
no posting for its machine can produce. Such a file was modified and is not planned, since its path or duration may be
unbounded. Times: whole ms, as in the program.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from itertools import zip_longest
from typing import TypeVar

import numpy as np

from pkm_post.geometry import norm
from pkm_post.model import (
    Diagnostic,
    Diagnostics,
    Event,
    EventKind,
    Kind,
    Machine,
    Motion,
    Place,
    StrutMotion,
    Trajectory,
    as_executed,
    threads,
)

_Thing = TypeVar("_Thing")
_FARTHEST = 10
"""Distance from the middle of the base in longest struts, as in placement."""
_ROUNDING = 1e-9
"""Relative rounding error of limits converted from other units."""
_SAME = 1e-9
"""mm, rad, and of unit axes."""


def structure_faults(
    struts: StrutMotion,
    program_name: str,
    trajectory: Trajectory,
    machine: Machine,
    motion: Motion,
    rests: tuple[bool, bool],
) -> Diagnostics:
    """Diagnostics that prevent a comparison: another machine, other knots, other events, or motion at the ends.

    Args:
        struts: the program, read back.
        program_name: names the program in diagnostics.
        trajectory: the programmed trajectory.
        machine: the machine to check the program on.
        motion: the plan; its times of the joints are used, its events are not.
        rests: whether the program is at rest at its start and end.
    """
    another, found = machine_fault(trajectory, machine, program_name), []
    if not np.array_equal(struts.time_ms, motion.time_ms):
        times = struts.time_ms.tolist(), motion.time_ms.tolist()
        found.append(("V110", _first_difference("knot", *times, "{} ms".format)))
    else:
        found += _faults_at_rests(struts, trajectory, motion)
    for which, speed, rest in zip(("first", "last"), struts.speed[[0, -1]], rests, strict=True):
        if rest and speed.any():
            found.append(("V105", f"{which} speeds {speed.tolist()} mm/s"))
    diagnostics = (Diagnostic(code, Place(program_name), text) for code, text in found)
    return (another, *diagnostics) if another else tuple(diagnostics)


def _faults_at_rests(struts: StrutMotion, trajectory: Trajectory, motion: Motion) -> Iterator[tuple[str, str]]:
    """Exact stops at which the program moves, rests elsewhere, and other events than those of the trajectory."""
    passed = np.rint(1000 * np.append(0.0, motion.joint_time)).astype(np.int64)
    knots = np.searchsorted(struts.time_ms[:-1], passed)
    stops = np.flatnonzero(trajectory.exact_stop[:-1]) + 1
    moves = stops[(struts.time_ms[knots[stops]] != passed[stops]) | struts.speed[knots[stops]].any(axis=1)]
    if len(moves):
        yield "V110", f"no rest at {passed[moves[0]]} ms, at the end of line {trajectory.line[moves[0] - 1]}"
    goes_on = np.asarray(struts.speed.any(axis=1))
    goes_on[[0, *knots[stops], -1]] = True
    still = np.flatnonzero(~goes_on)
    if len(still):
        yield "V118", f"all speeds are 0 at {struts.time_ms[still[0]]} ms, where the motion goes on"
    planned = tuple(replace(event, row=int(knots[event.row])) for event in as_executed(trajectory.events))
    if struts.events != planned:
        yield "V109", event_fault(struts.events, planned)


def machine_fault(trajectory: Trajectory, machine: Machine, name: str) -> Diagnostic | None:
    """T104 for a trajectory of another machine.

    Args:
        trajectory: the programmed trajectory.
        machine: the machine to run it on.
        name: names the program in the diagnostic.
    """
    if trajectory.machine_fingerprint == machine.fingerprint:
        return None
    return Diagnostic("T104", Place(name), f"made for {trajectory.machine}, checked on {machine.name}")


def event_fault(found: Sequence[Event], planned: Sequence[Event]) -> str:
    """The first event that differs, as text."""
    return _first_difference("event", found, planned, _event)


def _first_difference(
    what: str, found: Sequence[_Thing], planned: Sequence[_Thing], text_of: Callable[[_Thing], str]
) -> str:
    """The first difference of two sequences, with its index from 0, and their lengths."""
    pairs = enumerate(zip_longest(found, planned))
    number, pair = next((number, pair) for number, pair in pairs if pair[0] != pair[1])
    here, there = ("none" if thing is None else text_of(thing) for thing in pair)
    return f"{what} {number}: {here}, planned {there}; {len(found)} found, {len(planned)} planned"


def _event(event: Event) -> str:
    return f"{event.kind.name.lower().replace('_', ' ')} {event.value} at knot {event.row}"


def values_beyond_machine(trajectory: Trajectory, machine: Machine) -> Iterator[tuple[Place, str]]:
    """Each quantity beyond the machine, with its first place.

    Args:
        trajectory: at least one segment with any values that a trajectory file may have.
        machine: the machine it was made for.
    """
    yield from _of_segments(trajectory, machine)
    yield from _of_start(trajectory, machine)
    yield from _of_spindle(trajectory, machine)
    yield from _of_threads(trajectory, machine)


def _of_segments(trajectory: Trajectory, machine: Machine) -> Iterator[tuple[Place, str]]:
    most = np.where(trajectory.kind == Kind.RAPID, machine.rapid_speed, machine.feed_speed)
    away = norm(trajectory.tip - machine.base_joints.mean(axis=0))
    for wrong, values, words in (
        (away > _FARTHEST * machine.strut_stroke[1], away, "the tip is {:.6g} mm from the middle of the base"),
        (trajectory.feed > most * (1 + _ROUNDING), trajectory.feed, "the feed is {:.6g} mm/s, the machine allows less"),
    ):
        rows = np.flatnonzero(wrong)
        if len(rows):
            yield trajectory.place(int(rows[0])), words.format(values[rows[0]])


def _of_start(trajectory: Trajectory, machine: Machine) -> Iterator[tuple[Place, str]]:
    # a program from a line on may start with another tool: the platform is at home, the tip higher or lower
    longer = np.array([tool.length for tool in trajectory.tools.values()]) - trajectory.tool_length()[0]
    homes = machine.home_tip + longer[:, None] * machine.home_axis
    off_tip = np.abs(homes - trajectory.start_tip).max(axis=1).min()
    off_axis = np.abs(trajectory.start_axis - machine.home_axis).max()
    if max(off_tip, off_axis, abs(trajectory.start_spin - machine.home_spin)) > _SAME:
        yield Place(trajectory.source), "the start pose is not the home of the machine"


def _of_spindle(trajectory: Trajectory, machine: Machine) -> Iterator[tuple[Place, str]]:
    for event in trajectory.events:
        speed = abs(event.value)
        allowed = machine.spindle_least_speed <= speed <= machine.spindle_speed
        if event.kind is EventKind.SPINDLE and speed and not allowed:
            yield trajectory.place(min(event.row, len(trajectory) - 1)), f"the spindle turns at {speed:g} rpm"
            return


def _of_threads(trajectory: Trajectory, machine: Machine) -> Iterator[tuple[Place, str]]:
    axis = machine.spindle_axis
    for thread in threads(trajectory.events):
        fastest = trajectory.feed[thread.first : thread.end].max() / abs(thread.lead)
        if axis is None or fastest > axis.speed * (1 + _ROUNDING):
            place = trajectory.place(thread.first)
            yield place, "a thread, and the spindle is no axis" if axis is None else f"{60 * fastest:g} rpm in a thread"
            return
