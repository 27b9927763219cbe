# SPDX-License-Identifier: LGPL-2.1-or-later
"""Feeds and speeds: FEDRAT, RAPID, SPINDL, COOLNT, DELAY and stops, with items in any order.

Input: statements. Output: feeds in mm/s and events. A feed per revolution follows the spindle speed.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import replace

from pkm_post.model import EventKind
from pkm_post.reading.cldata.state import Feed, ReaderState, SurfaceSpeed
from pkm_post.reading.cldata.statements import Statement
from pkm_post.reading.units import LONG_DWELL, UNITS

MM_PER_MINUTE: dict[str, float | None] = {"MMPM": 1.0, "IPM": 25.4, "FPM": 304.8, "PERMIN": None}
"""mm per length unit of a feed per minute; None is the program unit."""
MM_PER_TURN: dict[str, float | None] = {"MMPR": 1.0, "IPR": 25.4, "FPR": 304.8, "PERREV": None}
FEED_WORDS = frozenset({*MM_PER_MINUTE, *MM_PER_TURN, "INVERS"})
_FEED_MODES = frozenset({"AUTO", "ON", "OFF"})

_SENSES = {"CLW": 1.0, "CCLW": -1.0}
_SURFACE_SPEEDS = {"SMM": 1000.0, "SFM": 304.8}
_SPINDLE_PAIRS = frozenset({"MAXRPM", "RADIUS", "RANGE"})
_STOPPED = frozenset({"OFF", "ORIENT", "LOCK", "NEUTRL"})
_SPINDLE_WORDS = frozenset({"RPM", "ON", "LOW", "MEDIUM", "HIGH", "AUTO", *_SPINDLE_PAIRS, *_STOPPED})
_COOLANT = {"ON": 1.0, "FLOOD": 1.0, "MIST": 2.0, "TAP": 1.0, "TAPKUL": 1.0, "THRU": 1.0, "OFF": 0.0}
_PRESSURES = frozenset({"LOW", "MEDIUM", "HIGH"})


def feed_of(state: ReaderState, word: str, value: float) -> Feed:
    """The feed of a value with its unit word, NaN per revolution of a spindle at rest; stores a feed per revolution."""
    state.feed_per_turn = 0.0
    if word == "INVERS":
        return Feed(value / 60, inverse=True)
    table = MM_PER_TURN if word in MM_PER_TURN else MM_PER_MINUTE
    stated = table[word]
    mm = value * (state.scale if stated is None or _unit_overridden(state, stated) else stated)
    if table is MM_PER_TURN:
        state.feed_per_turn = mm
        return _feed_per_turn(state)
    return Feed(mm / 60)


def _feed_per_turn(state: ReaderState) -> Feed:
    """The feed per revolution at the present speed."""
    return Feed(state.feed_per_turn * (state.turning_speed or math.nan) / 60, per_turn=True)


def _unit_overridden(state: ReaderState, stated: float) -> bool:
    """Whether a feed is in the file unit while the options override it with another."""
    unit = state.file_unit.name
    return state.options.units not in (None, unit) and stated == UNITS.get(unit)


def fedrat(state: ReaderState, row: int, statement: Statement) -> None:
    """FEDRAT/value[,unit], in any order; a unit alone is that of the next values.

    FEDRAT/INVERS,AUTO and ON are output settings for posts and have no effect; INVERS,OFF ends inverse time.
    """
    items = _without_pairs(statement, frozenset({"LENGTH"}))
    numbers = [item for item in items if isinstance(item, float)]
    words = [item for item in items if isinstance(item, str)]
    units = [word for word in words if word in FEED_WORDS]
    modes = {word for word in words if word in _FEED_MODES}
    several, known = len(numbers) > 1 or len(units) > 1, set(words) <= FEED_WORDS | _FEED_MODES
    misplaced_mode = bool(modes) and (bool(numbers) or len(modes) > 1 or units != ["INVERS"])
    if several or misplaced_mode or not known or not _numbered(statement, "LENGTH"):
        state.report_items(row, statement, f"one number and one of {_list(FEED_WORDS)}")
    elif numbers and not numbers[0] > 0:
        state.report("L403", row, f"feed {numbers[0]:g}")
    elif numbers:
        state.feed_word = units[0] if units else state.feed_word
        state.set_feed(row, feed_of(state, state.feed_word, numbers[0]))
    elif units and not modes:
        _set_feed_word(state, row, units[0])
    elif "OFF" in modes and state.feed_word == "INVERS":
        _set_feed_word(state, row, "PERMIN")
    elif not words and len(items) == len(statement.items):
        state.report("L402", row, "FEDRAT, expected a number")


def _set_feed_word(state: ReaderState, row: int, word: str) -> None:
    """Set the unit of the next feeds; in another mode the present feed means nothing [NCCS PostWorks]."""
    if _mode(word) != _mode(state.feed_word):
        state.feed_per_turn = 0.0
        state.set_feed(row, Feed(math.nan))
    state.feed_word = word


def _mode(word: str) -> str:
    """The mode of a unit of feeds."""
    return "minute" if word in MM_PER_MINUTE else "turn" if word in MM_PER_TURN else "inverse"


def rapid(state: ReaderState, row: int, statement: Statement) -> None:
    """RAPID: applies to the next motion only. With words it is modal, or along single axes, as the post defines it."""
    if any(item is not None for item in statement.items):
        state.report("L401", row, f"RAPID/{statement.items_text()}, other than RAPID for one motion")
        return
    state.rapids.append(row)


def spindl(state: ReaderState, row: int, statement: Statement) -> None:
    """SPINDL/speed, unit and sense in any order; SPINDL/OFF and ON; ORIENT[,angle]; MAXRPM,n and RANGE,n alone."""
    items = _without_pairs(statement, _SPINDLE_PAIRS)
    numbers = [item for item in items if isinstance(item, float)]
    words = {item for item in items if isinstance(item, str)}
    if _is_spindle_unclear(statement, numbers, words):
        state.report_items(row, statement, "one number, RPM, SFM or SMM, CLW or CCLW")
        return
    state.spindle_limit = statement.number_after("MAXRPM") or state.spindle_limit
    if not numbers and not words:
        return
    state.spindle_on = not words & _STOPPED
    if state.spindle_on:  # with the last sense and speed where there are no others [NCCS PostWorks]
        state.spindle_sense = next((_SENSES[word] for word in _SENSES if word in words), state.spindle_sense)
        if not (_new_speed(state, row, numbers[0], statement) if numbers else _last_speed(state, row, statement)):
            return
    _spindle_event(state, row)


def _is_spindle_unclear(statement: Statement, numbers: list[float], words: set[str]) -> bool:
    """Whether items of SPINDL are unknown, missing, or contradict each other."""
    units = words & {"RPM", *_SURFACE_SPEEDS}
    of_two_things = "LOCK" in words and words & {"ON", "OFF"}  # the spindle, or its override
    stops_and_turns = words & _STOPPED and ("ON" in words or (numbers and "ORIENT" not in words))
    several = len(numbers) > 1 or len(units) > 1 or len(words & {*_SENSES}) > 1
    lacking = not statement.items or (units and not numbers) or not _numbered(statement, "MAXRPM", "RADIUS")
    unknown = not words <= _SPINDLE_WORDS | {*_SENSES, *_SURFACE_SPEEDS}
    return any((of_two_things, stops_and_turns, several, lacking, unknown))


def _new_speed(state: ReaderState, row: int, value: float, statement: Statement) -> bool:
    """Set a speed in 1/min, or of the surface at the cutter's edge or the radius written; False if it is invalid."""
    if value < 0:
        state.report("L403", row, f"speed {value:g}")
        return False
    surface = next((_SURFACE_SPEEDS[word] for word in statement.words if word in _SURFACE_SPEEDS), None)
    state.surface_speed = None
    if surface is None:
        state.spindle_speed = value
        return True
    diameter = 2 * statement.number_after("RADIUS") * state.scale
    if not diameter:
        motions, sense = state.motions_before(row), state.spindle_sense
        state.surface_speed = SurfaceSpeed(len(state.events), motions, value * surface, sense, state.changed_tool)
    state.spindle_speed = _turns_per_minute(state, value * surface, diameter or state.diameter)
    return True


def _last_speed(state: ReaderState, row: int, statement: Statement) -> bool:
    """Start at the last speed; False after a surface speed of another tool: are its turns kept, or computed again?"""
    surface = state.surface_speed
    if surface is None:
        return True
    if surface.motions != state.motions_before(row) and surface.tool != state.changed_tool:
        words = statement.items_text()
        state.report("L403", row, f"SPINDL/{words} after the surface speed of tool {surface.tool}; write a speed")
        return False
    state.surface_speed = replace(surface, event=len(state.events), sense=state.spindle_sense)
    return True


def _turns_per_minute(state: ReaderState, surface: float, diameter: float) -> float:
    """The speed at a diameter, mm, for one on the surface there, mm/min; NaN if the diameter is unknown."""
    return min(surface / (math.pi * diameter), state.spindle_limit or math.inf) if diameter > 0 else math.nan


def resolve_surface_speed(state: ReaderState, row: int) -> None:
    """A new cutter gives a surface speed its turns if no motion was made with it: either may come first."""
    surface = state.surface_speed
    if surface is None or surface.motions != state.motions_before(row):
        return
    state.spindle_speed = _turns_per_minute(state, surface.speed, state.diameter)
    at, kind, _ = state.events[surface.event]
    state.events[surface.event] = (at, kind, surface.sense * state.spindle_speed)
    if state.feed_per_turn:
        state.set_feed(row, _feed_per_turn(state))


def report_unknown_speeds(state: ReaderState) -> None:
    """Report surface speeds of cutters that stayed unknown."""
    for row, kind, value in state.events:
        if kind is EventKind.SPINDLE and math.isnan(value):
            statement = state.statements.statement(row)
            state.report("L403", row, f"SPINDL/{statement.items_text()} of a cutter of unknown diameter")


def _spindle_event(state: ReaderState, row: int) -> None:
    """Record the present speed, and the feed per revolution that follows it."""
    speed = state.spindle_sense * state.spindle_speed if state.spindle_on else 0.0
    state.events.append((row, EventKind.SPINDLE, speed))
    if state.feed_per_turn:
        state.set_feed(row, _feed_per_turn(state))


def coolnt(state: ReaderState, row: int, statement: Statement) -> None:
    """COOLNT/ON, FLOOD, MIST, TAP, THRU or OFF; ON beside a kind is that kind, a pressure is ignored.

    ON is flood with NX [UG/Post], the last coolant elsewhere [NCCS PostWorks].
    """
    words = statement.words
    kinds = [word for word in words if _COOLANT.get(word) and word != "ON"]
    both = len(kinds) > 1 or (bool(kinds or "ON" in words) and "OFF" in words)  # one of several may go on
    if both or not words or words[0] not in _COOLANT or not set(words) <= {*_COOLANT, *_PRESSURES}:
        state.report_items(row, statement, f"one of {_list(_COOLANT)}")
        return
    word = kinds[0] if kinds else words[0]
    coolant = state.coolant if word == "ON" and state.dialect.name != "nx" else _COOLANT[word]
    state.coolant = coolant or state.coolant
    state.events.append((row, EventKind.COOLANT, coolant))


def delay(state: ReaderState, row: int, statement: Statement) -> None:
    """DELAY/seconds or DELAY/turns,REV."""
    numbers, turns = statement.numbers, "REV" in statement.words
    if len(numbers) != 1 or not set(statement.words) <= {"REV"}:
        state.report_items(row, statement, "seconds, or turns and REV")
    elif numbers[0] < 0 or (turns and not state.turning_speed > 0):
        state.report(
            "L403", row, f"{statement.word} {numbers[0]:g}" + (" revolutions of a stopped spindle" if turns else "")
        )
    else:
        seconds = numbers[0] * 60 / state.spindle_speed if turns else numbers[0]
        if seconds > LONG_DWELL:
            state.report("L448", row, f"{statement.word}/{statement.items_text()}: {seconds:g} s")
        state.events.append((row, EventKind.DWELL, seconds))


def stop(state: ReaderState, row: int, statement: Statement) -> None:
    """STOP and OPSTOP."""
    state.events.append((row, EventKind.STOP, 1.0 if statement.word == "OPSTOP" else 0.0))


def _without_pairs(statement: Statement, names: frozenset[str]) -> list[object]:
    """The items without the named words and their numbers."""
    return [
        item
        for before, item in zip((None, *statement.items), statement.items, strict=False)
        if item not in names and not (before in names and isinstance(item, float))
    ]


def _numbered(statement: Statement, *names: str) -> bool:
    """Whether a number above zero follows each of the names in a statement."""
    return all(statement.number_after(name) > 0 for name in names if name in statement.words)


def _list(words: Iterable[str]) -> str:
    return ", ".join(sorted(words))
