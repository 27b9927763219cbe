# SPDX-License-Identifier: LGPL-2.1-or-later
"""Motion CSV: strut motion as a CSV table, and back.

Input: strut motion. Output: a line of names, then a line for each knot: time in ms, six lengths in mm, six speeds in
mm/s, and its events. Numbers have as many digits as needed to read back the same motion.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from itertools import groupby

import numpy as np

from pkm_post.model import Diagnostic, Diagnostics, Event, EventKind, Place, StrutMotion, pieces
from pkm_post.system import result_files

SUFFIX = result_files.SIDE_OUTPUTS["csv"]

_NAMES = [
    "time_ms",
    *(f"length_{strut}_mm" for strut in range(1, 7)),
    *(f"speed_{strut}_mm_s" for strut in range(1, 7)),
    "events",
]
_HEADER = ",".join(_NAMES) + "\n"
_NUMBERS = len(_NAMES) - 1
_ROWS_AT_ONCE = 4096
_LAST_MS = 2**53
"""Beyond it a double does not resolve milliseconds."""

_NUMBER = r"-?[0-9]+(?:\.[0-9]+)?(?:e[-+]?[0-9]+)?"
_EVENT = rf"({'|'.join(kind.name.lower() for kind in EventKind)})=({_NUMBER})"
_ROW = re.compile(rf"[0-9]+(?:,{_NUMBER}){{12}},(?:{_EVENT}(?:;{_EVENT})*)?")
_EVENTS = re.compile(rf"{_EVENT}(?=[;\n])")


def texts(motion: StrutMotion, heading: Sequence[str]) -> tuple[str, ...]:
    """The table of a motion, without the heading, as CSV has no comments.

    Raises:
        ValueError: the motion has a number that is not finite.
    """
    if not (np.isfinite(motion.length).all() and np.isfinite(motion.speed).all()):
        raise ValueError("motion: expected finite lengths and speeds, got NaN or infinity")
    row = ",".join(["%d", *["%r"] * 12, ""]) + "\n"
    lines: list[str] = []
    for rows in pieces(len(motion), _ROWS_AT_ONCE):
        columns = np.column_stack([motion.time_ms[rows], motion.length[rows] + 0.0, motion.speed[rows] + 0.0])
        lines += ((row * len(columns)) % tuple(columns.ravel().tolist())).splitlines(keepends=True)
    for knot, events in groupby(motion.events, lambda event: event.row):
        cell = ";".join(f"{event.kind.name.lower()}={event.value!r}" for event in events)
        lines[knot] = f"{lines[knot][:-1]}{cell}\n"
    return ("".join([_HEADER, *lines]),)


def read_table(text: str, file: str) -> tuple[StrutMotion | None, Diagnostics]:
    """Read a table back; return the motion, or None and the first fault."""
    lines = text.splitlines(keepends=True)
    wrong = next((number for number, line in enumerate(lines) if not _is_right(number, line)), None)
    if wrong is None and len(lines) < 2:
        wrong = len(lines)
    if wrong is not None:
        found = repr(lines[wrong][:60]) if wrong < len(lines) else "the end"
        return None, (Diagnostic("C106", Place(file, line=wrong + 1), found),)
    body = lines[1:]
    numbers = np.fromstring("".join(line[: line.rindex(",") + 1] for line in body), sep=",").reshape(-1, _NUMBERS)
    events = tuple(
        Event(row, EventKind[name.upper()], float(value))
        for row, line in enumerate(body)
        if not line.endswith(",\n")
        for name, value in _EVENTS.findall(line)
    )
    large = ~np.isfinite(numbers).all(axis=1) | (numbers[:, 0] > _LAST_MS)
    large[[event.row for event in events if not math.isfinite(event.value)]] = True
    if large.any():
        row = int(np.argmax(large))
        return None, (Diagnostic("C106", Place(file, line=row + 2), "a number that is too large"),)
    time_ms = numbers[:, 0].astype(np.int64)
    slow = np.flatnonzero(np.diff(time_ms) <= 0)
    if len(slow):
        return None, (Diagnostic("C106", Place(file, line=int(slow[0]) + 3), "a time that does not grow"),)
    return StrutMotion(time_ms, numbers[:, 1:7], numbers[:, 7:], events), ()


def _is_right(number: int, line: str) -> bool:
    return line == _HEADER if number == 0 else line.endswith("\n") and _ROW.fullmatch(line[:-1]) is not None


def measured(texts: Sequence[tuple[str, str]], motion: StrutMotion) -> tuple[str, Diagnostics]:
    """Read a table back and compare it with its motion, which it must equal exactly."""
    ((file, text),) = texts
    read, faults = read_table(text, file)
    if read is None:
        return "", faults
    apart = _apart(read, motion)
    if apart:
        return "", (Diagnostic("C107", Place(file), f"{apart:.3g} mm or mm/s apart"),)
    return f"{len(read)} rows", ()


def _apart(first: StrutMotion, second: StrutMotion) -> float:
    """The largest difference; infinite if times or events differ."""
    if not np.array_equal(first.time_ms, second.time_ms) or first.events != second.events:
        return math.inf
    return max(float(np.abs(getattr(first, name) - getattr(second, name)).max()) for name in ("length", "speed"))
