# SPDX-License-Identifier: LGPL-2.1-or-later
"""Holes: convert a CYCLE statement of any CAM system to a cycle.

Enters: a statement. Leaves: a cycle of the course, in mm and mm/s.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

from pkm_post.reading.cldata.course import Course
from pkm_post.reading.cldata.cycle_items import CycleError, CycleItems
from pkm_post.reading.cldata.cycle_words import (
    CAMWORKS,
    TAPPING,
    CycleWords,
    kind_of_some,
    words_by_use,
    words_of_dialect,
)
from pkm_post.reading.cldata.cycles import Cycle, Strokes
from pkm_post.reading.cldata.feeds import feed_of, shown
from pkm_post.reading.cldata.statements import Statement

MOST_PECKS = 10000
_RETURNS = ("INIT", "CLEAR")
"""CAMWorks: the tool returns to the height before the cycle, or RTRCTO if written, or to the clearance."""


def cycle(course: Course, row: int, statement: Statement) -> None:
    """CYCLE/kind,items; INIT and CLEAR set the return height; ON and OFF."""
    word = next(iter(statement.words), "")
    if word == "OFF":
        course.cycles.append((row, None))
    elif word == "ON" and course.cycle is not None:
        course.cycles.append((row, course.cycle))
    elif word in _RETURNS and len(statement.items) == 1 and words_of_dialect(course.dialect.name) in (None, CAMWORKS):
        course.cycle_return = word
    else:
        try:
            course.cycle, words = _understood(course, statement)
            course.cycles.append((row, course.cycle))
            course.cycles_read.setdefault(words, []).append(row)
        except CycleError as fault:
            course.tell(fault.code, row, fault.found)


def cycles_told(course: Course) -> list[str]:
    """Describe how the cycles of a file were interpreted: one line per CAM system."""
    told = []
    for words, rows in course.cycles_read.items():
        more = f" and {len(rows) - 1} more" if len(rows) > 1 else ""
        told.append(f"CYCLE in line {course.statements.place(rows[0])[0]}{more}: {words}")
    return told


def _understood(course: Course, statement: Statement) -> tuple[Cycle, str]:
    """The cycle of a statement, and a description of its interpretation."""
    ours = words_of_dialect(course.dialect.name)
    words = ours or words_by_use(statement.words)
    kind = _kind(statement, words, guessed=ours is None)
    items = CycleItems(words, kind, ours is None, course.options.cycle_values)
    items.read(statement.items[len(kind.split(",")) :])
    _check_signs(items)
    found = _cycle(course, words.kinds[kind], items)
    wrong = _wrong(found, words)
    if wrong:
        raise CycleError("L412", f"CYCLE/{kind}: {wrong}")
    return found, f"words of {words.maker}, {_evidence(course, ours is None, items)}"


def _evidence(course: Course, guessed: bool, items: CycleItems) -> str:
    """Why the words of a cycle are attributed to a CAM system."""
    by = "by themselves" if guessed else "as the option says" if course.options.dialect else "by the dialect"
    numbers = ", ".join(items.positions)
    return f"{by}; numbers are {numbers}, as the option says" if items.by_position else by


def _kind(statement: Statement, words: CycleWords, guessed: bool) -> str:
    """The kind of a cycle, one or two words."""
    first = [item for item in statement.items[:2] if isinstance(item, str)]
    candidates = [",".join(first), *first[:1]]
    if TAPPING & set(first):
        raise CycleError("L440", f"CYCLE/{candidates[0]}")
    for kind in candidates:
        if kind in words.kinds:
            return kind
    if guessed and any(map(kind_of_some, candidates)):
        raise CycleError("L419", f"CYCLE/{shown(statement)}: {candidates[-1]} with the words of {words.maker}")
    raise CycleError("L401", f"CYCLE/{shown(statement)}")


def _check_signs(items: CycleItems) -> None:
    """Make the depth positive; reject a bottom that is not below the point, and other heights that are."""
    values = items.values
    written = values.get("depth", items.words.down)
    values["depth"] = written * items.words.down if "depth" in values else math.nan
    if values["depth"] <= 0 and items.guessed:
        raise CycleError("L419", f"depth {written:g}, above the point for {items.words.maker}")
    wrong = [f"{name} {value:g}" for name, value in values.items() if value < 0 or (name == "depth" and not value)]
    if wrong:
        raise CycleError("L412", f"CYCLE/{items.kind}: {', '.join(wrong)}")


def _cycle(course: Course, strokes: Strokes, items: CycleItems) -> Cycle:
    """The cycle defined by the values; NaN where a value is missing."""
    values, scale = items.values, course.scale
    clearance = values.get("clearance", math.nan) * scale
    returns = "return" in values and course.cycle_return != "CLEAR"
    before = values["return"] == items.words.initial if returns else course.cycle_return == "INIT"
    pecks = strokes.pecks != "none"
    return Cycle(
        strokes=strokes,
        depth=values["depth"] * scale,
        clearance=clearance,
        start=clearance - values.get("advance", 0.0) * scale,
        height=max(values["return"] * scale, clearance) if returns else clearance,
        to_initial=items.to_initial or before,
        step=values.get("step", math.nan) * scale if pecks else 0.0,
        first_step=values.get("first step", 0.0) * scale if pecks else 0.0,
        dwell=_dwell(course, values),
        feed=_feed(course, items.feed),
    )


def _dwell(course: Course, values: Mapping[str, float]) -> float:
    """The dwell at the bottom in s; infinite for revolutions of a stopped spindle."""
    turns = values.get("turns", 0.0)
    return turns * 60 / course.speed if turns and course.speed else math.inf if turns else values.get("dwell", 0.0)


def _feed(course: Course, given: tuple[str, float] | None) -> float:
    """The feed of the cycle in mm/s, NaN if absent; the feed of other moves is unchanged."""
    if given is None:
        return math.nan if course.feed is None or course.feed.inverse else course.feed.value
    per_turn = course.feed_per_turn
    feed = feed_of(course, given[0] or course.feed_word, given[1])
    course.feed_per_turn = per_turn
    return math.nan if feed.inverse else feed.value


def _wrong(cycle: Cycle, words: CycleWords) -> str:
    """Why the cycle cannot be executed, empty if it can."""
    missing = [words.words_for(name) for name in ("depth", "clearance", "step") if math.isnan(getattr(cycle, name))]
    if missing:
        return f"{', '.join(missing)} is missing"
    if not cycle.feed > 0:
        return "it has no feed in mm/min"
    if cycle.start < 0:
        return f"the feed begins {-cycle.start:g} mm below the point"
    if not math.isfinite(cycle.dwell):
        return "it dwells for turns of a spindle at rest"
    if cycle.strokes.pecks != "none" and not cycle.step * MOST_PECKS > cycle.depth:
        return f"the step is {cycle.step:g} mm"
    return ""
