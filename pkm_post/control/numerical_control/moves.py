# SPDX-License-Identifier: LGPL-2.1-or-later
"""Moves: manual jogs as trajectories from the current pose.

A Cartesian jog is one straight segment: the tip moves along a line, the tool axis along a great circle, the spin
linearly. A jog of one strut moves all six degrees of freedom: forward kinematics gives its poses while one strut length
grows. Units: mm, rad, mm/s; directions are those of {M}.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from pkm_post.control.link.readout import Pose, spin_of
from pkm_post.geometry import Array, angle_between, norm
from pkm_post.machine import follow, platform_rotation, strut_lengths
from pkm_post.model import Diagnostic, Event, Kind, Machine, Place, Tool, Trajectory
from pkm_post.toolpath import ToolPose, columns, safe_way

SOURCE = "jog"
_STEP_MM = 0.5
"""Step of a single-strut jog between poses: straight segments deviate from its path by less than a micron."""
_NO_MOVE = 1e-9
_MEASURABLE = 1e-6
"""mm: a machine code alone would give the plan an empty path, so the tip rises by this much, a hundredth of an encoder
count."""


@dataclass(frozen=True)
class Cartesian:
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
class OneStrut:
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


Jog = Cartesian | OneStrut


def trajectory_of(
    jog: Jog, machine: Machine, here: Pose, tool_length: float, feed: float
) -> tuple[Trajectory | None, tuple[Diagnostic, ...]]:
    """The trajectory of a jog, or why there is none.

    Args:
        jog: the move requested.
        machine: its geometry and highest feed.
        here: current pose of the tool.
        tool_length: gauge length of the tool in the spindle, mm.
        feed: of the tip, mm/s; while the tip stands, degrees per second, as in programs.

    Raises:
        ValueError: a number is not finite, or the feed is not positive.
    """
    if not (np.isfinite(feed) and feed > 0):
        raise ValueError(f"feed: expected a number above zero, got {feed}")
    if isinstance(jog, OneStrut):
        poses = _of_strut(jog, machine, here, tool_length)
        if poses is None:
            return None, (Diagnostic("C202", Place(SOURCE), f"strut {jog.strut} by {jog.by:g} mm"),)
    else:
        poses = _of_tool(jog, here)
    return _through(machine, here, poses, tool_length, min(feed, machine.feed_speed))


def approach(
    machine: Machine, here: Pose, start: Pose, tool_length: float, feed: float
) -> tuple[Trajectory | None, tuple[Diagnostic, ...]]:
    """The safe approach to the start of a program: up along the tool axis, across, down along the axis of the start.

    It crosses at the height of the start, or at the machine file's safe height if that is higher.

    Args:
        machine: its geometry, safe height and highest feed.
        here: current pose of the tool.
        start: target pose.
        tool_length: gauge length of the tool in the spindle, mm.
        feed: of the tip, mm/s; while the tip stands, degrees per second.
    """
    height = float(start.tip[2])
    if machine.tool_change is not None:
        height = max(height, machine.tool_change.safe_height)
    begin, end = (ToolPose(pose.tip, pose.axis, pose.spin) for pose in (here, start))
    if not (begin.rises_to(height) and end.rises_to(height)):
        return None, (Diagnostic("K142", Place("approach"), f"to z {height:.3f} mm"),)
    way = [begin, *safe_way(begin, end, height)]
    moved = [pose for before, pose in itertools.pairwise(way) if not before.is_at(pose)]
    if not moved:
        return None, (Diagnostic("C201", Place("approach"), "the tool is at the start of the program"),)
    trajectory, told = _through(machine, here, columns(moved), tool_length, min(feed, machine.feed_speed))
    return None if trajectory is None else replace(trajectory, source="approach"), told


def standing(machine: Machine, here: Pose, tool_length: float, events: tuple[Event, ...]) -> Trajectory:
    """Events at standstill, with the minimal path that planning needs.

    Args:
        machine: its geometry and highest feed.
        here: current pose of the tool.
        tool_length: gauge length of the tool in the spindle, mm.
        events: each at row 0.
    """
    tip = (here.tip + _MEASURABLE * here.axis)[None]
    poses = tip, here.axis[None], np.array([here.spin])
    trajectory, told = _through(machine, here, poses, tool_length, machine.feed_speed)
    if trajectory is None:
        raise ValueError(f"here: expected a pose, got {here}: {told}")
    return replace(trajectory, events=events)


def _of_tool(jog: Cartesian, here: Pose) -> tuple[Array, Array, Array]:
    values = np.array([*jog.shift, *jog.tilt, jog.spin])
    if not np.isfinite(values).all():
        raise ValueError(f"jog: expected finite numbers, got {values.tolist()}")
    axis = _about(1, jog.tilt[1]) @ _about(0, jog.tilt[0]) @ here.axis
    return (here.tip + values[:3])[None], (axis / norm(axis))[None], np.array([here.spin + jog.spin])


def _about(coordinate: int, angle: float) -> Array:
    """Rotation matrix about X (0) or Y (1), (3, 3)."""
    turn = np.eye(3)
    first, second = ((1, 2), (2, 0))[coordinate]
    turn[first, first] = turn[second, second] = np.cos(angle)
    turn[second, first], turn[first, second] = np.sin(angle), -np.sin(angle)
    return turn


def _of_strut(jog: OneStrut, machine: Machine, here: Pose, tool_length: float) -> tuple[Array, Array, Array] | None:
    if not np.isfinite(jog.by):
        raise ValueError(f"by: expected a finite number, got {jog.by}")
    steps = max(1, int(np.ceil(abs(jog.by) / _STEP_MM)))
    tool = np.full(steps, tool_length)
    lengths = np.repeat(_lengths(machine, here, tool_length), steps, axis=0)
    lengths[:, jog.strut - 1] += jog.by * np.arange(1, steps + 1) / steps
    rotation = platform_rotation(here.axis[None], np.array([here.spin]))[0]
    found = follow(machine, lengths, tool, here.tip, rotation)
    return (found.tip, found.axis, spin_of(found.rotation)) if found.converged.all() else None


def _lengths(machine: Machine, here: Pose, tool_length: float) -> Array:
    """(1, 6) strut lengths of a pose, mm."""
    return strut_lengths(machine, here.tip[None], here.axis[None], np.array([here.spin]), np.array([tool_length]))


def _through(
    machine: Machine, here: Pose, poses: tuple[Array, Array, Array], tool_length: float, feed: float
) -> tuple[Trajectory | None, tuple[Diagnostic, ...]]:
    """Straight segments from the current pose through poses, to rest."""
    tip, axis, spin = poses
    length = norm(np.diff(tip, axis=0, prepend=here.tip[None]))
    axis_before = np.vstack([here.axis, axis[:-1]])
    angle, turned = angle_between(axis_before, axis), np.abs(np.diff(spin, prepend=here.spin))
    if (np.maximum(length, np.maximum(angle, turned)) < _NO_MOVE).any():
        return None, (Diagnostic("C201", Place(SOURCE), "the jog leads to where the tool is"),)
    trajectory = Trajectory(
        **_straight(len(tip), feed),
        tip=tip,
        axis=axis,
        spin=spin,
        length=length,
        angle=angle,
        start_tip=here.tip,
        start_axis=here.axis,
        start_spin=here.spin,
        events=(),
        operations=("",),
        tools={0: Tool(0, "in the spindle", 0.0, 0.0, tool_length)},
        machine_from_work=np.eye(4),
        machine=machine.name,
        machine_fingerprint=machine.fingerprint,
        source=SOURCE,
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
