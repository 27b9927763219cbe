# SPDX-License-Identifier: LGPL-2.1-or-later
"""Writer: strut motion as the text of a motion program, from its first comment to the end of its last move.

Enters: knots with six lengths in mm and six speeds in mm/s at whole ms. Leaves: ASCII text. The controller approaches
knot 0 slowly in LINEAR mode, then follows from knot to knot the one cubic that has the lengths and speeds of both
(PVT mode). Axis values are true strut lengths; times in the program are in ms.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from pkm_post.controllers.pvt.codes import code_text
from pkm_post.controllers.pvt.comment import comment_lines
from pkm_post.controllers.pvt.settings import Settings
from pkm_post.controllers.pvt.words import Words
from pkm_post.model import StrutMotion
from pkm_post.model.program import Array

LONGEST_INTERVAL_MS = 4095
_ROWS_PER_CHUNK = 4096


def program_text(motion: StrutMotion, settings: Settings, words: Words, opening: str, heading: Sequence[str]) -> str:
    """Write a motion as a motion program.

    Args:
        motion: at rest at both ends and at every event; knots from 1 to 4095 ms apart, the first at 0.
        settings: of the controller.
        words: of the controller.
        opening: what stands between the comment on top and the lengths of knot 0.
        heading: lines of text for the comment on top.

    Raises:
        ValueError: the motion cannot be written: its times, a number that is not finite, a speed where it must rest,
            or an event without code.
    """
    _check(motion, settings)
    lines = _knot_lines(motion, settings)
    for knot, text in _interruptions(motion, settings, words).items():
        lines[knot] += text
    for knot, interval in _new_intervals(motion):
        lines[knot] = f"{words.interval}{interval}\n{lines[knot]}"
    comment = [f"{line}\n" for text in heading for line in comment_lines(text, settings.line_limit, words.comment)]
    return "".join([*comment, opening, *lines, f"{words.linear}\n{words.close}\n"])


def rests(motion: StrutMotion, settings: Settings) -> Array:
    """The knots at which every printed speed is zero."""
    return np.flatnonzero(~_rounded(motion.speed, settings.speed_decimals).any(axis=1))


def _knot_lines(motion: StrutMotion, settings: Settings) -> list[str]:
    """One line per knot: lengths alone for the approach to knot 0, lengths and speeds for the others."""
    values = np.stack(
        [_rounded(motion.length, settings.length_decimals), _rounded(motion.speed, settings.speed_decimals)], axis=2
    )
    length, speed = f"%.{settings.length_decimals}f", f"%.{settings.speed_decimals}f"
    approach = " ".join(f"{letter}{length}" for letter in settings.letters) + "\n"
    move = " ".join(f"{letter}{length}:{speed}" for letter in settings.letters) + "\n"
    lines = [approach % tuple(values[0, :, 0])]
    for start in range(1, len(values), _ROWS_PER_CHUNK):
        chunk = values[start : start + _ROWS_PER_CHUNK]
        lines += ((move * len(chunk)) % tuple(chunk.ravel().tolist())).splitlines(keepends=True)
    return lines


def _rounded(column: Array, decimals: int) -> Array:
    """The column as it will be printed; adding zero turns -0.0 into 0.0."""
    return np.round(column, decimals) + 0.0


def _resting_knots(motion: StrutMotion) -> list[int]:
    return sorted({0, len(motion) - 1} | {event.row for event in motion.events})


def _interruptions(motion: StrutMotion, settings: Settings, words: Words) -> dict[int, str]:
    """What stands after the line of a knot where the motion rests.

    A dwell of 0 comes first: it keeps the controller from computing ahead, which would carry out the codes too early.
    """
    text = dict.fromkeys(_resting_knots(motion), f"{words.dwell}0\n")
    for event in motion.events:
        text[event.row] += code_text(event, settings.codes, words.dwell) + "\n"
    return text


def _new_intervals(motion: StrutMotion) -> Iterator[tuple[int, int]]:
    """The knots whose interval the controller must be told: the time changes, or an interruption ended PVT mode."""
    intervals = np.diff(motion.time_ms)
    told = np.diff(intervals, prepend=0) != 0
    told[[knot for knot in _resting_knots(motion) if knot < len(intervals)]] = True
    for index in np.flatnonzero(told).tolist():
        yield index + 1, int(intervals[index])


def _check(motion: StrutMotion, settings: Settings) -> None:
    if len(motion) == 0 or motion.time_ms[0] != 0:
        raise ValueError(f"motion: expected knots from 0 ms on, got {motion.time_ms[:1].tolist()}")
    intervals = np.diff(motion.time_ms)
    wrong = np.flatnonzero((intervals < 1) | (intervals > LONGEST_INTERVAL_MS))
    if len(wrong):
        raise ValueError(
            f"motion.time_ms: expected intervals of 1 to {LONGEST_INTERVAL_MS} ms, "
            f"got {intervals[wrong[0]]} ms before knot {wrong[0] + 1}"
        )
    if not (np.isfinite(motion.length).all() and np.isfinite(motion.speed).all()):
        raise ValueError("motion: expected finite lengths and speeds, got NaN or infinity")
    rows = [event.row for event in motion.events]
    if rows != sorted(rows) or any(not 0 <= row < len(motion) for row in rows):
        raise ValueError(f"motion.events: expected rows in order from 0 to {len(motion) - 1}, got {rows}")
    knots = _resting_knots(motion)
    moving = np.flatnonzero(_rounded(motion.speed[knots], settings.speed_decimals).any(axis=1))
    if len(moving):
        knot = knots[moving[0]]
        raise ValueError(f"motion.speed: expected rest at knot {knot}, got {motion.speed[knot].tolist()} mm/s")
