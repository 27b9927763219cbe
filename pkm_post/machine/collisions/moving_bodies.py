# SPDX-License-Identifier: LGPL-2.1-or-later
"""Moving bodies that may collide: bodies of the platform, struts, shank and cutter of a tool.

Each is a set of cylinders at any pose, with a bound of the motion of any point in each cell of the path. Solids of
revolution about the tool axis are independent of the spin. Units: mm, rad.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial

import numpy as np

from pkm_post.geometry import Array, Cylinders
from pkm_post.machine.kinematics.inverse import ToolPoses, lever_arms
from pkm_post.machine.kinematics.placed_machine import PlacedMachine, body_reach, rod_speed_ratio, strut_cylinders
from pkm_post.machine.reach.limit_checks import shortest_distance
from pkm_post.machine.reach.pose_path import PosePath
from pkm_post.model import Body, Machine, Phrase, Shank, Tool
from pkm_post.toolpath import Cutter


@dataclass(frozen=True)
class ToolCylinder:
    """A cylinder about the tool axis, offset by a rounding radius.

    Attributes:
        start: height of its lower end above the tip, before the offset.
        end: height of its upper end above the tip, before the offset.
        radius: radius before the offset; 0 makes it a line.
        rounding: offset on all sides.
    """

    start: float
    end: float
    radius: float
    rounding: float = 0.0


@dataclass(frozen=True)
class MovingBody:
    """A moving body.

    Attributes:
        name: its name in messages.
        cells: (K,) the cells of the path in which it is checked, ascending.
        change: (N,) upper bound of the motion of any of its points in each cell of the path.
        reach: upper bound of the distance from the tip of any point that turns with the platform, mm.
        rounding: (P,) offset of each of its P cylinders.
        cylinders: P cylinders for each of M poses, pose by pose.
        is_about_axis: whether the tool axis is the axis of all cylinders.
    """

    name: str
    cells: Array
    change: Array
    reach: float
    rounding: Array
    cylinders: Callable[[ToolPoses], Cylinders]
    is_about_axis: bool = True


def platform_body(machine: Machine, path: PosePath, body: Body) -> MovingBody:
    """A body of the platform, along the whole path."""
    offset = machine.spindle_nose + body.start, machine.spindle_nose + body.end
    reach = body_reach(machine, path.tool_length, body)
    return MovingBody(
        body.name,
        np.arange(1, len(path)),
        _about_the_axis(path, reach),
        reach,
        np.zeros(1),
        partial(_platform_cylinder, *offset, body.radius),
    )


def tool_body(name: str, path: PosePath, cells: Array, pieces: Iterable[ToolCylinder]) -> MovingBody:
    """A part of a tool, in the cells where it is in use."""
    start, end, radius, rounding = np.array([[p.start, p.end, p.radius, p.rounding] for p in pieces]).T
    reach = float((np.hypot(np.maximum(np.abs(start), np.abs(end)), radius) + rounding).max())
    return MovingBody(
        name, cells, _about_the_axis(path, reach), reach, rounding, partial(_tool_cylinders, start, end, radius)
    )


def strut_bodies(machine: Machine, path: PosePath) -> MovingBody | None:
    """The six struts; None if the joints of a strut coincide somewhere, which another check reports."""
    shortest = shortest_distance(machine, path)
    if not shortest > 0:
        return None
    lever, arm = rod_speed_ratio(machine, shortest), float(lever_arms(machine, path.tool_length).max())
    pieces = len(list(strut_cylinders(PlacedMachine.of(machine, path.rows(slice(0, 1))))))
    change = lever * (path.travel + arm * path.turn())
    cells, rounding = np.arange(1, len(path)), np.zeros(6 * pieces)
    return MovingBody(Phrase("strut"), cells, change, lever * arm, rounding, partial(_struts, machine), False)


def _about_the_axis(path: PosePath, reach: float) -> Array:
    """Bound of the motion of points that move with the tip and turn about it; the spin moves no solid of revolution."""
    return path.travel + path.angle * reach


def _platform_cylinder(start: float, end: float, radius: float, pose: ToolPoses) -> Cylinders:
    tip, axis, _, tool_length = pose
    middle = tip + ((start + end) / 2 + tool_length)[:, None] * axis
    return Cylinders(middle, axis, np.full(len(tip), (end - start) / 2), np.full(len(tip), radius))


def _tool_cylinders(start: Array, end: Array, radius: Array, pose: ToolPoses) -> Cylinders:
    tip, axis, _, _ = pose
    middle = tip[:, None] + ((start + end) / 2)[:, None] * axis[:, None]
    repeated = np.repeat(axis, len(start), axis=0)
    return Cylinders(middle.reshape(-1, 3), repeated, *(np.tile(one, len(tip)) for one in ((end - start) / 2, radius)))


def _struts(machine: Machine, pose: ToolPoses) -> Cylinders:
    """All pieces of all struts, pose by pose."""
    pieces = list(strut_cylinders(PlacedMachine.of(machine, pose)))
    count = len(pose[0])

    def by_pose(columns: list[Array]) -> Array:
        shape = columns[0].shape[1:]
        stacked = np.concatenate([column.reshape(count, 6, *shape) for column in columns], axis=1)
        return stacked.reshape(-1, *shape)

    return Cylinders(
        *(by_pose([getattr(one, name) for one in pieces]) for name in ("middle", "axis", "half", "radius"))
    )


_ARC_CHORDS = 24
_STEP = 0.1
"""mm by which cylinders may be off a slanted outline."""
_LEVEL = 1e-9
"""mm: lines that rise by less are level."""


@dataclass(frozen=True)
class RevolvedProfile:
    """Radii of a solid of revolution about the tool axis, by height above the tip.

    Attributes:
        height: (K,) heights, ascending.
        radius: (K,) radii, linear between heights.
    """

    height: Array
    radius: Array

    @property
    def farthest(self) -> float:
        """The largest distance of any of its points from the tip, mm."""
        return float(np.hypot(self.height, self.radius).max())

    def contains(self, high: Array, out: Array, more: float = 0.0) -> Array:
        """Whether points at heights and distances from the axis, (N,), are inside the profile offset by ``more``.

        An outward offset may include slightly more than this distance, never less; an inward one slightly less, never
        more.
        """
        low, top = self.height[0] - more, self.height[-1] + more
        radius = self._widest(high, more) if more > 0 else self._narrowest(high, -more)
        inside: Array = (high >= low) & (high <= top) & (out <= radius + more)
        return inside

    def _widest(self, high: Array, within: float) -> Array:
        if (np.diff(self.radius) >= 0).all():
            return self._at(high + within)
        return np.full(len(high), self.radius.max())

    def _narrowest(self, high: Array, within: float) -> Array:
        """Cutters bulge at most once: the smallest radius of a stretch is at one of its ends."""
        return np.minimum(self._at(high - within), self._at(high + within))

    def _at(self, high: Array) -> Array:
        return np.interp(high, self.height, self.radius)


def cylinder(start: float, end: float, radius: float) -> RevolvedProfile:
    """The profile of a cylinder."""
    return RevolvedProfile(np.array([start, end]), np.array([radius, radius]))


def cutter_profile(tool: Tool, length: float) -> RevolvedProfile:
    """The cutting part of a tool of known diameter, up to a height; chords of the corner arc are inside it."""
    cutter = Cutter.of(tool)
    angle = np.linspace(cutter.corner_start, cutter.corner_end, _ARC_CHORDS + 1)
    radius = cutter.radial_offset + cutter.corner_radius * np.sin(angle)
    height = cutter.axial_offset - cutter.corner_radius * np.cos(angle)
    height, radius = np.append(0.0, height), np.append(0.0, np.maximum(radius, 0.0))
    if length > height[-1]:
        side = radius[-1] + (length - height[-1]) * math.tan(tool.side_angle)
        return RevolvedProfile(np.append(height, length), np.append(radius, max(side, 0.0)))
    kept = height < length
    return RevolvedProfile(np.append(height[kept], length), np.append(radius[kept], np.interp(length, height, radius)))


def cutter_pieces(tool: Tool, length: float, allowance: float) -> tuple[ToolCylinder, ...]:
    """Cylinders inside a cutter reduced by an allowance on all sides; ``_STEP`` less at steps of slanted ones."""
    less = min(allowance, tool.diameter / 4)
    if tool.bottom_angle == 0.0 and tool.side_angle == 0.0:
        rounding = max(min(tool.corner_radius, tool.diameter / 2) - less, 0.0)
        start = less + rounding
        return (ToolCylinder(start, max(length - rounding, start), tool.diameter / 2 - less - rounding, rounding),)
    outline = _reduced(cutter_profile(tool, length), max(less - _STEP, 0.0))
    edges = _stepped(outline)
    radius = np.interp(edges, outline.height, outline.radius)
    return _pieces(edges, np.minimum(radius[:-1], radius[1:]), 0.0)


def _reduced(outline: RevolvedProfile, less: float) -> RevolvedProfile:
    """A convex outline, moved inwards: it is below each of its lines moved inwards; below 0 there is nothing."""
    rise = np.diff(outline.height)
    start = np.flatnonzero(rise > _LEVEL)
    slope, low = np.diff(outline.radius)[start] / rise[start], outline.height[start]
    moved = outline.radius[start] - low * slope - less * np.hypot(1.0, slope)
    bend = -np.diff(slope)
    meets = np.divide(np.diff(moved), bend, out=low[1:].copy(), where=bend > _LEVEL)
    height = np.unique(np.clip(np.concatenate([outline.height, meets]), less, outline.height[-1]))
    return RevolvedProfile(height, (moved + height[:, None] * slope).min(axis=1))


def cutter_hull(tool: Tool, length: float) -> tuple[ToolCylinder, ...]:
    """Cylinders around a cutter, which add no more than ``_STEP`` to slanted outlines."""
    if tool.bottom_angle == 0.0 and tool.side_angle == 0.0:
        return cutter_pieces(tool, length, 0.0)
    outline = cutter_profile(tool, length)
    edges = _stepped(outline)
    radius = np.interp(edges, outline.height, outline.radius)
    bulge = tool.corner_radius * (1.0 - math.cos(math.pi / 2 / _ARC_CHORDS))
    return _pieces(edges, np.maximum(radius[:-1], radius[1:]), bulge)


def _stepped(outline: RevolvedProfile) -> Array:
    """Heights between which cylinders are off an outline by ``_STEP`` at most."""
    rise, growth = np.diff(outline.height), np.abs(np.diff(outline.radius))
    off = rise * growth / np.maximum(np.hypot(rise, growth), _LEVEL)
    count = np.maximum(np.ceil(off / _STEP), 1).astype(np.int64)
    ends = zip(outline.height[:-1], outline.height[1:], count + 1, strict=True)
    return np.unique(np.concatenate([np.linspace(*one) for one in ends]))


def _pieces(edges: Array, radius: Array, rounding: float) -> tuple[ToolCylinder, ...]:
    columns = zip(edges[:-1].tolist(), edges[1:].tolist(), radius.tolist(), strict=True)
    return tuple(ToolCylinder(low, high, wide, rounding) for low, high, wide in columns if wide > 0)


def shank_pieces(tool: Tool, shank: Shank, allowance: float) -> tuple[ToolCylinder, ...]:
    """The shank below the spindle nose, reduced by an allowance; it may rub where the cutter has been."""
    start, radius = shank.start + allowance, shank.diameter / 2 - min(allowance, shank.diameter / 4)
    return (ToolCylinder(start, tool.length, radius),) if start < tool.length else ()
