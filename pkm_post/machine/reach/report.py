# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reach: whether a machine can follow a trajectory, not only at sampled poses.

Takes a trajectory and a machine; returns a report: for each check its least margin, the element and block where it
occurs, the first block that violates it, and the remedy. As data, as text, as a dictionary for JSON, and as columns by
pose.

The trajectory is checked as programmed: lines, arcs, great circles, spin at a constant rate. The rounded corners of the
actual motion deviate from it by less than the tolerances of the job; posting checks those. Units: mm, rad, s inside,
degrees in texts and in JSON.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from pkm_post.geometry import Array, norm
from pkm_post.machine.kinematics.inverse import ToolPoses
from pkm_post.machine.reach.collision_mesh import CollisionMesh
from pkm_post.machine.reach.findings import DISPLAY_UNITS, ReachFinding, finding_diagnostics
from pkm_post.machine.reach.path_checks import reach_findings
from pkm_post.machine.reach.pose_path import PosePath
from pkm_post.model import RULES, Diagnostics, Machine, Trajectory
from pkm_post.toolpath import Segments

_LONGEST_CELL = 5.0
"""mm or degrees of path length"""
_WIDEST_CELL = np.radians(2.0)
"""rad of axis turn, arc sweep or spin: the largest step between reported margins."""
_ROUNDING = 1e-6
"""Part of a cell by which a length of whole cells may be longer: paths have rounded numbers."""
_CHUNK = 65536
"""Cells per pass where poses are computed."""


class ReachReport(NamedTuple):
    """Results of the checks of a trajectory; N poses, each the end of a path cell.

    Attributes:
        tip: (N, 3) tool tips of the poses in {M}, for plots.
        segment: (N,) segment of the trajectory of each pose.
        findings: one for each check.
    """

    trajectory: Trajectory
    machine: Machine
    tip: Array
    segment: Array
    findings: tuple[ReachFinding, ...]

    def faults(self) -> Diagnostics:
        """One diagnostic for each check and operation that violates it, at its worst pose."""
        return finding_diagnostics(self.findings, self.trajectory, self.segment)

    def column(self, name: str) -> Array:
        """Margins of one check by pose, (N,), in internal units; for colouring the tips."""
        margins = {finding.subject.name: finding.margin for finding in self.findings}
        if name not in margins:
            raise ValueError(f"expected one of {', '.join(margins)}, got {name!r}")
        return margins[name]

    def as_dict(self) -> dict[str, Any]:
        """The report for JSON."""
        return {
            "format": 1,
            "machine": self.machine.name,
            "source": self.trajectory.source,
            "poses": len(self.segment),
            "blocks": len(self.trajectory),
            "characteristic_length": self.machine.characteristic_length,
            "checks": [self._check(finding) for finding in self.findings],
        }

    def _check(self, finding: ReachFinding) -> dict[str, Any]:
        subject, worst, first = finding.subject, finding.worst_row, finding.first_bad_row
        unit, factor = DISPLAY_UNITS[subject.unit]
        return {
            "name": subject.name,
            "code": subject.code,
            "unit": unit,
            "margin": float(finding.margin[worst]) * factor,
            "proven_margin": finding.at_least * factor if math.isfinite(finding.at_least) else None,
            "part": subject.parts[finding.part[worst]],
            "worst": self._where(worst),
            "first_violation": None if first is None else self._where(first),
            "cure": None if first is None else RULES[self._code(finding, first)].cure,
        }

    def _code(self, finding: ReachFinding, row: int) -> str:
        return finding.subject.code_of(int(self.trajectory.kind[self.segment[row]]))

    def _where(self, row: int) -> dict[str, Any]:
        segment = int(self.segment[row])
        place = self.trajectory.place(segment)
        return {"block": segment + 1, "operation": place.operation, "line": place.line}

    def text(self) -> str:
        """The report as text: a table, and a remedy for each violation."""
        report = self.as_dict()
        head = ("check", "least margin", "proven", "of", "worst at", "first violation at")
        rows = [head, *(_row(check) for check in report["checks"])]
        widths = [max(len(row[column]) for row in rows) for column in range(len(head))]
        table = ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows]
        cures = [f"{check['name']}: {check['cure']}" for check in report["checks"] if check["cure"]]
        first = f"{report['source']} on {report['machine']}: {report['blocks']} blocks, {report['poses']} poses"
        scale = f"rotation columns of the Jacobian divided by {report['characteristic_length']:g} mm"
        return "\n".join([first, scale, "", *table, *([""] if cures else []), *cures]) + "\n"


def _row(check: dict[str, Any]) -> tuple[str, ...]:
    proven, first = check["proven_margin"], check["first_violation"]
    return (
        check["name"],
        f"{check['margin']:.4g} {check['unit']}".rstrip(),
        "rows only" if proven is None else f"{proven:.4g}",
        check["part"],
        _place_text(check["worst"]),
        "none" if first is None else _place_text(first),
    )


def _place_text(where: dict[str, Any]) -> str:
    operation = f"{where['operation']}, " if where["operation"] else ""
    return f"{operation}line {where['line']}"


def check_reach(
    trajectory: Trajectory,
    machine: Machine,
    part: CollisionMesh | None = None,
    normal: Array | None = None,
    least_stiffness: float = 0.0,
) -> ReachReport:
    """Check a whole trajectory.

    Args:
        trajectory: in {M}, at least one segment.
        machine: its limits; a check whose limits it does not state is skipped.
        part: the body that spindle and holder must not touch, in {M}.
        normal: (S, 3) unit normals of the surface at the ends of the S segments, in {M}, for the stiffness.
        least_stiffness: required stiffness of the tip along the normals, N/mm.
    """
    path, segment, duration = pose_path_of(trajectory)
    by_pose = None if normal is None else normal[segment]
    findings = reach_findings(machine, path, part, duration, by_pose, least_stiffness)
    return ReachReport(trajectory, machine, path.tip, segment, findings)


def poses_along(trajectory: Trajectory) -> ToolPoses:
    """The poses of a reach report of a trajectory, row by row."""
    return pose_path_of(trajectory)[0].rows(slice(None))


def pose_path_of(trajectory: Trajectory) -> tuple[PosePath, Array, Array]:
    """The pose path of a trajectory, the segment of each of its rows (N,), and the time at feed of each cell (N,)."""
    segments, tool_length = Segments.of(trajectory), trajectory.tool_length()
    segment, start, extent = _cells(segments)

    def inside(cell: Array, share: Array) -> ToolPoses:
        at, u = segment[cell], start[cell] + share * extent[cell]
        spin = segments.spin[at] + u * segments.spin_rate[at]
        return ToolPoses(segments.tip_at(at, u)[0], segments.axis_at(at, u)[0], spin, tool_length[at])

    chunks = [np.arange(first, min(first + _CHUNK, len(segment))) for first in range(0, len(segment), _CHUNK)]
    tip, axis, spin, length = (
        np.concatenate(columns) for columns in zip(*(inside(rows, np.ones(len(rows))) for rows in chunks), strict=True)
    )
    travel, bend = _motion_of_tip(segments)
    path = PosePath(
        tip=tip,
        axis=axis,
        spin=spin,
        tool_length=length,
        travel=travel[segment] * extent,
        bend=bend[segment] * extent**2,
        angle=norm(segments.axis_rate)[segment] * extent,
        spin_change=segments.spin_rate[segment] * extent,
        inside=inside,
    )
    return path, segment, extent / trajectory.feed[segment]


def _cells(segments: Segments) -> tuple[Array, Array, Array]:
    """Cells of all segments, after one of no extent at the start of the path: segment, start and extent, (N,) each."""
    turn = np.maximum(segments.turn(), np.abs(segments.spin_rate))
    widest = np.maximum(segments.extent / _LONGEST_CELL, segments.extent * turn / _WIDEST_CELL)
    cells = np.maximum(1, np.ceil(widest - _ROUNDING)).astype(np.int64)
    width = segments.extent / cells
    segment = np.concatenate([[0], np.repeat(np.arange(len(cells)), cells)])
    number = np.arange(len(segment)) - 1 - (np.cumsum(cells) - cells)[segment]
    extent = np.concatenate([[0.0], width[segment[1:]]])
    return segment, np.concatenate([[0.0], number[1:] * extent[1:]]), extent


def _motion_of_tip(segments: Segments) -> tuple[Array, Array]:
    """Bounds of the first and of the second derivative of the tip by path length, (S,) each."""
    first, second, arcs = norm(segments.tangent), np.zeros(len(segments)), segments.arcs
    growth, radius, turn = np.abs(arcs.growth), norm(arcs.radius), arcs.turn
    largest = radius * (1 + growth * segments.extent[arcs.row])
    first[arcs.row] = np.hypot(first[arcs.row], largest * turn) + growth * radius
    second[arcs.row] = 2 * growth * radius * turn + largest * turn**2
    return first, second
