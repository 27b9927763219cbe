# SPDX-License-Identifier: LGPL-2.1-or-later
"""Collisions with the stock: rapid moves, shanks and bodies of the machine in remaining or possibly remaining material.

A stock point met before any cutter can have reached it certainly remains: an error. A point that no cutter has
certainly cut may remain: a warning. Units: mm.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from pkm_post.geometry import Array, is_closed
from pkm_post.machine.collisions.contacts import Contacts, TrajectoryPath
from pkm_post.machine.collisions.moving_bodies import RevolvedProfile, cylinder
from pkm_post.machine.collisions.stock_grid import StockGrid, SweptPoses, first_met, when_cut
from pkm_post.machine.collisions.tools_in_use import ToolUse
from pkm_post.machine.reach.pose_path import PosePath
from pkm_post.model import Body, Diagnostic, Machine, Mesh, Phrase, Tool

_SCALLOP = 0.1
"""mm: largest ridge between two poses of a cutter, which is taken to cut everything between them."""

_BESIDE = 5.0
"""mm: moves farther beside the stock are left out."""
_MOST_CUTS, _MOST_PAIRS = 200_000, 60_000_000
"""Poses of cuts, and pairs of a pose and a point of other bodies; a path with more is looked at in longer steps."""
_MOST_MET = 4000
"""Most intruded points whose cutting time is determined."""


@dataclass(frozen=True)
class Intruder:
    """A body that must not enter the stock.

    Attributes:
        name: its name in messages.
        codes: diagnostic codes of a certain and of a possible collision.
        shapes: its profiles about the tool axis, and the cells to which each applies.
    """

    name: str
    codes: tuple[str, str]
    shapes: tuple[tuple[RevolvedProfile, Array], ...]


def rapid_cutter(used: ToolUse) -> Intruder:
    """The cutting part of a tool in rapid moves."""
    return Intruder(Phrase("{} in a rapid move", used.name), ("K136", "K137"), ((used.profile(), used.rapid),))


def shank_of(used: ToolUse) -> Intruder:
    """The shank of a tool, if it has one."""
    assert used.shank is not None
    shape = cylinder(used.shank.start, used.tool.length, used.shank.diameter / 2)
    return Intruder(Phrase("shank of {}", used.name), ("K134", "K135"), ((shape, used.cells()),))


def body_of(machine: Machine, body: Body, used: Sequence[ToolUse]) -> Intruder:
    """A body of the platform."""
    return Intruder(
        body.name,
        ("K134", "K135"),
        tuple(
            (cylinder(nose + body.start, nose + body.end, body.radius), one.cells())
            for one, nose in ((one, machine.spindle_nose + one.tool.length) for one in used)
        ),
    )


def stock_faults(
    driven: TrajectoryPath, stock: Mesh, intruders: Sequence[Intruder], used: Sequence[ToolUse], tolerance: float
) -> tuple[StockGrid, float, float, list[Diagnostic]]:
    """The grid, the motion between two poses, the depth from which points count, and a fault for each operation.

    Args:
        driven: the trajectory.
        stock: a closed mesh.
        intruders: bodies that must not enter it.
        used: all tools in use, since each one cuts.
        tolerance: largest deviation of the tool from the trajectory, mm.
    """
    grid = StockGrid.of(stock.triangles)
    work_from_machine = np.linalg.inv(driven.trajectory.machine_from_work)
    cuts = [(one, _cuts(driven, one, grid, work_from_machine)) for one in used if one.has_size]
    ridge = max((_ridge(one.tool, swept.moved) for one, swept in cuts), default=0.0)
    less = max(_SCALLOP, ridge) + tolerance
    unsized = (one.cutting for one in used if not one.has_size and len(one.cutting))
    unknown = min((float(cells[0]) - 1 for cells in unsized), default=np.inf)
    found: list[Diagnostic] = []
    apart = 0.0
    for one in intruders:
        first, moved = _first_met(driven, one, grid, work_from_machine, less)
        apart = max(apart, moved)
        number = _some(_not_surely_cut(grid, first, cuts))
        points, met = grid.points(number), first[number]
        may, sure = np.full(len(met), unknown), np.full(len(met), np.inf)
        for cutter, swept in cuts:
            times = when_cut(points, met, swept, cutter.profile(), cutter.largest_profile(), tolerance)
            may, sure = np.minimum(may, times[0]), np.minimum(sure, times[1])
        certain = ~(may < met) & (not stock.assumed)
        hits = [(one.codes[0], certain)] if certain.any() else [(one.codes[1], ~(sure <= met))]
        for code, hit in hits:
            found += _operation_faults(driven, one.name, code, stock, points[hit], met[hit])
    return grid, apart, less, found


def _not_surely_cut(grid: StockGrid, first: Array, cuts: Sequence[tuple[ToolUse, SweptPoses]]) -> Array:
    """Points met, without those in a cutter before; where they are few, all: each is searched for closely."""
    met = np.isfinite(first)
    if np.count_nonzero(met) > _MOST_MET:
        seen, cut = replace(grid, filled=met.reshape(grid.filled.shape)), np.full(first.size, np.inf)
        for cutter, swept in cuts:
            profile = cutter.profile()
            # Fewer poses leave more points: none is taken for cut that is not.
            stride = max(math.ceil(len(swept.at) * _points_in(profile, grid) / _MOST_PAIRS), 1)
            cut = np.minimum(cut, first_met(seen, swept.every(stride), profile, 0.0))
        met &= ~(cut <= first)
    return np.flatnonzero(met)


def points_met(driven: TrajectoryPath, part: Mesh, intruder: Intruder, less: float) -> tuple[StockGrid, Contacts]:
    """Points of a grid in a part that are inside an intruder by more than ``less``; none where the mesh is open."""
    grid = StockGrid.of(part.triangles)
    grid.filled[:] &= is_closed(part.triangles)
    placed = driven.trajectory.machine_from_work
    first, _ = _first_met(driven, intruder, grid, np.linalg.inv(placed), less)
    number = _some(np.flatnonzero(np.isfinite(first)))
    cell = np.maximum(np.ceil(first[number]).astype(np.int64), 1)
    points = grid.points(number) @ placed[:3, :3].T + placed[:3, 3]
    return grid, Contacts(cell, first[number] - (cell - 1), points, np.zeros(len(number)))


def _some(number: Array) -> Array:
    """At most ``_MOST_MET`` of them, evenly chosen."""
    return number[np.unique(np.linspace(0, max(len(number) - 1, 0), _MOST_MET).astype(np.int64))[: len(number)]]


def _cuts(driven: TrajectoryPath, used: ToolUse, grid: StockGrid, work_from_machine: Array) -> SweptPoses:
    """Poses in which a tool cuts, in steps whose ridges stay within ``_SCALLOP``."""
    step = float(np.sqrt(4 * used.tool.diameter * _SCALLOP))
    step *= min(1.0, _SCALLOP / _ridge(used.tool, step))
    profile = used.largest_profile()
    cells = _near(driven.poses, used.cutting, work_from_machine, profile, grid)
    return SweptPoses.of(driven.poses, cells, work_from_machine, profile.farthest, step, _MOST_CUTS)


def _ridge(tool: Tool, moved: float) -> float:
    """Largest depth of what a tool leaves between two poses apart: between round sides, or between points."""
    return max(moved**2 / (4 * tool.diameter), moved / 2 * math.sin(tool.bottom_angle))


def _first_met(
    driven: TrajectoryPath, intruder: Intruder, grid: StockGrid, work_from_machine: Array, less: float
) -> tuple[Array, float]:
    """First positions at which stock points are inside an intruder by more than ``less``, (points,), and ``moved``."""
    first, apart = np.full(grid.filled.size, np.inf), 0.0
    for profile, every in intruder.shapes:
        cells = _near(driven.poses, every, work_from_machine, profile, grid)
        most = _MOST_PAIRS / _points_in(profile, grid)
        swept = SweptPoses.of(driven.poses, cells, work_from_machine, profile.farthest, grid.step, most)
        first = np.minimum(first, first_met(grid, swept, profile, -less))
        apart = max(apart, swept.moved)
    return first, apart


def _points_in(profile: RevolvedProfile, grid: StockGrid) -> float:
    """Approximate number of grid points in the box around an upright solid of revolution, at least 1."""
    box = [len(axis) * grid.step for axis in grid.axes]
    wide, length = 2 * float(profile.radius.max()), float(profile.height[-1] - profile.height[0])
    return max(min(wide, box[0]) * min(wide, box[1]) * min(length, max(box)) / grid.step**3, 1.0)


def _near(path: PosePath, cells: Array, work_from_machine: Array, profile: RevolvedProfile, grid: StockGrid) -> Array:
    """The cells in which a solid of revolution may come within ``_BESIDE`` of the grid."""
    rotation, shift = work_from_machine[:3, :3].T, work_from_machine[:3, 3]
    ends = [np.array([axis[at] if len(axis) else np.inf for axis in grid.axes]) for at in (0, -1)]
    half, radius = float(profile.height[-1] - profile.height[0]) / 2, float(profile.radius.max())
    axis = path.axis[cells] @ rotation
    middle = path.tip[cells] @ rotation + shift + (float(profile.height[0]) + half) * axis
    change = path.travel[cells] + path.angle[cells] * profile.farthest
    extent = half * np.abs(axis) + radius * np.sqrt(np.maximum(1 - axis**2, 0.0)) + (change + _BESIDE)[:, None]
    near: Array = ((middle + extent > ends[0]) & (middle - extent < ends[1])).all(axis=1)
    return cells[near]


def _operation_faults(
    driven: TrajectoryPath, name: str, code: str, stock: Mesh, points: Array, met: Array
) -> Iterator[Diagnostic]:
    """One fault for each operation, at its first intrusion, from the points met and their positions on the path."""
    cells = np.maximum(np.ceil(met).astype(np.int64), 1)
    operation = driven.operation[cells]
    for number in np.unique(operation):
        mine = np.flatnonzero(operation == number)
        begin = mine[np.argmin(met[mine])]
        x, y, z = np.round(points[begin], 1) + 0.0
        found = Phrase("{}, stock {}, at X{:.1f} Y{:.1f} Z{:.1f}", name, stock.source, x, y, z)
        yield driven.fault(code, int(cells[begin]), found)
