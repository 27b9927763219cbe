# SPDX-License-Identifier: LGPL-2.1-or-later
"""Approach check: check the approach to a row for collisions with part, stock and fixtures, where these are known.

The stock is what the earlier rows have left, so the approach is checked as the end of a trajectory with these rows.
From their end it continues above everything to the start of the approach, with a tool without a cutter, which neither
cuts nor touches anything.

Input: a program, an approach to one of its rows. Output: the collisions of the approach. Units: mm.
"""

from __future__ import annotations

import itertools
from dataclasses import replace
from typing import Any

import numpy as np

from pkm_post.control.link.errors import NotReadyError
from pkm_post.control.player.sections import rows_of
from pkm_post.control.player.stop_events import TOLERANCES, PlayContext
from pkm_post.geometry import Array, angle_between, norm
from pkm_post.machine import find_collisions, lengths_at
from pkm_post.model import APPROACH, TRAJECTORY_COLUMNS, Diagnostics, Kind, Mesh, Setup, Tool, Trajectory
from pkm_post.options import START_TOLERANCE_MM
from pkm_post.toolpath import ToolPose, clearance_path, highest_tip, pose_columns

_STRAIGHT_MM = 1e-6


def approach_faults(task: PlayContext, row: int, approach: Trajectory) -> Diagnostics:
    """Collisions of the approach to a row, errors and warnings; none if the set-up is unknown.

    Args:
        task: the program, with its set-up.
        row: row at which the approach ends.
        approach: straight moves, with the tool of the row.
    """
    if task.setup.is_empty:
        return ()
    # How much stock is left around the tool where it stands is not known, as after an abort: it may cut on its way up.
    solids, stock = replace(task.setup, stock=None), replace(task.setup, part=None, fixtures=())
    found = [
        find_collisions(_with_rows_before(task, row, approach, upwards), task.machine, setup, TOLERANCES).faults
        for setup, upwards in ((solids, Kind.RAPID), (stock, Kind.LINE))
        if not setup.is_empty
    ]
    return tuple(each for faults in found for each in faults if each.place.operation == APPROACH)


def check_start(task: PlayContext, first: Array, tool_length: float | None) -> None:
    """Check that the start of a trajectory matches the program in the controller.

    Args:
        task: the trajectory.
        first: (6,) strut lengths at the start of the program, mm.
        tool_length: gauge length of the tool in the spindle, mm; None for that of the trajectory.

    Raises:
        NotReadyError: the trajectory starts elsewhere, or with a tool of another length.
    """
    made = task.trajectory
    length = float(made.tool_length()[0])
    if tool_length not in (None, length):
        raise NotReadyError([f"the trajectory begins with a tool of {length:g} mm, not of {tool_length:g} mm"])
    off = float(np.abs(lengths_at(task.machine, ToolPose.at_start(made), length) - first).max())
    if off > START_TOLERANCE_MM:
        raise NotReadyError([f"the trajectory begins elsewhere than the program: a strut is {off:.3f} mm off there"])


def _with_rows_before(task: PlayContext, row: int, approach: Trajectory, upwards: Kind) -> Trajectory:
    """The rows before a row, and the approach to it, which cuts nothing, but perhaps where it begins upwards."""
    program = task.trajectory
    way, up = approach.tip[0] - approach.start_tip, approach.start_axis
    begins_upwards = way @ up > norm(way) - _STRAIGHT_MM
    kinds = np.where(begins_upwards & (np.arange(len(approach)) == 0), upwards, Kind.RAPID)
    start = ToolPose.at_start(approach)
    without = max(program.tools) + 1
    parts = [_moves(program, row, approach, kinds, len(program.operations))]
    if row:
        before = rows_of(program, 0, row)
        end = ToolPose(before.tip[-1], before.axis[-1], float(before.spin[-1]))
        route = (end, *clearance_path(end, start, _height(task, approach)))
        over = [pose for last, pose in itertools.pairwise(route) if not last.is_at(pose)]
        between = _moves(
            program, row, _through(approach, over), np.full(len(over), Kind.RAPID), len(program.operations) + 1
        )
        parts = [before, replace(between, tool=np.full(len(over), without)), *parts]
        start = ToolPose.at_start(before)
    columns: dict[str, Any] = {
        name: np.concatenate([getattr(part, name) for part in parts]) for name in TRAJECTORY_COLUMNS
    }
    joined = replace(
        program,
        **columns,
        events=(),
        operations=(*("" for _ in program.operations), APPROACH, ""),  # the program may have an approach
        tools=program.tools | {without: Tool(without, "none", 0.0, 0.0, program.tools[int(program.tool[row])].length)},
        start_tip=start.tip,
        start_axis=start.axis,
        start_spin=start.spin,
    )
    return replace(joined, **_extents(joined))


def _through(approach: Trajectory, poses: list[ToolPose]) -> Trajectory:
    """Moves to some poses; all other columns are those of the first row of an approach."""
    columns: dict[str, Any] = {
        name: np.repeat(getattr(approach, name)[:1], len(poses), axis=0) for name in TRAJECTORY_COLUMNS
    }
    tip, axis, spin = pose_columns(poses)
    columns |= {"tip": tip, "axis": axis, "spin": spin}
    return replace(approach, **columns)


def _moves(program: Trajectory, row: int, approach: Trajectory, kinds: Array, operation: int) -> Trajectory:
    """Moves with the tool and line of a row of the program, in a separate operation."""
    count = len(approach)
    return replace(
        approach,
        kind=kinds,
        tool=np.full(count, program.tool[row]),
        line=np.full(count, program.line[row]),
        operation=np.full(count, operation),
    )


def _extents(made: Trajectory) -> dict[str, Any]:
    """Length and angle of all straight moves; arcs keep theirs."""
    straight = made.kind != Kind.ARC
    length = np.where(straight, norm(made.tip - made.tip_before()), made.length)
    return {"length": length, "angle": np.where(straight, angle_between(made.axis_before(), made.axis), made.angle)}


def _height(task: PlayContext, approach: Trajectory) -> float:
    """Z in {M} above all known obstacles."""
    tops = [_top(mesh, task.trajectory) for mesh in _meshes(task.setup)]
    return max(float(approach.tip[:, 2].max()), highest_tip(task.trajectory), *tops)


def _meshes(setup: Setup) -> list[Mesh]:
    return [mesh for mesh in (setup.part, setup.stock, *setup.fixtures) if mesh is not None]


def _top(mesh: Mesh, trajectory: Trajectory) -> float:
    points = (
        mesh.triangles.reshape(-1, 3) @ trajectory.machine_from_work[:3, :3].T + trajectory.machine_from_work[:3, 3]
    )
    return float(points[:, 2].max())
