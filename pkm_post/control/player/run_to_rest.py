# SPDX-License-Identifier: LGPL-2.1-or-later
"""Run to rest: keep the list of the controller ahead of it, from one rest to the next.

The list reaches at least so far ahead of the point that was computed last, when the next piece is asked for:

    lead = 2 (longest planning + longest sending of the last pieces) + 2 longest intervals, at least half a second

Planning counts from asking for a piece until it is there: what the computer does besides counts as well. A piece
lasts longer than planning and sending it takes, so the list is as far ahead after it as before. The second planning
and sending are for one short piece, at the end of a section: it takes as long and adds next to nothing. The intervals
are for the controller, which computes two moves ahead, and for the 20 ms between two looks. The list has room for two
pieces with their stops at least, so pieces with many points are shorter; where it has no room for all of the lead, it
starts when it is full.

Input: a planner, a place at rest, the operator's input. Output: the place at rest where the motion has ended.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from concurrent.futures import Executor, Future
from dataclasses import dataclass, field

import numpy as np

from pkm_post.control.link.errors import PmacError
from pkm_post.control.link.session import Session
from pkm_post.control.player.certified_motion import LONGEST_MS, CertifiedMotion, MotionState
from pkm_post.control.player.list_feed import ListFeed
from pkm_post.control.player.operator_input import OperatorInput
from pkm_post.control.player.pieces import PIECE_MS, SHORTEST_PIECE_MS, PiecePlanner, PlayedPiece
from pkm_post.model import Refused

LEAST_LEAD_S = 0.25
_AHEAD = 2.5
"""Duration of a piece by that of its planning, which hardly depends on it; to it comes that of sending the piece."""
_LONGEST_PIECE_MS = 2000
_FITTING = 0.9
"""Share of the room for a piece for which it is planned, by the points of the one before."""
_PIECES_IN_LIST = 2
"""Pieces with their stops that fit into the list together: one runs while the other one is written."""
_PIECES_TIMED = 64
"""Last pieces of which the longest planning and sending count: what comes every half a minute is not forgotten."""

_Moment = tuple[float, int]
"""s of the session's clock, and how often it had connected."""


def _last_times() -> deque[float]:
    return deque([0.0], maxlen=_PIECES_TIMED)


@dataclass
class Timing:
    """What the last pieces took.

    Attributes:
        planning: s from asking for a piece until it was there; of one that came too late, until it was given up.
        sending: s of sending it.
        planned, programmed: s of all pieces that were sent, and at the programmed feed and their override.
    """

    planning: deque[float] = field(default_factory=_last_times)
    sending: deque[float] = field(default_factory=_last_times)
    planned: float = 0.0
    programmed: float = 0.0

    def add(self, piece: PlayedPiece) -> None:
        """Count the motion of a piece that was sent."""
        seconds = float(piece.motion.struts.time_ms[-1]) / 1000
        self.planned += seconds
        self.programmed += seconds * piece.reached / piece.motion.end.state.override

    @property
    def slower(self) -> float:
        """Time of what was planned by that of the programmed feed; 1 before the first piece."""
        return self.planned / self.programmed if self.programmed else 1.0

    @property
    def lead_s(self) -> float:
        """How far the list has to reach ahead, s."""
        return max(2 * (max(self.planning) + max(self.sending)), LEAST_LEAD_S) + 2 * LONGEST_MS / 1000

    @property
    def piece_ms(self) -> int:
        """Duration of a piece, so that planning and sending keep ahead."""
        wanted = 1000 * (_AHEAD * max(self.planning) + max(self.sending))
        return int(np.clip(wanted, PIECE_MS, _LONGEST_PIECE_MS))


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
        at: MotionState,
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
        self._pending: Future[PlayedPiece] | None = None
        self._asked: _Moment | None = None
        self._planned: PlayedPiece | None = None
        self._last: CertifiedMotion | None = None
        self._fault: Refused | PmacError | None = None
        self._is_block_end, self._section = False, -1
        self._fitting_ms = _LONGEST_PIECE_MS
        self.reached, self.is_started = 0.0, False

    @property
    def begin(self) -> MotionState:
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
            self._asked = self._now()
            self._pending = self._planning.submit(self._next_piece, self._ahead, timing.piece_ms)
        if self._operator.is_held_back:
            self._asked = None  # the operator may be waited for meanwhile
        if self._pending is not None and self._pending.done():
            self._time(timing.planning, self._asked)
            try:
                self._planned = self._pending.result()
            except (Refused, PmacError) as fault:
                self._fault = fault
            self._pending = None

    def steer(self) -> None:
        """Lead a list that runs into the next stop where nothing more is wanted, and back where it is.

        Raises:
            LinkLostError: to be tried again.
        """
        if self.is_started and (self._operator.override == 0 or self._operator.is_over):
            self._feed.end_soon()
        elif self.is_started:
            self._feed.end_at_its_end()

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
        piece = self._planned
        if not self._feed.has_room(piece):
            return
        if piece.motion.end.section != self._section:
            self._section = piece.motion.end.section
            self._planning.submit(self._planner.prepare, self._section)
        began = self._now()
        self._feed.append(piece)
        self._time(timing.sending, began)
        timing.add(piece)
        self._planned, self._ahead = None, piece.motion.end
        self._last = piece.motion if piece.is_end else None
        self._is_block_end = piece.stop is None and self._operator.single_block
        if piece.stop is not None:
            self.reached = piece.reached

    def may_start(self, lead_s: float) -> bool:
        """Whether the list is long enough to be started, complete, or full."""
        ahead = self._feed.ahead_ms / 1000
        is_full = self._planned is not None and not self._feed.has_room(self._planned)
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

    def rest(self, where: Callable[[], str]) -> tuple[MotionState, bool]:
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
        return point.motion.end, self._planner.is_end(point.motion.end)  # a stop may lead there as well

    def time_late_piece(self, timing: Timing) -> None:
        """Count the time of a piece that is still planned, now that the list has run out: the lead becomes longer."""
        if self._pending is not None:
            self._time(timing.planning, self._asked)

    def was_late(self) -> bool:
        """Whether it has come to rest although more motion was wanted."""
        was_stopped = self._feed.stopped_at is not None and not self._feed.ends_early
        return was_stopped and self._operator.override > 0 and not self._operator.is_over

    def _now(self) -> _Moment:
        return self._session.now(), self._session.connections

    def _time(self, times: deque[float], since: _Moment | None) -> None:
        """Note what something took; where the link was lost meanwhile, that says nothing."""
        now, connections = self._now()
        if since is not None and since[1] == connections:
            times.append(now - since[0])

    def _next_piece(self, at: MotionState, piece_ms: int) -> PlayedPiece:
        """Plan a piece that leaves room for another one in the list; in a thread that plans.

        Raises:
            PmacError: the list is too short for the shortest piece and its stop.
        """
        room = self._feed.capacity // _PIECES_IN_LIST
        piece_ms = max(min(piece_ms, self._fitting_ms), SHORTEST_PIECE_MS)
        while True:
            piece = self._planner.next_piece(at, self._operator.override, self._operator.single_block, piece_ms)
            lasts_ms = min(piece_ms, int(piece.motion.struts.time_ms[-1]))
            self._fitting_ms = int(_FITTING * lasts_ms * room / piece.size)
            if piece.size <= room or piece_ms <= SHORTEST_PIECE_MS:
                break
            piece_ms = max(self._fitting_ms, SHORTEST_PIECE_MS)
        if piece.size > self._feed.capacity:
            need = f"the list has {self._feed.capacity} points, a piece and its stop take {piece.size}"
            raise PmacError(f"{need}: choose lower --variables")
        return piece
