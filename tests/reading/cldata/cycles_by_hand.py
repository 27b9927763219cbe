# SPDX-License-Identifier: LGPL-2.1-or-later
"""A second reader of CL data with cycles, written from the manuals alone; nothing of the product is in it.

It knows GOTO with or without an axis, RAPID, FEDRAT/f,MMPM, UNITS and CYCLE of four makers, one word after the other:
NX (UG/Post: heights above the point, FEDTO negative, RTRCTO,AUTO is the height before), Creo (PTC: RAPTO from CLEAR
down, RETURN,0 the retract plane), CAMWorks (AptPostProcessor: FEDTO down, RAPTO and RTRCTO up), NCCS PostWorks
(cycle.f). Where the tool crosses is found by halving, not by a formula.
"""

from dataclasses import dataclass

import numpy as np

BACK_ABOVE_BOTTOM = 0.5
"""mm, docs/cl-data.md."""


@dataclass
class Move:
    """Where a move ends; the feed in mm/min is None for a rapid move."""

    place: np.ndarray
    axis: np.ndarray
    feed: float | None
    line: int


@dataclass
class Drilled:
    """A hole: its point, its axis, how deep it is and in which height the tool may move sideways above it, mm."""

    point: np.ndarray
    axis: np.ndarray
    depth: float
    clear: float
    line: int


@dataclass
class Heights:
    """A cycle in no system's words: heights above the point, mm, None for the height before the first hole."""

    depth: float
    clear: float
    start: float
    back: float | None
    pecks: list[float]
    out: bool
    feed_out: bool
    feed: float


class ByHand:
    """Reads a text at once: ``moves`` and ``holes``."""

    def __init__(self, maker, text):
        self.maker, self.scale = maker, 1.0
        self.moves, self.holes = [], []
        self.axis, self.feed, self.rapid = np.array([0, 0, 1.0]), None, True
        self.cycle, self.drilling, self.returns, self.initial = None, False, None, None
        for number, line in enumerate(text.splitlines(), 1):
            word, _, rest = line.partition("/")
            getattr(self, f"read_{word.lower()}")(rest.split(","), number)

    def read_units(self, items, _):
        self.scale = {"MM": 1.0, "INCHES": 25.4}[items[0]]

    def read_rapid(self, _, __):
        self.rapid = True

    def read_loadtl(self, _, __):
        """The tool makes no motion."""

    def read_fedrat(self, items, _):
        self.feed = float(items[0])

    def read_goto(self, items, number):
        values = np.array([float(item) for item in items])
        place = values[:3] * self.scale
        before = self.axis
        self.axis = values[3:] / np.linalg.norm(values[3:]) if len(values) == 6 else before
        if self.drilling:
            self.drill(place, before, number)
        else:
            self.initial = None
            self.moves.append(Move(place, self.axis, None if self.rapid else self.feed, number))
        self.rapid = False

    def read_cycle(self, items, _):
        if items[0] in ("OFF", "ON"):
            self.drilling = items[0] == "ON"
        elif items in (["INIT"], ["CLEAR"]):
            self.returns = items[0]
        else:
            self.cycle, self.drilling = self.heights(items), True
        if not self.drilling:
            self.initial = None

    def heights(self, items):
        values = {word: self.number(after) for word, after in zip(items, [*items[1:], ""], strict=True)}
        step = next((values[word] for word in ("STEP", "INCR", "SUBPECK") if word in values), None)
        if self.maker == "nx":
            depth, clear = -values["FEDTO"], values.get("RAPTO", values.get("CLEAR"))
            start, back = clear, None if values.get("RTRCTO") == "AUTO" else values.get("RTRCTO", clear)
        elif self.maker == "creo":
            depth, clear = values["DEPTH"], values["CLEAR"]
            start, back = clear - values.get("RAPTO", 0), values.get("RETURN", clear)
            back = None if back == 0 else back
        else:
            depth, clear = values["FEDTO"], values["RAPTO"]
            start, back = clear, values.get("RTRCTO", None if self.returns == "INIT" else clear)
            back = clear if self.returns == "CLEAR" else back
        pecks = self.pecks(depth, values.get("1STPECK", step), step) if step else [depth]
        lengths = [length * self.scale for length in (depth, clear, start)]
        height = None if back is None else max(back, clear) * self.scale
        kinds = {"DEEP", "DEEP2", "BRKCHP"} & set(items)
        feed = values.get("MMPM", self.feed)
        pecks = [peck * self.scale for peck in pecks] if kinds else lengths[:1]
        return Heights(*lengths, height, pecks, "BRKCHP" not in kinds, bool({"REAM", "BORE"} & set(items)), feed)

    @staticmethod
    def number(text):
        try:
            return float(text)
        except ValueError:
            return text

    @staticmethod
    def pecks(depth, first, step):
        reached = [min(first, depth)]
        while reached[-1] < depth - 1e-9:
            reached.append(min(reached[-1] + step, depth))
        return reached

    def drill(self, point, axis_before, number):
        cycle, axis = self.cycle, self.axis
        here = self.moves[-1].place
        self.initial = here if self.initial is None else self.initial
        height = max(cycle.clear, (self.initial - point) @ axis) if cycle.back is None else cycle.back
        self.holes.append(Drilled(point, axis, cycle.depth, cycle.clear, number))
        top = point + height * axis
        rise = least(lambda way: (here + way * axis_before - top) @ axis >= -1e-12)
        drop = least(lambda way: (top + way * axis - here) @ axis_before >= -1e-12)
        self.moves.append(Move(here + rise * axis_before, axis_before, None, number))
        self.moves.append(Move(top + drop * axis, axis, None, number))
        self.go(point, cycle.start, None, number)
        for index, depth in enumerate(cycle.pecks):
            self.go(point, -depth, cycle.feed, number)
            if index + 1 < len(cycle.pecks):
                if cycle.out:
                    self.go(point, cycle.clear, None, number)
                self.go(point, min(BACK_ABOVE_BOTTOM - depth, cycle.start), None, number)
        if cycle.feed_out:
            self.go(point, cycle.start, cycle.feed, number)
        self.go(point, height, None, number)

    def go(self, point, height, feed, number):
        self.moves.append(Move(point + height * self.axis, self.axis, feed, number))


def least(holds):
    """The least way from 0 on at which a condition holds that goes on holding, by halving."""
    low, high = 0.0, 1e5
    if holds(low):
        return low
    for _ in range(100):
        middle = (low + high) / 2
        low, high = (low, middle) if holds(middle) else (middle, high)
    return high


def without_standing_still(moves):
    """The moves that go somewhere."""
    return [
        move
        for before, move in zip([None, *moves], moves, strict=False)
        if before is None or abs(move.place - before.place).max() > 1e-7 or abs(move.axis - before.axis).max() > 1e-9
    ]
