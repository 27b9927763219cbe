# SPDX-License-Identifier: LGPL-2.1-or-later
"""Holes: the CYCLE statement, its items by name in any order.

A statement enters; what it says leaves as a cycle of the course, in mm and mm/s.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

from pkm_post.cldata.course import Course
from pkm_post.cldata.cycles import (
    CLEARANCE,
    DEPTH,
    FIRST_STEP,
    MOST_PECKS,
    NAMES,
    PECKS,
    RETURN,
    STEP,
    TAPPING,
    Cycle,
)
from pkm_post.cldata.feeds import FEED_WORDS, feed_of, shown
from pkm_post.cldata.statements import Statement


def cycle(course: Course, row: int, statement: Statement) -> None:
    """CYCLE/kind,items; INIT and CLEAR say where the tool returns to; ON and OFF."""
    kind = next(iter(statement.words), "")
    if kind == "OFF":
        course.cycles.append((row, None))
    elif kind == "ON" and course.cycle is not None:
        course.cycles.append((row, course.cycle))
    elif kind in ("INIT", "CLEAR") and len(statement.items) == 1:
        course.cycle_return = kind == "INIT"
    elif kind in TAPPING:
        course.tell("L440", row, f"CYCLE/{kind}")
    elif kind not in PECKS:
        course.tell("L401", row, f"CYCLE/{shown(statement)}")
    else:
        _start(course, row, statement, kind)


def _start(course: Course, row: int, statement: Statement, kind: str) -> None:
    """Take a cycle over, if it can be carried out."""
    values, unknown = _named(statement)
    if unknown:
        course.tell("L412", row, f"{unknown}, expected one of {', '.join(sorted(NAMES | FEED_WORDS))}")
        return
    found = _cycle(course, kind, values)
    wrong = _wrong(found)
    if wrong:
        course.tell("L412", row, f"CYCLE/{kind}: {wrong}")
        return
    course.cycle = found
    course.cycles.append((row, found))


def _named(statement: Statement) -> tuple[dict[str, float], str]:
    """The numbers by the word before them, a leading one as DEPTH; and the first item that is not understood."""
    values: dict[str, float] = {}
    name = "DEPTH"
    for item in statement.items[1:]:
        if isinstance(item, str) and item in NAMES | FEED_WORDS:
            name = item
        elif isinstance(item, float) and name not in values:
            values[name] = item
        elif item is not None:
            return values, f"{item:g}" if isinstance(item, float) else item if isinstance(item, str) else item.word
    return values, ""


def _cycle(course: Course, kind: str, values: Mapping[str, float]) -> Cycle:
    """The cycle that the values say; NaN where something is missing."""

    def length(names: tuple[str, ...], default: float) -> float:
        return next((abs(values[name]) * course.scale for name in names if name in values), default)

    clearance = length(CLEARANCE, math.nan)
    height = max(length(RETURN, clearance), clearance) if course.cycle_return else clearance
    unit = next((word for word in values if word in FEED_WORDS), None)
    current = course.feed_per_turn, course.feed
    feed = current[1] if unit is None else feed_of(course, unit, values[unit])
    course.feed_per_turn = current[0]
    pecks = PECKS[kind] != "none"
    return Cycle(
        kind=kind,
        depth=length(DEPTH, math.nan),
        clearance=clearance,
        height=height,
        step=length(STEP, math.nan) if pecks else 0.0,
        first_step=length(FIRST_STEP, 0.0) if pecks else 0.0,
        dwell=max(values.get("DWELL", 0.0), 0.0),
        feed=math.nan if feed is None or feed.inverse else feed.value,
    )


def _wrong(cycle: Cycle) -> str:
    """Why the cycle cannot be carried out, empty if it can."""
    names = {"depth": DEPTH, "clearance": CLEARANCE, "step": STEP}
    missing = [" or ".join(words) for field, words in names.items() if math.isnan(getattr(cycle, field))]
    if missing:
        return f"{', '.join(missing)} is missing"
    if not cycle.feed > 0:
        return "it has no feed in mm/min"
    if PECKS[cycle.kind] != "none" and not cycle.step * MOST_PECKS > cycle.depth:
        return f"the step is {cycle.step:g} mm"
    return ""
