# SPDX-License-Identifier: LGPL-2.1-or-later
"""Arc statements. docs/cl-data.md lists the forms.

Input: a statement. Output: an arc, as written, and its end point if the statement has one. CIRCLE, CYLNDR and MOVARC
end at the next point; ARCDAT with ARCMOV, GOCLW and GOCCLW, CW and CCW, and HELICAL have their own end point. Clockwise
is as seen against the written axis (ARCMOV), or against the tool axis, from the holder to the tip (the others).
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from pkm_post.geometry import arc_sweep, cross, dot, norm
from pkm_post.model import Array
from pkm_post.reading.cldata.points import NO_DIRECTION, tool_position
from pkm_post.reading.cldata.state import Arc, ArcData, Point, ReaderState, Vector
from pkm_post.reading.cldata.statements import Statement

MAX_TURNS = 10000
WARNED_DEVIATION = 5e-4
"""mm by which start and end radius may differ without a warning: files have at least four decimals."""
MAX_DEVIATION = 0.05
"""mm by which they may differ with a warning."""
COINCIDENT = 1e-3
"""mm below which two points of a circle coincide: one digit above the rounding of files with four decimals."""

_MOVARC = {"CENTER": 3, "AXIS": 3, "RADIUS": 1, "ANGLE": 1}
_COUNTS = {"CIRCLE": (6, 7, 11), "CYLNDR": (7,)}
_SENSES = {"CLW": -1.0, "CCLW": 1.0, "GOCLW": -1.0, "GOCCLW": 1.0, "CW": -1.0, "CCW": 1.0}
_PERPENDICULAR = 1e-6
"""Cosine below which a direction does not determine the sense of rotation."""


def circle(state: ReaderState, row: int, statement: Statement) -> None:
    """CIRCLE/x,y,z,i,j,k[,r[,t,f,d,e]][,TIMES,n], CYLNDR/x,y,z,i,j,k,r: the next GOTO is its end point."""
    items = list(statement.items)
    turns = 0.0
    if len(items) > 2 and items[-2] == "TIMES" and isinstance(items[-1], float):
        turns = items[-1] - 1
        del items[-2:]
    values = [item for item in items if isinstance(item, float)]
    counts = _COUNTS[statement.word]
    if len(values) != len(items) or len(values) not in counts:
        expected = ", ".join(map(str, counts[:-1])) + " or " if len(counts) > 1 else ""
        state.report_items(row, statement, f"{expected}{counts[-1]} values")
        return
    if not 0 <= turns <= MAX_TURNS or turns != int(turns):
        state.report("L403", row, f"TIMES,{turns + 1:g}")
        return
    radius = values[6] if len(values) > 6 else math.nan
    state.arcs.append((row, Arc(tuple(values[:3]), tuple(values[3:6]), radius, turns=int(turns))))


def commented_circle(state: ReaderState, row: int, statement: Statement) -> None:
    """$$ CIRCLE/x,y,z,i,j,k,r: the following points may lie on this circle."""
    values = statement.numbers
    if state.dialect.goto_continues and len(values) == 7 and math.hypot(*values[3:6]) > NO_DIRECTION and values[6] > 0:
        state.commented_circles.append((row, Arc(tuple(values[:3]), tuple(values[3:6]), values[6], minor=True)))


def movarc(state: ReaderState, row: int, statement: Statement) -> None:
    """MOVARC/x,y,z,i,j,k,r[,ANGLE,a] and MOVARC/CENTER,x,y,z,AXIS,i,j,k,RADIUS,r[,ANGLE,a]."""
    values = _values_by_word(statement)
    if values is None or not {"CENTER", "AXIS"} <= values.keys():
        state.report_items(row, statement, "x,y,z,i,j,k,r,ANGLE,a")
        return
    angle = math.radians(values["ANGLE"][0]) if "ANGLE" in values else math.nan
    if angle <= 0 or angle > 2 * math.pi * (1 + 1e-9):
        state.report("L401", row, f"MOVARC by {math.degrees(angle):g} degrees")
        return
    radius = values.get("RADIUS", (math.nan,))[0]
    rise, state.arc_rise = state.arc_rise or math.nan, 0.0
    state.arcs.append((row, Arc(values["CENTER"], values["AXIS"], radius, angle, rise=rise)))


def _values_by_word(statement: Statement) -> dict[str, Vector] | None:
    """The values by their preceding word; without words in the order centre, axis, radius."""
    items, by_word = list(statement.items), dict[str, list[float]]()
    if items and isinstance(items[0], float):
        items = ["CENTER", *items[:3], "AXIS", *items[3:6], "RADIUS", *items[6:]]
    for item in items:
        if isinstance(item, str) and item in _MOVARC and item not in by_word:
            by_word[item] = []
        elif isinstance(item, float) and by_word:
            by_word[next(reversed(by_word))].append(item)
        else:
            return None
    if any(len(values) != _MOVARC[name] for name, values in by_word.items()):
        return None
    return {name: tuple(values) for name, values in by_word.items()}


def arcslp(state: ReaderState, row: int, statement: Statement) -> None:
    """ARCSLP/depth directly before ARCDAT or MOVARC: the arc rises or falls by it; other uses are refused."""
    after = state.statements.word(row + 1) if row + 1 < len(state.statements) else ""
    if len(statement.values) != 1 or after not in ("ARCDAT", "MOVARC"):
        state.report("L401", row, f"ARCSLP/{statement.items_text()}, other than a depth before ARCDAT or MOVARC")
        return
    state.arc_rise = abs(statement.values[0])


def arcdat(state: ReaderState, row: int, statement: Statement) -> None:
    """ARCDAT/x,y,z,i,j,k,r: the circle of the next ARCMOV."""
    rise, state.arc_rise = state.arc_rise, 0.0
    values = state.expect_values(row, statement, 7)
    if values:
        report_unused_arcdat(state)
        state.arc_data = ArcData(row, Arc(tuple(values[:3]), tuple(values[3:6]), values[6]), rise)


def report_unused_arcdat(state: ReaderState) -> None:
    """Report an ARCDAT without ARCMOV."""
    if state.arc_data is not None:
        state.report("L414", state.arc_data.row, "ARCDAT")


def arcmov(state: ReaderState, row: int, statement: Statement) -> None:
    """ARCMOV/CLW or CCLW,x,y,z,angle: along the circle of ARCDAT to the point, by an angle in degrees."""
    data, state.arc_data = state.arc_data, None
    match statement.items:
        case ["CLW" | "CCLW" as word, float(x), float(y), float(z), float(angle)] if data is not None:
            start = tool_position(state, row, "ARCMOV")
            if start is not None:
                arc = replace(data.arc, sense=_SENSES[word])
                _arcmov(state, row, arc, data.rise, start, np.array([x, y, z]), math.radians(angle))
        case _:
            expected = "CLW or CCLW,x,y,z,angle after ARCDAT"
            state.report_items(row, statement, expected)


def _arcmov(state: ReaderState, row: int, arc: Arc, rise: float, start: Array, end: Array, angle: float) -> None:
    """Add an arc if its end point, angle and rise are consistent."""
    size = float(norm(np.array(arc.axis)))
    if size < NO_DIRECTION:
        state.report("L408", row, "an axis without direction")
        return
    axis = arc.sense * np.array(arc.axis) / size
    along = float((end - start) @ axis)
    if norm(end - start - along * axis) * state.scale < COINCIDENT:
        end = start + along * axis
    sweep = float(arc_sweep(start, end, np.array(arc.centre), axis))
    turns = round((angle - sweep) / (2 * math.pi))
    deviation = abs(angle - sweep - 2 * math.pi * turns) * arc.radius
    if not 0 <= turns <= MAX_TURNS or deviation * state.scale > MAX_DEVIATION:
        found = f"{math.degrees(angle):.6g} degrees as written, {math.degrees(sweep):.6g} to the end point"
        state.report("L408", row, found)
    elif abs(abs(along) - rise) * state.scale > MAX_DEVIATION:
        state.report("L408", row, f"it rises by {abs(along):.6g}, ARCSLP gives {rise:.6g}")
    else:
        add_arc(state, row, replace(arc, turns=turns), end)


def gocclw(state: ReaderState, row: int, statement: Statement) -> None:
    """GOCLW and GOCCLW/centre,axis,radius,end: 10 values."""
    values = state.expect_values(row, statement, 10)
    if values:
        arc = Arc(tuple(values[:3]), tuple(values[3:6]), values[6], sense=_SENSES[statement.word], seen_from_tool=True)
        add_arc(state, row, arc, np.array(values[7:]))


def ccw(state: ReaderState, row: int, statement: Statement) -> None:
    """CW and CCW/axis,start,centre,end,radius: 13 values."""
    values = state.expect_values(row, statement, 13)
    start = tool_position(state, row, statement.word) if values else None
    if start is None:
        return
    if norm(start - np.array(values[3:6])) * state.scale > MAX_DEVIATION:
        state.report("L408", row, f"{statement.word} does not start at the tool position")
        return
    arc = Arc(tuple(values[6:9]), tuple(values[:3]), values[12], sense=_SENSES[statement.word], seen_from_tool=True)
    add_arc(state, row, arc, np.array(values[9:12]))


def helical(state: ReaderState, row: int, statement: Statement) -> None:
    """HELICAL/centre, start tangent, axis, pitch, radius[, angle, height, turns], end: 14 or 17 values."""
    values = state.expect_values(row, statement, 14, 17)
    start = tool_position(state, row, "HELICAL") if values else None
    if start is None:
        return
    centre, tangent, axis = np.reshape(values[:9], (3, 3))
    end = np.array(values[-3:])
    size = float(norm(axis))
    sense = sense_of_rotation(tangent, axis, start - centre)
    if size < NO_DIRECTION or not sense:
        state.report("L408", row, "HELICAL: its tangent and axis do not give the sense of rotation")
        return
    pitches = abs(float((end - start) @ axis) / (size * values[9])) if values[9] else 0.0
    sweep = float(arc_sweep(start, end, centre, sense * axis / size))
    turns = max(pitches - sweep / (2 * math.pi), 0.0)
    if turns > MAX_TURNS:
        state.report("L403", row, f"{turns:g} turns")
        return
    add_arc(state, row, Arc(tuple(values[:3]), tuple(values[6:9]), values[10], sense=sense, turns=round(turns)), end)


def add_arc(state: ReaderState, row: int, arc: Arc, end: Array) -> None:
    """Record an arc with its end point."""
    state.arcs.append((row, arc))
    state.points.append((row, Point(tuple(end.tolist()))))


def sense_of_rotation(tangent: Array, axis: Array, radius: Array) -> float:
    """Sense of rotation about the axis of a direction at a point: 1 right-handed, -1 left-handed, 0 neither.

    ``tangent`` is the direction, ``radius`` leads from the centre to the point; all are (3,), of any length.
    """
    forward = cross(axis, radius)
    along = float(dot(tangent, forward))
    size = float(norm(tangent) * norm(forward))
    return float(np.sign(along)) if abs(along) > _PERPENDICULAR * size else 0.0
