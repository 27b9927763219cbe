# SPDX-License-Identifier: LGPL-2.1-or-later
"""Canned cycles: G73, G81, G82, G83, G85, G86 and G89 drill, G74 and G84 tap, in any plane.

Input: cycle blocks and the tool position, in mm and program coordinates. Output: rapid and linear moves, with the
events between them. R, Q, P and the depth are modal as long as the cycle is active, the initial level until another
motion intervenes. L, or K on Fanuc, repeats the hole, with G91 at the same increment each time [LinuxCNC; Fanuc, canned
cycles]. The flavour covers differences between controls.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from pkm_post.model import Array, EventKind, Kind
from pkm_post.reading.gcode.codes import TAPPING, Word, word_of
from pkm_post.reading.gcode.flavours import RS274, Flavour

PECK_CLEARANCE = 0.254
"""Clearance above the depth reached at which a peck resumes feed, and retract distance of G73, mm."""
MOST_STROKES = 10_000
"""More pecks or holes in one block count as a programming error."""

_PECKS = (730, 830)
_STOPS_SPINDLE = 860


HANDS = {840: 1.0, 740: -1.0}
"""Hand of the thread: 1 right, -1 left."""

WordBlock = tuple[float, float, float, float]
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
        peck: Q, or I for decreasing pecks.
        dwell: P, s.
        reduction: J, reduction from peck to peck.
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
        cycle: the last one, with the active words.
        initial: the initial level: the tool height at the start of the first cycle.
    """

    cycle: Cycle
    initial: float

    @classmethod
    def after(
        cls, before: CycleSeries | None, code: int, height: float, words: WordBlock, flavour: Flavour = RS274
    ) -> CycleSeries:
        """Extend the series, None after another motion, by a cycle at a height of the tool.

        ``words`` are R, depth, Q and P of its block, NaN where absent.
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

    position: Array
    kinds: list[int] = field(default_factory=list)
    ends: list[Array] = field(default_factory=list)
    events: list[tuple[int, EventKind, float]] = field(default_factory=list)

    def move(self, kind: Kind, axis: int | tuple[int, ...], to: float | Array) -> None:
        """Move some coordinates, unless the tool is already there."""
        end = self.position.copy()
        end[[axis] if isinstance(axis, int) else list(axis)] = to
        if not np.array_equal(end, self.position):
            self.kinds.append(kind)
            self.ends.append(end)
            self.position = end

    def add_event(self, kind: EventKind, value: float) -> None:
        """Add an event at the current point."""
        self.events.append((len(self.ends), kind, value))


def cycle_fault(
    cycle: Cycle, hole: Hole, repeats: float, spindle: float, flavour: Flavour = RS274
) -> tuple[str, tuple[str | Word, ...]] | None:
    """The fault that prevents a cycle from being executed: code and finding."""
    name = word_of(cycle.code)
    dwells = set(flavour.cycle_dwells) - set(TAPPING) if flavour.needs_dwell else ()
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
    if cycle.code in TAPPING and spindle * HANDS[cycle.code] < 0:
        return "G418", (name, " while the spindle turns the other way")
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
    position: Array,
    spindle: float,
    flavour: Flavour = RS274,
) -> Strokes:
    """The moves of a cycle: retract if the tool is too low, traverse, descend to R, and drill the hole.

    Args:
        cycle: to expand.
        hole: its heights.
        centres: (n, 2) hole positions, by first and second coordinate of the plane.
        axes: first, second and normal coordinate of the plane.
        position: (3,) of the tool.
        spindle: signed spindle speed, 1/min.
        flavour: of the cycle.
    """
    strokes = Strokes(position)
    normal = axes[2]
    if position[normal] <= hole.top:
        strokes.move(Kind.RAPID, normal, hole.clear)
    for centre in centres:
        strokes.move(Kind.RAPID, axes[:2], centre)
        strokes.move(Kind.RAPID, normal, hole.top)
        if cycle.code in TAPPING:
            _tap(cycle, hole, normal, strokes, spindle)
            continue
        _drill_down(cycle, hole, normal, strokes)
        _retract(cycle, hole, normal, strokes, spindle, flavour)
    return strokes


def _tap(cycle: Cycle, hole: Hole, normal: int, strokes: Strokes, spindle: float) -> None:
    """Down and up to R with the spindle as an axis, which then turns as before. The lead is set later."""
    if hole.bottom < hole.top:
        strokes.add_event(EventKind.SPINDLE_AXIS, HANDS[cycle.code])
        strokes.move(Kind.LINE, normal, hole.bottom)
        if cycle.dwell > 0:
            strokes.add_event(EventKind.DWELL, cycle.dwell)
        strokes.move(Kind.LINE, normal, hole.top)
        strokes.add_event(EventKind.SPINDLE_AXIS, 0.0)
        if spindle:
            strokes.add_event(EventKind.SPINDLE, spindle)
    strokes.move(Kind.RAPID, normal, hole.clear)


def rigid_tap(position: Array, end: Array, spindle: float) -> Strokes:
    """To a point and back, both (3,), with the spindle as an axis, which then turns as before."""
    strokes = Strokes(position)
    if not np.array_equal(position, end):
        strokes.add_event(EventKind.SPINDLE_AXIS, math.copysign(1.0, spindle))
        strokes.move(Kind.LINE, (0, 1, 2), end)
        strokes.move(Kind.LINE, (0, 1, 2), position)
        strokes.add_event(EventKind.SPINDLE_AXIS, 0.0)
        strokes.add_event(EventKind.SPINDLE, spindle)
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
