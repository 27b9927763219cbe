# SPDX-License-Identifier: LGPL-2.1-or-later
"""Gates: a program cut into segments, each of which ends with STOP where the struts rest.

A controller executes a rotary buffer as long as it holds lines. If they run out within a move because the link was cut,
the struts stop abruptly, or do something undocumented. So STOP is inserted where the program rests anyway, and all
lines between two STOPs are loaded before R releases the first of them: whatever happens to the link, the controller
holds all lines up to a place where it stops by itself.

Enters: a program and the size of the rotary buffer in words. Leaves: its segments.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import accumulate

import numpy as np

from pkm_post.control.link.faults import NotReadyError
from pkm_post.control.link.listing import Program, words_of
from pkm_post.control.link.status import Array
from pkm_post.writing import PmacSettings

STOP = "STOP"
_STAND = "DWELL0"
_DWELL, _INTERVAL = re.compile(r"DWELL"), re.compile(r"PVT\d+")
_GATE_WORDS = 34
"""More than the words of DWELL0, STOP, the repeated interval, and two executed lines that may still be there."""
_VALUE = r"(-?\d+\.\d+)"


@dataclass(frozen=True)
class Segment:
    """Lines that are executed in one run.

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
    """A place where the struts stand: after how many lines, their lengths, the interval to repeat."""

    behind: int
    length: Array
    interval: str


def segments_of(program: Program, settings: PmacSettings, words: int) -> tuple[Segment, ...]:
    """Cut a program where it rests, as rarely as half the buffer allows, so that one part runs while the next is sent.

    Args:
        program: as written for a fixed buffer.
        settings: of the controller it was written for.
        words: size of the rotary buffer in 48-bit words.

    Raises:
        NotReadyError: it does not end at rest, or the lines between two rests exceed the buffer.
    """
    rests = list(_rests(program.lines, settings))
    if not rests or rests[-1].behind != len(program.lines):
        raise NotReadyError(["the program does not end at rest: it cannot be streamed"])
    filled = [0, *accumulate(map(words_of, program.lines))]
    segments: list[Segment] = []
    start, interval = 0, ""
    while start < len(program.lines):
        rest = _next(rests, start, filled, words)
        lines = [interval] if interval else []
        lines += program.lines[start : rest.behind]
        lines += [_STAND, STOP] if rest.interval else [STOP]
        segments.append(Segment(tuple(lines), rest.length, rest.behind))
        start, interval = rest.behind, rest.interval
    return tuple(segments)


def _next(rests: list[_Rest], start: int, filled: list[int], words: int) -> _Rest:
    """The farthest rest within half of the buffer, else the nearest one."""
    ahead = [rest for rest in rests if rest.behind > start]
    within = [rest for rest in ahead if filled[rest.behind] - filled[start] + _GATE_WORDS <= words // 2]
    chosen = within[-1] if within else ahead[0]
    needed = filled[chosen.behind] - filled[start] + _GATE_WORDS
    if needed > words:
        raise NotReadyError(
            [
                f"the program does not rest between its lines {start + 1} and {chosen.behind}, which take {needed}"
                f" words; the rotary buffer has {words}: define a larger one, or put stops into the job"
            ]
        )
    return chosen


def _rests(lines: tuple[str, ...], settings: PmacSettings) -> Iterator[_Rest]:
    """Where the struts stand: after a dwell, after a knot with zero speed, and after the last line."""
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
