# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beside the path: coverage of approach, tool changes and spindle start.

Enters: a machine and a trajectory. Leaves: rows of coverage. Statements of the machine file alone are not trusted: a
row is covered if the trajectory confirms it.
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry import norm
from pkm_post.model import Coverage, EventKind, Extent, Kind, Machine, Topic, Trajectory

_SAME = 1e-6
"""mm, and of unit axes: a tool change within this distance of the pose in the machine file counts as there."""
_UNPLANNED = "each strut moves by itself, on a way that is not planned"
_PLANNED_BY_HAND = f"{_UNPLANNED}; pmac approach and the panel plan one, loading the program by other means does not"
_Answer = tuple[str, str]
"""How a hazard is covered, or nothing; and the reason if it is not."""


def beside_the_path(machine: Machine, trajectory: Trajectory) -> tuple[Coverage, ...]:
    """Coverage of the approach to the first point, of moves to and from tool changes, and of spindle acceleration."""
    rows: tuple[tuple[str, _Answer], ...] = (
        ("way to the start of the program", ("", _to_the_start(machine))),
        ("approach from the start to the first point", (_from_the_start(trajectory), "")),
        ("tool change", _tool_change(machine, trajectory)),
        ("spindle speed at the first cut", _spindle(machine, trajectory)),
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


def _tool_change(machine: Machine, trajectory: Trajectory) -> _Answer:
    pose = machine.tool_change
    if pose is None:
        return "", "the machine file states no tool-change pose: tools change where the tip stands"
    rows = _rows(trajectory, EventKind.TOOL_CHANGE)
    off = np.hypot(norm(trajectory.nose_before(rows) - pose.nose), norm(trajectory.axis_at(rows) - pose.axis))
    if (off > _SAME).any():
        return "", "the trajectory changes tools elsewhere than at the tool-change pose of the machine file"
    nose = ", ".join(f"{value:g}" for value in pose.nose)
    return f"there and back by moves of the program, to the spindle nose at ({nose}) mm", ""


def _spindle(machine: Machine, trajectory: Trajectory) -> _Answer:
    if machine.spin_up_time is None:
        return "", "the machine file states no spindle.spin_up_time: the motion does not wait for the spindle"
    starts = [event.row for event in trajectory.events if event.kind is EventKind.SPINDLE and event.value]
    cuts = np.flatnonzero(trajectory.kind != Kind.RAPID)
    if len(cuts) and (not starts or min(starts) > cuts[0]):
        return "", "the program cuts before it starts the spindle"
    return f"dwells for a spindle that takes {machine.spin_up_time:g} s to its highest speed", ""


def _rows(trajectory: Trajectory, kind: EventKind) -> list[int]:
    return [event.row for event in trajectory.events if event.kind is kind]
