# SPDX-License-Identifier: LGPL-2.1-or-later
"""Against meshes: bodies of the machine and parts of tools against workpiece, fixtures, and uncut stock.

Takes a driven trajectory, a machine and a mesh; returns faults by operation, proven to be complete. Units: mm.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array, cut_small, dot
from pkm_post.machine.collisions.contacts import Contacts, contacts
from pkm_post.machine.collisions.movers import Mover
from pkm_post.machine.kinematics.part import Part
from pkm_post.machine.kinematics.way import Way
from pkm_post.model import Diagnostic, Mesh, Trajectory

_PIECES = 32
"""Number of subdivided triangles along the mesh."""
_LOOKED_AT = 24
"""Contacts per operation whose depth is computed."""


def placed(mesh: Mesh, machine_from_work: Array) -> Array:
    """The triangles of a mesh in {M}, (T, 3, 3)."""
    return mesh.triangles @ machine_from_work[:3, :3].T + machine_from_work[:3, 3]


@dataclass(frozen=True)
class Obstacle:
    """A mesh in its position on the machine.

    Attributes:
        name: its kind: part, stock, fixture.
        source: source of the mesh.
        part: its triangles in {M}.
        triangles: its original number of triangles.
    """

    name: str
    source: str
    part: Part
    triangles: int

    @classmethod
    def of(cls, name: str, mesh: Mesh, machine_from_work: Array) -> Obstacle:
        """An obstacle from a mesh in the work frame."""
        triangles = placed(mesh, machine_from_work)
        size = float(np.ptp(triangles.reshape(-1, 3), axis=0).max())
        return cls(name, mesh.source, Part.of(cut_small(triangles, max(size, 1e-3) / _PIECES)), len(mesh.triangles))


@dataclass(frozen=True)
class Driven:
    """A trajectory as driven.

    Attributes:
        trajectory: the source of places in diagnostics.
        way: its pose path, including the motion between poses.
        segment: (N,) segment of each cell of the path.
    """

    trajectory: Trajectory
    way: Way
    segment: Array

    @property
    def operation(self) -> Array:
        """Operation of each cell, (N,)."""
        return self.trajectory.operation[self.segment]

    def told(self, code: str, cell: int, found: str) -> Diagnostic:
        """A fault in a cell."""
        return Diagnostic(code, self.trajectory.place(int(self.segment[cell])), found)


def faults(driven: Driven, code: str, mover: Mover, obstacle: Obstacle, clearance: float) -> Iterator[Diagnostic]:
    """One fault for each operation in which a mover comes too close to an obstacle, at the worst place."""
    met = contacts(driven.way, mover, obstacle.part, clearance, driven.operation)
    yield from told(driven, code, mover, obstacle, met, clearance)


def told(
    driven: Driven, code: str, mover: Mover, obstacle: Obstacle, met: Contacts, clearance: float
) -> Iterator[Diagnostic]:
    """One fault for each operation with contacts, at the worst of those evaluated."""
    operation = driven.operation[met.cell]
    for number in np.unique(operation):
        rows = np.flatnonzero(operation == number)
        rows = rows[np.unique(np.linspace(0, len(rows) - 1, _LOOKED_AT).astype(np.int64))]
        lacking = [clearance - _distance(driven, mover, obstacle, met, row) for row in rows.tolist()]
        worst = int(np.argmax(lacking))
        found = f"{mover.name}, {obstacle.name} {obstacle.source}, by {max(lacking[worst], 0.0):.3f} mm"
        yield driven.told(code, int(met.cell[rows[worst]]), found)


def _distance(driven: Driven, mover: Mover, obstacle: Obstacle, met: Contacts, row: int) -> float:
    """Distance at a contact; where the bodies overlap, reduced by the depth of a mesh corner inside the mover."""
    if met.distance[row] > 0:
        return float(met.distance[row])
    cylinders = mover.cylinders(driven.way.inside(met.cell[row : row + 1], met.share[row : row + 1]))
    corners = obstacle.part.triangles.reshape(-1, 3)
    deepest = 0.0
    for number, rounding in enumerate(mover.rounding):
        away = corners - cylinders.middle[number]
        high = dot(away, cylinders.axis[number])
        out = np.sqrt(np.maximum(dot(away, away) - high * high, 0.0))
        depth = np.minimum(cylinders.half[number] - np.abs(high), cylinders.radius[number] - out) + rounding
        deepest = max(deepest, float(depth.max()))
    return -deepest
