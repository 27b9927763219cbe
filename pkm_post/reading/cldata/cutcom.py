# SPDX-License-Identifier: LGPL-2.1-or-later
"""CUTCOM: start and end of cutter compensation, and the meaning of the points there according to the file.

Input: statements and comments. Output: records in the state, evaluated once all points are known: see
``contour_data``.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from itertools import pairwise

import numpy as np

from pkm_post.geometry import across, dot, norm
from pkm_post.model import Array
from pkm_post.reading.cldata.arcs import Arcs
from pkm_post.reading.cldata.points import Points, active_index
from pkm_post.reading.cldata.state import Cutcom, PointMeaning, ReaderState
from pkm_post.reading.cldata.statements import Statement

_CENTRE, _CONTOUR = "centre", "contour"
_IN_WORDS = {_CENTRE: "the centre of the tool", _CONTOUR: "the contour of the part"}
_TIGHTER = 0.01
"""mm by which an arc radius must be below the tool radius to count: arcs of equal radius are no evidence."""

_ALIGNED = 1e-6
"""Cosine by which a plane may be off one between coordinates, or across the tool axis."""

_SIDES = {"LEFT": 1.0, "RIGHT": -1.0}
PLANES = {"XYPLAN": 2, "ZXPLAN": 1, "YZPLAN": 0}
_REGISTERS = {"ADJUST", "LENGTH", "OSETNO"}
"""Words before the number of an offset register of the control, which does not affect the path."""
_OTHER_OFFSETS = {"ADJUST", "LENGTH"}
"""Words of fixture offset and tool length: ON and OFF with them are not those of the side."""
_KNOWN = {*_SIDES, *PLANES, *_REGISTERS, "OFF", "ON", "PLANE"}
_GEOMETRY_TYPES = {"OUTPUT_ON_CENTER": "centre", "OUTPUT_ON_PROFILE": "contour"}
_HEADERS = {"CENTRE": "centerline data", "CONTOUR": "contact contour data"}


def cutcom(state: ReaderState, row: int, statement: Statement) -> None:
    """CUTCOM/LEFT or RIGHT[,plane][,register], CUTCOM/OFF; CUTCOM/ON the last side; with ADJUST or LENGTH no side."""
    words = statement.words
    sides = [_SIDES[word] for word in words if word in _SIDES]
    planes = {PLANES[word] for word in words if word in PLANES}
    contradict = len(sides) > 1 or len(planes) > 1 or ("OFF" in words and bool(sides or "ON" in words))
    no_register = any(number < 0 or number != round(number) for number in statement.numbers)
    no_register |= any(isinstance(one, float) and isinstance(other, float) for one, other in pairwise(statement.items))
    if not words or not set(words) <= _KNOWN or contradict or no_register:
        state.report("L401", row, f"CUTCOM/{statement.items_text()}")
    elif sides:
        _record(state, row, sides[0], next(iter(planes), None))
    elif not set(words) & _OTHER_OFFSETS:
        _on_or_off(state, row, statement)


def _on_or_off(state: ReaderState, row: int, statement: Statement) -> None:
    """OFF ends the side in force; ON after OFF takes the last one up again [NCCS PostWorks]."""
    last = next((each for each in reversed(state.cutcoms) if each.side), None)
    if "OFF" in statement.words:
        _record(state, row, 0.0, None)
    elif "ON" in statement.words and last is not None:
        if not state.cutcoms[-1].side:
            _record(state, row, last.side, last.plane)
    elif "ON" in statement.words and state.statements.word(min(row + 1, len(state.statements) - 1)) != "CUTCOM":
        state.report("L401", row, f"CUTCOM/{statement.items_text()} before any LEFT or RIGHT")


def _record(state: ReaderState, row: int, side: float, plane: int | None) -> None:
    state.cutcoms.append(Cutcom(row, row, side, plane, state.tool, _radius(state), state.point_meaning))


def cutcom_with_new_tool(state: ReaderState, row: int) -> None:
    """Compensation in force goes on with the tool and the radius from here on."""
    last = state.cutcoms[-1] if state.cutcoms else None
    if last is None or not last.side or _cutter(last) == (state.tool, _radius(state)):
        return
    if state.motions_before(row) == state.motions_before(last.row):
        state.cutcoms.pop()
    state.cutcoms.append(replace(last, row=row, tool=state.tool, radius=_radius(state)))


def _radius(state: ReaderState) -> float:
    """Radius of the active tool: from the user, else from the file."""
    given = state.options.tools.get(state.tool)
    return (given.diameter if given and given.diameter > 0 else state.diameter) / 2


def geometry_type(state: ReaderState, row: int, statement: Statement) -> None:
    """CUTCOM_GEOMETRY_TYPE/OUTPUT_ON_CENTER or OUTPUT_ON_PROFILE, a comment of Creo."""
    kind = next((word for word in statement.words if word in _GEOMETRY_TYPES), None)
    state.point_meaning = PointMeaning(_GEOMETRY_TYPES[kind], kind) if kind else None


def points_comment(state: ReaderState, row: int, statement: Statement) -> None:
    """The comments ``$$ centerline data`` and ``$$ contact contour data`` in the header of a tool path of NX."""
    kind = next((word for word in statement.words if word in _HEADERS), "")
    if kind:
        state.point_meaning = PointMeaning(kind.lower(), f"$$ {_HEADERS[kind]}")


@dataclass(frozen=True)
class Offset:
    """Compensation of the rows after a statement.

    Attributes:
        row: the statement.
        offset: mm to the left, 0 for none.
        plane: the coordinate normal to the plane.
        smaller_tool: the points are the centre path of a larger tool.
    """

    row: int
    offset: float
    plane: int
    smaller_tool: bool


@dataclass(frozen=True)
class _Interpretation:
    """Meaning of the points of a CUTCOM, empty if unknown, its evidence, and whether that is only the arcs."""

    points: str = ""
    evidence: str = ""
    by_arcs: bool = False


_Cutter = tuple[int, float]
"""Tool number and radius."""


@dataclass
class _TightArcs:
    """The arcs of one cutter that are tighter than its radius: their statements and radii."""

    towards: list[tuple[int, float]] = field(default_factory=list)
    away: list[tuple[int, float]] = field(default_factory=list)


def cutcom_offsets(state: ReaderState, points: Points, frames: Array, arcs: Arcs) -> tuple[list[Offset], list[str]]:
    """The offset of each CUTCOM, and a description of the interpretation of its points.

    ``frames``, (P, 4, 4) or (1, 4, 4), transform the resolved points to the work frame.
    """
    _report_unused_wear(state)
    normal = _normals(state, points, frames)
    tight = _tight_arcs(state, points, arcs, normal)
    by_arcs = _interpretations_by_arcs(state, tight)
    interpretations = [_interpretation(state, cutcom, by_arcs) for cutcom in state.cutcoms]
    _report_undecided(state, interpretations, tight)
    offsets = []
    for cutcom, interpretation, axis in zip(state.cutcoms, interpretations, normal, strict=True):
        plane = int(np.argmax(np.abs(axis)))
        distance = _distance(state, cutcom, interpretation)
        if distance and cutcom.side:
            _report_oblique_plane(state, cutcom, axis, points.axis[_next_points(points, [cutcom.row])[0]])
        left = distance * cutcom.side * np.sign(axis[plane])
        smaller_tool = interpretation.points == _CENTRE and distance < 0
        offsets.append(Offset(cutcom.row, float(left) + 0.0, plane, smaller_tool))
    return offsets, _descriptions(state, interpretations)


def _normals(state: ReaderState, points: Points, frames: Array) -> Array:
    """Normals of the compensation planes, (C, 3), towards the holder: of the named plane, else the next tool axis."""
    nexts = _next_points(points, [cutcom.row for cutcom in state.cutcoms])
    normal = points.axis[nexts]
    turn = frames[nexts] if len(frames) > 1 else np.broadcast_to(frames[0], (len(nexts), 4, 4))
    for index, cutcom in enumerate(state.cutcoms):
        if cutcom.plane is not None:
            named, tool_axis = turn[index, :3, cutcom.plane], normal[index]
            normal[index] = -named if named @ tool_axis < -_ALIGNED else named
    return normal


def _next_points(points: Points, rows: list[int]) -> Array:
    """Indices of the points behind some statements."""
    return np.minimum(np.searchsorted(points.row, rows), len(points.row) - 1)


def _report_oblique_plane(state: ReaderState, cutcom: Cutcom, normal: Array, tool_axis: Array) -> None:
    """Report a named plane that a frame has turned out of all planes in which paths are offset.

    ``normal`` is that of the plane, ``tool_axis`` that at the next point, (3,) each.
    """
    if max(np.abs(normal).max(), abs(normal @ tool_axis)) < 1 - _ALIGNED:
        found = f"{normal[0]:.4f},{normal[1]:.4f},{normal[2]:.4f}"
        state.report("L401", cutcom.written, f"CUTCOM in a plane that a frame has turned, with the normal {found}")


def _tight_arcs(state: ReaderState, points: Points, arcs: Arcs, normal: Array) -> dict[_Cutter, _TightArcs]:
    """By cutter, the arcs under its CUTCOMs that are tighter than its radius."""
    row = points.row[arcs.point]
    owner = active_index(row, [cutcom.row for cutcom in state.cutcoms])
    mine = np.flatnonzero(owner >= 0)
    owner, end = owner[mine], arcs.point[mine]
    side = np.array([cutcom.side for cutcom in state.cutcoms])[owner]
    size = np.array([cutcom.radius for cutcom in state.cutcoms])[owner]
    radius = norm(across(points.position[end - 1] - arcs.centre[mine], arcs.axis[mine]))
    bend = side * dot(arcs.axis[mine], normal[owner])
    tight: dict[_Cutter, _TightArcs] = {}
    for index in np.flatnonzero((radius < size - _TIGHTER) & (np.abs(bend) > 0.5)).tolist():
        of_cutter = tight.setdefault(_cutter(state.cutcoms[owner[index]]), _TightArcs())
        bending = of_cutter.towards if bend[index] > 0 else of_cutter.away
        bending.append((int(points.row[end[index]]), float(radius[index])))
    return tight


def _cutter(cutcom: Cutcom) -> _Cutter:
    return cutcom.tool, cutcom.radius


def _interpretations_by_arcs(state: ReaderState, tight: dict[_Cutter, _TightArcs]) -> dict[_Cutter, _Interpretation]:
    """By cutter, the evidence of its arcs, if conclusive in this dialect."""
    if not state.dialect.tight_arcs_are_centre:
        return {}
    return {
        cutter: _Interpretation(_CENTRE, _tightest_arc(state, arcs.towards, "bend towards it", cutter[1]), by_arcs=True)
        for cutter, arcs in tight.items()
        if arcs.towards and not arcs.away
    }


def _interpretation(state: ReaderState, cutcom: Cutcom, by_arcs: dict[_Cutter, _Interpretation]) -> _Interpretation:
    """Interpretation of the points of a CUTCOM."""
    if not cutcom.side:
        return _Interpretation()
    if state.options.contour_data is not None:
        return _Interpretation(state.options.contour_data, "as the option says")
    if cutcom.point_meaning is not None:
        return _Interpretation(cutcom.point_meaning.points, f"as {cutcom.point_meaning.words} says")
    return by_arcs.get(_cutter(cutcom), _Interpretation())


def _distance(state: ReaderState, cutcom: Cutcom, interpretation: _Interpretation) -> float:
    """Offset of the tool from the points, to the side of the CUTCOM, mm."""
    is_contour = interpretation.points == _CONTOUR
    if is_contour and not cutcom.radius:
        state.report("L403", cutcom.written, "compensation for a cutter of unknown diameter")
    radius = cutcom.radius if is_contour else 0.0
    return radius + state.options.wear.get(cutcom.tool, 0.0)


def _descriptions(state: ReaderState, interpretations: list[_Interpretation]) -> list[str]:
    """Describe the interpretation of the points; a guess also gives a warning."""
    rows: dict[_Interpretation, list[int]] = {}
    for cutcom, interpretation in zip(state.cutcoms, interpretations, strict=True):
        if interpretation.points:
            rows.setdefault(interpretation, []).append(cutcom.written)
    descriptions = []
    for interpretation, mine in rows.items():
        if interpretation.by_arcs:
            state.report("L430", mine[0], interpretation.evidence)
        evidence = f"{'since ' * interpretation.by_arcs}{interpretation.evidence}"
        descriptions.append(f"{_cutcom_lines(state, mine)}: points are {_IN_WORDS[interpretation.points]}, {evidence}")
    return descriptions


def _cutcom_lines(state: ReaderState, rows: list[int]) -> str:
    """Name CUTCOMs by the line of the first one."""
    others = f" and {len(rows) - 1} more" if len(rows) > 1 else ""
    return f"CUTCOM in line {state.statements.place(rows[0])[0]}{others}"


def _report_undecided(
    state: ReaderState, interpretations: list[_Interpretation], tight: dict[_Cutter, _TightArcs]
) -> None:
    """Report each cutter with ambiguous CUTCOMs, with the evidence of its arcs."""
    by_cutter: dict[_Cutter, list[Cutcom]] = {}
    for cutcom, interpretation in zip(state.cutcoms, interpretations, strict=True):
        if cutcom.side and not interpretation.points:
            by_cutter.setdefault(_cutter(cutcom), []).append(cutcom)
    for (tool, radius), mine in by_cutter.items():
        arcs = tight.get((tool, radius), _TightArcs())
        hints = [f"{_cutcom_lines(state, [cutcom.written for cutcom in mine])} with T{tool}"]
        if arcs.towards:
            hints.append(f"{_tightest_arc(state, arcs.towards, 'bend towards it', radius)}, as the centre may")
        if arcs.away:
            hints.append(f"{_tightest_arc(state, arcs.away, 'bend away from it', radius)}, as a contour may")
        state.report("L429", mine[0].written, "; ".join(hints))


def _tightest_arc(state: ReaderState, arcs: list[tuple[int, float]], bend: str, radius: float) -> str:
    row, tightest = min(arcs, key=lambda arc: arc[1])
    line = state.statements.place(row)[0]
    arcs_text = f"{len(arcs)} arcs {bend} and are tighter than its radius of {radius:g} mm"
    return f"{arcs_text}, down to {tightest:.4g} mm in line {line}"


def _report_unused_wear(state: ReaderState) -> None:
    """Report wear of tools without compensation: it has no effect."""
    used = {cutcom.tool for cutcom in state.cutcoms if cutcom.side}
    for number in sorted(set(state.options.wear) - used):
        known = ", ".join(f"T{tool}" for tool in sorted(used)) or "no tool"
        state.faults.add("L432", (0, 0), f"T{number}, CUTCOM is for {known}")
