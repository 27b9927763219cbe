# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tools: CUTTER, TLDATA, LOADTL, LOAD/TOOL and TOOLNO.

Enters: statements. Leaves: tools and tool changes, in mm. Dialects define the cutter before or after the change, so a
tool is final at the first motion after both.
"""

from __future__ import annotations

import math
from dataclasses import replace

from pkm_post.model import EventKind, Tool, angles_fit, corner_reach, largest_corner
from pkm_post.reading.cldata.feeds import shown
from pkm_post.reading.cldata.state import Course
from pkm_post.reading.cldata.statements import Statement

_TOUCHING = 2e-3
"""Tolerance in mm of e and f from those of a tangent corner: files round to three decimals."""


def cutter(course: Course, row: int, statement: Statement) -> None:
    """CUTTER/d[,r[,e,f,a,b,h]], angles in degrees; e and f follow from the others."""
    numbers = statement.numbers
    if not numbers or statement.words:
        course.tell("L402", row, f"CUTTER/{shown(statement)}, expected d[,r[,e,f,a,b,h]]")
        return
    d, r, e, f, a, b = _filled(numbers, 6)
    if not _new_cutter(course, row, d, r, a, b):
        return
    course.corner_known = len(numbers) > 1
    if len(numbers) >= 4:
        _check_corner(course, row, e * course.scale, f * course.scale)


def tldata(course: Course, row: int, statement: Statement) -> None:
    """TLDATA/MILL,d,r,length,taper,tip,... and TLDATA/DRILL,MILL,d,...: only the diameter of the latter."""
    numbers = statement.numbers
    if not numbers:
        course.tell("L402", row, f"TLDATA/{shown(statement)}, expected a diameter")
        return
    told = numbers[:1] if "DRILL" in statement.words else numbers
    d, r, _, taper, tip = _filled(told, 5)
    if _new_cutter(course, row, d, r, tip, taper):
        course.corner_known = len(told) > 1


def _check_corner(course: Course, row: int, e: float, f: float) -> None:
    """Report e or f that does not belong to the corner tangent to bottom and side."""
    a, b, r = course.bottom_angle, course.side_angle, course.corner
    touching_e = course.diameter / 2 - r * corner_reach(a, b)
    touching_f = touching_e * math.tan(a) + r / math.cos(a)
    if abs(e - touching_e) > _TOUCHING or abs(f - touching_f) > _TOUCHING:
        found = f"e {e:g} mm, f {f:g} mm; touching are e {touching_e:.6g} mm, f {touching_f:.6g} mm"
        course.tell("L418", row, found)


def _filled(numbers: list[float], count: int) -> tuple[float, ...]:
    """The first numbers of a statement, 0 for missing ones."""
    return (*numbers[:count], *(0.0,) * (count - len(numbers)))


def _new_cutter(course: Course, row: int, diameter: float, corner: float, bottom: float, side: float) -> bool:
    """Whether the cutter is possible; if so, it becomes the active one."""
    diameter, corner = diameter * course.scale, corner * course.scale
    bottom_angle, side_angle = math.radians(bottom), math.radians(side)
    if not angles_fit(bottom_angle, side_angle):
        course.tell("L403", row, f"bottom angle {bottom:g} degrees, side angle {side:g} degrees")
        return False
    largest = largest_corner(diameter, bottom_angle, side_angle)
    if diameter < 0 or not 0 <= corner <= largest + 1e-3:
        course.tell("L403", row, f"diameter {diameter:g} mm, corner radius {corner:g} mm")
        return False
    settle(course, row)
    course.diameter, course.corner = diameter, min(corner, largest)
    course.bottom_angle, course.side_angle = bottom_angle, side_angle
    course.tool_name = course.insert
    return True


def load(course: Course, row: int, statement: Statement) -> None:
    """LOADTL/n[,LENGTH,l], LOAD/TOOL,n and TOOLNO/n: a tool change; only one if two of them occur."""
    items = statement.items
    if statement.word == "LOAD" and items[:1] != ("TOOL",):
        course.tell("L401", row, f"LOAD/{shown(statement)}")
        return
    number = next(iter(items[1:] if statement.word == "LOAD" else items), None)
    if not isinstance(number, float) or number != int(number) or not 0 <= number < 2**31:
        course.tell("L402", row, f"{statement.word}/{shown(statement)}, expected the number of a tool")
        return
    settle(course, row)
    length = _after(statement, "LENGTH") * course.scale
    if int(number) == course.tool_changed and course.motions_settled == course.motions_at_change:
        course.length = length or course.length
        return
    course.tool = course.tool_changed = int(number)
    course.motions_at_change = course.motions_settled
    course.length = length
    if course.tool not in course.tools:
        keep(course)
    course.events.append((row, EventKind.TOOL_CHANGE, float(course.tool)))


def _after(statement: Statement, word: str) -> float:
    """The number after a word, 0 if absent."""
    for name, value in zip(statement.items, statement.items[1:], strict=False):
        if name == word and isinstance(value, float):
            return value
    return 0.0


def insert(course: Course, row: int, statement: Statement) -> None:
    """INSERT/text: in SolidWorks the tool name before its CUTTER; elsewhere text for the NC program."""
    if course.dialect.insert_is_tool:
        course.insert = statement.text


def settle(course: Course, row: int) -> None:
    """Record the active tool if there were motions since its last change."""
    motions = int(course.gotos_before[row]) + sum(not point.start for _, point in course.points)
    if motions != course.motions_settled:
        course.motions_settled = motions
        keep(course)


def keep(course: Course) -> None:
    """Record the tool as currently known."""
    stands_for = course.options.default_tool
    given = course.options.tools.get(course.tool)
    length = course.length or (stands_for.length if stands_for else 0.0)
    shape = (course.diameter, course.corner, length, course.bottom_angle, course.side_angle)
    known = Tool(course.tool, course.tool_name, *shape, course.corner_known)
    if given is not None:
        known = replace(given, name=given.name or known.name, length=given.length or known.length)
    course.tools[course.tool] = known
