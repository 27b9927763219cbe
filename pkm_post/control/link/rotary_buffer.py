# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rotary buffer: split a program into segments, load their lines and track the contents of the buffer.

A controller executes a rotary buffer while it has lines. If they run out within a move because the link was cut, the
struts stop abruptly, or do something undocumented. So each segment ends with STOP where the struts are at rest anyway,
and all its lines are loaded before R releases the first: whatever happens to the link, the controller has all lines up
to a place where it stops by itself.

Lines are counted from the first one sent: some are certainly in the controller, some after them may be. The controller
reports the number not yet begun, which shows how many of the last ones arrived.

Input: a session, a program, the size of the buffer in 48-bit words. Output: segments, and lines in the buffer.
"""

from __future__ import annotations

import logging
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import accumulate

import numpy as np

from pkm_post.control.link.errors import LinkLostError, NotReadyError, PmacError
from pkm_post.control.link.program import PmacProgram, line_words
from pkm_post.control.link.session import Session
from pkm_post.model import Array
from pkm_post.writing import PmacSettings, rotary_opening

ATTEMPTS = 5
"""Attempts of an operation."""
_MARGIN = 2
"""Started lines that may still occupy the buffer: the running one, and the one after it."""
_log = logging.getLogger(__name__)

STOP = "STOP"
_DWELL_AT_REST = "DWELL0"
_DWELL, _INTERVAL = re.compile(r"DWELL"), re.compile(r"PVT\d+")
_SEGMENT_END_WORDS = 34
"""Upper bound for DWELL0, STOP, the repeated interval, and two executed lines that may still be there."""
_VALUE = r"(-?\d+\.\d+)"


@dataclass(frozen=True)
class Segment:
    """Lines executed in one run.

    Attributes:
        lines: as sent; the last is STOP.
        rest: (6,) strut lengths at their end, mm.
        last: number of program lines completed at their end.
    """

    lines: tuple[str, ...]
    rest: Array
    last: int


@dataclass(frozen=True)
class _Rest:
    """A rest of the struts: number of lines before it, strut lengths, and the interval to repeat."""

    behind: int
    length: Array
    interval: str


def split_into_segments(program: PmacProgram, settings: PmacSettings, words: int) -> tuple[Segment, ...]:
    """Cut a program at rests into the longest segments within half the buffer: one runs while the next is sent.

    Args:
        program: as written for a fixed buffer.
        settings: of the controller it was written for.
        words: size of the rotary buffer in 48-bit words.

    Raises:
        NotReadyError: the program does not end at rest, or the lines between two rests exceed the buffer.
    """
    rests = list(_rests(program.lines, settings))
    if not rests or rests[-1].behind != len(program.lines):
        raise NotReadyError(["the program does not end at rest: it cannot be streamed"])
    filled = [0, *accumulate(map(line_words, program.lines))]
    segments: list[Segment] = []
    start, interval = 0, ""
    while start < len(program.lines):
        rest = _next(rests, start, filled, words)
        lines = [interval] if interval else []
        lines += program.lines[start : rest.behind]
        lines += [_DWELL_AT_REST, STOP] if rest.interval else [STOP]
        segments.append(Segment(tuple(lines), rest.length, rest.behind))
        start, interval = rest.behind, rest.interval
    return tuple(segments)


def _next(rests: list[_Rest], start: int, filled: list[int], words: int) -> _Rest:
    """The farthest rest within half of the buffer, else the nearest one."""
    ahead = [rest for rest in rests if rest.behind > start]
    within = [rest for rest in ahead if filled[rest.behind] - filled[start] + _SEGMENT_END_WORDS <= words // 2]
    chosen = within[-1] if within else ahead[0]
    needed = filled[chosen.behind] - filled[start] + _SEGMENT_END_WORDS
    if needed > words:
        raise NotReadyError(
            [
                f"the program does not rest between its lines {start + 1} and {chosen.behind}, which take {needed}"
                f" words; the rotary buffer has {words}: define a larger one, or put stops into the job"
            ]
        )
    return chosen


def _rests(lines: tuple[str, ...], settings: PmacSettings) -> Iterator[_Rest]:
    """The rests: after a dwell, after a knot with zero speed, and after the last line."""
    knot = re.compile(" ".join(rf"{letter}{_VALUE}(?::{_VALUE})?" for letter in settings.letters))
    length: Array | None = None
    stands, interval = False, ""
    for index, line in enumerate(lines):
        found = knot.fullmatch(line)
        if found:
            length = np.array(found.groups()[::2], dtype=float)
            speeds = found.groups()[1::2]
            stands = all(speed is not None and float(speed) == 0 for speed in speeds)
        elif _DWELL.match(line):
            stands = length is not None
        elif _INTERVAL.fullmatch(line):
            interval = line
        is_last = index == len(lines) - 1
        dwells_next = not is_last and _DWELL.match(lines[index + 1])
        if length is not None and stands and (is_last or _DWELL.match(line)):
            yield _Rest(index + 1, length, "")
        elif length is not None and stands and found and not dwells_next:
            yield _Rest(index + 1, length, interval)


class RotaryBuffer:
    """Tracks the contents of the buffer.

    Attributes:
        loaded: lines that certainly arrived, executed or not.
        uncertain: further lines that may have arrived.
    """

    def __init__(self, session: Session, settings: PmacSettings, lines: Sequence[str], words: int) -> None:
        self.loaded = self.uncertain = 0
        self._session, self._lines, self._system = session, lines, f"&{settings.coordinate_system}"
        self._opening = rotary_opening(settings)
        self._filled = [0, *accumulate(map(line_words, lines))]
        self._words, self._room = words, words
        self._connections = session.connections

    def open(self) -> None:
        """Open the buffer empty and point the coordinate system to it."""
        # Retrying the whole sequence is safe: nothing is released yet.
        if ahead := self._execute_all(*self._opening):
            raise PmacError(f"{ahead} lines are in the rotary buffer after CLEAR")

    def empty(self) -> bool:
        """Empty and close it; return whether the controller confirms that."""
        return self._execute_all("CLOSE", self._system, "OPEN ROT", "CLEAR", "CLOSE") == 0

    def lines_ahead(self) -> int:
        """Lines in the buffer that have not begun."""
        answer = self._session.query(f"{self._system}PR")
        if len(answer) != 1 or not re.fullmatch(r"\d{1,9}", answer[0].strip()):
            raise LinkLostError(f"PR: expected a number of lines, got {answer}")
        return int(answer[0])

    def send(self, end: int) -> bool:
        """Send as many of the lines up to ``end`` as fit; return whether any line fitted.

        Raises:
            RefusedError: a line was refused; those before it may be in the buffer.
            LinkLostError: the link failed, or has reconnected; ``recount`` must come next.
        """
        batch = self._lines[self.loaded : self.loaded + self._fitting(end)]
        if not self._is_still_open():
            raise LinkLostError("the link has reconnected, which closed the rotary buffer")
        if not batch:
            return False
        self.uncertain = min(len(batch), self._session.lines_at_once(batch))
        done = self._session.load(batch)
        self._room -= self._filled[self.loaded + done] - self._filled[self.loaded]
        self.loaded, self.uncertain = self.loaded + done, 0
        return True

    def recount(self, begun: int) -> None:
        """After a failure, at rest after line ``begun``, count the loaded lines and reopen the buffer.

        Raises:
            PmacError: the controller's count is inconsistent.
        """
        there = begun + self._execute_all("CLOSE", self._system, "OPEN ROT")
        if not self.loaded <= there <= self.loaded + self.uncertain:
            raise PmacError(
                f"the controller has {there} lines, sent were {self.loaded} to {self.loaded + self.uncertain}"
            )
        self.loaded, self.uncertain, self._room = there, 0, 0

    def _execute_all(self, *lines: str) -> int:
        """Execute lines, retrying all if the link fails; return the number of lines ahead."""
        for attempt in range(ATTEMPTS):
            self._connections = self._session.connections
            try:
                for line in lines:
                    self._session.command(line)
                ahead = self.lines_ahead()
            except LinkLostError as lost:
                _log.warning("the link failed: %s", lost)
                if attempt == ATTEMPTS - 1:
                    raise
            else:
                if self._is_still_open():
                    return ahead
        raise LinkLostError("the link fails repeatedly")

    def _is_still_open(self) -> bool:
        """Whether the buffer is still open: a reconnect closes it, and a line would then be executed at once."""
        return self._connections == self._session.connections

    def _fitting(self, end: int) -> int:
        if self._filled[self.loaded + 1] - self._filled[self.loaded] > self._room:
            oldest = max(self.loaded - self.lines_ahead() - _MARGIN, 0)
            self._room = self._words - (self._filled[self.loaded] - self._filled[oldest])
        count = self.loaded
        while count < end and self._filled[count + 1] - self._filled[self.loaded] <= self._room:
            count += 1
        return count - self.loaded
