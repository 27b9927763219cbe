# SPDX-License-Identifier: LGPL-2.1-or-later
"""Stream: run a program that exceeds the controller's memory from its rotary buffer while it is being sent.

The program is sent in segments that end with STOP at rest (``rotary_buffer``). R releases a segment once it is complete
in the buffer and the previous one has ended; while it runs, the next one is sent. So a cut link ends at rest without
any help. When the link is back, the stream waits until the controller is at rest and queries the number of lines ahead,
which shows how many of the last lines arrived. If the number is inconsistent, or the machine is not at the end of the
segment, the stream does not continue. Above the override for which the program is certified it is held, then aborted.

Input: a session, settings, a program, the size of the rotary buffer. Output: a record of the executed program.
"""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import dataclass
from itertools import accumulate

from pkm_post.control.link import stopping
from pkm_post.control.link.errors import (
    CancelledError,
    LinkLostError,
    OverrideError,
    PmacError,
    RefusedError,
    StreamError,
)
from pkm_post.control.link.ownership import owned
from pkm_post.control.link.program import PmacProgram
from pkm_post.control.link.queries import read_number
from pkm_post.control.link.rotary_buffer import ATTEMPTS, RotaryBuffer, Segment, split_into_segments
from pkm_post.control.link.run import HIGHEST_OVERRIDE, check_override, check_start
from pkm_post.control.link.session import Session
from pkm_post.control.link.status import Status, read_status, settled_status
from pkm_post.model import Array, Machine
from pkm_post.options import START_TOLERANCE_MM
from pkm_post.writing import PmacSettings

_NOT_OPEN, _NO_ROOM = 5, 6
_POLL_S = 0.05
_WATCH_S = 0.2
"""Interval at which the override is read while lines are sent."""
_QUIET_POLLS = 20
"""Consecutive readings of the machine at rest in the wrong place before the stream fails."""
_log = logging.getLogger(__name__)

Progress = Callable[[int, int, int], None]
"""Called with the numbers of program lines released, loaded, and in total."""


class RotaryStream:
    """A program being streamed.

    Attributes:
        segments: of the program.
        rest: (6,) strut lengths at rest after all released lines, mm.
        line: program line after which that is.
        resumptions: number of resumptions.
    """

    def __init__(
        self,
        session: Session,
        settings: PmacSettings,
        segments: tuple[Segment, ...],
        words: int,
        start_tolerance: float,
    ) -> None:
        self.segments, self.resumptions, self.line = segments, 0, 0
        self.rest: Array = segments[0].rest
        self._session, self._settings, self._start_tolerance = session, settings, start_tolerance
        self._ends = list(accumulate(len(segment.lines) for segment in segments))
        self._buffer = RotaryBuffer(session, settings, [line for each in segments for line in each.lines], words)
        self._released = 0  # lines
        self._watched_at = session.now()

    def open(self) -> None:
        """Open an empty rotary buffer and point the coordinate system to it."""
        self._buffer.open()

    def run(self, progress: Progress, is_cancelled: Callable[[], bool]) -> None:
        """Send and release the segments in order."""
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
        """Come to rest, empty and close the buffer; return whether the controller confirmed both."""
        try:
            self._come_to_rest(at_once)
            return self._buffer.empty()
        except (PmacError, KeyboardInterrupt) as fault:
            _log.error("the rotary buffer could not be emptied: %s", fault)
            return False

    def _come_to_rest(self, at_once: bool) -> None:
        """Wait for rest; an interrupt meanwhile holds and aborts the program."""
        try:
            if not at_once:
                self._wait(lambda: None)
                return
        except (KeyboardInterrupt, OverrideError):
            pass  # the user wants to end now, or the machine is held
        stopping.abort(self._session, self._settings)
        self._wait(lambda: None)

    def _sent(self) -> int:
        """Program lines in the controller, in whole segments."""
        there = [each.last for each, end in zip(self.segments, self._ends, strict=True) if end <= self._buffer.loaded]
        return max(there, default=0)

    def _fill(self, end: int, check: Callable[[], None]) -> None:
        """Load the lines up to ``end`` into the buffer, as room becomes free."""
        failures = 0
        while self._buffer.loaded < end:
            check()
            try:
                self._watch_override()
                if not self._buffer.send(end):
                    self._session.sleep(_POLL_S)
            except (LinkLostError, RefusedError) as fault:
                failures += 1
                passes = isinstance(fault, LinkLostError) or fault.number in (_NOT_OPEN, _NO_ROOM)
                if not passes or failures > ATTEMPTS:
                    raise
                _log.warning("the stream was interrupted: %s", fault)
                self._settle(check)

    def _watch_override(self) -> None:
        """Check the override now and then while the released lines run; the whole state is long for a serial line.

        Raises:
            OverrideError: it is above that of the certificate; the machine is held.
        """
        if self._session.now() - self._watched_at < _WATCH_S:
            return
        if read_number(self._session, f"&{self._settings.coordinate_system}%") > HIGHEST_OVERRIDE:
            check_override(self._session, self._settings, read_status(self._session, self._settings))
        self._watched_at = self._session.now()

    def _wait(self, check: Callable[[], None]) -> Status:
        """Wait until the controller has finished the released lines, or was stopped, and the struts are at rest."""
        quiet = 0
        while True:
            status = read_status(self._session, self._settings)
            check_override(self._session, self._settings, status)
            quiet = 0 if status.running or not status.standing else quiet + 1
            # The state reflects R with a delay.
            if quiet and (quiet >= _QUIET_POLLS or self._is_done()):
                return status
            check()
            self._session.sleep(_POLL_S)

    def _is_done(self) -> bool:
        left = self._buffer.loaded - self._released
        return left <= self._buffer.lines_ahead() <= left + self._buffer.uncertain

    def _check_done(self) -> None:
        if not self._is_done():
            ahead = self._buffer.lines_ahead()
            raise PmacError(f"the program was stopped with {ahead} lines of the rotary buffer ahead of it")

    def _settle(self, check: Callable[[], None]) -> None:
        """Recover from a failure: wait for rest, count the loaded lines, and reopen the buffer.

        Raises:
            PmacError: the controller's count is inconsistent.
        """
        self._check(self._wait(check))
        self._buffer.recount(self._released)
        self.resumptions += 1

    def _release(self, segment: Segment, end: int) -> None:
        """Send R; if its answer is lost, the lines ahead show whether it was executed."""
        self._check_done()
        for attempt in range(ATTEMPTS):
            self._check(read_status(self._session, self._settings))
            rest, line, before = self.rest, self.line, self._released
            # From now on the machine may move this far, whatever the answer.
            self.rest, self.line, self._released = segment.rest, segment.last, end
            try:
                self._session.command(f"&{self._settings.coordinate_system}R")
                return
            except (LinkLostError, RefusedError) as fault:
                if isinstance(fault, LinkLostError) and self._has_begun(before):
                    self.resumptions += 1
                    return
                self.rest, self.line, self._released = rest, line, before
                if isinstance(fault, RefusedError) or attempt == ATTEMPTS - 1:
                    raise
        raise AssertionError("unreachable")

    def _has_begun(self, before: int) -> bool:
        """Whether lines after the first ``before`` have begun."""
        return (
            read_status(self._session, self._settings).running
            or self._buffer.loaded - self._buffer.lines_ahead() > before
        )

    def _check(self, status: Status) -> None:
        check_start(status, self.rest, self._start_tolerance)


@dataclass(frozen=True)
class StreamResult:
    """A completed program.

    Attributes:
        lines: of the program.
        digest: SHA-256 of its lines.
        segments: number of segments.
        resumptions: number of link failures after which the stream continued.
    """

    lines: int
    digest: str
    segments: int
    resumptions: int


def stream(
    session: Session,
    settings: PmacSettings,
    program: PmacProgram,
    first: Array,
    words: int,
    start_tolerance: float = START_TOLERANCE_MM,
    progress: Progress = lambda done, sent, all_lines: None,
    is_cancelled: Callable[[], bool] = lambda: False,
    machine: Machine | None = None,
) -> StreamResult:
    """Run a program from the rotary buffer.

    Args:
        first: (6,) strut lengths of the program's first point, mm.
        words: size of the rotary buffer, as defined.
        start_tolerance: largest distance of each strut from the first point, and from each rest where it resumes, mm.
        progress: called with the lines released, loaded, and in total.
        is_cancelled: polled; the machine then stops at the end of the running segment.
        machine: its geometry, to compare the tool pose with the first point as well.

    Raises:
        NotReadyError: the program cannot be streamed, or the machine is not ready; nothing was sent.
        StreamError: it failed; states where the machine stopped and whether the buffer is empty.
        CancelledError: it was cancelled; the machine is at rest and the buffer is empty.
        NotOwnerError: another client owns the machine; nothing was sent.
    """
    streaming = RotaryStream(session, settings, split_into_segments(program, settings, words), words, start_tolerance)
    streaming.rest = first
    with owned(session, "stream"):
        check_start(settled_status(session, settings), first, start_tolerance, machine)
        return _streamed(streaming, program, progress, is_cancelled)


def _streamed(
    streaming: RotaryStream, program: PmacProgram, progress: Progress, is_cancelled: Callable[[], bool]
) -> StreamResult:
    try:
        streaming.open()
        streaming.run(progress, is_cancelled)
    except (PmacError, KeyboardInterrupt) as fault:
        raise _ended(streaming, fault) from fault
    except BaseException:
        streaming.end(at_once=False)
        raise
    if not streaming.end(at_once=False):
        raise StreamError("the program was carried out, but its buffer could not be closed", streaming.line, False)
    _log.info("%d lines in %d segments, SHA-256 %s", len(program.lines), len(streaming.segments), program.digest)
    return StreamResult(len(program.lines), program.digest, len(streaming.segments), streaming.resumptions)


def _ended(streaming: RotaryStream, fault: PmacError | KeyboardInterrupt) -> PmacError:
    """End an incomplete stream; return the exception that describes its state."""
    is_empty = streaming.end(at_once=isinstance(fault, KeyboardInterrupt | OverrideError))
    if isinstance(fault, CancelledError | KeyboardInterrupt) and is_empty:
        return CancelledError("the stream was stopped; the machine rests, the rotary buffer is empty")
    why = fault.reason if isinstance(fault, OverrideError) else str(fault)
    return StreamError(why or "the stream was stopped", streaming.line, is_empty)
