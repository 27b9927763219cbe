# SPDX-License-Identifier: LGPL-2.1-or-later
"""Feeds and speeds: FEDRAT, RAPID, SPINDL, COOLNT, DELAY and stops, with items in any order.

Input: statements. Output: feeds in mm/s and events. A feed per revolution follows the spindle speed.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

from pkm_post.model import EventKind
from pkm_post.reading.cldata.state import Feed, ReaderState
from pkm_post.reading.cldata.statements import Statement
from pkm_post.reading.units import UNITS

MM_PER_MINUTE: dict[str, float | None] = {"MMPM": 1.0, "IPM": 25.4, "FPM": 304.8, "PERMIN": None}
"""mm per length unit of a feed per minute; None is the program unit."""
MM_PER_TURN: dict[str, float | None] = {"MMPR": 1.0, "IPR": 25.4, "FPR": 304.8, "PERREV": None}
FEED_WORDS = frozenset({*MM_PER_MINUTE, *MM_PER_TURN, "INVERS"})
_FEED_MODES = frozenset({"AUTO", "ON", "OFF"})

_SENSES = {"CLW": 1.0, "CCLW": -1.0}
_SURFACE_SPEEDS = {"SMM": 1000.0, "SFM": 304.8}
_SPINDLE_PAIRS = frozenset({"MAXRPM", "RADIUS", "RANGE"})
_SPINDLE_WORDS = frozenset({"RPM", "ON", "OFF", "ORIENT", "LOCK", "NEUTRL", "RANGE", "LOW", "MEDIUM", "HIGH"})
_COOLANT = {"ON": 1.0, "FLOOD": 1.0, "MIST": 2.0, "TAP": 1.0, "TAPKUL": 1.0, "THRU": 1.0, "OFF": 0.0}


def feed_of(state: ReaderState, word: str, value: float) -> Feed:
    """The feed of a value with its unit word; stores a feed per revolution."""
    state.feed_per_turn = 0.0
    if word == "INVERS":
        return Feed(value / 60, inverse=True)
    table = MM_PER_TURN if word in MM_PER_TURN else MM_PER_MINUTE
    stated = table[word]
    mm = value * (state.scale if stated is None or _unit_overridden(state, stated) else stated)
    if table is MM_PER_TURN:
        state.feed_per_turn = mm
        return Feed(mm * state.spindle_speed / 60)
    return Feed(mm / 60)


def _unit_overridden(state: ReaderState, stated: float) -> bool:
    """Whether a feed is in the file unit while the options override it with another."""
    unit = state.file_unit.name
    return state.options.units not in (None, unit) and stated == UNITS.get(unit)


def fedrat(state: ReaderState, row: int, statement: Statement) -> None:
    """FEDRAT/value[,unit], in any order; FEDRAT/INVERS,AUTO is an output setting for posts and has no effect."""
    items = _without_pairs(statement, frozenset({"LENGTH"}))
    numbers = [item for item in items if isinstance(item, float)]
    words = [item for item in items if isinstance(item, str)]
    units = [word for word in words if word in FEED_WORDS]
    if len(numbers) > 1 or len(units) > 1 or not set(words) <= FEED_WORDS | _FEED_MODES:
        state.report_items(row, statement, f"one number and one of {_list(FEED_WORDS)}")
    elif numbers and not numbers[0] > 0:
        state.report("L403", row, f"feed {numbers[0]:g}")
    elif numbers:
        state.feed_word = units[0] if units else state.feed_word
        state.set_feed(row, feed_of(state, state.feed_word, numbers[0]))
    elif not words and len(items) == len(statement.items):
        state.report("L402", row, "FEDRAT, expected a number")


def rapid(state: ReaderState, row: int, statement: Statement) -> None:
    """RAPID: applies to the next motion only."""
    state.rapids.append(row)


def spindl(state: ReaderState, row: int, statement: Statement) -> None:
    """SPINDL/speed, unit and sense in any order; SPINDL/OFF and ON."""
    items = _without_pairs(statement, _SPINDLE_PAIRS)
    numbers = [item for item in items if isinstance(item, float)]
    words = {item for item in items if isinstance(item, str)}
    if len(numbers) > 1 or not words <= _SPINDLE_WORDS | {*_SENSES, *_SURFACE_SPEEDS} or not statement.items:
        state.report_items(row, statement, "one number, RPM, SFM or SMM, CLW or CCLW")
        return
    sense = next((_SENSES[word] for word in ("CLW", "CCLW") if word in words), state.spindle_sense or 1.0)
    if numbers and not _new_speed(state, row, numbers[0], words):
        return
    stopped = bool(words & {"OFF", "ORIENT", "LOCK", "NEUTRL"}) or (not words and not numbers)
    state.spindle_sense = 0.0 if stopped and not numbers else sense
    speed = state.spindle_sense * state.spindle_speed if state.spindle_sense else 0.0
    state.events.append((row, EventKind.SPINDLE, speed))
    if state.feed_per_turn:
        state.set_feed(row, Feed(state.feed_per_turn * state.spindle_speed / 60))


def _new_speed(state: ReaderState, row: int, value: float, words: set[str]) -> bool:
    """Set a speed in 1/min; False if it is invalid."""
    surface = next((_SURFACE_SPEEDS[word] for word in ("SMM", "SFM") if word in words), None)
    if value < 0 or (surface is not None and state.diameter <= 0):
        state.report("L403", row, f"speed {value:g}" + ("" if surface is None else " of a cutter of unknown diameter"))
        return False
    state.spindle_speed = value if surface is None else value * surface / (math.pi * state.diameter)
    return True


def coolnt(state: ReaderState, row: int, statement: Statement) -> None:
    """COOLNT/ON, FLOOD, MIST, TAP, THRU or OFF; a following pressure is ignored."""
    word = next(iter(statement.words), "")
    if word not in _COOLANT:
        state.report_items(row, statement, _list(_COOLANT))
        return
    state.events.append((row, EventKind.COOLANT, _COOLANT[word]))


def delay(state: ReaderState, row: int, statement: Statement) -> None:
    """DELAY/seconds or DELAY/turns,REV."""
    numbers, turns = statement.numbers, "REV" in statement.words
    if len(numbers) != 1 or not set(statement.words) <= {"REV"}:
        state.report_items(row, statement, "seconds, or turns and REV")
    elif numbers[0] < 0 or (turns and not state.spindle_speed):
        state.report(
            "L403", row, f"{statement.word} {numbers[0]:g}" + (" revolutions of a stopped spindle" if turns else "")
        )
    else:
        state.events.append((row, EventKind.DWELL, numbers[0] * 60 / state.spindle_speed if turns else numbers[0]))


def stop(state: ReaderState, row: int, statement: Statement) -> None:
    """STOP and OPSTOP."""
    state.events.append((row, EventKind.STOP, 1.0 if statement.word == "OPSTOP" else 0.0))


def _without_pairs(statement: Statement, names: frozenset[str]) -> list[object]:
    """The items without the named words and their numbers."""
    items: list[object] = []
    after = False
    for item in statement.items:
        if item in names:
            after = True
        elif not (after and isinstance(item, float)):
            items.append(item)
            after = False
        else:
            after = False
    return items


def _list(words: Iterable[str]) -> str:
    return ", ".join(sorted(words))
