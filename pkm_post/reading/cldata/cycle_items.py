# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cycle items: the items after the kind of a CYCLE statement, each number identified by its preceding word.

Enters: items, with the vocabulary of their CAM system. Leaves: numbers by meaning, as written. For numbers without a
word before the first one an option gives the meaning: CATIA writes them according to the post-processor table.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

from pkm_post.reading.cldata.cycle_words import AUTO, MANUAL, CycleWords, known_to_some
from pkm_post.reading.cldata.feeds import FEED_WORDS
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
