# SPDX-License-Identifier: LGPL-2.1-or-later
"""Contacts: places on a path where a mover violates its clearance to a mesh; none is missed between two poses.

A stretch of the path is checked in the pose at its middle. If c bounds the motion of every point of the body from
there, and the mesh is farther away than c plus the clearance, the stretch is clear. Otherwise it is bisected. Long
stretches use only the bounding spheres of the triangles; in short ones distances are exact. A tool that slides along
its axis fills a longer cylinder, which is checked at once. A stretch that is still unproven when c is below a hundredth
of a millimetre counts as a contact. Units: mm.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from pkm_post.geometry import Array, Cylinders, height_and_radius, nearest_on_triangle, subdivide
from pkm_post.machine.collisions.moving_bodies import MovingBody
from pkm_post.machine.kinematics.inverse import ToolPoses
from pkm_post.machine.reach.collision_mesh import CollisionMesh, from_planes, pairs_within
from pkm_post.machine.reach.limit_checks import HUNDREDTH
from pkm_post.machine.reach.pose_path import PosePath
from pkm_post.model import Amount, Diagnostic, Mesh, Phrase, Trajectory, batches

_FINE = 1.0
"""mm of motion in a stretch, below which distances from triangles are computed."""
_ACROSS = 0.01
"""Most motion across the tool axis, relative to that along it, of a tool that slides."""
_AT_ONCE = 1024
"""Cylinders per pass."""
ENOUGH = 40
"""Contacts in one operation, after which its search ends."""


@dataclass(frozen=True)
class Contacts:
    """Contacts found, in path order.

    Attributes:
        cell: (K,) cell of the path.
        share: (K,) position within the cell, 0 to 1.
        point: (K, 3) the contact point of the mesh.
        distance: (K,) distance of the body from it; 0 where it is inside.
    """

    cell: Array
    share: Array
    point: Array
    distance: Array

    def __len__(self) -> int:
        return len(self.cell)

    def joined(self, other: Contacts) -> Contacts:
        """These contacts and the others, not in path order."""
        return Contacts(*(np.concatenate([getattr(one, name) for one in (self, other)]) for name in vars(self)))


class _PathIntervals:
    """Positions on the path combine cell and share in one number: cell i is from i - 1 to i."""

    def __init__(self, path: PosePath, mover: MovingBody) -> None:
        self.path, self.change, self.total = path, mover.change, np.cumsum(mover.change)
        breaks = np.flatnonzero(np.diff(mover.cells) > 1) + 1
        runs = np.split(mover.cells, breaks) if len(mover.cells) else []
        self.start = np.array([run[0] - 1.0 for run in runs])
        self.end = np.array([float(run[-1]) for run in runs])

    def come(self, at: Array) -> Array:
        """Lipschitz bound of the distance travelled by any point of the body since the start of the path."""
        cell = np.ceil(at).astype(np.int64)
        return self.total[cell] - (cell - at) * self.change[cell]

    def pose(self, at: Array) -> ToolPoses:
        cell = np.maximum(np.ceil(at).astype(np.int64), 1)
        return self.path.inside(cell, at - (cell - 1))


def contacts(
    path: PosePath, mover: MovingBody, part: CollisionMesh, clearance: float, operation: Array, enough: int = ENOUGH
) -> Contacts:
    """Contacts where a mover is closer to a part than its clearance.

    Args:
        path: poses, including the motion between poses.
        mover: the moving body.
        part: the stationary body.
        clearance: smallest allowed distance, mm, above 0.
        operation: (N,) operation of each cell of the path; every operation with contacts yields some.
        enough: contacts in an operation, after which its search ends.
    """
    stretches = _PathIntervals(path, mover)
    start, end = stretches.start, stretches.end
    found: list[tuple[Array, Array, Array]] = []
    counted = np.zeros(int(operation.max(initial=0)) + 1, dtype=np.int64)
    while len(start):
        open_yet = ~_cleared_sliding(stretches, mover, part, start, end, clearance)
        start, end = start[open_yet], end[open_yet]
        one_cell = end - start <= 1
        middle = np.where(one_cell, (start + end) / 2, np.floor((start + end) / 2))
        there = stretches.come(middle)
        change = np.maximum(there - stretches.come(start), stretches.come(end) - there)
        distance, point = _distances_at(stretches, mover, part, middle, change, clearance)
        met = (distance < clearance) | ((distance < clearance + change) & (change < HUNDREDTH))
        found.append((middle[met], point[met], distance[met]))
        np.add.at(counted, operation[np.ceil(middle[met]).astype(np.int64)], 1)
        more = (distance < clearance + change) & ~(met & one_cell)
        first, last = operation[np.floor(start).astype(np.int64) + 1], operation[np.ceil(end).astype(np.int64)]
        more &= (first != last) | (counted[first] < enough)
        start, middle, end = start[more], middle[more], end[more]
        start, end = np.concatenate([start, middle]), np.concatenate([middle, end])
    at, point, distance = (np.concatenate(columns) for columns in zip(*found, strict=True)) if found else _NONE
    return _in_order(at, point, distance)


def _cleared_sliding(
    stretches: _PathIntervals, mover: MovingBody, part: CollisionMesh, start: Array, end: Array, clearance: float
) -> Array:
    """Stretches from start to end, (M,), that are clear at once: a tool that slides along its axis fills a cylinder.

    In a bore of its size nothing else clears a drill before its stretches are as short as the gap.
    """
    path, pieces = stretches.path, len(mover.rounding)
    cell, clear = np.ceil(end).astype(np.int64), np.zeros(len(start), dtype=np.bool_)
    straight = (end - start <= 1) & (path.angle[cell] == 0) & (path.bend[cell] == 0) & mover.is_about_axis
    for rows in batches(np.flatnonzero(straight), max(1, _AT_ONCE // pieces)):
        cells = cell[rows]
        first, middle, last = (path.inside(cells, at[rows] - (cells - 1)) for at in (start, (start + end) / 2, end))
        along, across = height_and_radius(last.tip - first.tip, middle.axis)
        along = np.abs(along)
        slides = np.flatnonzero((along > HUNDREDTH) & (across < _ACROSS * along))
        cylinders = mover.cylinders(ToolPoses(*(column[slides] for column in middle)))
        longer = replace(cylinders, half=cylinders.half + np.repeat(along[slides] / 2, pieces))
        allowed = np.repeat(clearance + across[slides] / 2, pieces)
        distance, _ = _exactly(longer, part, allowed, np.tile(mover.rounding, len(slides)))
        clear[rows[slides]] = np.isinf(distance).reshape(-1, pieces).all(axis=1)
    return clear


def contacts_at_ends(path: PosePath, mover: MovingBody, part: CollisionMesh, clearance: float) -> Contacts:
    """Contacts at the ends of the mover's cells only; the motion between them is not checked."""
    stretches = _PathIntervals(path, mover)
    at = mover.cells.astype(np.float64)
    distance, point = _distances_at(stretches, mover, part, at, np.zeros(len(at)), clearance)
    met = distance < clearance
    return _in_order(at[met], point[met], distance[met])


def _in_order(at: Array, point: Array, distance: Array) -> Contacts:
    order = np.argsort(at, kind="stable")
    cell = np.maximum(np.ceil(at[order]).astype(np.int64), 1)
    return Contacts(cell, at[order] - (cell - 1), point[order], distance[order])


_NONE = np.empty(0), np.empty((0, 3)), np.empty(0)


def _distances_at(
    stretches: _PathIntervals, mover: MovingBody, part: CollisionMesh, at: Array, change: Array, clearance: float
) -> tuple[Array, Array]:
    """Distances at positions (M,), and the contact points (M, 3).

    A distance is infinite where it provably exceeds change plus clearance; on a long stretch without proof the
    clearance is returned.
    """
    distance, point = np.full(len(at), np.inf), np.full((len(at), 3), np.nan)
    for rows in batches(np.arange(len(at)), max(1, _AT_ONCE // len(mover.rounding))):
        cylinders = mover.cylinders(stretches.pose(at[rows]))
        allowed = np.repeat(change[rows] + clearance, len(mover.rounding))
        rounding = np.tile(mover.rounding, len(allowed) // len(mover.rounding))
        fine = np.repeat(change[rows] < _FINE, len(mover.rounding))
        cylinder_distance, met = np.full(len(allowed), np.inf), np.full((len(allowed), 3), np.nan)
        for level, of_level in _levels(part, change[rows], fine, len(mover.rounding)):
            pose, _, _ = pairs_within(cylinders.take(of_level), part, (allowed + rounding)[of_level], level)
            cylinder_distance[of_level[pose]] = clearance
        exact = np.flatnonzero(fine)
        cylinder_distance[exact], met[exact] = _exactly(cylinders.take(exact), part, allowed[exact], rounding[exact])
        by_pose = cylinder_distance.reshape(-1, len(mover.rounding))
        best = np.argmin(by_pose, axis=1)
        picked = np.arange(len(best)) * len(mover.rounding) + best
        distance[rows], point[rows] = cylinder_distance[picked], met[picked]
    return distance, point


def _levels(part: CollisionMesh, change: Array, fine: Array, pieces: int) -> Iterator[tuple[int, Array]]:
    """For long stretches, the level of spheres small compared with them, and the cylinders checked at that level."""
    radii = np.array([np.median(radius) for _, radius in part.balls])
    small_enough = radii[None, :] < change[:, None] / 2
    level = np.where(small_enough.any(axis=1), small_enough.shape[1] - 1 - np.argmax(small_enough[:, ::-1], axis=1), 0)
    level = np.repeat(level, pieces)
    for one in np.unique(level[~fine]):
        yield int(one), np.flatnonzero(~fine & (level == one))


def _exactly(cylinders: Cylinders, part: CollisionMesh, allowed: Array, rounding: Array) -> tuple[Array, Array]:
    """Distances (M,), infinite where they are at least the allowed one; and the nearest points."""
    distance, point = np.full(len(allowed), np.inf), np.full((len(allowed), 3), np.nan)
    pose, triangle, bound = pairs_within(cylinders, part, allowed + rounding)
    for some in batches(np.arange(len(pose)), _PAIRS):  # the spheres of a narrow bore leave no room for a drill
        bound[some] = np.maximum(bound[some], from_planes(cylinders, part, pose[some], triangle[some]))
    near = bound < (allowed + rounding)[pose]
    pose, triangle, bound = pose[near], triangle[near], bound[near]
    order = np.lexsort((bound, pose))
    pose, triangle, bound = pose[order], triangle[order], bound[order]
    # Where bodies overlap, many spheres are inside; a few of them are enough.
    rank = np.arange(len(pose)) - np.searchsorted(pose, pose)
    for few in (rank < _FEW, rank >= _FEW):
        open_yet = few & (bound < np.minimum(distance, allowed)[pose] + rounding[pose]) & (distance > 0)[pose]
        rows, others = pose[open_yet], triangle[open_yet]
        for some in batches(np.arange(len(rows)), _PAIRS):
            found, where = nearest_on_triangle(cylinders.take(rows[some]), part.triangles[others[some]])
            found = np.maximum(found - rounding[rows[some]], 0.0)
            best = np.lexsort((found, rows[some]))
            best = best[np.append(True, np.diff(rows[some][best]) > 0)]
            nearer = found[best] < np.minimum(distance, allowed)[rows[some][best]]
            taken = rows[some][best][nearer]
            distance[taken], point[taken] = found[best][nearer], where[best][nearer]
    return distance, point


_FEW = 8
_PAIRS = 8192


_PIECES = 32
"""Number of subdivided triangles along the mesh."""
_MAX_DEPTHS = 24
"""Contacts per operation whose depth is computed."""


def placed_triangles(mesh: Mesh, machine_from_work: Array) -> Array:
    """The triangles of a mesh in {M}, (T, 3, 3)."""
    return mesh.triangles @ machine_from_work[:3, :3].T + machine_from_work[:3, 3]


@dataclass(frozen=True)
class Obstacle:
    """A mesh in its position on the machine.

    Attributes:
        name: its kind: part, stock, fixture.
        source: source of the mesh.
        mesh: its triangles in {M}.
        triangles: its original number of triangles.
    """

    name: Phrase
    source: str
    mesh: CollisionMesh
    triangles: int

    @classmethod
    def of(cls, name: Phrase, mesh: Mesh, machine_from_work: Array) -> Obstacle:
        """An obstacle from a mesh in the work frame."""
        triangles = placed_triangles(mesh, machine_from_work)
        size = float(np.ptp(triangles.reshape(-1, 3), axis=0).max())
        return cls(
            name, mesh.source, CollisionMesh.of(subdivide(triangles, max(size, 1e-3) / _PIECES)), len(mesh.triangles)
        )


@dataclass(frozen=True)
class TrajectoryPath:
    """A trajectory as driven.

    Attributes:
        trajectory: the source of places in diagnostics.
        poses: its pose path, including the motion between poses.
        segment: (N,) segment of each cell of the path.
    """

    trajectory: Trajectory
    poses: PosePath
    segment: Array

    @property
    def operation(self) -> Array:
        """Operation of each cell, (N,)."""
        return self.trajectory.operation[self.segment]

    def fault(self, code: str, cell: int, found: str) -> Diagnostic:
        """A fault in a cell."""
        return Diagnostic(code, self.trajectory.place(int(self.segment[cell])), found)


def mesh_faults(
    driven: TrajectoryPath, code: str, mover: MovingBody, obstacle: Obstacle, clearance: float
) -> Iterator[Diagnostic]:
    """One fault for each operation in which a mover comes too close to an obstacle, at the worst place."""
    met = contacts(driven.poses, mover, obstacle.mesh, clearance, driven.operation)
    yield from contact_faults(driven, code, mover, obstacle, met, clearance)


def contact_faults(
    driven: TrajectoryPath, code: str, mover: MovingBody, obstacle: Obstacle, met: Contacts, clearance: float
) -> Iterator[Diagnostic]:
    """One fault for each operation with contacts, at the worst of those evaluated."""
    operation = driven.operation[met.cell]
    for number in np.unique(operation):
        rows = np.flatnonzero(operation == number)
        rows = rows[np.unique(np.linspace(0, len(rows) - 1, _MAX_DEPTHS).astype(np.int64))]
        lacking = [clearance - _distance(driven, mover, obstacle, met, row) for row in rows.tolist()]
        worst = int(np.argmax(lacking))
        by = Amount(max(lacking[worst], 0.0), "mm", ".3f")
        found = Phrase("{}, {} {}, by {}", mover.name, obstacle.name, obstacle.source, by)
        yield driven.fault(code, int(met.cell[rows[worst]]), found)


def _distance(driven: TrajectoryPath, mover: MovingBody, obstacle: Obstacle, met: Contacts, row: int) -> float:
    """Distance at a contact; where the bodies overlap, reduced by the depth of a mesh corner inside the mover."""
    if met.distance[row] > 0:
        return float(met.distance[row])
    cylinders = mover.cylinders(driven.poses.inside(met.cell[row : row + 1], met.share[row : row + 1]))
    corners = obstacle.mesh.triangles.reshape(-1, 3)
    deepest = 0.0
    for number, rounding in enumerate(mover.rounding):
        high, out = height_and_radius(corners - cylinders.middle[number], cylinders.axis[number])
        depth = np.minimum(cylinders.half[number] - np.abs(high), cylinders.radius[number] - out) + rounding
        deepest = max(deepest, float(depth.max()))
    return -deepest
