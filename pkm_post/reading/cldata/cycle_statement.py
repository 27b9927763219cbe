# SPDX-License-Identifier: LGPL-2.1-or-later
"""CYCLE statements of any CAM system.

Input: a statement. Output: the active cycle, in mm and mm/s. Each number of a CYCLE is identified by its preceding
word. For numbers before the first word an option gives the meaning, or the CAM system: CATIA writes them
according to the post-processor table, Creo always in one order.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import NoReturn

from pkm_post.reading.cldata.cycle_notation import (
    AUTO,
    BREAK_CHIP,
    CAMWORKS,
    DEEP,
    DRILL,
    MANUAL,
    NOTATIONS,
    REAM,
    TAPPING,
    Cycle,
    CycleKind,
    CycleNotation,
    is_known_kind,
    is_known_word,
    notation_by_words,
)
from pkm_post.reading.cldata.feeds import FEED_WORDS, feed_of
from pkm_post.reading.cldata.state import ReaderState
from pkm_post.reading.cldata.statements import Statement
from pkm_post.reading.units import LONG_DWELL

_MAX_PECKS = 10000
_RETURNS = ("INIT", "CLEAR")
"""CAMWorks: the tool returns to the height before the cycle, or RTRCTO if written, or to the clearance."""

_STROKES = {"drill": DRILL, "deep": DEEP, "break": BREAK_CHIP, "ream": REAM}
"""Strokes by their names in the option ``cycle_kinds``."""

_Item = float | str | Statement | None


class _CycleError(Exception):
    """A CYCLE statement is rejected, with a code and a finding."""

    def __init__(self, code: str, found: str) -> None:
        super().__init__(found)
        self.code, self.found = code, found


def cycle(state: ReaderState, row: int, statement: Statement) -> None:
    """CYCLE/kind,items; INIT and CLEAR set the return height; ON and OFF."""
    word = next(iter(statement.words), "")
    if word in ("OFF", "ON") and len(statement.items) > 1:
        state.report_items(row, statement, f"CYCLE/{word} alone")
    elif word == "OFF":
        state.cycles.append((row, None))
    elif word == "ON" and state.cycle is not None:
        state.cycles.append((row, _at_feed_and_speed(state, state.cycle)))
    elif word in _RETURNS and len(statement.items) == 1 and NOTATIONS.get(state.dialect.name) in (None, CAMWORKS):
        state.cycle_return = word
    else:
        try:
            state.cycle, interpretation = _interpret(state, statement)
            state.cycles.append((row, state.cycle))
            state.cycle_interpretations.setdefault(interpretation, []).append(row)
            if LONG_DWELL < state.cycle.dwell < math.inf:
                state.report("L448", row, f"CYCLE/{statement.items_text()}: {state.cycle.dwell:g} s")
        except _CycleError as fault:
            state.report(fault.code, row, fault.found)


def cycle_goes_on(state: ReaderState, row: int) -> None:
    """A cycle in force goes on with the feed and the spindle speed that a statement has set."""
    if state.cycle is not None and state.cycles[-1][1] is not None:
        state.cycles.append((row, _at_feed_and_speed(state, state.cycle)))


def _at_feed_and_speed(state: ReaderState, cycle: Cycle) -> Cycle:
    """The cycle with its feed and dwell at the present FEDRAT and spindle speed."""
    turns_per_second = state.turning_speed / 60 if state.turning_speed > 0 else math.nan
    feed = cycle.own_feed * (turns_per_second if cycle.per_turn else 1.0)
    if math.isnan(cycle.own_feed) and state.feed is not None and not state.feed.inverse:
        feed = state.feed.value
    if not cycle.dwell_turns:
        return replace(cycle, feed=feed)
    dwell = math.inf if math.isnan(turns_per_second) else cycle.dwell_turns / turns_per_second
    return replace(cycle, feed=feed, dwell=dwell)


def cycle_descriptions(state: ReaderState) -> list[str]:
    """Describe the interpretation of the cycles of a file: one line per CAM system."""
    descriptions = []
    for interpretation, rows in state.cycle_interpretations.items():
        more = f" and {len(rows) - 1} more" if len(rows) > 1 else ""
        descriptions.append(f"CYCLE in line {state.statements.place(rows[0])[0]}{more}: {interpretation}")
    return descriptions


def _interpret(state: ReaderState, statement: Statement) -> tuple[Cycle, str]:
    """The cycle of a statement, and a description of its interpretation."""
    known = NOTATIONS.get(state.dialect.name)
    notation = known or notation_by_words(statement.words)
    guessed = known is None
    kinds = {**notation.kinds, **{kind: _STROKES[name] for kind, name in state.options.cycle_kinds.items()}}
    kind = _kind(statement, notation, kinds, guessed)
    positions = state.options.cycle_values or (() if guessed else notation.positions_of(kinds[kind]))
    items = _CycleItems(notation, kind, guessed, positions)
    items.read(statement.items[len(kind.split(",")) :])
    if "diameter" in items.values:
        items.values["depth"] = _countersink_depth(state, items) * notation.down
    _check_signs(items)
    cycle = _at_feed_and_speed(state, _cycle(state, kinds[kind], items))
    fault = _fault_of(cycle, notation)
    if fault:
        raise _CycleError("L412", f"CYCLE/{kind}: {fault}")
    return cycle, f"words of {notation.system}, {_evidence(state, guessed, items)}"


def _evidence(state: ReaderState, guessed: bool, items: _CycleItems) -> str:
    """The reason for attributing the words of a cycle to a CAM system."""
    by = "by themselves" if guessed else "as the option says" if state.options.dialect else "by the dialect"
    if items.kind in state.options.cycle_kinds:
        by = f"{by}; {items.kind} is {state.options.cycle_kinds[items.kind]}, as the option says"
    if not items.by_position:
        return by
    source = "as the option says" if state.options.cycle_values else f"in the order of {items.notation.system}"
    return f"{by}; numbers are {', '.join(items.positions)}, {source}"


def _countersink_depth(state: ReaderState, items: _CycleItems) -> float:
    """Depth at which the cone of the tool has a diameter, as written: diameter / 2 / tan(point angle / 2)."""
    diameter, tool = items.values.pop("diameter"), state.diameter / state.scale
    if "depth" in items.values:
        raise _CycleError("L412", f"CYCLE/{items.kind}: a depth and a diameter")
    if not state.point_angle:
        raise _CycleError("L412", f"CYCLE/{items.kind}: diameter {diameter:g} with a tool of unknown point angle")
    if not 0 < diameter <= tool:
        raise _CycleError("L412", f"CYCLE/{items.kind}: diameter {diameter:g} with a tool of diameter {tool:g}")
    return diameter / 2 / math.tan(state.point_angle / 2)


def _kind(statement: Statement, notation: CycleNotation, kinds: Mapping[str, CycleKind], guessed: bool) -> str:
    """The kind of a cycle, one or two words."""
    first = [item for item in statement.items[:2] if isinstance(item, str)]
    candidates = [",".join(first), *first[:1]]
    if TAPPING & set(first):
        raise _CycleError("L440", f"CYCLE/{candidates[0]}")
    for kind in candidates:
        if kind in kinds:
            return kind
    if guessed and any(map(is_known_kind, candidates)):
        raise _CycleError(
            "L419", f"CYCLE/{statement.items_text()}: {candidates[-1]} with the words of {notation.system}"
        )
    raise _CycleError("L445", f"CYCLE/{statement.items_text()}")


def _check_signs(items: _CycleItems) -> None:
    """Make the depth positive; reject a bottom that is not below the point, and other heights below it."""
    values = items.values
    written = values.get("depth", items.notation.down)
    values["depth"] = written * items.notation.down if "depth" in values else math.nan
    if values["depth"] <= 0 and items.guessed:
        raise _CycleError("L419", f"depth {written:g}, above the point for {items.notation.system}")
    wrong = [f"{name} {value:g}" for name, value in values.items() if value < 0 or (name == "depth" and not value)]
    if wrong:
        raise _CycleError("L412", f"CYCLE/{items.kind}: {', '.join(wrong)}")


def _cycle(state: ReaderState, kind: CycleKind, items: _CycleItems) -> Cycle:
    """The cycle defined by the values; NaN where a value is missing."""
    values, scale = items.values, state.scale
    clearance = values.get("clearance", math.nan) * scale
    returns = "return" in values and state.cycle_return != "CLEAR"
    before = values["return"] == items.notation.initial if returns else state.cycle_return == "INIT"
    before = before or items.notation.to_initial and not returns
    pecks = kind.pecks != "none"
    own_feed, per_turn = _own_feed(state, items.feed)
    return Cycle(
        kind=kind,
        depth=values["depth"] * scale,
        clearance=clearance,
        start=clearance - values.get("advance", 0.0) * scale,
        height=max(values["return"] * scale, clearance) if returns else clearance,
        to_initial=items.to_initial or before,
        step=values.get("step", math.nan) * scale if pecks else 0.0,
        first_step=values.get("first step", 0.0) * scale if pecks else 0.0,
        dwell=values.get("dwell", 0.0),
        dwell_turns=values.get("turns", 0.0),
        own_feed=own_feed,
        per_turn=per_turn,
    )


def _own_feed(state: ReaderState, given: tuple[str, float] | None) -> tuple[float, bool]:
    """The feed that a cycle states, mm/s or mm per turn, and which; the feed of other moves is unchanged.

    Raises:
        _CycleError: it is an inverse time, or not above zero.
    """
    if given is None:
        return math.nan, False
    of_moves = state.feed_per_turn
    feed = feed_of(state, given[0] or state.feed_word, given[1])
    value = state.feed_per_turn if feed.per_turn else feed.value
    state.feed_per_turn = of_moves
    if feed.inverse or not value > 0:
        raise _CycleError("L412", f"a feed of {given[1]:g} {given[0]}, expected one in mm/min or mm per turn")
    return value, feed.per_turn


def _fault_of(cycle: Cycle, notation: CycleNotation) -> str:
    """The reason why the cycle cannot be executed; empty if it can."""
    missing = [notation.words_for(name) for name in ("depth", "clearance", "step") if math.isnan(getattr(cycle, name))]
    if missing:
        return f"{', '.join(missing)} is missing"
    if not cycle.feed > 0 and not cycle.per_turn:
        return "it has no feed in mm/min"
    if cycle.start < 0:
        return f"the feed begins {-cycle.start:g} mm below the point"
    if cycle.kind.pecks != "none" and not cycle.step * _MAX_PECKS > cycle.depth:
        return f"the step is {cycle.step:g} mm"
    return ""


@dataclass
class _CycleItems:
    """Parser of the items of one statement.

    Attributes:
        notation: of the CAM system.
        kind: kind of the cycle.
        guessed: the CAM system is inferred from these words only.
        positions: meanings of numbers without a word, in order; a depth among them counts down from the point.
        values: the numbers by meaning.
        feed: with its unit; the unit is empty if none is written.
        to_initial: the tool returns to its height before the cycle.
        by_position: numbers follow the kind without words.
    """

    notation: CycleNotation
    kind: str
    guessed: bool
    positions: tuple[str, ...] = ()
    values: dict[str, float] = field(default_factory=dict)
    feed: tuple[str, float] | None = None
    to_initial: bool = False
    by_position: bool = False
    _unit: str = ""
    _pending: str = ""
    _next: int = 0

    def read(self, items: Iterable[_Item]) -> None:
        """Read the items after the kind.

        Raises:
            _CycleError: an item is not understood.
        """
        present = [item for item in items if item is not None]
        self.by_position = bool(present) and isinstance(present[0], float)
        if self.by_position and not self.positions:
            raise _CycleError("L420", f"CYCLE/{self.kind},{present[0]:g}")
        for item in present:
            if isinstance(item, Statement):
                raise _CycleError("L412", f"{item.word}, {self._expected()}")
            if isinstance(item, str):
                self._word(item)
            else:
                self._number(item)
        self._check_no_pending_word()
        if self.by_position and "feed" in self.values:
            self.feed = self._unit, self.values.pop("feed")

    def _word(self, word: str) -> None:
        """Process a word: the name of the next number, a unit, or a standalone word."""
        if self.notation.down < 0 and word == AUTO and self._pending_means("return"):
            self.to_initial, self._pending = True, ""
        elif self.notation.down < 0 and word == MANUAL and not self._pending and "return" in self.values:
            pass
        elif word == "REV" and word in self.notation.words and self._pending_means("dwell"):
            self._pending = word
        else:
            if word not in FEED_WORDS and word not in self.notation.known_words(self.kind):
                self._refuse(word)
            self._check_no_pending_word()
            if word in FEED_WORDS:
                self._unit = word
            self._pending = "" if word in FEED_WORDS and self.by_position and "feed" in self.positions else word

    def _pending_means(self, meaning: str) -> bool:
        """Whether the pending word has a given meaning."""
        return self.notation.words.get(self._pending) == meaning

    def _number(self, number: float) -> None:
        """Process a number."""
        name, self._pending = self._pending, ""
        if name in FEED_WORDS:
            if self.feed is not None:
                raise _CycleError("L412", f"{name},{number:g}, a second feed")
            self.feed = name, number
            return
        meaning = self.notation.words[name] if name else self._next_meaning(number)
        if not name and meaning == "depth":
            number *= self.notation.down
        if not meaning:
            return
        if meaning in self.values:
            raise _CycleError("L412", f"{name},{number:g}, a second {meaning}")
        self.values[meaning] = number

    def _next_meaning(self, number: float) -> str:
        """Meaning of the next number without a word."""
        if self._next >= len(self.positions):
            raise _CycleError("L412", f"{number:g}, {self._expected()}")
        self._next += 1
        return self.positions[self._next - 1]

    def _check_no_pending_word(self) -> None:
        """Check that the last word that needs a number has one."""
        if self._pending:
            raise _CycleError("L412", f"{self._pending} without a number")

    def _refuse(self, word: str) -> NoReturn:
        """Raise the fault of an unknown word."""
        if self.guessed and is_known_word(word):
            raise _CycleError("L419", f"{word} among the words of {self.notation.system}")
        raise _CycleError("L412", f"{word}, {self._expected()}")

    def _expected(self) -> str:
        return f"expected one of {', '.join(sorted(self.notation.known_words(self.kind) | FEED_WORDS))}"
