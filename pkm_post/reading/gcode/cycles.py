# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cycles: expand a drilling cycle into moves and dwells.

Enters: the tool position and the words of one block, in mm and program coordinates. Leaves: rapid and linear moves,
with the events between them. G73, G81, G82, G83, G85, G86 and G89, in any plane, as defined by RS274NGC.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from pkm_post.model import Array, EventKind, Kind
from pkm_post.reading.gcode.codes import name_of

PECK_CLEARANCE = 0.254
"""Clearance above the depth reached at which a peck resumes feed, and retract distance of G73, mm."""
MOST_STROKES = 10_000
"""A block with more pecks or holes than this is taken for a programming error."""

DWELLS = (820, 860, 890)
"""Cycles that dwell at the bottom."""
_PECKS = (730, 830)
_STOPS_SPINDLE = 860


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
        peck: Q.
        dwell: P, s.
    """

    code: int
    retract: float = math.nan
    bottom: float = math.nan
    peck: float = math.nan
    dwell: float = math.nan

    def with_words(self, retract: float, bottom: float, peck: float, dwell: float) -> Cycle:
        """Update the cycle with the words that are given."""
        new, old = (retract, bottom, peck, dwell), (self.retract, self.bottom, self.peck, self.dwell)
        return Cycle(self.code, *(before if math.isnan(word) else word for word, before in zip(new, old, strict=True)))


@dataclass(frozen=True)
class Series:
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
    def after(cls, before: Series | None, code: int, height: float, words: Words) -> Series:
        """Extend the series by one cycle.

        Args:
            before: the series so far; None after another motion.
            code: code of the cycle.
            height: of the tool.
            words: R, depth, Q and P of its block, NaN where absent.
        """
        if before is None:
            return cls(Cycle(code).with_words(*words), height)
        same = before.cycle if before.cycle.code == code else Cycle(code)
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

    def go(self, kind: Kind, axis: int | tuple[int, int], to: float | Array) -> None:
        """Move some coordinates, unless the tool is already there."""
        end = self.here.copy()
        end[[axis] if isinstance(axis, int) else list(axis)] = to
        if not np.array_equal(end, self.here):
            self.kinds.append(kind)
            self.ends.append(end)
            self.here = end

    def happen(self, kind: EventKind, value: float) -> None:
        """Add an event at the current point."""
        self.events.append((len(self.ends), kind, value))


def fault_of(cycle: Cycle, hole: Hole, repeats: float, spindle: float) -> tuple[str, str] | None:
    """The fault that prevents a cycle from being executed: code and what was found."""
    name = name_of(cycle.code)
    for letter, value, codes in (("Q", cycle.peck, _PECKS), ("P", cycle.dwell, DWELLS)):
        if cycle.code in codes and math.isnan(value):
            return "G405", f"{name} without {letter}"
    if math.isnan(hole.top):
        return "G405", f"{name} without R"
    if math.isnan(hole.bottom):
        return "G405", f"{name} without a depth"
    if hole.top < hole.bottom:
        return "G418", f"{name}: R {hole.top:g} is below the bottom {hole.bottom:g}"
    if cycle.code in _PECKS and not cycle.peck > 0:
        return "G418", f"{name} Q{cycle.peck:g}"
    if not 1 <= repeats <= MOST_STROKES or repeats != round(repeats):
        return "G418", f"{name} repeated {repeats:g} times"
    if cycle.code in _PECKS and repeats * (hole.top - hole.bottom) / cycle.peck > MOST_STROKES:
        return "G418", f"{name}: more than {MOST_STROKES} pecks"
    if cycle.code == _STOPS_SPINDLE and not spindle:
        return "G418", f"{name} while the spindle stands still"
    if not cycle.dwell >= 0 and not math.isnan(cycle.dwell):
        return "G418", f"{name} P{cycle.dwell:g}"
    return None


def strokes(
    cycle: Cycle, hole: Hole, centres: Array, axes: tuple[int, int, int], here: Array, spindle: float
) -> Strokes:
    """The moves of a cycle: retract if the tool is too low, traverse, descend to R, and drill the hole.

    Args:
        cycle: to expand.
        hole: its heights.
        centres: (n, 2) hole positions, by first and second coordinate of the plane.
        axes: first, second and normal coordinate of the plane.
        here: (3,) tool position.
        spindle: signed spindle speed, 1/min.
    """
    made = Strokes(here)
    normal = axes[2]
    if here[normal] <= hole.top:
        made.go(Kind.RAPID, normal, hole.clear)
    for centre in centres:
        made.go(Kind.RAPID, axes[:2], centre)
        made.go(Kind.RAPID, normal, hole.top)
        _down(cycle, hole, normal, made)
        _up(cycle, hole, normal, made, spindle)
    return made


def _pecks(cycle: Cycle, hole: Hole) -> Iterator[float]:
    depth = hole.top - cycle.peck
    while depth > hole.bottom:
        yield depth
        depth -= cycle.peck


def _down(cycle: Cycle, hole: Hole, normal: int, made: Strokes) -> None:
    for depth in _pecks(cycle, hole) if cycle.code in _PECKS else ():
        made.go(Kind.LINE, normal, depth)
        if cycle.code == 830:
            made.go(Kind.RAPID, normal, hole.top)
        made.go(Kind.RAPID, normal, depth + PECK_CLEARANCE)
    made.go(Kind.LINE, normal, hole.bottom)


def _up(cycle: Cycle, hole: Hole, normal: int, made: Strokes, spindle: float) -> None:
    if cycle.code in DWELLS and cycle.dwell > 0:
        made.happen(EventKind.DWELL, cycle.dwell)
    if cycle.code == _STOPS_SPINDLE:
        made.happen(EventKind.SPINDLE, 0.0)
    if cycle.code in (850, 890):
        made.go(Kind.LINE, normal, hole.top if cycle.code == 850 else hole.clear)
    made.go(Kind.RAPID, normal, hole.clear)
    if cycle.code == _STOPS_SPINDLE:
        made.happen(EventKind.SPINDLE, spindle)
