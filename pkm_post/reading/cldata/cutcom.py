# SPDX-License-Identifier: LGPL-2.1-or-later
"""CUTCOM: start and end of cutter compensation, and what the file states about its points there.

Enters: statements and comments. Leaves: records in the course, evaluated once all points are known: see
``contour_data``.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from pkm_post.geometry import across, dot, norm
from pkm_post.model import Array
from pkm_post.reading.cldata.arcs import Fitted
from pkm_post.reading.cldata.feeds import shown
from pkm_post.reading.cldata.points import Points, in_force
from pkm_post.reading.cldata.state import Course, Cutcom, Said
from pkm_post.reading.cldata.statements import Statement

_SIDES = {"LEFT": 1.0, "RIGHT": -1.0}
_PLANES = {"XYPLAN": 2, "ZXPLAN": 1, "YZPLAN": 0}
_REGISTERS = {"ADJUST", "LENGTH", "OSETNO"}
"""Words before the number of an offset register of the control, which does not affect the path."""
_KNOWN = {*_SIDES, *_PLANES, *_REGISTERS, "OFF", "ON", "PLANE"}
_GEOMETRY_TYPES = {"OUTPUT_ON_CENTER": "centre", "OUTPUT_ON_PROFILE": "contour"}
_HEADERS = {"CENTRE": "centerline data", "CONTOUR": "contact contour data"}


def cutcom(course: Course, row: int, statement: Statement) -> None:
    """CUTCOM/LEFT or RIGHT[,plane][,register], CUTCOM/OFF; CUTCOM/ON keeps the active state."""
    words = statement.words
    sides = [_SIDES[word] for word in words if word in _SIDES]
    if not words or not set(words) <= _KNOWN or len(sides) > 1:
        course.tell("L401", row, f"CUTCOM/{shown(statement)}")
        return
    if sides or "OFF" in words:
        plane = next((_PLANES[word] for word in words if word in _PLANES), None)
        side = sides[0] if sides else 0.0
        course.cutcoms.append(Cutcom(row, side, plane, course.tool, _radius(course), course.points_said))


def _radius(course: Course) -> float:
    """Radius of the active tool: from the user, else from the file."""
    given = course.options.tools.get(course.tool)
    return (given.diameter if given and given.diameter > 0 else course.diameter) / 2


def geometry_type(course: Course, row: int, statement: Statement) -> None:
    """CUTCOM_GEOMETRY_TYPE/OUTPUT_ON_CENTER or OUTPUT_ON_PROFILE, a comment of Creo."""
    kind = next((word for word in statement.words if word in _GEOMETRY_TYPES), None)
    course.points_said = Said(_GEOMETRY_TYPES[kind], kind, row) if kind else None


def points_are(course: Course, row: int, statement: Statement) -> None:
    """The comments ``$$ centerline data`` and ``$$ contact contour data`` in the header of a tool path of NX."""
    kind = next((word for word in statement.words if word in _HEADERS), "")
    if kind:
        course.points_said = Said(kind.lower(), f"$$ {_HEADERS[kind]}", row)


CENTRE, CONTOUR = "centre", "contour"
_IN_WORDS = {CENTRE: "the centre of the tool", CONTOUR: "the contour of the part"}
_TIGHTER = 0.01
"""mm by which an arc radius must be below the tool radius to count: arcs of equal radius prove nothing."""


@dataclass(frozen=True)
class Offset:
    """Compensation of the rows after a statement.

    Attributes:
        row: the statement.
        offset: mm to the left, 0 for none.
        plane: the coordinate normal to the plane.
        smaller: the points are the centre path of a larger tool.
    """

    row: int
    offset: float
    plane: int
    smaller: bool


@dataclass(frozen=True)
class _Taken:
    """Interpretation of the points of a CUTCOM, empty if unknown, its source, and whether it was guessed."""

    points: str = ""
    evidence: str = ""
    by_arcs: bool = False


_Cutter = tuple[int, float]
"""Tool number and radius."""


@dataclass
class _Tight:
    """The arcs of one cutter that are tighter than its radius: their statements and radii."""

    towards: list[tuple[int, float]] = field(default_factory=list)
    away: list[tuple[int, float]] = field(default_factory=list)


def contour_offsets(course: Course, points: Points, frames: Array, arcs: Fitted) -> tuple[list[Offset], list[str]]:
    """The offset of each CUTCOM, and a description of how its points were interpreted.

    Args:
        course: has the CUTCOMs; collects the faults.
        points: resolved points.
        frames: (P, 4, 4) or (1, 4, 4) transforms of the points to the work frame.
        arcs: with their end points.
    """
    _tell_unused_wear(course)
    normal = _normals(course, points, frames)
    tight = _tight_arcs(course, points, arcs, normal)
    shown = _shown_by_arcs(course, tight)
    taken = [_taken(course, cutcom, shown) for cutcom in course.cutcoms]
    _tell_undecided(course, taken, tight)
    offsets = []
    for cutcom, how, axis in zip(course.cutcoms, taken, normal, strict=True):
        plane = int(np.argmax(np.abs(axis)))
        distance = _distance(course, cutcom, how)
        left = distance * cutcom.side * np.sign(axis[plane])
        offsets.append(Offset(cutcom.row, float(left) + 0.0, plane, how.points == CENTRE and distance < 0))
    return offsets, _told(course, taken)


def _normals(course: Course, points: Points, frames: Array) -> Array:
    """Normals of the compensation planes, (C, 3): of the named plane, else the tool axis at the next point."""
    nexts = np.searchsorted(points.row, [cutcom.row for cutcom in course.cutcoms])
    nexts = np.minimum(nexts, len(points.row) - 1)
    normal = points.axis[nexts]
    turn = frames[nexts] if len(frames) > 1 else np.broadcast_to(frames[0], (len(nexts), 4, 4))
    for index, cutcom in enumerate(course.cutcoms):
        if cutcom.plane is not None:
            normal[index] = turn[index, :3, cutcom.plane]
    return normal


def _tight_arcs(course: Course, points: Points, arcs: Fitted, normal: Array) -> dict[_Cutter, _Tight]:
    """By cutter, the arcs under its CUTCOMs that are tighter than its radius."""
    row = points.row[arcs.point]
    owner = in_force(row, [cutcom.row for cutcom in course.cutcoms])
    mine = np.flatnonzero(owner >= 0)
    owner, end = owner[mine], arcs.point[mine]
    side = np.array([cutcom.side for cutcom in course.cutcoms])[owner]
    size = np.array([cutcom.radius for cutcom in course.cutcoms])[owner]
    radius = norm(across(points.position[end - 1] - arcs.centre[mine], arcs.axis[mine]))
    bend = side * dot(arcs.axis[mine], normal[owner])
    found: dict[_Cutter, _Tight] = {}
    for index in np.flatnonzero((radius < size - _TIGHTER) & (np.abs(bend) > 0.5)).tolist():
        one = found.setdefault(_cutter(course.cutcoms[owner[index]]), _Tight())
        (one.towards if bend[index] > 0 else one.away).append((int(points.row[end[index]]), float(radius[index])))
    return found


def _cutter(cutcom: Cutcom) -> _Cutter:
    return cutcom.tool, cutcom.radius


def _shown_by_arcs(course: Course, tight: dict[_Cutter, _Tight]) -> dict[_Cutter, _Taken]:
    """By cutter, the evidence of its arcs, if conclusive in this dialect."""
    if not course.dialect.tight_arcs_are_centre:
        return {}
    return {
        cutter: _Taken(CENTRE, _shown(course, arcs.towards, "bend towards it", cutter[1]), by_arcs=True)
        for cutter, arcs in tight.items()
        if arcs.towards and not arcs.away
    }


def _taken(course: Course, cutcom: Cutcom, shown: dict[_Cutter, _Taken]) -> _Taken:
    """Interpretation of the points of a CUTCOM."""
    if not cutcom.side:
        return _Taken()
    if course.options.contour_data is not None:
        return _Taken(course.options.contour_data, "as the option says")
    if cutcom.said is not None:
        return _Taken(cutcom.said.points, f"as {cutcom.said.words} says")
    return shown.get(_cutter(cutcom), _Taken())


def _distance(course: Course, cutcom: Cutcom, how: _Taken) -> float:
    """Offset of the tool from the points, to the side of the CUTCOM, mm."""
    if how.points == CONTOUR and not cutcom.radius:
        course.tell("L403", cutcom.row, "compensation for a cutter of unknown diameter")
    radius = cutcom.radius if how.points == CONTOUR else 0.0
    return radius + course.options.wear.get(cutcom.tool, 0.0)


def _told(course: Course, taken: list[_Taken]) -> list[str]:
    """Describe how points were interpreted; a guess also gives a warning."""
    rows: dict[_Taken, list[int]] = {}
    for cutcom, how in zip(course.cutcoms, taken, strict=True):
        if how.points:
            rows.setdefault(how, []).append(cutcom.row)
    for how, mine in rows.items():
        if how.by_arcs:
            course.tell("L430", mine[0], how.evidence)
    return [
        f"{_lines(course, mine)}: points are {_IN_WORDS[how.points]}, {'since ' * how.by_arcs}{how.evidence}"
        for how, mine in rows.items()
    ]


def _lines(course: Course, rows: list[int]) -> str:
    """Name CUTCOMs by the line of the first one."""
    others = f" and {len(rows) - 1} more" if len(rows) > 1 else ""
    return f"CUTCOM in line {course.statements.place(rows[0])[0]}{others}"


def _tell_undecided(course: Course, taken: list[_Taken], tight: dict[_Cutter, _Tight]) -> None:
    """Report each cutter with ambiguous CUTCOMs, with the evidence of its arcs."""
    by_cutter: dict[_Cutter, list[Cutcom]] = {}
    for cutcom, how in zip(course.cutcoms, taken, strict=True):
        if cutcom.side and not how.points:
            by_cutter.setdefault(_cutter(cutcom), []).append(cutcom)
    for (tool, radius), mine in by_cutter.items():
        arcs = tight.get((tool, radius), _Tight())
        hints = [f"{_lines(course, [cutcom.row for cutcom in mine])} with T{tool}"]
        if arcs.towards:
            hints.append(f"{_shown(course, arcs.towards, 'bend towards it', radius)}, as the centre may")
        if arcs.away:
            hints.append(f"{_shown(course, arcs.away, 'bend away from it', radius)}, as a contour may")
        course.tell("L429", mine[0].row, "; ".join(hints))


def _shown(course: Course, arcs: list[tuple[int, float]], how: str, radius: float) -> str:
    row, tightest = min(arcs, key=lambda arc: arc[1])
    line = course.statements.place(row)[0]
    shown = f"{len(arcs)} arcs {how} and are tighter than its radius of {radius:g} mm"
    return f"{shown}, down to {tightest:.4g} mm in line {line}"


def _tell_unused_wear(course: Course) -> None:
    """Report wear of tools without compensation: it has no effect."""
    used = {cutcom.tool for cutcom in course.cutcoms if cutcom.side}
    for number in sorted(set(course.options.wear) - used):
        known = ", ".join(f"T{tool}" for tool in sorted(used)) or "no tool"
        course.faults.add("L432", (0, 0), f"T{number}, CUTCOM is for {known}")
