# SPDX-License-Identifier: LGPL-2.1-or-later
"""Interference: clearance between struts, platform, spindle and fixtures.

Strut tubes and rods are capsules here, cylinders with round ends; platform bodies are cylinders with flat ends,
fixtures are boxes. Margins are distances minus radii and clearance; between a body and a fixture, a lower bound of it,
see ``geometry.cylinders``. Units: mm.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from pkm_post.geometry import Array, segment_to_box, segment_to_cylinder, segment_to_segment, separation
from pkm_post.machine.kinematics.inverse import lever_arms
from pkm_post.machine.kinematics.placed_machine import (
    PlacedMachine,
    StrutCapsules,
    body_cylinders,
    body_reach,
    box_corners,
    has_strut_bodies,
    rod_speed_ratio,
    strut_cylinders,
)
from pkm_post.machine.reach.limit_checks import HUNDREDTH, STRUTS
from pkm_post.machine.reach.path_bounds import Check
from pkm_post.machine.reach.pose_path import PosePath
from pkm_post.model import Body, Machine, Pattern, Phrase

if TYPE_CHECKING:
    from pkm_post.machine.reach.collision_mesh import CollisionMesh

COMFORT = 10.0
"""mm: distances that exceed the clearance by more are given as a lower bound."""
_BOX_EDGES = np.array([[0, 1], [2, 3], [4, 5], [6, 7], [0, 2], [1, 3], [4, 6], [5, 7], [0, 4], [1, 5], [2, 6], [3, 7]])
"""Corner pairs of the box edges, in the numbering of ``box_corners``."""
_FIRST, _SECOND = np.triu_indices(6, 1)
_PAIRS = tuple(Phrase("{} and {}", one + 1, two + 1) for one, two in zip(_FIRST, _SECOND, strict=True))


def strut_checks(machine: Machine, path: PosePath, shortest: float) -> tuple[Check, ...]:
    """Check that struts keep clear of each other, the platform and the fixtures; no checks if struts have no bodies."""
    if not has_strut_bodies(machine):
        return ()
    arm = float(lever_arms(machine, path.tool_length).max())
    lever = rod_speed_ratio(machine, shortest)
    reach = max((body_reach(machine, path.tool_length, body) for body in machine.bodies), default=0.0)
    bodies, boxes = (_names(other.name for other in others) for others in (machine.bodies, machine.fixtures))
    violation, violation_of_two = Pattern("strut {part} by {by}"), Pattern("struts {part} by {by}")
    rows = (
        (Phrase("strut and strut"), "K113", _PAIRS, violation_of_two, _strut_to_strut, 2 * lever, 2 * lever * arm),
        (Phrase("strut and platform"), "K114", bodies, violation, _strut_to_bodies, 1 + lever, lever * arm + reach),
        (Phrase("strut and fixture"), "K115", boxes, violation, _strut_to_fixtures, lever, lever * arm),
    )
    return tuple(
        Check(name, code, "mm", parts, violation, margins, by_travel, by_turn, HUNDREDTH, COMFORT)
        for name, code, parts, violation, margins, by_travel, by_turn in rows
        if parts
    )


def body_checks(machine: Machine, path: PosePath) -> tuple[Check, ...]:
    """Check that each platform body keeps clear of the fixtures; no checks without them."""
    if not machine.fixtures:
        return ()
    return tuple(
        Check(
            Phrase("{} and fixture", body.name), "K116", "mm",
            tuple(Phrase("{} and {}", body.name, box.name) for box in machine.fixtures),
            Pattern("{part} by {by}"), partial(_body_to_fixtures, body),
            1.0, body_reach(machine, path.tool_length, body), HUNDREDTH, COMFORT,
        )
        for body in machine.bodies
    )  # fmt: skip


def _names(others: Iterable[str]) -> tuple[str, ...]:
    return tuple(Phrase("{} and {}", strut, other) for other in others for strut in STRUTS)


def _strut_to_strut(placed: PlacedMachine) -> Array:
    """Margins of the 15 strut pairs, (M, 15)."""
    machine = placed.machine
    pieces = StrutCapsules.of(machine, placed.distance)
    start, end = pieces.ends(machine.base_joints, placed.direction)
    least = np.full((len(placed), len(_FIRST)), np.inf)
    for one, radius in enumerate(pieces.radius):
        for two, other_radius in enumerate(pieces.radius):
            apart = segment_to_segment(
                start[:, one, _FIRST], end[:, one, _FIRST], start[:, two, _SECOND], end[:, two, _SECOND]
            )
            least = np.minimum(least, apart - (radius + other_radius))
    return least - machine.clearance


def _strut_to_bodies(placed: PlacedMachine) -> Array:
    """Margins of six struts to each platform body, (M, 6 B)."""
    machine = placed.machine
    pieces = StrutCapsules.of(machine, placed.distance)
    direction = placed.in_platform()
    base = machine.platform_joints - placed.distance[..., None] * direction
    start, end = pieces.ends(base, direction)
    sizes = np.array([(body.radius, body.start, body.end) for body in machine.bodies]).T[:, :, None]
    apart = segment_to_cylinder(start[:, :, None], end[:, :, None], *sizes)  # piece, body, strut
    return (apart - pieces.radius[:, None, None]).min(axis=1).reshape(len(placed), -1) - machine.clearance


def _strut_to_fixtures(placed: PlacedMachine) -> Array:
    """Margins of six struts to each fixture, (M, 6 F)."""
    machine = placed.machine
    pieces = StrutCapsules.of(machine, placed.distance)
    start, end = pieces.ends(machine.base_joints, placed.direction)
    columns = []
    for box in machine.fixtures:
        apart = segment_to_box(start, end, box.lowest, box.highest)
        columns.append((apart - pieces.radius[:, None]).min(axis=1))
    return np.concatenate(columns, axis=1) - machine.clearance


def _body_to_fixtures(body: Body, placed: PlacedMachine) -> Array:
    """Margins of a platform body to each fixture, (M, F)."""
    count = len(placed)
    faces, cylinders = np.broadcast_to(np.eye(3), (count, 3, 3)), body_cylinders(placed, body)
    columns = [
        separation(cylinders, np.broadcast_to(box_corners(box), (count, 8, 3)), faces, _BOX_EDGES)[0]
        for box in placed.machine.fixtures
    ]
    return np.stack(columns, axis=1) - placed.machine.clearance


_FAR = 5 * COMFORT
"""mm: margins are capped here, which leaves the survey room for large steps."""


def workpiece_checks(machine: Machine, path: PosePath, shortest: float, part: CollisionMesh) -> tuple[Check, ...]:
    """Check that platform bodies and struts keep clear of the part, as far as the machine file states them.

    Args:
        path: for the longest tool.
        shortest: lower bound of a strut's joint distance on the path, mm.
        part: the part to keep clear of.
    """
    far = _FAR + machine.clearance
    checks = [
        Check(
            Phrase("{} and part", body.name), "K117", "mm", (body.name,), Pattern("{part} by {by}"),
            partial(_of_body, body, part, far), 1.0, body_reach(machine, path.tool_length, body), HUNDREDTH, COMFORT,
        )
        for body in machine.bodies
    ]  # fmt: skip
    if has_strut_bodies(machine):
        lever, arm = rod_speed_ratio(machine, shortest), float(lever_arms(machine, path.tool_length).max())
        checks.append(
            Check(
                Phrase("strut and part"), "K121", "mm", STRUTS, Pattern("strut {part} by {by}"),
                partial(_of_struts, part, far),
                lever, lever * arm, HUNDREDTH, COMFORT,
            )
        )  # fmt: skip
    return tuple(checks)


def _of_body(body: Body, part: CollisionMesh, far: float, placed: PlacedMachine) -> Array:
    """Margins of one body, (M, 1)."""
    from pkm_post.machine.reach.collision_mesh import distance_from_mesh

    return distance_from_mesh(body_cylinders(placed, body), part, far)[:, None] - placed.machine.clearance


def _of_struts(part: CollisionMesh, far: float, placed: PlacedMachine) -> Array:
    """Margins of the struts, (M, 6)."""
    from pkm_post.machine.reach.collision_mesh import distance_from_mesh

    pieces = [distance_from_mesh(piece, part, far) for piece in strut_cylinders(placed)]
    return np.min(pieces, axis=0).reshape(-1, 6) - placed.machine.clearance
