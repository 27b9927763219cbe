# SPDX-License-Identifier: LGPL-2.1-or-later
"""Manual moves: jogs and approaches as trajectories from the current pose.

A Cartesian jog is one straight segment: the tip moves along a line, the tool axis along a great circle, the spin
linearly. A jog of one strut moves all six degrees of freedom: forward kinematics gives its poses while one strut length
grows. Units: mm, rad, mm/s; directions are those of {M}.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from pkm_post.geometry import Array, angle_between, norm
from pkm_post.machine import forward_along_path, lengths_at
from pkm_post.model import Amount, Diagnostic, Diagnostics, Event, Kind, Machine, Phrase, Place, Tool, Trajectory
from pkm_post.toolpath import MOST_TILT, ToolPose, clearance_path, largest_tilts, pose_columns, rotation

_JOG = "jog"
_STEP_MM = 0.5
"""Step of a single-strut jog between poses: straight segments deviate from its path by less than a micron."""
_SMALLEST_MOVE = 1e-9
_MEASURABLE = 1e-6
"""mm: an M code alone would give the plan an empty path, so the tip rises by this, a hundredth of an encoder count."""


@dataclass(frozen=True)
class CartesianJog:
    """A jog of the tool.

    Attributes:
        shift: (3,) displacement of the tip in {M}, mm.
        tilt: (2,) rotation of the tool axis about X, then about Y of {M}, with the tip fixed, rad.
        spin: rotation of the platform about the tool axis, rad.
    """

    shift: tuple[float, float, float] = (0.0, 0.0, 0.0)
    tilt: tuple[float, float] = (0.0, 0.0)
    spin: float = 0.0


@dataclass(frozen=True)
class StrutJog:
    """A jog of one strut; the other five keep their lengths.

    Attributes:
        strut: from 1 to 6.
        by: change of its length, mm.
    """

    strut: int
    by: float

    def __post_init__(self) -> None:
        if self.strut not in range(1, 7):
            raise ValueError(f"strut: expected 1 to 6, got {self.strut}")


Jog = CartesianJog | StrutJog


def jog_trajectory(
    jog: Jog, machine: Machine, pose: ToolPose, tool_length: float, feed: float
) -> tuple[Trajectory | None, Diagnostics]:
    """The trajectory of a jog, or the reasons against it.

    Args:
        tool_length: gauge length of the tool in the spindle, mm.
        feed: of the tip, mm/s; for a turn in place, degrees per second, as in programs.

    Raises:
        ValueError: a number is not finite, or the feed is not positive.
    """
    if not (np.isfinite(feed) and feed > 0):
        raise ValueError(f"feed: expected a number above zero, got {feed}")
    if isinstance(jog, StrutJog):
        poses = _of_strut(jog, machine, pose, tool_length)
        if poses is None:
            return None, (
                Diagnostic("C202", Place(_JOG), Phrase("strut {} by {}", jog.strut, Amount(jog.by, "mm", "g"))),
            )
    else:
        poses = _of_tool(jog, pose)
    return _through(machine, pose, poses, tool_length, min(feed, machine.feed_speed))


def approach_trajectory(
    machine: Machine, pose: ToolPose, start: ToolPose, tool_length: float, feed: float, free: float = -math.inf
) -> tuple[Trajectory | None, Diagnostics]:
    """The safe approach to the start of a program: up along the tool axis, across, down along the axis of the start.

    It crosses at the highest of the start, the machine file's safe height, and ``free``.

    Args:
        start: target pose.
        tool_length: gauge length of the tool in the spindle, mm.
        feed: of the tip, mm/s; for a turn in place, degrees per second.
        free: z in {M} above which there are no obstacles, mm; unknown by default.
    """
    height = max(float(start.tip[2]), free)
    if machine.tool_change is not None:
        height = max(height, machine.tool_change.safe_height)
    if not (pose.rises_to(height) and start.rises_to(height)):
        return None, (Diagnostic("K142", Place("approach"), f"to z {height:.3f} mm"),)
    route = [pose, *clearance_path(pose, start, height)]
    moved = [each for before, each in itertools.pairwise(route) if not before.is_at(each)]
    if not moved:
        return None, (Diagnostic("C201", Place("approach"), "the tool is at the start of the program"),)
    trajectory, diagnostics = _through(machine, pose, pose_columns(moved), tool_length, min(feed, machine.feed_speed))
    return None if trajectory is None else replace(trajectory, source="approach"), diagnostics


def straight_trajectory(
    machine: Machine, pose: ToolPose, end: ToolPose, tool_length: float, feed: float
) -> tuple[Trajectory | None, Diagnostics]:
    """One straight move; arguments as for ``approach_trajectory``."""
    return _through(machine, pose, pose_columns([end]), tool_length, min(feed, machine.feed_speed))


def stationary_trajectory(
    machine: Machine, pose: ToolPose, tool_length: float, events: tuple[Event, ...]
) -> Trajectory:
    """Events at standstill, with the minimal path for planning.

    Args:
        tool_length: gauge length of the tool in the spindle, mm.
        events: each at row 0.
    """
    tip = (pose.tip + _MEASURABLE * pose.axis)[None]
    poses = tip, pose.axis[None], np.array([pose.spin])
    trajectory, diagnostics = _through(machine, pose, poses, tool_length, machine.feed_speed)
    if trajectory is None:
        raise ValueError(f"pose: expected that of the tool, got {pose}: {diagnostics}")
    return replace(trajectory, events=events)


def _of_tool(jog: CartesianJog, pose: ToolPose) -> tuple[Array, Array, Array]:
    values = np.array([*jog.shift, *jog.tilt, jog.spin])
    if not np.isfinite(values).all():
        raise ValueError(f"jog: expected finite numbers, got {values.tolist()}")
    about_x, about_y = (rotation(np.zeros(3), axis, angle) for axis, angle in zip(np.eye(3)[:2], jog.tilt, strict=True))
    axis = (about_y @ about_x)[:3, :3] @ pose.axis
    return (pose.tip + values[:3])[None], (axis / norm(axis))[None], np.array([pose.spin + jog.spin])


def _of_strut(jog: StrutJog, machine: Machine, pose: ToolPose, tool_length: float) -> tuple[Array, Array, Array] | None:
    if not np.isfinite(jog.by):
        raise ValueError(f"by: expected a finite number, got {jog.by}")
    steps = max(1, int(np.ceil(abs(jog.by) / _STEP_MM)))
    lengths = np.tile(lengths_at(machine, pose, tool_length), (steps, 1))
    lengths[:, jog.strut - 1] += jog.by * np.arange(1, steps + 1) / steps
    found = forward_along_path(machine, lengths, np.full(steps, tool_length), pose)
    return (found.tip, found.axis, found.spin) if found.converged.all() else None


def _through(
    machine: Machine, pose: ToolPose, poses: tuple[Array, Array, Array], tool_length: float, feed: float
) -> tuple[Trajectory | None, Diagnostics]:
    """Straight segments from the current pose through poses, to rest."""
    tip, axis, spin = poses
    length = norm(np.diff(tip, axis=0, prepend=pose.tip[None]))
    axis_before = np.vstack([pose.axis, axis[:-1]])
    angle, turned = angle_between(axis_before, axis), np.abs(np.diff(spin, prepend=pose.spin))
    if (np.maximum(length, np.maximum(angle, turned)) < _SMALLEST_MOVE).any():
        return None, (Diagnostic("C201", Place(_JOG), Phrase("the jog leads to where the tool is")),)
    if (tilt := largest_tilts(axis_before, axis).max()) > MOST_TILT:
        return None, (Diagnostic("K159", Place(_JOG), Phrase("{} degrees from upright", f"{np.degrees(tilt):.3f}")),)
    trajectory = Trajectory(
        **_straight(len(tip), feed),
        tip=tip,
        axis=axis,
        spin=spin,
        length=length,
        angle=angle,
        start_tip=pose.tip,
        start_axis=pose.axis,
        start_spin=pose.spin,
        events=(),
        operations=("",),
        tools={0: Tool(0, "in the spindle", 0.0, 0.0, tool_length)},
        machine_from_work=np.eye(4),
        machine=machine.name,
        machine_fingerprint=machine.fingerprint,
        source=_JOG,
    )
    return trajectory, ()


def _straight(count: int, feed: float) -> dict[str, Any]:
    """The columns common to all straight segments; only the last one ends at rest."""
    nowhere, zero = np.full((count, 3), np.nan), np.zeros(count)
    return {
        "kind": np.full(count, Kind.LINE),
        "feed": np.full(count, feed),
        "arc_centre": nowhere,
        "arc_axis": nowhere,
        "sweep": zero,
        "smooth": zero,
        "exact_stop": np.arange(count) == count - 1,
        "tool": zero,
        "operation": zero,
        "line": zero,
    }
