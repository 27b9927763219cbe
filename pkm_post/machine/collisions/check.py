# SPDX-License-Identifier: LGPL-2.1-or-later
"""Check: collisions of a trajectory with the set-up, and the coverage of the checks.

Takes a trajectory, a machine and a set-up; returns diagnostics and coverage rows. Without a set-up, the search
is not even imported.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from pkm_post.machine.collisions.coverage import NO_SETUP
from pkm_post.model import Coverage, Diagnostics, Machine, Setup, Tolerances, Trajectory

if TYPE_CHECKING:
    from pkm_post.machine.reach.collision_mesh import CollisionMesh


class Collisions(NamedTuple):
    """Result of the checks.

    Attributes:
        coverage: the checks made, and the unknown items.
    """

    faults: Diagnostics
    coverage: tuple[Coverage, ...]


def find_collisions(trajectory: Trajectory, machine: Machine, setup: Setup, tolerances: Tolerances) -> Collisions:
    """Find collisions on a whole trajectory.

    Args:
        trajectory: in {M}, at least one segment.
        setup: workpiece, stock and fixtures, and the shanks of the tools.
        tolerances: allowed deviation of the tool from the trajectory.
    """
    if setup.is_empty:
        return Collisions((), NO_SETUP)
    from pkm_post.machine.collisions.contacts import TrajectoryPath
    from pkm_post.machine.collisions.search import Search
    from pkm_post.machine.reach.report import pose_path_of

    path, segment, _ = pose_path_of(trajectory)
    search = Search(TrajectoryPath(trajectory, path, segment), machine, setup, tolerances)
    search.part()
    search.fixtures()
    search.stock()
    found = sorted(set(search.found), key=lambda fault: (fault.place.operation, fault.place.line, fault.code))
    return Collisions(tuple(found), search.extents.rows())


def setup_names(setup: Setup) -> list[str]:
    """Names of the known items of the set-up, for display."""
    named = [("part", setup.part), ("stock", setup.stock), *(("fixture", mesh) for mesh in setup.fixtures)]
    return [f"{name} {mesh.source}" for name, mesh in named if mesh is not None]


def placed_workpiece(setup: Setup, trajectory: Trajectory) -> CollisionMesh | None:
    """The workpiece in the position of a trajectory on the machine; None if unknown."""
    if setup.part is None:
        return None
    from pkm_post.machine.collisions.contacts import placed_triangles
    from pkm_post.machine.reach.collision_mesh import CollisionMesh

    return CollisionMesh.of(placed_triangles(setup.part, trajectory.machine_from_work))
