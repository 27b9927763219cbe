# SPDX-License-Identifier: LGPL-2.1-or-later
"""Stretches: a motion including its dwells, split at all other events.

Enters: strut motion, whose clock stops during dwells. Leaves: for each stretch a clock that also runs during dwells, in
ms, and the events before it, and after the last one.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from pkm_post.model import Array, Event, EventKind, StrutMotion


@dataclass(frozen=True)
class Stretch:
    """A stretch of a motion.

    Attributes:
        before: events before it begins, in order.
        clock_ms: marks on its own clock, from 0 on.
        motion_ms: the time of the motion at each of these marks; linear between them.
        after: events after its end; last stretch only.
    """

    before: tuple[Event, ...]
    clock_ms: tuple[float, ...]
    motion_ms: tuple[float, ...]
    after: tuple[Event, ...] = ()

    def time_at(self, clock_ms: Array) -> Array:
        """The time of the motion in ms, (M,), at times of this clock; constant after the end."""
        return np.interp(clock_ms, self.clock_ms, self.motion_ms)

    def rows_ms(self, period_ms: int) -> Array:
        """The time of the motion in ms at every period, (M,), from the first mark to the last or just after it."""
        periods = int(np.ceil(self.clock_ms[-1] / period_ms))
        return self.time_at(np.arange(periods + 1) * float(period_ms))


@dataclass
class _Piece:
    """A stretch under construction."""

    motion_ms: list[float]
    clock_ms: list[float] = field(default_factory=lambda: [0.0])
    before: list[Event] = field(default_factory=list)

    def go_to(self, motion_ms: float) -> None:
        self._mark(motion_ms - self.motion_ms[-1], motion_ms)

    def stand(self, duration_ms: float) -> None:
        self._mark(duration_ms, self.motion_ms[-1])

    def _mark(self, later: float, motion_ms: float) -> None:
        if later > 0:
            self.clock_ms.append(self.clock_ms[-1] + later)
            self.motion_ms.append(motion_ms)

    @property
    def is_empty(self) -> bool:
        return len(self.clock_ms) == 1


def stretches(motion: StrutMotion) -> tuple[Stretch, ...]:
    """The stretches of a motion, at least one; only a motion at standstill has a stretch without duration."""
    pieces = [_Piece([0.0])]
    for event in motion.events:
        pieces[-1].go_to(float(motion.time_ms[event.row]))
        if event.kind == EventKind.DWELL:
            pieces[-1].stand(1000 * event.value)
            continue
        if not pieces[-1].is_empty:
            pieces.append(_Piece([float(motion.time_ms[event.row])]))
        pieces[-1].before.append(event)
    pieces[-1].go_to(float(motion.time_ms[-1]))
    after = pieces.pop().before if len(pieces) > 1 and pieces[-1].is_empty else []
    made = [Stretch(tuple(piece.before), tuple(piece.clock_ms), tuple(piece.motion_ms)) for piece in pieces]
    return (*made[:-1], replace(made[-1], after=tuple(after)))
