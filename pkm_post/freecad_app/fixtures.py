# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fixtures: a CAM job at several work offsets, such as G54 and G55.

Takes the fixtures of a job; returns the order in which CAM cuts its operations at them, and the pose of each in the
work frame {C}, which is the frame of the first one. All of them are in one program with one certificate.

The order is that of CAM's own posts, by the job's OrderOutputBy [FreeCAD 1.1, Path/Post/Processor.py,
_buildPostList]. Between two fixtures CAM adds a move up at the old one; here the first move of the operation
starts at the current position, and the collision check includes the parts at all fixtures.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from Path.Base.Util import toolControllerForOp

from pkm_post.freecad_app.document import members
from pkm_post.freecad_app.frames import apply
from pkm_post.geometry import Array
from pkm_post.model import Diagnostic, Diagnostics, Machine, Mesh, Phrase, Place
from pkm_post.options import Options
from pkm_post.posting import work_offset
from pkm_post.toolpath import rotation

Origins = Mapping[str, tuple[float, float, float, float]]
"""Origin in {C} in mm and turn about z in degrees, by name."""
DEFAULT = "G54"
"""The fixture of a job without any."""
ONE_PLACE: Mapping[str, Array] = {}
"""No places: every operation is in {C}."""
_SAME_PLACE = 1e-6
"""mm, and for directions."""


def cutting_order(operations: Sequence[Any], fixtures: Sequence[str], order: str) -> list[tuple[str, Any]]:
    """The fixture and the operation of each cut.

    Args:
        operations: the active ones, in the order of the job.
        fixtures: in the order of the job, at least one.
        order: the job's OrderOutputBy: all operations at a fixture before the next one ("Fixture"), all fixtures with a
            tool ("Tool"), or all fixtures with an operation ("Operation").
    """
    return [(fixture, each) for group in _groups(operations, order) for fixture in fixtures for each in group]


def files_of_split_output(operations: Sequence[Any], fixtures: Sequence[str], order: str) -> int:
    """Number of files that CAM's own posts write for a job with SplitOutput; arguments as in ``cutting_order``."""
    return len(_groups(operations, order)) if order in _GROUPS else len(fixtures)


def _groups(operations: Sequence[Any], order: str) -> list[list[Any]]:
    """Groups of operations cut at one fixture before the next fixture."""
    return _GROUPS[order](operations) if order in _GROUPS else [list(operations)]


def _by_tool(operations: Sequence[Any]) -> list[list[Any]]:
    """Groups of consecutive operations with one tool and spindle speed; those without a tool controller join them."""
    groups: list[list[Any]] = []
    loaded = None
    for operation in operations:
        controller = toolControllerForOp(operation)
        wanted = controller and (controller.ToolNumber, controller.SpindleSpeed, controller.SpindleDir)
        if not groups or wanted not in (None, loaded):
            groups.append([])
        loaded = wanted or loaded
        groups[-1].append(operation)
    return groups


_GROUPS: dict[str, Callable[[Sequence[Any]], list[list[Any]]]] = {
    "Tool": _by_tool,
    "Operation": lambda operations: [[each] for each in operations],
}
"""By the job's OrderOutputBy; any other has one group."""


def fixture_places(
    names: Sequence[str], machine: Machine, options: Options, origins: Origins, place: Place
) -> tuple[dict[str, Array], Diagnostics]:
    """The pose in {C} of each fixture of a job.

    The work offset of the options places the first one; the others are at ``--origin`` in {C}, or else as in the
    machine file in {M}.

    Args:
        names: the fixtures, in the order of the job.
        machine: its work offsets.
        options: the work offset.
        place: of the job, for diagnostics.

    Returns:
        (4, 4) poses by name, without unknown ones; K108 for these, J111 for two at one place, and J139 for
        ``--copies``, since it is ambiguous which fixture they are about.
    """
    first, _ = work_offset(machine, options)
    places, faults = {names[0]: np.eye(4)}, list[Diagnostic]()
    for name in names[1:]:
        if name in origins:
            places[name] = _pose(*origins[name])
        elif name not in machine.work_offsets:
            known = ", ".join(sorted(machine.work_offsets))
            faults.append(Diagnostic("K108", place, Phrase("{}, the machine file has {}", name, known)))
        elif first is not None:  # without it, posting refuses the job
            places[name] = np.linalg.solve(first, machine.work_offsets[name])
    if len(names) > 1 and options.copies.moves:
        faults.append(Diagnostic("J139", place, ", ".join(names)))
    return places, (*faults, *_coincident(places, place))


def _pose(x: float, y: float, z: float, degrees: float) -> Array:
    pose = rotation((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), np.radians(degrees))
    pose[:3, 3] = x, y, z
    return pose


def _coincident(places: Mapping[str, Array], place: Place) -> list[Diagnostic]:
    known = list(places.items())
    return [
        Diagnostic("J111", place, Phrase("{} and {}", name, other))
        for row, (name, pose) in enumerate(known)
        for other, other_pose in known[:row]
        if np.allclose(pose, other_pose, rtol=0.0, atol=_SAME_PLACE)
    ]


def unused_origins(origins: Origins, fixtures: Sequence[str], place: Place) -> list[Diagnostic]:
    """J138 for each origin that does not belong to a fixture after the first."""
    return [Diagnostic("J138", place, f"--origin {name}") for name in origins if name not in fixtures[1:]]


def at_fixtures(mesh: Mesh | None, places: Mapping[str, Array]) -> Mesh | None:
    """A mesh of {C}, repeated at each fixture, as one mesh."""
    if mesh is None or len(places) < 2:
        return mesh
    corners = mesh.triangles.reshape(-1, 3)
    placed = np.concatenate([apply(pose, corners) for pose in places.values()])
    return Mesh(mesh.source, placed.reshape(-1, 3, 3), mesh.assumed)


def operation_name(label: str, fixture: str, fixtures: Sequence[str]) -> str:
    """The name of an operation at a fixture in programs and reports; its label at the first one."""
    return label if fixture in fixtures[:1] else f"{label} ({fixture})"


def operation_named(job: Any, name: str) -> Any:
    """The operation of a job with this name in a program; None if there is none."""
    fixtures = list(job.Fixtures) or [DEFAULT]
    own = members(job.Operations)
    names = ((operation_name(each.Label, fixture, fixtures), each) for fixture in fixtures for each in own)
    return dict(reversed(list(names))).get(name)
