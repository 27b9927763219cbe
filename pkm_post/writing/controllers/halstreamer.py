# SPDX-License-Identifier: LGPL-2.1-or-later
"""Halstreamer: strut lengths row by row at a fixed period, for LinuxCNC's ``halstreamer``.

Input: the cubics of a strut motion. Output: tables of six lengths in mm, one row for each period of 1 ms, and back.
Dwells repeat a row. Other events need another program: a table ends there, at rest, and the next one starts. A drive
that interpolates linearly between rows deviates from the cubic by no more than ``chord_error``.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from pkm_post.geometry import hermite_accelerations, hermite_lengths
from pkm_post.model import (
    Array,
    Diagnostic,
    Diagnostics,
    Event,
    EventKind,
    Place,
    StrutMotion,
    freeze,
    intervals_at,
    pieces,
)
from pkm_post.system import result_files


@dataclass(frozen=True)
class TableSection:
    """A section of a motion between two events that need another program; it includes dwells.

    Attributes:
        before: events before it begins, in order.
        clock_ms: marks on its own clock, from 0 on.
        motion_ms: the time of the motion at each of these marks; linear between them.
        after: events after its end; last section only.
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
    """A section under construction."""

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


def sections(motion: StrutMotion) -> tuple[TableSection, ...]:
    """The sections of a motion, at least one; only a motion without duration has a section without duration."""
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
    made = [TableSection(tuple(piece.before), tuple(piece.clock_ms), tuple(piece.motion_ms)) for piece in pieces]
    return (*made[:-1], replace(made[-1], after=tuple(after)))


SUFFIX = result_files.SIDE_OUTPUTS["halstreamer"]
PERIOD_MS = 1
"""The servo period of LinuxCNC's own configurations."""
DECIMALS = 6
_HALF_DIGIT = 0.5001 * 10.0**-DECIMALS
"""mm: rounding error, with margin for the arithmetic."""
_ROWS_AT_ONCE = 1 << 16

_LENGTH = r"-?(?:0|[1-9][0-9]*)\.[0-9]+"
_ROW = rf"{_LENGTH}(?: {_LENGTH}){{5}}\n"
_PERIOD = r"# period (?P<ms>[1-9][0-9]{0,3}) ms\n"
_PIECES = re.compile(rf"(?P<rows>(?>{_ROW})++)|(?P<period>{_PERIOD})|(?P<comment>#[ -~]*\n)")


@dataclass(frozen=True)
class RowTable:
    """One table.

    Attributes:
        period_ms: time between rows.
        length: (M, 6) strut lengths in mm.
    """

    period_ms: int
    length: Array

    def __post_init__(self) -> None:
        freeze(self, len(self.length), {"length": (np.float64, (6,))})


def lengths_at(motion: StrutMotion, time_ms: Array) -> Array:
    """Strut lengths at times in ms, (M, 6), on the cubics of a motion."""
    result = np.empty((len(time_ms), 6))
    if len(motion) == 1:
        result[:] = motion.length
        return result
    for rows in pieces(len(time_ms), _ROWS_AT_ONCE):
        time = time_ms[rows]
        knot = intervals_at(motion.time_ms, time)
        begin = motion.time_ms[knot]
        share = (time - begin) / (motion.time_ms[knot + 1] - begin)
        result[rows] = hermite_lengths(*motion.cubics(knot), share[:, None])[:, 0]
    return result


def chord_error(motion: StrutMotion) -> float:
    """Largest deviation of the straight line between rows from the cubics, mm: T^2 / 8 max |p''|."""
    if len(motion) == 1:
        return 0.0
    accelerations = hermite_accelerations(*motion.cubics(np.arange(len(motion) - 1)))
    return float((PERIOD_MS / 1000) ** 2 / 8 * np.abs(np.stack(accelerations)).max())


def texts(motion: StrutMotion, heading: Sequence[str]) -> tuple[str, ...]:
    """The tables of a motion as text, with a heading of printable ASCII."""
    made = sections(motion)
    error = chord_error(motion)
    return tuple(
        "".join([*_heading(heading, section, number, len(made), error), *_rows(motion, section), *_after(section)])
        for number, section in enumerate(made, start=1)
    )


def _heading(heading: Sequence[str], section: TableSection, number: int, count: int, error: float) -> Iterator[str]:
    lines = [re.sub(r"[^ -~]", lambda sign: ascii(sign[0])[1:-1], line) for line in heading]
    yield from (f"# {line}\n" for line in lines)
    yield f"# part {number} of {count}; strut lengths in mm, strut 1 first; cfg=ffffff\n"
    yield f"# straight from row to row a strut is at most {error:.3g} mm from its cubic\n"
    yield f"# before: {_event_list(section.before)}\n"
    yield f"# period {PERIOD_MS} ms\n"


def _after(section: TableSection) -> Iterator[str]:
    if section.after:
        yield f"# after: {_event_list(section.after)}\n"


def _event_list(events: Sequence[Event]) -> str:
    return ", ".join(f"{event.kind.name.lower()} {event.value:.12g}" for event in events) or "nothing"


def _rows(motion: StrutMotion, section: TableSection) -> Iterator[str]:
    times = section.rows_ms(PERIOD_MS)
    row = " ".join([f"%.{DECIMALS}f"] * 6) + "\n"
    for rows in pieces(len(times), _ROWS_AT_ONCE):
        length = np.round(lengths_at(motion, times[rows]), DECIMALS) + 0.0
        yield (row * len(length)) % tuple(length.ravel().tolist())


def read_stream(text: str, file: str) -> tuple[RowTable | None, Diagnostics]:
    """Read a table back; return it, or None and the first fault."""
    position, periods, rows = 0, [], []
    while match := _PIECES.match(text, position):
        position = match.end()
        periods += [int(match["ms"])] if match["period"] else []
        rows += [match["rows"]] if match["rows"] else []
    if position < len(text) or len(periods) != 1 or not rows:
        found = repr(text[position:].split("\n", 1)[0][:60]) if position < len(text) else "the end"
        return None, (Diagnostic("C106", Place(file, line=text.count("\n", 0, position) + 1), found),)
    length = np.fromstring("".join(rows), sep=" ").reshape(-1, 6)
    if not np.isfinite(length).all():
        return None, (Diagnostic("C106", Place(file), "a length that is too large"),)
    return RowTable(periods[0], length), ()


def measured(texts: Sequence[tuple[str, str]], motion: StrutMotion) -> tuple[str, Diagnostics]:
    """Read the tables back and measure their deviation from the cubics, at their rows and half way between."""
    limits = _HALF_DIGIT, chord_error(motion) + _HALF_DIGIT
    worst, rows = 0.0, 0
    made = sections(motion)
    if len(made) != len(texts):
        return "", (Diagnostic("C107", Place(texts[0][0]), f"{len(texts)} tables, expected {len(made)}"),)
    for (file, text), section in zip(texts, made, strict=True):
        stream, faults = read_stream(text, file)
        if stream is None:
            return "", faults
        apart = _apart(stream, section, motion)
        for found, limit in zip(apart, limits, strict=True):
            if found > limit:
                return "", (Diagnostic("C107", Place(file), f"{found:.3g} mm apart, at most {limit:.3g} mm can be"),)
        worst, rows = max(worst, apart[1]), rows + len(stream.length)
    return f"{rows} rows, straight lines between them {worst:.3g} mm from the cubics", ()


def _apart(stream: RowTable, section: TableSection, motion: StrutMotion) -> tuple[float, float]:
    """Deviation of a table from the cubics at its rows and between them, mm; infinite if the number of rows differs."""
    times = section.rows_ms(stream.period_ms)
    if len(times) != len(stream.length):
        return math.inf, math.inf
    half = section.time_at(stream.period_ms * (np.arange(len(times) - 1) + 0.5))
    chord = (stream.length[:-1] + stream.length[1:]) / 2
    at_rows, between = stream.length - lengths_at(motion, times), chord - lengths_at(motion, half)
    return float(np.abs(at_rows).max()), float(np.abs(between).max(initial=0.0))
