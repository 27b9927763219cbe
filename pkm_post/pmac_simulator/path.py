# SPDX-License-Identifier: LGPL-2.1-or-later
"""Path: the moves of a program, one behind the other, in a time that an override may slow down or stop.

Enters: moves with their times in ms of the program. Leaves: positions of the axes. Assignments that wait for a move are
carried out when it begins.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from pkm_post.pmac_simulator.moves import Cubic, Move, Rest
from pkm_post.pmac_simulator.variables import Array

Pending = Callable[[], None]


class Path:
    """The moves that are computed and not yet made.

    Attributes:
        time: of the program, ms.
        abrupt_stops: how often a PVT move ended at a speed with nothing behind it.
    """

    def __init__(self) -> None:
        self.time, self.abrupt_stops = 0.0, 0
        self._moves: list[Move] = []
        self._pending: list[tuple[Move, list[Pending]]] = []

    def clear(self) -> None:
        """Forget all moves."""
        self._moves, self._pending = [], []

    def add(self, move: Move, pending: list[Pending]) -> None:
        """Add a move that begins now or later, with what waits for its beginning."""
        self._moves.append(move)
        self._pending.append((move, pending))
        self._pass()

    def last(self) -> Move | None:
        """The move behind which the next one comes."""
        return self._moves[-1] if self._moves else None

    def has_enough(self) -> bool:
        """Whether nothing more is computed now: a move lies ahead, or a dwell has to be waited for."""
        return any(move.start > self.time or self._dwells(move) for move in self._moves)

    def done(self) -> bool:
        """Whether all moves have arrived."""
        return all(move.end <= self.time for move in self._moves)

    def current(self) -> Move | None:
        """The move that runs; where two blend, the later one."""
        running = [move for move in self._moves if move.start <= self.time < move.end]
        return running[-1] if running else None

    def position(self) -> Array | None:
        """Where the axes are, (9,); None when no move has begun."""
        begun = [move for move in self._moves if move.start <= self.time]
        if not begun:
            return None
        position = np.array(begun[-1].target)
        for move in begun:
            position -= move.missing(self.time)
        return position

    def go_on(self, ms: float, override: float) -> float:
        """Let time pass, but not beyond the next beginning or end of a move.

        Args:
            ms: of real time.
            override: 1 is 100 %; a dwell heeds none.

        Returns:
            The real time that is left.
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
        """Begin moves and take those out that have ended; the last one stays, for the place where it led to."""
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
