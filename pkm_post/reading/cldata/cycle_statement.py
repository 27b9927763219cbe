# SPDX-License-Identifier: LGPL-2.1-or-later
"""Holes: convert a CYCLE statement of any CAM system to a cycle.

Enters: a statement. Leaves: a cycle of the course, in mm and mm/s.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from pkm_post.reading.cldata.cycle_notation import (
    AUTO,
    CAMWORKS,
    MANUAL,
    TAPPING,
    Cycle,
    CycleWords,
    Strokes,
    kind_of_some,
    known_to_some,
    words_by_use,
    words_of_dialect,
)
from pkm_post.reading.cldata.feeds import FEED_WORDS, feed_of, shown
from pkm_post.reading.cldata.state import Course
from pkm_post.reading.cldata.statements import Statement

Item = float | str | Statement | None


class CycleError(Exception):
    """A CYCLE statement is rejected, with a code and what was found."""

    def __init__(self, code: str, found: str) -> None:
        super().__init__(found)
        self.code, self.found = code, found


@dataclass
class CycleItems:
    """Parser of the items of one statement.

    Attributes:
        words: vocabulary of the CAM system.
        kind: kind of the cycle.
        guessed: the CAM system is inferred from these words only.
        positions: meanings of numbers without a word, in order; a depth among them counts down from the point.
        values: the numbers by meaning.
        feed: with its unit; the unit is empty if none is written.
        to_initial: the tool returns to its height before the cycle.
        by_position: numbers follow the kind without words.
    """

    words: CycleWords
    kind: str
    guessed: bool
    positions: tuple[str, ...] = ()
    values: dict[str, float] = field(default_factory=dict)
    feed: tuple[str, float] | None = None
    to_initial: bool = False
    by_position: bool = False
    _unit: str = ""
    _waiting: str = ""
    _placed: int = 0

    def read(self, items: Iterable[Item]) -> None:
        """Read the items after the kind.

        Raises:
            CycleError: an item is not understood.
        """
        present = [item for item in items if item is not None]
        self.by_position = bool(present) and isinstance(present[0], float)
        if self.by_position and not self.positions:
            raise CycleError("L420", f"CYCLE/{self.kind},{present[0]:g}")
        for item in present:
            if isinstance(item, Statement):
                raise CycleError("L412", f"{item.word}, {self._expected()}")
            if isinstance(item, str):
                self._word(item)
            else:
                self._number(item)
        self._no_word_waits()
        if self.by_position and "feed" in self.values:
            self.feed = self._unit, self.values.pop("feed")

    def _word(self, word: str) -> None:
        """Process a word: the name of the next number, a unit, or a standalone word."""
        if self.words.down < 0 and word == AUTO and self._means("return"):
            self.to_initial, self._waiting = True, ""
        elif self.words.down < 0 and word == MANUAL and not self._waiting and "return" in self.values:
            pass
        elif word == "REV" and self._means("dwell"):
            self._waiting = word
        else:
            if word not in FEED_WORDS and word not in self.words.known_words(self.kind):
                self._refuse(word)
            self._no_word_waits()
            if word in FEED_WORDS:
                self._unit = word
            self._waiting = "" if self.by_position and word in FEED_WORDS else word

    def _means(self, meaning: str) -> bool:
        """Whether the pending word has a given meaning."""
        return self.words.words.get(self._waiting) == meaning

    def _number(self, number: float) -> None:
        """Process a number."""
        name, self._waiting = self._waiting, ""
        if name in FEED_WORDS:
            if self.feed is not None:
                raise CycleError("L412", f"{name},{number:g}, a second feed")
            self.feed = name, number
            return
        meaning = self.words.words[name] if name else self._next_position(number)
        if not name and meaning == "depth":
            number *= self.words.down
        if meaning in self.values:
            raise CycleError("L412", f"{name},{number:g}, a second {meaning}")
        self.values[meaning] = number

    def _next_position(self, number: float) -> str:
        """Meaning of the next number without a word."""
        if self._placed >= len(self.positions):
            raise CycleError("L412", f"{number:g}, {self._expected()}")
        self._placed += 1
        return self.positions[self._placed - 1]

    def _no_word_waits(self) -> None:
        if self._waiting:
            raise CycleError("L412", f"{self._waiting} without a number")

    def _refuse(self, word: str) -> None:
        if self.guessed and known_to_some(word):
            raise CycleError("L419", f"{word} beside the words of {self.words.maker}")
        raise CycleError("L412", f"{word}, {self._expected()}")

    def _expected(self) -> str:
        return f"expected one of {', '.join(sorted(self.words.known_words(self.kind) | FEED_WORDS))}"


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
