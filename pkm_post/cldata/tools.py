# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tools: CUTTER, TLDATA, LOADTL, LOAD/TOOL, TOOLNO, and CUTCOM, which needs the tool's radius.

Statements enter; tools, tool changes and side offsets leave, in mm. Dialects give the cutter before or after
the change, so a tool is known for what it is at the first motion behind both.
"""

from __future__ import annotations

from pkm_post.cldata.course import Course
from pkm_post.cldata.feeds import shown
from pkm_post.cldata.statements import Statement
from pkm_post.model import EventKind, Tool

_PLANES = {"XYPLAN": 2, "ZXPLAN": 1, "YZPLAN": 0}
_SIDES = {"LEFT": 1.0, "RIGHT": -1.0}


def cutter(course: Course, row: int, statement: Statement) -> None:
    """CUTTER/d[,r[,e,f,a,b,h]]."""
    numbers = statement.numbers
    if not numbers or statement.words:
        course.tell("L402", row, f"CUTTER/{shown(statement)}, expected d[,r[,e,f,a,b,h]]")
        return
    _new_cutter(course, row, numbers[0], numbers[1] if len(numbers) > 1 else 0.0)


def tldata(course: Course, row: int, statement: Statement) -> None:
    """TLDATA/MILL,d,r,length,... and TLDATA/DRILL,MILL,d,...: diameter and corner radius."""
    numbers = statement.numbers
    if not numbers:
        course.tell("L402", row, f"TLDATA/{shown(statement)}, expected a diameter")
        return
    corner = numbers[1] if len(numbers) > 1 and "DRILL" not in statement.words else 0.0
    _new_cutter(course, row, numbers[0], corner)


def _new_cutter(course: Course, row: int, diameter: float, corner: float) -> None:
    diameter, corner = diameter * course.scale, corner * course.scale
    if diameter < 0 or not 0 <= corner <= diameter / 2 + 1e-3:
        course.tell("L403", row, f"diameter {diameter:g} mm, corner radius {corner:g} mm")
        return
    settle(course, row)
    course.diameter, course.corner = diameter, min(corner, diameter / 2)
    course.tool_name = course.insert


def load(course: Course, row: int, statement: Statement) -> None:
    """LOADTL/n[,LENGTH,l], LOAD/TOOL,n and TOOLNO/n: the tool is changed; once, if two of them say so."""
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
    """The number behind a word, 0 if there is none."""
    for name, value in zip(statement.items, statement.items[1:], strict=False):
        if name == word and isinstance(value, float):
            return value
    return 0.0


def insert(course: Course, row: int, statement: Statement) -> None:
    """INSERT/text: SolidWorks names the tool so before its CUTTER; others insert text into the NC program."""
    if course.dialect.insert_is_tool:
        course.insert = statement.text


def settle(course: Course, row: int) -> None:
    """Note the tool that was in use, if there were motions since the last change of anything about it."""
    motions = int(course.gotos_before[row]) + sum(not point.start for _, point in course.points)
    if motions != course.motions_settled:
        course.motions_settled = motions
        keep(course)


def keep(course: Course) -> None:
    """Note the tool as it is known now."""
    stands_for = course.options.default_tool
    given = course.options.tools.get(course.tool)
    length = course.length or (stands_for.length if stands_for else 0.0)
    known = Tool(course.tool, course.tool_name, course.diameter, course.corner, length)
    course.tools[course.tool] = given or known


def cutcom(course: Course, row: int, statement: Statement) -> None:
    """CUTCOM/LEFT or RIGHT[,plane][,n], CUTCOM/OFF; CUTCOM/ON keeps what is in force."""
    words = statement.words
    side = next((_SIDES[word] for word in words if word in _SIDES), 0.0)
    if not words or not set(words) <= {*_SIDES, *_PLANES, "OFF", "ON", "ADJUST", "LENGTH"}:
        course.tell("L401", row, f"CUTCOM/{shown(statement)}")
        return
    if not side and "OFF" not in words:
        return
    radius = 0.0 if course.on_centre else course.diameter / 2
    if side and not radius and not course.on_centre:
        course.tell("L403", row, "compensation for a cutter of unknown diameter")
    plane = next((_PLANES[word] for word in words if word in _PLANES), 2)
    course.sides.append((row, side * radius, plane))


def cutcom_geometry(course: Course, row: int, statement: Statement) -> None:
    """CUTCOM_GEOMETRY_TYPE/OUTPUT_ON_CENTER or OUTPUT_ON_PROFILE, a comment of Creo."""
    course.on_centre = "OUTPUT_ON_CENTER" in statement.words
