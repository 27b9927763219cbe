# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tools: CUTTER, TLDATA, LOADTL, LOAD/TOOL and TOOLNO.

Input: statements. Output: tools and tool changes, in mm. Dialects define the cutter before or after the change, so a
tool is final at the first motion after both.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import replace

from pkm_post.model import EventKind, Tool, corner_reach, largest_corner_radius, valid_cutter_angles
from pkm_post.reading.cldata.cutcom import cutcom_with_new_tool
from pkm_post.reading.cldata.feeds import resolve_surface_speed
from pkm_post.reading.cldata.state import ReaderState
from pkm_post.reading.cldata.statements import Statement

_TANGENT_TOLERANCE = 2e-3
"""Tolerance in mm of e and f from those of a tangent corner: files round to three decimals."""

_CUTTER_VALUES = 7
"""Values of CUTTER."""

_OTHER_PROCESSES = frozenset({"TURN", "GROOVE", "THREAD", "WEDM"})
"""Tools of TLDATA whose first number is no diameter of a cutter."""


def cutter(state: ReaderState, row: int, statement: Statement) -> None:
    """CUTTER/d[,r[,e,f,a,b,h]], angles in degrees; e and f follow from the others."""
    if statement.items[:1] == ("DISPLY",):  # display setting of NCL
        return
    numbers = statement.values
    if not 0 < len(numbers) <= _CUTTER_VALUES:
        state.report_items(row, statement, "d[,r[,e,f,a,b,h]]")
        return
    d, r, e, f, a, b = _padded(numbers, 6)
    if not _new_cutter(state, row, d, r, a, b):
        return
    state.corner_known = len(numbers) > 1
    if len(numbers) >= 4:
        _check_corner(state, row, e * state.scale, f * state.scale)


def tldata(state: ReaderState, row: int, statement: Statement) -> None:
    """TLDATA/MILL,d,r,length,taper,tip,...; of TLDATA/DRILL,[MILL,]d,r,length,point,... diameter and point angle.

    Of other tools of milling, such as BARREL, only the diameter is known; those of other processes are refused.
    """
    numbers, kind = statement.numbers, next(iter(statement.words), "MILL")
    if kind in _OTHER_PROCESSES:
        state.report("L401", row, f"TLDATA/{kind}, no tool of milling")
        return
    if not numbers:
        state.report_items(row, statement, "a diameter")
        return
    given = numbers if kind == "MILL" else numbers[:1]
    d, r, _, taper, tip = _padded(given, 5)
    if _new_cutter(state, row, d, r, tip, taper):
        state.corner_known = len(given) > 1
        if "DRILL" in statement.words and len(numbers) > 3 and 0 < numbers[3] < 180:
            state.point_angle = math.radians(numbers[3])


def _check_corner(state: ReaderState, row: int, e: float, f: float) -> None:
    """Report e or f that does not match the corner tangent to bottom and side."""
    a, b, r = state.bottom_angle, state.side_angle, state.corner_radius
    tangent_e = state.diameter / 2 - r * corner_reach(a, b)
    tangent_f = tangent_e * math.tan(a) + r / math.cos(a)
    if abs(e - tangent_e) > _TANGENT_TOLERANCE or abs(f - tangent_f) > _TANGENT_TOLERANCE:
        found = f"e {e:g} mm, f {f:g} mm; tangent are e {tangent_e:.6g} mm, f {tangent_f:.6g} mm"
        state.report("L418", row, found)


def _padded(numbers: list[float], count: int) -> tuple[float, ...]:
    """The first numbers of a statement, 0 for missing ones."""
    return (*numbers[:count], *(0.0,) * (count - len(numbers)))


def _new_cutter(state: ReaderState, row: int, diameter: float, corner: float, bottom: float, side: float) -> bool:
    """Whether the cutter is possible; if so, it becomes the active one."""
    diameter, corner = diameter * state.scale, corner * state.scale
    bottom_angle, side_angle = math.radians(bottom), math.radians(side)
    if not valid_cutter_angles(bottom_angle, side_angle):
        state.report("L403", row, f"bottom angle {bottom:g} degrees, side angle {side:g} degrees")
        return False
    largest = largest_corner_radius(diameter, bottom_angle, side_angle)
    if diameter < 0 or not 0 <= corner <= largest + 1e-3:
        state.report("L403", row, f"diameter {diameter:g} mm, corner radius {corner:g} mm")
        return False
    record_tool_if_used(state, row)
    state.diameter, state.corner_radius = diameter, min(corner, largest)
    state.bottom_angle, state.side_angle = bottom_angle, side_angle
    state.point_angle = math.pi - 2 * bottom_angle if bottom_angle > 0 and not corner else 0.0
    state.tool_name = state.inserted_name
    resolve_surface_speed(state, row)
    cutcom_with_new_tool(state, row)
    return True


def load(state: ReaderState, row: int, statement: Statement) -> None:
    """LOADTL/n[,LENGTH,l], LOAD/TOOL,n and TOOLNO/n: a tool change; only one if two of them occur."""
    items = statement.items
    if statement.word == "LOAD" and items[:1] != ("TOOL",):
        state.report("L401", row, f"LOAD/{statement.items_text()}")
        return
    number = next(iter(items[1:] if statement.word == "LOAD" else items), None)
    if not isinstance(number, float) or number != int(number) or not 0 <= number < 2**31:
        state.report_items(row, statement, "the number of a tool")
        return
    after = [item for name, item in itertools.pairwise((*items, None)) if name == "LENGTH"]
    if len(after) > 1 or not all(isinstance(item, float) for item in after):
        state.report_items(row, statement, "LENGTH once, and a number after it")
        return
    length = statement.number_after("LENGTH") * state.scale
    if length < 0:
        state.report("L403", row, f"{statement.word}: length {length:g} mm")
        return
    if length and "IN" in items:  # as HSMWorks writes it: the length of the tool below its holder
        state.report("L450", row, f"{statement.word}/{statement.items_text()}")
        length = 0.0
    record_tool_if_used(state, row)
    if int(number) == state.changed_tool and state.motions_recorded == state.motions_at_change:
        state.tool_length = length or state.tool_length
        return
    state.tool = state.changed_tool = int(number)
    state.motions_at_change = state.motions_recorded
    state.tool_length = length
    if state.tool not in state.tools:
        record_tool(state)
    cutcom_with_new_tool(state, row)
    state.events.append((row, EventKind.TOOL_CHANGE, float(state.tool)))


def insert(state: ReaderState, row: int, statement: Statement) -> None:
    """INSERT/text: in SolidWorks the tool name before its CUTTER; elsewhere text for the NC program."""
    if state.dialect.insert_is_tool:
        state.inserted_name = statement.text


def record_tool_if_used(state: ReaderState, row: int) -> None:
    """Record the active tool if there were motions since its last change."""
    motions = state.motions_before(row)
    if motions != state.motions_recorded:
        state.motions_recorded = motions
        state.used_cutters.setdefault(state.tool, set()).add(_shape(state))
        record_tool(state)


def _shape(state: ReaderState) -> tuple[float, float, float, float]:
    return state.diameter, state.corner_radius, state.bottom_angle, state.side_angle


def record_tool(state: ReaderState) -> None:
    """Record the tool as currently known; a tool change without a length keeps the previous one of the tool."""
    default = state.options.default_tool
    given = state.options.tools.get(state.tool)
    stated = state.stated_lengths.setdefault(state.tool, [])
    if state.tool_length and state.tool_length not in stated:
        stated.append(state.tool_length)
    length = stated[-1] if stated else default.length if default else 0.0
    diameter, corner, bottom, side = _shape(state)
    known = Tool(state.tool, state.tool_name, diameter, corner, length, bottom, side, state.corner_known)
    if given is not None:
        known = replace(given, name=given.name or known.name, length=given.length or known.length)
    state.tools[state.tool] = known
