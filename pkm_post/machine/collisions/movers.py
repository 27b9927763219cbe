# SPDX-License-Identifier: LGPL-2.1-or-later
"""Movers: moving bodies that may collide: bodies of the platform, struts, shank and cutter of a tool.

Each is a set of cylinders at any pose, with a bound of the motion of any point in each cell of the path. Solids of
revolution about the tool axis are independent of the spin. Units: mm, rad.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial

import numpy as np

from pkm_post.geometry import Array, Cylinders
from pkm_post.machine.kinematics.bodies import lever_of_rod, reach_of_body, strut_cylinders
from pkm_post.machine.kinematics.checks import arms_from_tip, shortest_distance
from pkm_post.machine.kinematics.placed import Placed
from pkm_post.machine.kinematics.way import Pose, Way
from pkm_post.model import Body, Machine


@dataclass(frozen=True)
class Piece:
    """A cylinder about the tool axis, offset by a rounding radius.

    Attributes:
        start: height of its lower end above the tip, before the offset.
        end: height of its upper end, likewise.
        radius: radius before the offset; 0 makes it a line.
        rounding: offset on all sides.
    """

    start: float
    end: float
    radius: float
    rounding: float = 0.0


@dataclass(frozen=True)
class Mover:
    """A moving body.

    Attributes:
        name: its name in messages.
        cells: (K,) the cells of the path in which it is checked, ascending.
        change: (N,) upper bound of the motion of any of its points in each cell of the path.
        reach: upper bound of the distance from the tip of any point that turns with the platform, mm.
        rounding: (P,) offset of each of its P cylinders.
        cylinders: P cylinders for each of M poses, pose by pose.
    """

    name: str
    cells: Array
    change: Array
    reach: float
    rounding: Array
    cylinders: Callable[[Pose], Cylinders]


def of_body(machine: Machine, way: Way, body: Body) -> Mover:
    """A body of the platform, along the whole path."""
    offset = machine.spindle_nose + body.start, machine.spindle_nose + body.end
    reach = reach_of_body(machine, way, body)
    return Mover(
        body.name,
        np.arange(1, len(way)),
        _about_the_axis(way, reach),
        reach,
        np.zeros(1),
        partial(_platform_cylinder, *offset, body.radius),
    )


def of_tool(name: str, way: Way, cells: Array, pieces: Iterable[Piece]) -> Mover:
    """A part of a tool, in the cells where it is in use."""
    start, end, radius, rounding = np.array([[p.start, p.end, p.radius, p.rounding] for p in pieces]).T
    reach = float((np.hypot(np.maximum(np.abs(start), np.abs(end)), radius) + rounding).max())
    return Mover(
        name, cells, _about_the_axis(way, reach), reach, rounding, partial(_tool_cylinders, start, end, radius)
    )


def of_struts(machine: Machine, way: Way) -> Mover | None:
    """The six struts; None if the joints of a strut coincide somewhere, which another check refuses."""
    shortest = shortest_distance(machine, way)
    if not shortest > 0:
        return None
    lever, arm = lever_of_rod(machine, shortest), float(arms_from_tip(machine, way.tool_length).max())
    pieces = len(list(strut_cylinders(Placed.of(machine, way.rows(slice(0, 1))))))
    change = lever * (way.travel + arm * way.turn())
    return Mover("strut", np.arange(1, len(way)), change, lever * arm, np.zeros(6 * pieces), partial(_struts, machine))


def _about_the_axis(way: Way, reach: float) -> Array:
    """Bound of the motion of points that move with the tip and turn about it; the spin moves no solid of revolution."""
    return way.travel + way.angle * reach


def _platform_cylinder(start: float, end: float, radius: float, pose: Pose) -> Cylinders:
    tip, axis, _, tool_length = pose
    middle = tip + ((start + end) / 2 + tool_length)[:, None] * axis
    return Cylinders(middle, axis, np.full(len(tip), (end - start) / 2), np.full(len(tip), radius))


def _tool_cylinders(start: Array, end: Array, radius: Array, pose: Pose) -> Cylinders:
    tip, axis, _, _ = pose
    middle = tip[:, None] + ((start + end) / 2)[:, None] * axis[:, None]
    repeated = np.repeat(axis, len(start), axis=0)
    return Cylinders(middle.reshape(-1, 3), repeated, *(np.tile(one, len(tip)) for one in ((end - start) / 2, radius)))


def _struts(machine: Machine, pose: Pose) -> Cylinders:
    """All pieces of all struts, pose by pose."""
    pieces = list(strut_cylinders(Placed.of(machine, pose)))
    count = len(pose[0])

    def by_pose(columns: list[Array]) -> Array:
        shape = columns[0].shape[1:]
        stacked = np.concatenate([column.reshape(count, 6, *shape) for column in columns], axis=1)
        return stacked.reshape(-1, *shape)

    return Cylinders(
        *(by_pose([getattr(one, name) for one in pieces]) for name in ("middle", "axis", "half", "radius"))
    )
