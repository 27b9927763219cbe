# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cycle words: how each maker writes cycles, as a table: kinds, words, and where their numbers count from.

The same word is another height for another maker; docs/cl-data.md says where each reading comes from. Files of the
dialects without words of their own (CATIA's depend on the table of the post-processor) are read by the words they use.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field

from pkm_post.cldata.cycles import BREAK_CHIP, DEEP, DRILL, REAM, Strokes

AUTO = "AUTO"
MANUAL = "MANUAL"
"""Behind RTRCTO of NX: to where the tool was before the cycle, or to the height that is written."""


@dataclass(frozen=True)
class CycleWords:
    """The cycles of one maker.

    Attributes:
        maker: for people.
        kinds: the words of a kind, joined by commas, and what it does.
        words: what the number behind a word is: "depth"; "clearance", height in which the tool moves sideways;
            "advance", how far below the clearance the feed begins; "return", height to which the tool returns; "step";
            "first step"; "dwell", s; "turns", of the spindle to dwell.
        down: 1 where depths count positive downwards, -1 where they are heights above the point.
        initial: number behind "return" that is the height the tool had before the cycle; None for none.
        left_out: words that mean something else in one kind, which is not carried out.
    """

    maker: str
    kinds: Mapping[str, Strokes]
    words: Mapping[str, str]
    down: float = 1.0
    initial: float | None = None
    left_out: Mapping[str, frozenset[str]] = field(default_factory=dict)

    def known_words(self, kind: str) -> set[str]:
        """The words that have a meaning in cycles of a kind."""
        return set(self.words) - self.left_out.get(kind, frozenset())

    def words_for(self, meaning: str) -> str:
        """The words that say one thing, for people."""
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
"""Cycles in step with the spindle, whoever wrote them."""
_OF_DIALECT = {"nx": NX, "creo": CREO, "solidworks": CAMWORKS}
_ALL = (NX, CREO, CAMWORKS, NCCS)
_CAMWORKS_ALONE = {"DEEP2", "INCR", "SUBPECK", "1STPECK"}


def words_of_dialect(dialect: str) -> CycleWords | None:
    """How the CAM system of a dialect writes cycles, None if that is not known."""
    return _OF_DIALECT.get(dialect)


def words_by_use(used: Collection[str]) -> CycleWords:
    """Whose words a CYCLE statement uses, where the dialect does not say it."""
    if _CAMWORKS_ALONE & set(used):
        return CAMWORKS
    return NCCS if {"FEDTO", "RTRCTO"} & set(used) else CREO


def known_to_some(word: str) -> bool:
    """Whether a word is that of some maker: then it has another meaning, or none, with the words beside it."""
    return word == AUTO or any(word in one.words for one in _ALL)


def kind_of_some(kind: str) -> bool:
    """Whether some maker has cycles of a kind."""
    return any(kind in one.kinds for one in _ALL)
