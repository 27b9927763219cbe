# SPDX-License-Identifier: LGPL-2.1-or-later
"""Start line: begin a trajectory at a line of its source, after an abort or a loss of power.

The modal state before the line is restored: spindle, coolant and tool. The approach goes up along the tool axis, across
above everything that the program reaches, and down along the axis of the start; it is planned, certified and checked
for reach like any manual move, and for collisions with part, stock and fixtures where these are known. Spindle and
coolant are switched on above the start, before the last move down.

Input: a trajectory, a line, a machine anywhere with the tool of that line in its spindle. Output: the row, and a
machine at its start.
"""

from __future__ import annotations

import logging
from dataclasses import replace

import numpy as np

from pkm_post.control.link.errors import NotReadyError
from pkm_post.control.link.tool_pose import UNKNOWN_POSE
from pkm_post.control.numerical_control.manual_moves import approach_trajectory
from pkm_post.control.numerical_control.plan import MovePlan, planned
from pkm_post.control.player.approach_check import approach_faults
from pkm_post.control.player.stop_events import TOLERANCES, PlayContext, pose_before, run_events
from pkm_post.model import Event, Refused, Trajectory, errors, required
from pkm_post.options import APPROACH_MM_S
from pkm_post.toolpath import highest_tip, modal_events

_log = logging.getLogger(__name__)

_THERE = "C201"
"""The tool is already at the end of the approach."""


def go_to_row(task: PlayContext, row: int, repeat_codes: bool = False) -> None:
    """Move the tool to the start of a row, with its modal state.

    Args:
        task: the program and the machine.
        row: the row to start at.
        repeat_codes: whether to repeat machine-specific M codes.

    Raises:
        NotReadyError: the pose of the tool is unknown, or the machine is not ready.
        Refused: the approach is not certified.
        PmacError: as ``PlayContext.drive``.
    """
    events = modal_events(task.trajectory, row, task.machine, repeat_codes)
    plan = approach_to_row(task, row, events)
    if plan is None:
        if events:
            run_events(task, row, events)
        return
    task.drive(plan, "the approach")


def approach_to_row(task: PlayContext, row: int, events: tuple[Event, ...]) -> MovePlan | None:
    """The approach to the start of a row, with events above it; None if the tool is there.

    Raises:
        NotReadyError, Refused: as ``go_to_row``.
    """
    machine, settings = task.machine, task.settings
    start, length = pose_before(task.trajectory, row)
    here = task.pose(length)
    if here is None:
        raise NotReadyError([UNKNOWN_POSE])
    free = highest_tip(task.trajectory)
    approach, diagnostics = approach_trajectory(machine, here, start, length, APPROACH_MM_S, free)
    if approach is None:
        if [each.code for each in diagnostics] == [_THERE]:
            return None
        raise Refused(diagnostics)
    touched = approach_faults(task, row, approach)
    for each in touched:
        _log.warning("%s", each)
    if errors(touched):
        raise Refused(errors(touched))
    plan = required(*planned(_with_events(approach, events), machine, settings, TOLERANCES))
    return plan


def _with_events(approach: Trajectory, events: tuple[Event, ...]) -> Trajectory:
    """The approach with events before its last move, the move down."""
    last = len(approach) - 1
    stops = approach.exact_stop | (np.arange(len(approach)) >= last - 1)
    return replace(approach, exact_stop=stops, events=tuple(Event(last, each.kind, each.value) for each in events))
