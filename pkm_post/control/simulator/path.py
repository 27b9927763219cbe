# SPDX-License-Identifier: LGPL-2.1-or-later
"""Path: the queued moves of a program, in a time base that an override slows down or stops.

Enters: moves with their program times in ms. Leaves: axis positions. Synchronous assignments are executed when their
move begins.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from pkm_post.control.simulator.moves import Cubic, Move, Rest
from pkm_post.control.simulator.variables import Array

Pending = Callable[[], None]


class Path:
    """Moves that are computed but not completed.

    Attributes:
        time: program time, ms.
        abrupt_stops: number of PVT moves that ended at nonzero speed with nothing after them.
    """

    def __init__(self) -> None:
        self.time, self.abrupt_stops = 0.0, 0
        self._moves: list[Move] = []
        self._pending: list[tuple[Move, list[Pending]]] = []

    def clear(self) -> None:
        """Discard all moves."""
        self._moves, self._pending = [], []

    def add(self, move: Move, pending: list[Pending]) -> None:
        """Add a move that begins now or later, with its pending assignments."""
        self._moves.append(move)
        self._pending.append((move, pending))
        self._pass()

    def last(self) -> Move | None:
        """The last move in the queue."""
        return self._moves[-1] if self._moves else None

    def has_enough(self) -> bool:
        """Whether to compute no further: a move lies ahead, or a dwell must be waited for."""
        return any(move.start > self.time or self._dwells(move) for move in self._moves)

    def done(self) -> bool:
        """Whether all moves have arrived."""
        return all(move.end <= self.time for move in self._moves)

    def current(self) -> Move | None:
        """The running move; of two that blend, the later one."""
        running = [move for move in self._moves if move.start <= self.time < move.end]
        return running[-1] if running else None

    def position(self) -> Array | None:
        """Axis positions, (9,); None if no move has begun."""
        begun = [move for move in self._moves if move.start <= self.time]
        if not begun:
            return None
        position = np.array(begun[-1].target)
        for move in begun:
            position -= move.missing(self.time)
        return position

    def go_on(self, ms: float, override: float) -> float:
        """Advance time, but not beyond the next start or end of a move.

        Args:
            ms: of real time.
            override: 1 is 100 %; a dwell ignores it.

        Returns:
            The remaining real time.
        """
        rate = 1.0 if any(map(self._dwells, self._moves)) else override
        times = [time for move in self._moves for time in (move.start, move.end) if time > self.time]
        boundary = min(times, default=math.inf)
        if boundary > self.time + ms * rate:
            self.time += ms * rate
            return 0.0
        left = ms - (boundary - self.time) / rate
        self.time = boundary
        self._pass()
        return max(left, 0.0)

    def _pass(self) -> None:
        """Start due moves and drop completed ones; the last one stays, as it holds the current position."""
        due = [pending for move, pending in self._pending if move.start <= self.time]
        self._pending = self._pending[len(due) :]
        for write in (write for pending in due for write in pending):
            write()
        last = self._moves[-1]
        if last.start <= self.time:
            self._moves = [move for move in self._moves if move is last or move.end > self.time]
        if isinstance(last, Cubic) and last.end == self.time:
            self.abrupt_stops += bool(np.any(last.last_speed != 0))

    def _dwells(self, move: Move) -> bool:
        return isinstance(move, Rest) and move.fixed and move.start <= self.time < move.end
