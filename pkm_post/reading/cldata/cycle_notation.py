# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cycles: an interpreted CYCLE statement of any CAM system, in mm, mm/s and s.

Heights are along the tool axis, relative to the hole point: depth is positive downwards, all others upwards.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Strokes:
    """Stroke pattern of a kind of cycle.

    Attributes:
        pecks: "none"; "out", full retract after each peck; "break", short retract to break the chip.
        feed_out: the tool retracts at feed.
    """

    pecks: str = "none"
    feed_out: bool = False


DRILL = Strokes()
DEEP = Strokes("out")
BREAK_CHIP = Strokes("break")
REAM = Strokes(feed_out=True)


@dataclass(frozen=True)
class Cycle:
    """One cycle.

    Attributes:
        strokes: stroke pattern.
        depth: of the bottom below the point.
        clearance: height of lateral moves.
        start: height at which feed starts, at most the clearance.
        height: return height, at least the clearance.
        to_initial: the tool returns to its height before the first hole instead, if above the clearance.
        step: maximum depth of one peck; 0 for none.
        first_step: depth of the first peck.
        dwell: at the bottom, s.
        feed: mm/s.
    """

    strokes: Strokes
    depth: float
    clearance: float
    start: float
    height: float
    to_initial: bool
    step: float
    first_step: float
    dwell: float
    feed: float


AUTO = "AUTO"
MANUAL = "MANUAL"
"""After RTRCTO of NX: return to the height before the cycle, or to the written height."""


@dataclass(frozen=True)
class CycleWords:
    """The cycle notation of one CAM system.

    Attributes:
        maker: displayed name.
        kinds: the words of a kind, joined by commas, and its strokes.
        words: meaning of the number after a word: "depth"; "clearance", height of lateral moves; "advance", distance
            below the clearance at which feed starts; "return", height to which the tool returns; "step"; "first step";
            "dwell", s; "turns", spindle revolutions to dwell.
        down: 1 where depths count positive downwards, -1 where they are heights above the point.
        initial: number after "return" that means the height before the cycle; None for none.
        left_out: words with a different meaning in one kind, which is not supported.
    """

    maker: str
    kinds: Mapping[str, Strokes]
    words: Mapping[str, str]
    down: float = 1.0
    initial: float | None = None
    left_out: Mapping[str, frozenset[str]] = field(default_factory=dict)

    def known_words(self, kind: str) -> set[str]:
        """The words known in cycles of a kind."""
        return set(self.words) - self.left_out.get(kind, frozenset())

    def words_for(self, meaning: str) -> str:
        """The words with one meaning, for messages."""
        return " or ".join(word for word, said in self.words.items() if said == meaning)


NX = CycleWords(
    "NX",
    {"DRILL": DRILL, "DRILL,DEEP": DEEP, "DRILL,BRKCHP": BREAK_CHIP, "DRILL,CSINK": DRILL, "BORE": REAM},
    {"FEDTO": "depth", "RAPTO": "clearance", "CLEAR": "clearance", "RTRCTO": "return", "STEP": "step",
     "DWELL": "dwell", "REV": "turns"},
    down=-1.0,
)  # fmt: skip
CREO = CycleWords(
    "Creo",
    {"DRILL": DRILL, "FACE": DRILL, "CSINK": DRILL, "DEEP": DEEP, "BRKCHP": BREAK_CHIP, "REAM": REAM},
    {"DEPTH": "depth", "CLEAR": "clearance", "RAPTO": "advance", "RETURN": "return", "STEP": "step",
     "DWELL": "dwell", "REV": "turns"},
    initial=0.0,
    left_out={"BRKCHP": frozenset({"DWELL", "REV"})},
)  # fmt: skip
CAMWORKS = CycleWords(
    "CAMWorks",
    {"DRILL": DRILL, "DEEP": DEEP, "DEEP2": DEEP},
    {"FEDTO": "depth", "RAPTO": "clearance", "RTRCTO": "return", "INCR": "step", "SUBPECK": "step",
     "1STPECK": "first step", "DWELL": "dwell"},
)  # fmt: skip
NCCS = CycleWords(
    "NCCS PostWorks",
    {"DRILL": DRILL, "FACE": DRILL, "REAM": REAM},
    {"FEDTO": "depth", "RAPTO": "clearance", "RTRCTO": "return", "DWELL": "dwell"},
)
TAPPING = frozenset({"TAP", "RIGID", "REVERS"})
"""Spindle-synchronised cycles of any CAM system."""
_OF_DIALECT = {"nx": NX, "creo": CREO, "solidworks": CAMWORKS}
_ALL = (NX, CREO, CAMWORKS, NCCS)
_CAMWORKS_ALONE = {"DEEP2", "INCR", "SUBPECK", "1STPECK"}


def words_of_dialect(dialect: str) -> CycleWords | None:
    """The cycle notation of a dialect, None if unknown."""
    return _OF_DIALECT.get(dialect)


def words_by_use(used: Collection[str]) -> CycleWords:
    """Infer the cycle notation from the words used, where the dialect does not determine it."""
    if _CAMWORKS_ALONE & set(used):
        return CAMWORKS
    return NCCS if {"FEDTO", "RTRCTO"} & set(used) else CREO


def known_to_some(word: str) -> bool:
    """Whether any CAM system uses a word: with the words beside it, it then has another meaning or none."""
    return word == AUTO or any(word in one.words for one in _ALL)


def kind_of_some(kind: str) -> bool:
    """Whether any CAM system has cycles of a kind."""
    return any(kind in one.kinds for one in _ALL)
