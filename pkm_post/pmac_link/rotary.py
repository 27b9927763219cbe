# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rotary: segments on their way through the rotary buffer, and what is known of it at any time.

Lines are counted from the first that was sent: so many are surely in the controller, some behind them may be, so many
were let go by R. The controller tells how many it has not begun; whatever was heard of a command that got lost, these
numbers say whether it was carried out.

Enters: a session, segments, the size of the buffer. Leaves: a machine at rest, and where that is.
"""

from __future__ import annotations

import logging
from collections.abc import Callable
from itertools import accumulate

from pkm_post.controllers.pmac import Settings
from pkm_post.pmac_link import operate
from pkm_post.pmac_link.faults import CancelledError, LinkLostError, PmacError, RefusedError
from pkm_post.pmac_link.gates import Segment
from pkm_post.pmac_link.listing import words_of
from pkm_post.pmac_link.ready import check_start
from pkm_post.pmac_link.session import Session
from pkm_post.pmac_link.status import Array, Status, read_status

ATTEMPTS = 5
"""How often one segment is gone on with after a failure."""
_NOT_OPEN, _NO_ROOM = 5, 6
_POLL_S = 0.05
_QUIET_POLLS = 20
"""So often the controller has to show that it stands where it should not."""
_MARGIN = 2
"""Lines that may lie in the buffer still though they are not ahead any more: the one that runs, the one after it."""
_log = logging.getLogger(__name__)

Progress = Callable[[int, int, int], None]
"""Called with the lines of the program that were let go, those that are in the controller, and all."""


class RotaryStream:
    """What is known of the rotary buffer.

    Attributes:
        segments: of the program.
        rest: (6,) strut lengths where the machine rests when all that was let go is done, mm.
        line: of the program behind which that is.
        resumptions: how often it was gone on with.
    """

    def __init__(
        self,
        session: Session,
        settings: Settings,
        segments: tuple[Segment, ...],
        words: int,
        near: float,
        sleep: Callable[[float], None],
    ) -> None:
        self.segments, self.resumptions, self.line = segments, 0, 0
        self.rest: Array = segments[0].rest
        self._session, self._settings, self._near, self._sleep = session, settings, near, sleep
        self._lines = [line for segment in segments for line in segment.lines]
        self._ends = list(accumulate(len(segment.lines) for segment in segments))
        self._filled = [0, *accumulate(map(words_of, self._lines))]
        self._words, self._room = words, words
        self._loaded = self._unsure = self._let_go = 0  # lines; _unsure may have arrived behind those
        self._connections = session.connections

    def open(self) -> None:
        """An empty rotary buffer, open, and the coordinate system pointed to it."""
        # Behind OPEN ROT, B0 would be a move. To begin all this anew does no harm: nothing was let go.
        lines = ("CLOSE", "DELETE GATHER", f"&{self._settings.coordinate_system}B0", "OPEN ROT", "CLEAR")
        if ahead := self._ordered(lines):
            raise PmacError(f"{ahead} lines are in the rotary buffer after CLEAR")

    def _ordered(self, lines: tuple[str, ...]) -> int:
        """Have lines carried out, all again when the link fails; how many lines lie ahead then."""
        for attempt in range(ATTEMPTS):
            self._connections = self._session.connections
            try:
                for line in lines:
                    self._session.order(line)
                ahead = self._ahead()
            except LinkLostError as lost:
                _log.warning("the link failed: %s", lost)
                if attempt == ATTEMPTS - 1:
                    raise
            else:
                if self._is_still_open():
                    return ahead
        raise LinkLostError("the link fails again and again")

    def _is_still_open(self) -> bool:
        """A link that was called back has closed the buffer: a line would be carried out at once, not kept."""
        return self._connections == self._session.connections

    def run(self, progress: Progress, is_cancelled: Callable[[], bool]) -> None:
        """Send and let go segment by segment."""
        total = self.segments[-1].last

        def check() -> None:
            progress(self.line, self._sent(), total)
            if is_cancelled():
                raise CancelledError("the stream was stopped")

        for segment, end in zip(self.segments, self._ends, strict=True):
            self._fill(end, check)
            self._wait(check)
            self._release(segment, end)
        self._check(self._wait(check))
        self._check_done()
        progress(total, total, total)

    def end(self, at_once: bool) -> bool:
        """Come to rest, empty the buffer and close it; whether the controller has shown both."""
        try:
            self._come_to_rest(at_once)
            lines = ("CLOSE", f"&{self._settings.coordinate_system}", "OPEN ROT", "CLEAR", "CLOSE")
            return self._ordered(lines) == 0
        except (PmacError, KeyboardInterrupt) as fault:
            _log.error("the rotary buffer could not be emptied: %s", fault)
            return False

    def _come_to_rest(self, at_once: bool) -> None:
        """Wait for it; an interrupt meanwhile holds the program and aborts it."""
        try:
            if not at_once:
                self._wait(lambda: None)
                return
        except KeyboardInterrupt:
            pass  # this is how the user says that it has to be now
        operate.abort(self._session, self._settings, sleep=self._sleep)
        self._wait(lambda: None)

    def _sent(self) -> int:
        return max(
            (segment.last for segment, end in zip(self.segments, self._ends, strict=True) if end <= self._loaded),
            default=0,
        )

    def _fill(self, end: int, check: Callable[[], None]) -> None:
        """Bring the lines up to ``end`` into the buffer, as it has room for them."""
        failures = 0
        while self._loaded < end:
            check()
            count = self._fitting(end)
            if not self._is_still_open() and failures < ATTEMPTS:
                failures += 1
                self._settle(check)
                continue
            if not self._is_still_open():
                raise LinkLostError("the link fails again and again")
            if not count:
                self._sleep(_POLL_S)
                continue
            batch = self._lines[self._loaded : self._loaded + count]
            try:
                done = self._session.load(batch)
            except (LinkLostError, RefusedError) as fault:
                if isinstance(fault, RefusedError) and fault.number not in (_NOT_OPEN, _NO_ROOM):
                    raise
                failures += 1
                if failures > ATTEMPTS:
                    raise
                _log.warning("the stream was interrupted: %s", fault)
                self._unsure = min(len(batch), self._session.lines_at_once(batch))
                self._settle(check)
            else:
                self._room -= self._filled[self._loaded + done] - self._filled[self._loaded]
                self._loaded += done

    def _fitting(self, end: int) -> int:
        """How many of the next lines the buffer has room for."""
        if self._filled[self._loaded + 1] - self._filled[self._loaded] > self._room:
            oldest = max(self._loaded - self._ahead() - _MARGIN, 0)
            self._room = self._words - (self._filled[self._loaded] - self._filled[oldest])
        count = self._loaded
        while count < end and self._filled[count + 1] - self._filled[self._loaded] <= self._room:
            count += 1
        return count - self._loaded

    def _wait(self, check: Callable[[], None]) -> Status:
        """Until the controller has done what it was let go with, or was stopped, and the struts stand."""
        quiet = 0
        while True:
            status = read_status(self._session, self._settings)
            quiet = 0 if status.running or not status.standing else quiet + 1
            # R may take a moment until the state shows it.
            if quiet and (quiet >= _QUIET_POLLS or self._is_done()):
                return status
            check()
            self._sleep(_POLL_S)

    def _is_done(self) -> bool:
        left = self._loaded - self._let_go
        return left <= self._ahead() <= left + self._unsure

    def _check_done(self) -> None:
        if not self._is_done():
            raise PmacError(f"the program was stopped with {self._ahead()} lines of the rotary buffer ahead of it")

    def _settle(self, check: Callable[[], None]) -> None:
        """After a failure: wait for rest, see how many lines are there, and open the buffer again.

        Raises:
            PmacError: what the controller tells cannot be explained.
        """
        self._check(self._wait(check))
        there = self._let_go + self._ordered(("CLOSE", f"&{self._settings.coordinate_system}", "OPEN ROT"))
        if not self._loaded <= there <= self._loaded + self._unsure:
            raise PmacError(
                f"the controller has {there} lines, {self._loaded} to {self._loaded + self._unsure} were sent"
            )
        self._loaded, self._unsure, self._room = there, 0, 0
        self.resumptions += 1

    def _release(self, segment: Segment, end: int) -> None:
        """R; when its answer is lost, the lines ahead tell whether it was carried out."""
        self._check_done()
        for attempt in range(ATTEMPTS):
            self._check(read_status(self._session, self._settings))
            rest, line, before = self.rest, self.line, self._let_go
            # From here on the machine may go as far as this, whatever is heard of it.
            self.rest, self.line, self._let_go = segment.rest, segment.last, end
            try:
                self._session.order(f"&{self._settings.coordinate_system}R")
                return
            except (LinkLostError, RefusedError) as fault:
                if isinstance(fault, LinkLostError) and self._goes(before):
                    self.resumptions += 1
                    return
                self.rest, self.line, self._let_go = rest, line, before
                if isinstance(fault, RefusedError) or attempt == ATTEMPTS - 1:
                    raise
        raise AssertionError("unreachable")

    def _goes(self, before: int) -> bool:
        """Whether lines behind the first ``before`` were begun."""
        return read_status(self._session, self._settings).running or self._loaded - self._ahead() > before

    def _check(self, status: Status) -> None:
        check_start(status, self.rest, self._near)

    def _ahead(self) -> int:
        """Lines in the buffer that were not begun."""
        told = self._session.ask(f"&{self._settings.coordinate_system}PR")
        if len(told) != 1 or not told[0].strip().isdecimal():
            raise LinkLostError(f"PR: expected a number of lines, got {told}")
        return int(told[0])
