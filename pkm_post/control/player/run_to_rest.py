# SPDX-License-Identifier: LGPL-2.1-or-later
"""Run to rest: keep the controller's list filled ahead of the motion, from one rest to the next.

When the next piece is requested, the list extends ahead of the last computed point by at least

    lead = max(2 (longest planning + longest sending of the last pieces), 0.25 s) + 2 longest intervals

Planning is timed from the request of a piece until it is ready, including the other work of the computer. A piece lasts
longer than planning and sending it, so the list stays as far ahead. The second planning and sending are for a short
piece at the end of a section, which takes as long and adds next to nothing. The intervals are for the controller, which
computes two moves ahead, and for the 20 ms between two polls. The list has room for at least two pieces with their
stops, so pieces with many points are shorter; if it has no room for the whole lead, the motion starts when it is full.

Input: a planner, a state at rest, the operator's input. Output: the state at rest in which the motion has ended.
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
"""Duration of a piece relative to that of planning, which hardly depends on it; sending time is added."""
_LONGEST_PIECE_MS = 2000
_FITTING = 0.9
"""Share of the room that a piece should fill, judged by the points of the previous one."""
_PIECES_IN_LIST = 2
"""Pieces with their stops that must fit into the list: one runs while the other is written."""
_PIECES_TIMED = 64
"""Pieces over which the longest planning and sending are taken, to cover delays every half minute."""

_Moment = tuple[float, int]
"""s of the session's clock, and its number of connections."""


def _last_times() -> deque[float]:
    return deque([0.0], maxlen=_PIECES_TIMED)


@dataclass
class Timing:
    """Times of the last pieces.

    Attributes:
        planning: s from the request of a piece until it was ready or, if too late, given up.
        sending: s of sending it.
        planned, programmed: s of all sent pieces, as planned and at the programmed feed and their override.
    """

    planning: deque[float] = field(default_factory=_last_times)
    sending: deque[float] = field(default_factory=_last_times)
    planned: float = 0.0
    programmed: float = 0.0

    def add(self, piece: PlayedPiece) -> None:
        """Count the motion of a sent piece."""
        seconds = float(piece.motion.struts.time_ms[-1]) / 1000
        self.planned += seconds
        self.programmed += seconds * piece.reached / piece.motion.end.state.override

    @property
    def slower(self) -> float:
        """Planned time relative to that at the programmed feed; 1 before the first piece."""
        return self.planned / self.programmed if self.programmed else 1.0

    @property
    def lead_s(self) -> float:
        """Required lead of the list, s."""
        return max(2 * (max(self.planning) + max(self.sending)), LEAST_LEAD_S) + 2 * LONGEST_MS / 1000

    @property
    def piece_ms(self) -> int:
        """Duration of a piece such that planning and sending keep up."""
        wanted = 1000 * (_AHEAD * max(self.planning) + max(self.sending))
        return int(np.clip(wanted, PIECE_MS, _LONGEST_PIECE_MS))


class RunToRest:
    """One run of the list.

    Attributes:
        reached: mean speed of the last piece relative to the program; 0 before the first one.
        is_started: whether the resident program has started.
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
            feed: feed of the controller's list, which is initially empty.
            planner: of the part.
            at: state of the machine at rest.
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
        """The initial state."""
        return self._begin

    @property
    def is_wanted(self) -> bool:
        """Whether more motion is requested than the list has."""
        is_complete = self._last is not None or self._is_block_end or self._fault or self._feed.stopped_at
        return self._operator.override > 0 and not (self._operator.is_over or is_complete)

    def plan(self, timing: Timing) -> None:
        """Request the next piece when the list becomes short, and fetch it when ready."""
        is_short = self._feed.ahead_ms / 1000 < timing.lead_s
        if self._pending is None and self._planned is None and self.is_wanted and is_short:
            self._asked = self._now()
            self._pending = self._planning.submit(self._next_piece, self._ahead, timing.piece_ms)
        if self._operator.is_held_back:
            self._asked = None  # there may be a wait for the operator meanwhile
        if self._pending is not None and self._pending.done():
            self._time(timing.planning, self._asked)
            try:
                self._planned = self._pending.result()
            except (Refused, PmacError) as fault:
                self._fault = fault
            self._pending = None

    def steer(self) -> None:
        """Lead a running list into the next stop if no more motion is requested, and undo that otherwise.

        Raises:
            LinkLostError: retry.
        """
        if self.is_started and (self._operator.override == 0 or self._operator.is_over):
            self._feed.end_soon()
        elif self.is_started:
            self._feed.end_at_its_end()

    def send(self, timing: Timing) -> None:
        """Send the planned piece, unless the stop before it has begun, or it is no longer requested.

        Raises:
            LinkLostError: retry with the same piece.
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
        """Whether the list is long enough to start, complete, or full."""
        ahead = self._feed.ahead_ms / 1000
        is_full = self._planned is not None and not self._feed.has_room(self._planned)
        if self.is_started or self._operator.is_over:
            return False
        return ahead >= lead_s or (ahead > 0 and (is_full or not self.is_wanted))

    def is_void(self) -> bool:
        """Whether the run ends before its start, as no more motion is requested.

        Raises:
            Refused, PmacError: the first piece is not certified, or does not fit.
        """
        if not self.is_started and self._operator.is_over:
            return True
        if self.is_started or self.is_wanted or self._pending is not None or self._feed.ahead_ms:
            return False
        if self._fault is not None:
            raise self._fault
        return True

    def rest(self, where: Callable[[], str], faults: tuple[str, ...]) -> tuple[MotionState, bool]:
        """The state in which the machine came to rest, and whether the part ends there.

        Args:
            where: returns the place as text.
            faults: of struts and program in the controller, as text.

        Raises:
            Refused: a piece was not certified; the machine is at rest before it.
            PmacError: the program ended elsewhere than in a stop of its list.
        """
        point = self._feed.current
        if point is None or not self._feed.is_at_its_end():
            why = f" ({'; '.join(faults)})" if faults else ""
            raise PmacError(f"the program was ended from elsewhere {where()}{why}; continue with --from-line")
        if self._fault is not None:
            raise self._fault
        return point.motion.end, self._planner.is_end(point.motion.end)  # a stop may also lead there

    def time_late_piece(self, timing: Timing) -> None:
        """Count the time of a piece still in planning after the list ran out, to lengthen the lead."""
        if self._pending is not None:
            self._time(timing.planning, self._asked)

    def was_late(self) -> bool:
        """Whether the run came to rest although more motion was requested all the time."""
        return self._feed.is_late and self._operator.override > 0 and not self._operator.is_over

    def _now(self) -> _Moment:
        return self._session.now(), self._session.connections

    def _time(self, times: deque[float], since: _Moment | None) -> None:
        """Record a duration, unless the link was lost meanwhile."""
        now, connections = self._now()
        if since is not None and since[1] == connections:
            times.append(now - since[0])

    def _next_piece(self, at: MotionState, piece_ms: int) -> PlayedPiece:
        """Plan a piece that leaves room for another one in the list; runs in a planning thread.

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
