# SPDX-License-Identifier: LGPL-2.1-or-later
"""Run to rest: keep the list of the controller ahead of it, from one rest to the next.

The list reaches at least so far ahead of the point that was computed last:

    lead = 2 (longest planning + longest sending of the last pieces) + 2 longest intervals, at least half a second

Two, for one piece may just have missed its turn; the intervals, for the controller computes two moves ahead. A piece
lasts two and a half times as long as planning one, from a quarter of a second to one second: what planning takes hardly
depends on it. The list has room for two pieces with their stops at least, so pieces with many points are shorter;
where it has no room for all of the lead, it starts when it is full.

Enters: a planner, a place at rest, the operator's input. Leaves: the place at rest where the motion has ended.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from concurrent.futures import Executor, Future
from dataclasses import dataclass, field

import numpy as np

from pkm_post.control.link.errors import PmacError
from pkm_post.control.link.session import Session
from pkm_post.control.player.legs import LONGEST_MS, At, Leg
from pkm_post.control.player.list_feed import ListFeed
from pkm_post.control.player.operator_input import OperatorInput
from pkm_post.control.player.pieces import PIECE_MS, SHORTEST_PIECE_MS, Piece, PiecePlanner
from pkm_post.model import Refused

LEAST_LEAD_S = 0.25
_AHEAD = 2.5
"""Duration of a piece by that of its planning."""
_LONGEST_PIECE_MS = 1000
_PIECES_IN_LIST = 2
"""Pieces with their stops that fit into the list together: one runs while the other one is written."""
_PIECES_TIMED = 8
"""Last pieces of which the longest planning and sending count."""

Planned = tuple[Piece, float]
"""A piece, and the s that planning took."""


@dataclass
class Timing:
    """What the last pieces took.

    Attributes:
        spent: s of planning and of sending.
    """

    spent: deque[tuple[float, float]] = field(default_factory=lambda: deque([(0.0, 0.0)], maxlen=_PIECES_TIMED))

    @property
    def lead_s(self) -> float:
        """How far the list has to reach ahead, s."""
        planning, sending = (max(values) for values in zip(*self.spent, strict=True))
        return max(2 * (planning + sending), LEAST_LEAD_S) + 2 * LONGEST_MS / 1000

    @property
    def piece_ms(self) -> int:
        """Duration of a piece, so that planning keeps ahead."""
        planning = max(planning for planning, _ in self.spent)
        return int(np.clip(1000 * _AHEAD * planning, PIECE_MS, _LONGEST_PIECE_MS))


class RunToRest:
    """One run of the list.

    Attributes:
        reached: mean speed of the last piece by that of the program; 0 before the first one.
        is_started: whether the resident program was started.
    """

    def __init__(
        self,
        session: Session,
        feed: ListFeed,
        planner: PiecePlanner,
        at: At,
        operator: OperatorInput,
        planning: Executor,
    ) -> None:
        """Prepare a run; nothing is sent.

        Args:
            session: its clock times the pieces.
            feed: of the controller's list; the run begins with an empty one.
            planner: of the part.
            at: where the machine rests.
            operator: of the operator.
            planning: where pieces are planned.
        """
        self._session, self._feed, self._planner, self._operator, self._planning = (
            session,
            feed,
            planner,
            operator,
            planning,
        )
        self._begin = self._ahead = at
        self._pending: Future[Planned] | None = None
        self._planned: Planned | None = None
        self._last: Leg | None = None
        self._fault: Refused | PmacError | None = None
        self._is_block_end, self._section = False, -1
        self._fitting_ms = _LONGEST_PIECE_MS
        self.reached, self.is_started = 0.0, False

    @property
    def begin(self) -> At:
        """Where it begins."""
        return self._begin

    @property
    def is_wanted(self) -> bool:
        """Whether more motion is wanted than the list has."""
        is_complete = self._last is not None or self._is_block_end or self._fault or self._feed.stopped_at
        return self._operator.override > 0 and not (self._operator.is_over or is_complete)

    def plan(self, timing: Timing) -> None:
        """Have the next piece planned when the list becomes short, and fetch it when it is."""
        is_short = self._feed.ahead_ms / 1000 < timing.lead_s
        if self._pending is None and self._planned is None and self.is_wanted and is_short:
            self._pending = self._planning.submit(self._next_piece, self._ahead, timing.piece_ms)
        if self._pending is not None and self._pending.done():
            try:
                self._planned = self._pending.result()
            except (Refused, PmacError) as fault:
                self._fault = fault
            self._pending = None

    def send(self, timing: Timing) -> None:
        """Send the piece that is planned, unless the stop before it has begun, or it is not wanted any more.

        Raises:
            LinkLostError: to be tried again with the same piece.
        """
        if self._planned is None:
            return
        if self._feed.stopped_at is not None or not (self.is_wanted or self._feed.is_taking_in):
            self._planned = None
            return
        piece, planning_s = self._planned
        if not self._feed.has_room(piece):
            return
        if piece.leg.end.section != self._section:
            self._section = piece.leg.end.section
            self._planning.submit(self._planner.prepare, self._section)
        began = self._session.now()
        self._feed.append(piece)
        timing.spent.append((planning_s, self._session.now() - began))
        self._planned, self._ahead = None, piece.leg.end
        self._last = piece.leg if piece.is_end else None
        self._is_block_end = piece.stop is None and self._operator.single_block
        if piece.stop is not None:
            self.reached = piece.reached

    def may_start(self, lead_s: float) -> bool:
        """Whether the list is long enough to be started, complete, or full."""
        ahead = self._feed.ahead_ms / 1000
        is_full = self._planned is not None and not self._feed.has_room(self._planned[0])
        if self.is_started or self._operator.is_over:
            return False
        return ahead >= lead_s or (ahead > 0 and (is_full or not self.is_wanted))

    def is_void(self) -> bool:
        """Whether it ends before it has begun, because nothing is wanted any more.

        Raises:
            Refused, PmacError: its first piece is not certified, or does not fit.
        """
        if not self.is_started and self._operator.is_over:
            return True
        if self.is_started or self.is_wanted or self._pending is not None or self._feed.ahead_ms:
            return False
        if self._fault is not None:
            raise self._fault
        return True

    def rest(self, where: Callable[[], str]) -> tuple[At, bool]:
        """Where the machine has come to rest, and whether the part ends there.

        Args:
            where: says the place in words.

        Raises:
            Refused: a piece was not certified; the machine rests before it.
            PmacError: the program was ended at another place than a stop of its list.
        """
        point = self._feed.current
        if point is None or not self._feed.is_at_its_end():
            raise PmacError(f"the program was ended from elsewhere {where()}; go on with --from-line")
        if self._fault is not None:
            raise self._fault
        return point.leg.end, point.leg is self._last

    def was_late(self) -> bool:
        """Whether it has come to rest although more motion was wanted."""
        return self._feed.stopped_at is not None and self._operator.override > 0 and not self._operator.is_over

    def _next_piece(self, at: At, piece_ms: int) -> Planned:
        """Plan a piece that leaves room for another one in the list; in a thread that plans.

        Raises:
            PmacError: the list is too short for the shortest piece and its stop.
        """
        began = self._session.now()
        piece_ms = min(piece_ms, 2 * self._fitting_ms)
        while True:
            piece = self._planner.next_piece(at, self._operator.override, self._operator.single_block, piece_ms)
            is_shortest = piece_ms <= SHORTEST_PIECE_MS
            if is_shortest or piece.size <= self._feed.capacity // _PIECES_IN_LIST:
                break
            piece_ms = max(piece_ms // 2, SHORTEST_PIECE_MS)
        self._fitting_ms = piece_ms
        if piece.size > self._feed.capacity:
            room = f"the list has {self._feed.capacity} points, a piece and its stop take {piece.size}"
            raise PmacError(f"{room}: choose lower --variables")
        return piece, self._session.now() - began
