# SPDX-License-Identifier: LGPL-2.1-or-later
"""Drilling cycles: G73, G81, G82, G83, G85, G86 and G89, in any plane.

Enters: cycle blocks and the tool position, in mm and program coordinates. Leaves: rapid and linear moves, with the
events between them. R, Q, P and the depth are modal as long as the cycle is active, the initial level until another
motion intervenes. L, or K on Fanuc, repeats the hole, with G91 at the same increment each time [LinuxCNC; Fanuc, canned
cycles]. The flavour says where controls differ.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from pkm_post.model import Array, EventKind, Kind
from pkm_post.reading.gcode.blocks import Blocks
from pkm_post.reading.gcode.codes import Group, Word, word_of
from pkm_post.reading.gcode.diagnostics import BlockDiagnostics, Found
from pkm_post.reading.gcode.flavours import RS274, Flavour
from pkm_post.reading.gcode.frames import PLANES, Frame
from pkm_post.reading.gcode.modal import Modal, is_cycle
from pkm_post.reading.gcode.polar import PolarWords

PECK_CLEARANCE = 0.254
"""Clearance above the depth reached at which a peck resumes feed, and retract distance of G73, mm."""
MOST_STROKES = 10_000
"""A block with more pecks or holes than this is taken for a programming error."""

_PECKS = (730, 830)
_STOPS_SPINDLE = 860
_REPEATS = "LK"
_SAME_HEIGHT = 1e-9
"""mm: round-off of a coordinate transformed to {C} and back."""


Words = tuple[float, float, float, float]
"""R, depth, Q and P of a block, NaN where absent."""


@dataclass(frozen=True)
class Hole:
    """Heights of a cycle: feed start, bottom, and end, which is never below the feed start."""

    top: float
    bottom: float
    clear: float


@dataclass(frozen=True)
class Cycle:
    """The words of a cycle, including the modal ones; NaN where unspecified.

    Attributes:
        code: 810 for G81.
        retract: R, the height at which the feed starts.
        bottom: word of the coordinate normal to the plane.
        peck: Q, or I where pecks grow smaller.
        dwell: P, s.
        reduction: J, by how much each peck is smaller than the one before.
        least: K, the smallest peck.
    """

    code: int
    retract: float = math.nan
    bottom: float = math.nan
    peck: float = math.nan
    dwell: float = math.nan
    reduction: float = 0.0
    least: float = math.nan

    def with_words(self, retract: float, bottom: float, peck: float, dwell: float) -> Cycle:
        """Update the cycle with the words that are given."""
        new, old = (retract, bottom, peck, dwell), (self.retract, self.bottom, self.peck, self.dwell)
        kept = (before if math.isnan(word) else word for word, before in zip(new, old, strict=True))
        retract, bottom, peck, dwell = kept
        return replace(self, retract=retract, bottom=bottom, peck=peck, dwell=dwell)


@dataclass(frozen=True)
class CycleSeries:
    """Consecutive cycles without another motion between them.

    The tool may be at R when the next cycle begins (G99). G98 still returns to the initial level, and with G91 R is
    still relative to it [LinuxCNC; PUMOTIX].

    Attributes:
        cycle: the last one, with the words in force.
        initial: the initial level: the tool height at the start of the first cycle.
    """

    cycle: Cycle
    initial: float

    @classmethod
    def after(
        cls, before: CycleSeries | None, code: int, height: float, words: Words, flavour: Flavour = RS274
    ) -> CycleSeries:
        """Extend the series by one cycle.

        Args:
            before: the series so far; None after another motion.
            code: code of the cycle.
            height: of the tool.
            words: R, depth, Q and P of its block, NaN where absent.
            flavour: whose cycles they are.
        """
        if before is None:
            return cls(Cycle(code).with_words(*words), height)
        holds = flavour.keeps_cycle_words or before.cycle.code == code
        same = replace(before.cycle, code=code) if holds else Cycle(code)
        return cls(same.with_words(*words), before.initial)

    def hole(self, relative: bool, returns: bool) -> Hole:
        """The heights of the last cycle.

        Args:
            relative: whether R is relative to the initial level, and the depth relative to R (G91).
            returns: whether the tool returns to the initial level (G98) rather than to R.
        """
        top = self.cycle.retract + (self.initial if relative else 0.0)
        bottom = self.cycle.bottom + (top if relative else 0.0)
        return Hole(top, bottom, max(self.initial, top) if returns else top)


@dataclass
class Strokes:
    """Builder for the moves of a cycle: kind and end point by row, and events as (row, kind, value) before a row."""

    here: Array
    kinds: list[int] = field(default_factory=list)
    ends: list[Array] = field(default_factory=list)
    events: list[tuple[int, EventKind, float]] = field(default_factory=list)

    def move(self, kind: Kind, axis: int | tuple[int, int], to: float | Array) -> None:
        """Move some coordinates, unless the tool is already there."""
        end = self.here.copy()
        end[[axis] if isinstance(axis, int) else list(axis)] = to
        if not np.array_equal(end, self.here):
            self.kinds.append(kind)
            self.ends.append(end)
            self.here = end

    def add_event(self, kind: EventKind, value: float) -> None:
        """Add an event at the current point."""
        self.events.append((len(self.ends), kind, value))


def cycle_fault(
    cycle: Cycle, hole: Hole, repeats: float, spindle: float, flavour: Flavour = RS274
) -> tuple[str, tuple[str | Word, ...]] | None:
    """The fault that prevents a cycle from being executed: code and what was found."""
    name = word_of(cycle.code)
    dwells = flavour.cycle_dwells if flavour.needs_dwell else ()
    for letter, value, codes in (("Q", cycle.peck, _PECKS), ("P", cycle.dwell, dwells)):
        if cycle.code in codes and math.isnan(value):
            return "G405", (name, f" without {letter}")
    if math.isnan(hole.top):
        return "G405", (name, " without R")
    if math.isnan(hole.bottom):
        return "G405", (name, " without a depth")
    if hole.top < hole.bottom:
        return "G418", (name, f": R {hole.top:g} is below the bottom {hole.bottom:g}")
    if cycle.code in _PECKS and not cycle.peck > 0:
        return "G418", (name, " ", Word("Q", cycle.peck))
    if not 1 <= repeats <= MOST_STROKES or repeats != round(repeats):
        return "G418", (name, f" repeated {repeats:g} times")
    if cycle.code in _PECKS and cycle.reduction and not 0 < cycle.least <= cycle.peck:
        return "G418", (name, " with J: K is the smallest peck, above 0 and up to I")
    if cycle.code in _PECKS and repeats * (hole.top - hole.bottom) / _smallest(cycle) > MOST_STROKES:
        return "G418", (name, f": more than {MOST_STROKES} pecks")
    if cycle.code == _STOPS_SPINDLE and not spindle:
        return "G418", (name, " while the spindle stands still")
    if not cycle.dwell >= 0 and not math.isnan(cycle.dwell):
        return "G418", (name, " ", Word("P", cycle.dwell))
    return None


def _smallest(cycle: Cycle) -> float:
    return cycle.least if cycle.reduction else cycle.peck


def cycle_strokes(
    cycle: Cycle,
    hole: Hole,
    centres: Array,
    axes: tuple[int, int, int],
    here: Array,
    spindle: float,
    flavour: Flavour = RS274,
) -> Strokes:
    """The moves of a cycle: retract if the tool is too low, traverse, descend to R, and drill the hole.

    Args:
        cycle: to expand.
        hole: its heights.
        centres: (n, 2) hole positions, by first and second coordinate of the plane.
        axes: first, second and normal coordinate of the plane.
        here: (3,) tool position.
        spindle: signed spindle speed, 1/min.
        flavour: whose cycle it is.
    """
    strokes = Strokes(here)
    normal = axes[2]
    if here[normal] <= hole.top:
        strokes.move(Kind.RAPID, normal, hole.clear)
    for centre in centres:
        strokes.move(Kind.RAPID, axes[:2], centre)
        strokes.move(Kind.RAPID, normal, hole.top)
        _drill_down(cycle, hole, normal, strokes)
        _retract(cycle, hole, normal, strokes, spindle, flavour)
    return strokes


def _pecks(cycle: Cycle, hole: Hole) -> Iterator[float]:
    peck = cycle.peck
    depth = hole.top - peck
    while depth > hole.bottom:
        yield depth
        peck = max(peck - cycle.reduction, min(cycle.least, peck)) if cycle.reduction else peck
        depth -= peck


def _drill_down(cycle: Cycle, hole: Hole, normal: int, strokes: Strokes) -> None:
    for depth in _pecks(cycle, hole) if cycle.code in _PECKS else ():
        strokes.move(Kind.LINE, normal, depth)
        if cycle.code == 830:
            strokes.move(Kind.RAPID, normal, hole.top)
        strokes.move(Kind.RAPID, normal, depth + PECK_CLEARANCE)
    strokes.move(Kind.LINE, normal, hole.bottom)


def _retract(cycle: Cycle, hole: Hole, normal: int, strokes: Strokes, spindle: float, flavour: Flavour) -> None:
    if cycle.code in flavour.cycle_dwells and cycle.dwell > 0:
        strokes.add_event(EventKind.DWELL, cycle.dwell)
    if cycle.code == _STOPS_SPINDLE:
        strokes.add_event(EventKind.SPINDLE, 0.0)
    if cycle.code in (850, 890):
        strokes.move(Kind.LINE, normal, hole.top if cycle.code in flavour.feeds_to_r else hole.clear)
    strokes.move(Kind.RAPID, normal, hole.clear)
    if cycle.code == _STOPS_SPINDLE:
        strokes.add_event(EventKind.SPINDLE, spindle)


class CycleTracker:
    """Tracks the active series of cycles."""

    def __init__(
        self,
        blocks: Blocks,
        modal: Modal,
        polar: PolarWords,
        spindle: Array,
        dwells: Array,
        faults: BlockDiagnostics,
    ) -> None:
        self._modal, self._polar, self._words = modal, polar, polar.words
        self._cycle_words = {letter: blocks.word(letter) for letter in "RQIJ" + _REPEATS}
        self._spindle, self._dwells, self._faults = spindle, dwells, faults
        self._series: CycleSeries | None = None
        self._row, self._level = 0, np.zeros(3)
        self._plane = self._distance = 0
        self._scale = 1.0

    @cached_property
    def _series_number(self) -> Array:
        """Number of the last non-cycle block up to each block, (N,): constant within a series."""
        return np.cumsum(~is_cycle(self._modal.active[Group.MOTION]))

    def strokes(self, row: int, position: Array, known: Array, frame: Frame) -> Strokes | None:
        """The strokes of one block, None if it has a fault.

        Args:
            row: the block.
            position: (3,) tool position.
            known: (3,) which coordinates are known.
            frame: of these coordinates.
        """
        code = int(self._modal.active[Group.MOTION][row])
        axes = PLANES[int(self._modal.active[Group.PLANE][row])]
        relative = bool(self._modal.active[Group.DISTANCE][row] == 910)
        given = ~np.isnan(self._words.at(row)) & (not relative)
        given[axes[2]] = False
        if not (known | given).all():
            self._faults.add("G416", row, word_of(code))
            return None
        returns = bool(self._modal.active[Group.RETRACT][row] == 980)
        series = self._extend_series(row, code, position, frame)
        hole = series.hole(relative, returns)
        repeats, spindle = self._repeats(row), float(self._spindle[row])
        conflict = self._mode_conflict(row, series, relative or returns, frame)
        if repeats == 0 and self._modal.flavour.stores_cycle:
            return self._stored(row, position)
        flavour = self._modal.flavour
        fault = ("G426", conflict) if conflict else cycle_fault(series.cycle, hole, repeats, spindle, flavour)
        if math.isnan(repeats):
            fault = "G418", (word_of(code), " with L and K")
        if fault:
            self._faults.add(fault[0], row, fault[1])
            return None
        centres = self._centres(row, position, axes, relative, int(repeats))
        return cycle_strokes(series.cycle, hole, centres, axes, position, spindle, self._modal.flavour)

    def _stored(self, row: int, position: Array) -> Strokes | None:
        """A cycle that only stores its words; whether it goes to a place of its own, controls do not agree."""
        axes = PLANES[int(self._modal.active[Group.PLANE][row])]
        if np.isnan(self._words.at(row)[list(axes[:2])]).all():
            return Strokes(position)
        name = word_of(int(self._modal.active[Group.MOTION][row]))
        self._faults.add("G418", row, (name, " repeated 0 times at another place"))
        return None

    def _extend_series(self, row: int, code: int, position: Array, frame: Frame) -> CycleSeries:
        """Extend the series by the cycle of this block."""
        normal = PLANES[int(self._modal.active[Group.PLANE][row])][2]
        scale = float(self._modal.scale[row])
        retract, peck = (scale * float(self._cycle_words[letter][row]) for letter in "RQ")
        words = (retract, float(self._words.columns[normal][row]), peck, float(self._dwells[row]))
        before = self._series if self._series_number[row] == self._series_number[self._row] else None
        self._series = self._with_smaller_pecks(
            row, CycleSeries.after(before, code, float(position[normal]), words, self._modal.flavour)
        )
        self._row = row
        if before is None:
            self._level, self._plane = frame.to_work(position), int(self._modal.active[Group.PLANE][row])
        if before is None or not (math.isnan(words[0]) or math.isnan(words[1])):
            self._distance, self._scale = int(self._modal.active[Group.DISTANCE][row]), scale
        return self._series

    def _shrinks(self, row: int) -> bool:
        """Whether I of a block is the first of pecks that grow smaller: J is by how much, K the smallest [Haas]."""
        return self._modal.flavour.pecks_by_i and not math.isnan(self._cycle_words["I"][row])

    def _with_smaller_pecks(self, row: int, series: CycleSeries) -> CycleSeries:
        if not self._shrinks(row):
            return series
        scale = float(self._modal.scale[row])
        first, less, least = (scale * float(self._cycle_words[letter][row]) for letter in "IJK")
        reduction = 0.0 if math.isnan(less) else less
        return replace(series, cycle=replace(series.cycle, peck=first, reduction=reduction, least=least))

    def _mode_conflict(self, row: int, series: CycleSeries, needs_level: bool, frame: Frame) -> Found:
        """What has changed since the modal words were programmed and may alter their meaning."""
        name, plane = word_of(series.cycle.code), int(self._modal.active[Group.PLANE][row])
        distance, scale = int(self._modal.active[Group.DISTANCE][row]), float(self._modal.scale[row])
        if plane != self._plane:
            return name, " goes on in ", word_of(plane), ", begun in ", word_of(self._plane)
        if distance != self._distance:
            return name, " goes on in ", word_of(distance), ", its R and depth are those of ", word_of(self._distance)
        if scale != self._scale:
            return name, f" goes on in a unit of {scale:g} mm, its R and depth are in one of {self._scale:g} mm"
        level = float(frame.to_program(self._level)[PLANES[plane][2]])
        if needs_level and abs(level - series.initial) > _SAME_HEIGHT:
            return name, f": the initial level {series.initial:g} is {level:g} where the origin lies now"
        return ""

    def _repeats(self, row: int) -> float:
        """Repeat count of the hole; NaN where two words specify it."""
        letters = "L" if self._shrinks(row) else _REPEATS
        words = [float(self._cycle_words[letter][row]) for letter in letters]
        given = [word for word in words if not math.isnan(word)]
        return 1.0 if not given else given[0] if len(given) == 1 else math.nan

    def _centres(self, row: int, position: Array, axes: tuple[int, int, int], relative: bool, repeats: int) -> Array:
        """Hole positions, (n, 2)."""
        words, here = self._words.at(row)[list(axes[:2])], position[list(axes[:2])]
        around = self._polar.repeated(row, here, repeats) if relative and axes[:2] == (0, 1) else None
        if around is not None:
            return around
        if relative:
            return here + np.arange(1, repeats + 1)[:, None] * np.nan_to_num(words)
        return np.tile(np.where(np.isnan(words), here, words), (repeats, 1))
