# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cycles, and the notation of each CAM system for them: kinds, words, and datums of their numbers.

The same word can mean different heights in different systems; docs/cl-data.md gives the source of each reading. Files
of dialects without their own vocabulary (CATIA's depends on the post-processor table) are read by the words they use.

Lengths of a ``Cycle`` are in mm, times in s, feeds in mm/s. Heights are along the tool axis, relative to the hole
point: depth is positive downwards, all others upwards.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True)
class CycleKind:
    """Stroke pattern of a kind of cycle.

    Attributes:
        pecks: "none"; "out", full retract after each peck; "break", short retract to break the chip.
        feed_out: the tool retracts at feed.
    """

    pecks: str = "none"
    feed_out: bool = False


DRILL = CycleKind()
DEEP = CycleKind("out")
BREAK_CHIP = CycleKind("break")
REAM = CycleKind(feed_out=True)


@dataclass(frozen=True)
class Cycle:
    """One cycle.

    Attributes:
        kind: stroke pattern.
        depth: of the bottom below the point.
        clearance: height of lateral moves.
        start: height at which feed starts, at most the clearance.
        height: return height, at least the clearance.
        to_initial: the tool returns to its height before the first hole instead, if above the clearance.
        step: maximum depth of one peck; 0 for none.
        first_step: depth of the first peck.
        dwell: at the bottom, s; infinite for turns of a spindle at rest.
        feed: mm/s, NaN if there is none.
        dwell_turns: turns of the spindle to dwell, 0 for a dwell in s.
        own_feed: mm/s, or mm per turn; NaN if the feed is that of FEDRAT.
        per_turn: whether that is per turn.
    """

    kind: CycleKind
    depth: float
    clearance: float
    start: float
    height: float
    to_initial: bool
    step: float
    first_step: float
    dwell: float = 0.0
    feed: float = math.nan
    dwell_turns: float = 0.0
    own_feed: float = math.nan
    per_turn: bool = False


AUTO = "AUTO"
MANUAL = "MANUAL"
"""After RTRCTO of NX: return to the height before the cycle, or to the written height."""


@dataclass(frozen=True)
class CycleNotation:
    """The cycle notation of one CAM system.

    Attributes:
        system: displayed name.
        kinds: the words of a kind, joined by commas, and its strokes.
        words: meaning of the number after a word: "depth"; "clearance", height of lateral moves; "advance", distance
            below the clearance at which feed starts; "return", height to which the tool returns; "step"; "first step";
            "dwell", s; "turns", spindle revolutions to dwell; "" for a number that is not needed.
        down: 1 where depths count positive downwards, -1 where they are heights above the point.
        initial: number after "return" that means the height before the cycle; None for none.
        excluded: words with a different meaning in one kind, which is not supported.
        positions: meanings of numbers that follow the kind without words, in order, where the system defines them; a
            step only where there are pecks.
        to_initial: without "return" the tool returns to its height before the cycle, else to the clearance.
    """

    system: str
    kinds: Mapping[str, CycleKind]
    words: Mapping[str, str]
    down: float = 1.0
    initial: float | None = None
    excluded: Mapping[str, frozenset[str]] = field(default_factory=dict)
    positions: tuple[str, ...] = ()
    to_initial: bool = False

    def known_words(self, kind: str) -> set[str]:
        """The words known in cycles of a kind."""
        return set(self.words) - self.excluded.get(kind, frozenset())

    def positions_of(self, kind: CycleKind) -> tuple[str, ...]:
        """Meanings of the numbers without words in cycles of a kind; none where the system does not define them."""
        return tuple(name for name in self.positions if name != "step" or kind.pecks != "none")

    def words_for(self, meaning: str) -> str:
        """The words with one meaning, for messages."""
        return " or ".join(word for word, known in self.words.items() if known == meaning)


NX = CycleNotation(
    "NX",
    {"DRILL": DRILL, "DRILL,DEEP": DEEP, "DRILL,BRKCHP": BREAK_CHIP, "DRILL,CSINK": DRILL, "BORE": REAM},
    {"FEDTO": "depth", "RAPTO": "clearance", "CLEAR": "clearance", "RTRCTO": "return", "STEP": "step",
     "DWELL": "dwell", "REV": "turns"},
    down=-1.0,
)  # fmt: skip
CREO = CycleNotation(
    "Creo",
    {"DRILL": DRILL, "FACE": DRILL, "CSINK": DRILL, "DEEP": DEEP, "BRKCHP": BREAK_CHIP, "REAM": REAM,
     "THRU": DRILL},
    {"DEPTH": "depth", "CLEAR": "clearance", "RAPTO": "advance", "RETURN": "return", "STEP": "step",
     "DWELL": "dwell", "REV": "turns"},
    initial=0.0,
    excluded={"BRKCHP": frozenset({"DWELL", "REV"})},
    positions=("depth", "feed", "clearance", "step"),
)  # fmt: skip
CAMWORKS = CycleNotation(
    "CAMWorks",
    {"DRILL": DRILL, "DEEP": DEEP, "DEEP2": DEEP},
    {"FEDTO": "depth", "RAPTO": "clearance", "RTRCTO": "return", "INCR": "step", "SUBPECK": "step",
     "1STPECK": "first step", "DWELL": "dwell"},
)  # fmt: skip
NCCS = CycleNotation(
    "NCCS PostWorks",
    {"DRILL": DRILL, "FACE": DRILL, "REAM": REAM},
    {"FEDTO": "depth", "RAPTO": "clearance", "RTRCTO": "return", "DWELL": "dwell"},
)
CAMPLETE = CycleNotation(
    "CAMplete",
    {"DRILL": DRILL, "DRILL,DEEP": DEEP, "BRKCHP": BREAK_CHIP, "REAM": REAM},
    # CLEAR, and RETURN of MANUSnc, are coordinates: those of the height before the cycle [Autodesk posts].
    {"FEDTO": "depth", "RAPTO": "clearance", "RTRCTO": "return", "INCR": "step", "DWELL": "dwell", "CLEAR": "",
     "RETURN": ""},
    to_initial=True,
)  # fmt: skip
TAPPING = frozenset({"TAP", "RIGID", "REVERS"})
"""Spindle-synchronised cycles of any CAM system."""
NOTATIONS = {"nx": NX, "creo": CREO, "solidworks": CAMWORKS, "camplete": CAMPLETE}
"""By dialect, where it determines the notation."""
_ALL = (NX, CREO, CAMWORKS, NCCS, CAMPLETE)
_ONLY_CAMWORKS = {"DEEP2", "INCR", "SUBPECK", "1STPECK"}


def notation_by_words(used: Collection[str]) -> CycleNotation:
    """Infer the cycle notation from the words used, where the dialect does not determine it."""
    if _ONLY_CAMWORKS & set(used):
        return CAMWORKS
    return NCCS if {"FEDTO", "RTRCTO"} & set(used) else CREO


def words_of_cycles() -> set[str]:
    """All words of cycles, of any CAM system."""
    kinds = {word for one in _ALL for kind in one.kinds for word in kind.split(",")}
    return kinds | {word for one in _ALL for word in one.words} | {AUTO, MANUAL} | TAPPING


def is_known_word(word: str) -> bool:
    """Whether any CAM system uses a word."""
    return word == AUTO or any(word in one.words for one in _ALL)


def is_known_kind(kind: str) -> bool:
    """Whether any CAM system has cycles of a kind."""
    return any(kind in one.kinds for one in _ALL)
