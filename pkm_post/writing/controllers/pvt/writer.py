# SPDX-License-Identifier: LGPL-2.1-or-later
"""Writer: write strut motion as the text of a motion program, from its first comment to its last move.

Input: knots with six lengths in mm and six speeds in mm/s at whole ms. Output: ASCII text. The controller approaches
knot 0 slowly in LINEAR mode, then follows the cubic through the lengths and speeds of consecutive knots (PVT mode).
Axis values are true strut lengths; times in the program are in ms.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from itertools import chain
from typing import NamedTuple

import numpy as np

from pkm_post.model import Array, StrutMotion, checkpoint, is_among, threads
from pkm_post.writing.controllers.pvt.codes import code_text
from pkm_post.writing.controllers.pvt.decimals import BLANK, print_columns, round_values
from pkm_post.writing.controllers.pvt.settings import PvtSettings


class Keywords(NamedTuple):
    """The command words of one controller.

    Attributes:
        comment: start of a comment.
        linear: the mode of the approach, which also ends PVT mode.
        dwell: a dwell in ms; a dwell of 0 also stops look-ahead.
        interval: PVT mode with intervals in ms.
        close: ends the program.
    """

    comment: str
    linear: str
    dwell: str
    interval: str
    close: str


def comment_lines(text: str, line_limit: int, mark: str = ";") -> list[str]:
    """Write one line of text as comment lines of at most ``line_limit`` characters.

    Characters other than printable ASCII become escapes with their code point.
    """
    safe = re.sub(r"[^ -~]", lambda character: ascii(character[0])[1:-1], text)
    width = line_limit - len(mark) - 1
    return [f"{mark} {safe[start : start + width]}".rstrip() for start in range(0, max(len(safe), 1), width)]


LONGEST_INTERVAL_MS = 4095
_ROWS_AT_ONCE = 4096
_END_OF_SECTION = "\x1e"
"""The ASCII record separator, which no program contains."""


def program_text(
    motion: StrutMotion, settings: PvtSettings, keywords: Keywords, opening: str, heading: Sequence[str]
) -> str:
    """Write a motion as a motion program.

    It rests at both ends and at every event; its knots are 1 to 4095 ms apart, the first at 0. ``opening`` is the text
    between the comment on top and the lengths of knot 0.

    Raises:
        ValueError: the motion cannot be written: invalid times, a non-finite number, a speed where it must rest,
            or an event without code.
    """
    _check(motion, settings)
    sections = [[_approach(motion, settings)], *_sections(motion, settings, keywords)]
    interruptions = _interruptions(motion, settings, keywords)
    body = chain.from_iterable((*texts, stop) for texts, stop in zip(sections, interruptions, strict=True))
    checkpoint()
    comment = [f"{line}\n" for text in heading for line in comment_lines(text, settings.line_limit, keywords.comment)]
    return "".join([*comment, opening, *body, f"{keywords.linear}\n{keywords.close}\n"])


def rest_knots(motion: StrutMotion, settings: PvtSettings) -> Array:
    """The knots at which every printed speed is zero."""
    return np.flatnonzero(~round_values(motion.speed, settings.speed_decimals).any(axis=1))


def _approach(motion: StrutMotion, settings: PvtSettings) -> str:
    """The line that moves to knot 0: lengths only."""
    decimals = settings.length_decimals
    lengths = round_values(motion.length[0], decimals).tolist()
    return " ".join(f"{letter}{at:.{decimals}f}" for letter, at in zip(settings.letters, lengths, strict=True)) + "\n"


def _sections(motion: StrutMotion, settings: PvtSettings, keywords: Keywords) -> list[list[str]]:
    """The lines of the other knots, with changed intervals: texts up to each knot where the motion rests."""
    intervals = _interval_lines(motion, keywords.interval)
    ends = np.zeros(len(motion), dtype=np.uint8)
    ends[_resting_knots(motion)] = ord(_END_OF_SECTION)
    sections: list[list[str]] = [[]]
    for start in range(1, len(motion), _ROWS_AT_ONCE):
        rows = slice(start, start + _ROWS_AT_ONCE)
        checkpoint()
        length = print_columns(motion.length[rows], settings.length_decimals)
        speed = print_columns(motion.speed[rows], settings.speed_decimals)
        turns = turn_words(motion, start, len(length), settings)
        lines = _lines(intervals[rows], settings.letters, length, speed, turns, ends[rows])
        first, *others = lines.tobytes().translate(None, BLANK).decode("ascii").split(_END_OF_SECTION)
        sections[-1].append(first)
        sections += [[text] for text in others]
    return sections[:-1]


def _lines(intervals: Array, letters: Sequence[str], length: Array, speed: Array, turns: Array, ends: Array) -> Array:
    """Lines of moves as records of characters and blanks, (N,).

    Args:
        intervals: the interval line before each, or nothing, (N,).
        letters: letters of the axes.
        length: printed, (N, 6, W).
        speed: printed, (N, 6, V).
        turns: words of the spindle in threads, or nothing, (N,).
        ends: the character after each line, (N,).
    """
    columns = [("letter", 1), ("length", length.shape[-1]), ("colon", 1), ("speed", speed.shape[-1]), ("behind", 1)]
    axis = np.dtype([(name, np.uint8, (width,)) for name, width in columns])
    fields = [("interval", intervals.dtype), ("axes", axis, (6,)), ("turns", turns.dtype), ("end", np.uint8)]
    lines = np.empty(len(length), dtype=fields)
    lines["interval"], lines["turns"], lines["end"], axes = intervals, turns, ends, lines["axes"]
    axes["letter"] = np.array([[ord(letter)] for letter in letters])
    axes["length"], axes["colon"], axes["speed"] = length, ord(":"), speed
    axes["behind"] = np.array([[ord(character)] for character in "     \n"])
    axes["behind"][turns != b"", -1] = ord(" ")
    return lines


def turn_words(motion: StrutMotion, start: int, count: int, settings: PvtSettings) -> Array:
    """Words of the spindle in the lines of ``count`` knots from ``start`` on, with the line end, (count,)."""
    first, end = np.searchsorted(motion.turns.knot, [start, start + count])
    axis = settings.spindle_axis
    if first == end or axis is None:
        return np.zeros(count, dtype="S1")
    angles, speeds = (
        round_values(values[first:end], decimals).tolist()
        for values, decimals in (
            (motion.turns.angle, settings.length_decimals),
            (motion.turns.speed, settings.speed_decimals),
        )
    )
    texts = [
        f"{axis.letter}{angle:.{settings.length_decimals}f}:{speed:.{settings.speed_decimals}f}\n"
        for angle, speed in zip(angles, speeds, strict=True)
    ]
    words = np.zeros(count, dtype=f"S{max(map(len, texts))}")
    words[motion.turns.knot[first:end] - start] = texts
    return words


def _resting_knots(motion: StrutMotion) -> list[int]:
    return sorted({0, len(motion) - 1} | {event.row for event in motion.events})


def _interruptions(motion: StrutMotion, settings: PvtSettings, keywords: Keywords) -> Iterable[str]:
    """The text after the line of each knot where the motion rests, in order.

    A dwell of 0 comes first: it stops the controller's look-ahead, which would execute the codes too early.
    """
    text = dict.fromkeys(_resting_knots(motion), f"{keywords.dwell}0\n")
    for event in motion.events:
        text[event.row] += code_text(event, settings.codes, keywords.dwell) + "\n"
    return text.values()


def _interval_lines(motion: StrutMotion, word: str) -> Array:
    """The line with the interval before each knot; empty if it is already in force, (M,).

    It is needed when the interval changes, and after an interruption that ended PVT mode.
    """
    intervals = np.diff(motion.time_ms, prepend=0)
    checkpoint()
    is_stated = np.diff(intervals, prepend=0) != 0
    is_stated[[knot + 1 for knot in _resting_knots(motion)[:-1]]] = True
    checkpoint()
    lines = np.array([b"", *(f"{word}{ms}\n".encode("ascii") for ms in range(1, intervals.max() + 1))])
    return lines[np.where(is_stated, intervals, 0)]


def _check(motion: StrutMotion, settings: PvtSettings) -> None:
    if len(motion) == 0 or motion.time_ms[0] != 0:
        raise ValueError(f"motion: expected knots from 0 ms on, got {motion.time_ms[:1].tolist()}")
    intervals = np.diff(motion.time_ms)
    wrong = np.flatnonzero((intervals < 1) | (intervals > LONGEST_INTERVAL_MS))
    if len(wrong):
        raise ValueError(
            f"motion.time_ms: expected intervals of 1 to {LONGEST_INTERVAL_MS} ms, "
            f"got {intervals[wrong[0]]} ms before knot {wrong[0] + 1}"
        )
    checkpoint()
    if not (np.isfinite(motion.length).all() and np.isfinite(motion.speed).all()):
        raise ValueError("motion: expected finite lengths and speeds, got NaN or infinity")
    checkpoint()
    rows = [event.row for event in motion.events]
    if rows != sorted(rows) or any(not 0 <= row < len(motion) for row in rows):
        raise ValueError(f"motion.events: expected rows in order from 0 to {len(motion) - 1}, got {rows}")
    knots = _resting_knots(motion)
    moving = np.flatnonzero(round_values(motion.speed[knots], settings.speed_decimals).any(axis=1))
    if len(moving):
        knot = knots[moving[0]]
        raise ValueError(f"motion.speed: expected rest at knot {knot}, got {motion.speed[knot].tolist()} mm/s")
    _check_turns(motion, settings, knots)


def _check_turns(motion: StrutMotion, settings: PvtSettings, resting: Sequence[int]) -> None:
    """Check that the spindle is an axis only at the knots of threads, and rests where the struts do."""
    inside = [np.arange(thread.first + 1, thread.end + 1) for thread in threads(motion.events)]
    expected = np.concatenate([np.zeros(0, dtype=np.int64), *inside])
    if not np.array_equal(motion.turns.knot, expected):
        raise ValueError("motion.turns: expected those of the knots of threads, got other knots")
    if len(expected) and settings.spindle_axis is None:
        raise ValueError("motion.turns: expected none for a spindle that is no axis, got some")
    turning = is_among(motion.turns.knot, resting) & (round_values(motion.turns.speed, settings.speed_decimals) != 0)
    if turning.any():
        raise ValueError(f"motion.turns: expected rest at knot {motion.turns.knot[turning][0]}")
