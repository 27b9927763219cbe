# SPDX-License-Identifier: LGPL-2.1-or-later
"""Path checks: whether the machine can follow a pose path; the paper's check before any controller output.

Input: a pose path. Output: one finding for each check that the machine file has numbers for, in order of relevance.
Checking strut lengths alone is not enough: singular poses can lie well inside the stroke.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from pkm_post.geometry import Array
from pkm_post.machine.kinematics.stiffness import stiffness_along
from pkm_post.machine.reach.findings import CheckedLimit, ReachFinding, finding_diagnostics
from pkm_post.machine.reach.interference import body_checks, strut_checks, workpiece_checks
from pkm_post.machine.reach.limit_checks import (
    joint_checks,
    shortest_distance,
    singularity_check,
    stroke_checks,
    strut_speed_finding,
)
from pkm_post.machine.reach.path_bounds import Check, check_path, unproven_checks
from pkm_post.machine.reach.pose_path import PosePath
from pkm_post.model import Amount, Diagnostics, Machine, Pattern, Phrase, Trajectory

if TYPE_CHECKING:
    from pkm_post.machine.reach.collision_mesh import CollisionMesh

_NO_STRUT = 1e-3
"""Share of the shortest stroke: below it nothing is provable on a path, and its struts are far too short anyway."""


def reach_findings(
    machine: Machine,
    path: PosePath,
    part: CollisionMesh | None = None,
    duration: Array | None = None,
    normal: Array | None = None,
    least_stiffness: float = 0.0,
) -> tuple[ReachFinding, ...]:
    """Run all checks along a whole path.

    Args:
        machine: the limits; a check whose numbers it does not state is left out.
        path: poses, N rows.
        part: body that spindle and holder must not touch.
        duration: (N,) duration of each cell, s, for the check of strut speeds.
        normal: (N, 3) unit normals of the surface, for the stiffness; ignored if the machine states no stiffness.
        least_stiffness: required stiffness of the tip along the normals, N/mm.
    """
    shortest = _shortest(machine, path)
    findings = check_path(machine, path, all_checks(machine, path, shortest, part))
    if duration is not None:
        findings += (strut_speed_finding(machine, path, shortest, duration),)
    if normal is not None and machine.strut_stiffness is not None:
        findings += (_stiffness_finding(machine, path, normal, least_stiffness),)
    return findings


def all_checks(machine: Machine, path: PosePath, shortest: float, part: CollisionMesh | None) -> tuple[Check, ...]:
    """All checks of a path, in the order of their codes.

    Args:
        shortest: lower bound of the strut lengths on the path, mm.
        part: body to keep clear of; None skips its checks.
    """
    return (
        *stroke_checks(machine, path, shortest),
        *joint_checks(machine, path, shortest),
        singularity_check(machine, path, shortest),
        *strut_checks(machine, path, shortest),
        *body_checks(machine, path),
        *(workpiece_checks(machine, path, shortest, part) if part is not None else ()),
    )


def _stiffness_finding(machine: Machine, path: PosePath, normal: Array, least: float) -> ReachFinding:
    violation, values = Pattern("below {least} by {by}"), {"least": Amount(least, "N/mm", "g")}
    margin = stiffness_along(machine, path.rows(slice(None)), normal) - least
    subject = CheckedLimit(Phrase("stiffness along the normal"), "K119", "N/mm", ("",), violation, values=values)
    return ReachFinding(subject, margin, np.zeros(len(path), dtype=np.int32), -np.inf)


def reach_faults(machine: Machine, trajectory: Trajectory, path: PosePath, segment: Array) -> Diagnostics:
    """Diagnostics for a path that violates a limit: one for each operation and limit, at its worst.

    The same as from ``reach_findings``, but margins are computed only where the slopes do not prove them positive:
    first for poses around a few anchors, then along the path for the checks that remain open.

    Args:
        trajectory: source positions of the segments.
        path: N poses in order along the trajectory.
        segment: (N,) segment of each pose.
    """
    left = unproven_checks(machine, path, lambda shortest: all_checks(machine, path, shortest, None))
    if not left:
        return ()
    checks = all_checks(machine, path, _shortest(machine, path), None)
    found = check_path(machine, path, tuple(checks[number] for number in left), faults_alone=True)
    return finding_diagnostics(found, trajectory, segment)


def _shortest(machine: Machine, path: PosePath) -> float:
    return max(shortest_distance(machine, path), _NO_STRUT * max(machine.strut_stroke[0], 1.0))
