# SPDX-License-Identifier: LGPL-2.1-or-later
"""Summary: the report as plain data, as JSON, and as the heading of a motion program.

The data has no timestamps and no paths: the same job gives the same bytes.
"""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

import pkm_post
from pkm_post.geometry import Array, bounding_box, cubic_ranges, hermite_accelerations
from pkm_post.model import (
    AT_FEED,
    Certificate,
    Coverage,
    EventKind,
    FeedStudy,
    Figure,
    Finding,
    Kind,
    Motion,
    StrutMotion,
    Tolerances,
    Trajectory,
    coverage_summary,
    distinct,
    pieces,
)
from pkm_post.report.results import Results

_FORMAT = 1
"""Version of the report's layout, for programs that parse it."""
_AT_ONCE = 8192
"""Intervals per pass."""
_AS_IT_IS = "axis values are strut lengths in mm, speeds in mm/s; do not edit: the program is certified as it is"


def heading(trajectory: Trajectory) -> list[str]:
    """The first lines of a motion program, which describe it."""
    return [*origin(trajectory), _start(trajectory), _AS_IT_IS]


def hashes(programs: Sequence[str], trajectory: str) -> dict[str, Any]:
    """The SHA-256 of each file for the report; line ends of programs are ignored."""
    return {"programs_sha256": list(programs), "trajectory_sha256": trajectory}


def _start(trajectory: Trajectory) -> str:
    tool = trajectory.tools[int(trajectory.tool[0])]
    x, y, z, i, j, k = (f"{value + 0.0:.6g}" for value in (*trajectory.start_tip, *trajectory.start_axis))
    spin = math.degrees(trajectory.start_spin)
    pose = f"tip of T{tool.number} at X{x} Y{y} Z{z}, axis I{i} J{j} K{k}, spin {spin:.6g} degrees"
    return f"start of the program, at rest: {pose}, in the machine frame"


def origin(trajectory: Trajectory) -> list[str]:
    """The first lines of any file, which state its origin."""
    tools = ", ".join(f"T{tool.number} {tool.name} length {tool.length:g} mm" for tool in _tools(trajectory))
    return [
        f"PKM Post {pkm_post.__version__}: {trajectory.source}",
        f"machine {trajectory.machine}, machine file SHA-256 {trajectory.machine_fingerprint[:16]}",
        f"tools: {tools}",
    ]


def report(results: Results) -> dict[str, Any]:
    """The report as data that JSON can hold."""
    trajectory, machine, motion = results.trajectory, results.machine, results.motion
    return {
        "format": _FORMAT,
        "program": _program(trajectory, results.reading),
        "machine": {"name": machine.name, "sha256": machine.fingerprint},
        "setup": _setup(results),
        "files": dict(results.files),
        "tolerances": _tolerances(trajectory, results.tolerances),
        "motion": _motion(results.struts, results.certificate.duration),
        "machining_time": machining_time(trajectory, motion),
        "feed": {} if results.feed is None else feed_shares(trajectory, results.feed),
        "hold_points": hold_points(trajectory, motion),
        "certificate": _certificate(results.certificate),
    }


def _program(trajectory: Trajectory, reading: Sequence[str]) -> dict[str, Any]:
    return {
        "source": trajectory.source,
        "reading": list(reading),
        "operations": list(trajectory.operations),
        "segments": len(trajectory),
        "cutting_length_mm": _rounded(trajectory.length[trajectory.cutting()].sum(), 3),
        "box_mm": _box(trajectory),
        "tools": [vars(tool) for tool in _tools(trajectory)],
    }


def _tolerances(trajectory: Trajectory, tolerances: Tolerances) -> dict[str, Any]:
    own = trajectory.tip_tolerance
    return {
        "tip_mm": tolerances.tip,
        "axis_deg": _rounded(np.degrees(tolerances.axis), 9),
        "tip_of_program_mm": _rounded(distinct(own[own > 0]), 9),
    }


def _motion(struts: StrutMotion, duration: float) -> dict[str, Any]:
    shortest, longest = _strut_ranges(struts)
    return {
        "duration_s": duration,
        "points": len(struts),
        "shortest_strut_mm": _rounded(shortest, 3),
        "longest_strut_mm": _rounded(longest, 3),
    }


def _certificate(certificate: Certificate) -> dict[str, Any]:
    return {
        "holds": certificate.holds,
        "instants": certificate.instants,
        "meaning": list(coverage_summary(certificate.coverage)),
        "findings": [_finding(finding) for finding in certificate.findings],
        "figures": [_figure(figure) for figure in certificate.figures],
        "coverage": [_coverage(row) for row in certificate.coverage],
    }


def _setup(results: Results) -> dict[str, Any]:
    """Names of the items of the set-up, and the work frame; unknown items are omitted."""
    found: dict[str, Any] = {}
    if results.work_offset is not None:
        name, pose = results.work_offset
        axes = {f"{axis}_axis": _rounded(pose[:3, column], 9) for column, axis in enumerate("xyz")}
        found["work_offset"] = {"name": name, "origin_mm": _rounded(pose[:3, 3], 6), **axes}
    setup = results.setup
    if setup is not None:
        for kind, body in (("part", setup.part), ("stock", setup.stock)):
            found[kind] = "" if body is None else body.source
        found["fixtures"] = [body.source for body in setup.fixtures]
    return found


def machining_time(trajectory: Trajectory, motion: Motion) -> dict[str, Any]:
    """Machining time of the program, total and by operation, s; without tool changes and operator stops.

    The motion times add up to that of the written program.
    """
    segment_time = np.diff(motion.joint_time, prepend=0.0)
    cutting = trajectory.kind != Kind.RAPID
    dwell = np.zeros(len(trajectory))
    for event in trajectory.events:
        if event.kind is EventKind.DWELL:
            dwell[min(event.row, len(trajectory) - 1)] += event.value
    parts = {"cutting_s": segment_time * cutting, "rapid_s": segment_time * ~cutting, "dwell_s": dwell}
    names = trajectory.operations
    sums = {part: np.bincount(trajectory.operation, column, len(names)) for part, column in parts.items()}
    operations = [
        {"name": name} | {part: _rounded(total[number], 3) for part, total in sums.items()}
        for number, name in enumerate(names)
    ]
    return {"total_s": _rounded(segment_time.sum() + dwell.sum(), 3), "operations": operations}


def feed_shares(trajectory: Trajectory, feed: FeedStudy) -> dict[str, Any]:
    """Shares of the cutting time at the programmed feed, and the limits for the rest.

    With f the programmed, p the possible and v the planned feed: ``at_feed`` is where v >= 0.95 f, ``feed_possible``
    where p >= 0.95 f, ``as_possible`` where v >= 0.95 min(f, p). Each limit has its share, and the place where it slows
    the tool most.
    """
    programmed, possible, planned = (column[feed.cutting] for column in (feed.programmed, feed.possible, feed.planned))
    limit = feed.limit[feed.cutting]
    if not len(limit):
        return {}
    limits = [_limit_share(trajectory, feed, number) for number in distinct(limit[limit >= 0]).tolist()]
    return {
        "at_feed": _share(planned >= AT_FEED * programmed),
        "feed_possible": _share(possible >= AT_FEED * programmed),
        "as_possible": _share(planned >= AT_FEED * np.minimum(programmed, possible)),
        "limits": sorted(limits, key=lambda row: -row["share"]),
    }


def _limit_share(trajectory: Trajectory, feed: FeedStudy, number: int) -> dict[str, Any]:
    """Share of the cutting time that a limit has, and the place where it slows the tool most."""
    cells = np.flatnonzero(feed.cutting & (feed.limit == number))
    slowest = cells[np.argmin(feed.planned[cells] / feed.programmed[cells])]
    place = trajectory.place(int(feed.row[slowest]))
    return {
        "limit": feed.limits[number],
        "share": _rounded(len(cells) / np.count_nonzero(feed.cutting), 4),
        "slowest_mm_s": _significant(float(feed.planned[slowest])),
        "asked_mm_s": _significant(float(feed.programmed[slowest])),
        "time_s": _rounded(feed.time[slowest], 3),
        "operation": place.operation,
        "line": place.line,
    }


def _share(where: Array) -> float:
    return float(_rounded(float(where.mean()), 4))


def hold_points(trajectory: Trajectory, motion: Motion) -> dict[str, list[Any]]:
    """Columns of times and source lines at which the motion rests: a feed hold can stop there, and the work resume."""
    rows = np.flatnonzero(trajectory.exact_stop)
    return {
        "time_s": _rounded(motion.joint_time[rows], 3),
        "operation": [trajectory.operations[number] for number in trajectory.operation[rows].tolist()],
        "line": trajectory.line[rows].tolist(),
    }


def write(content: dict[str, Any], path: Path) -> None:
    """Write the report as JSON."""
    path.write_text(json.dumps(content, indent=2, allow_nan=False) + "\n", encoding="utf-8", newline="\n")


def verdict(certificate: Certificate) -> list[str]:
    """The figures that matter most to the user."""
    return [
        f"{finding.name} {finding.value:.3g} of {finding.limit:.3g} {finding.unit}"
        for finding in certificate.findings
        if finding.code in ("V101", "V102")
    ]


def _figure(figure: Figure) -> dict[str, Any]:
    return {
        "what": figure.name,
        "unit": figure.unit,
        "value": _significant(figure.value),
        "time_s": figure.time,
        "operation": figure.place.operation,
        "line": figure.place.line,
    }


def _finding(finding: Finding) -> dict[str, Any]:
    return {
        "what": finding.name,
        "unit": finding.unit,
        "value": _significant(finding.value) if math.isfinite(finding.value) else None,
        "limit": _significant(finding.limit),
        "is_least": finding.is_least,
        "holds": finding.holds,
        "time_s": finding.time,
        "operation": finding.place.operation,
        "line": finding.place.line,
    }


def _coverage(row: Coverage) -> dict[str, str]:
    return {"topic": row.topic.value, "what": row.subject, "extent": row.extent.value, "detail": row.detail}


def _tools(trajectory: Trajectory) -> list[Any]:
    return [trajectory.tools[number] for number in sorted(trajectory.tools)]


def _box(trajectory: Trajectory) -> list[list[float]]:
    """Least and greatest coordinates of the tip, also between the ends of arcs."""
    arc = np.flatnonzero(trajectory.kind == Kind.ARC)
    columns = trajectory.tip_before(), trajectory.tip, trajectory.arc_centre, trajectory.arc_axis, trajectory.sweep
    return [_rounded(corner, 3) for corner in bounding_box(trajectory.tip, *(column[arc] for column in columns))]


def _strut_ranges(struts: StrutMotion) -> tuple[Array, Array]:
    """Shortest and longest length of each strut on the cubics of its program, (6,) mm each."""
    shortest, longest = struts.length[0], struts.length[0]
    for rows in pieces(len(struts) - 1, _AT_ONCE):
        cubics = struts.cubics(np.arange(rows.start, rows.stop))
        begin, end = (rate.T for rate in hermite_accelerations(*cubics))
        p0, v0, p1, _, duration = (column.T for column in cubics)
        least, most = cubic_ranges(p0, v0, begin, (end - begin) / duration, p1, duration)
        shortest, longest = np.minimum(shortest, least.min(axis=1)), np.maximum(longest, most.max(axis=1))
    return shortest, longest


def _rounded(value: Array | float, decimals: int) -> Any:
    return np.round(value, decimals).tolist()


def _significant(value: float) -> float:
    """Round to six digits; further digits are rounding errors of the arithmetic."""
    return float(f"{value:.6g}")
