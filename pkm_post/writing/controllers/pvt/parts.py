# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parts: split a motion into several programs that run in sequence, and join them again.

Input: strut motion and the knots where it is cut, or the motions read from the parts. Output: a motion for each part,
each starting at 0 ms, or one motion. Events at a cut go to the part after it. Each part states its number in its
heading, for the user and for the reader.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from pkm_post.model import Array, Diagnostic, Diagnostics, Event, Place, SpindleTurns, StrutMotion

_STATED = re.compile(r"(?:(?:;|//).*\n)*?(?:;|//) part ([1-9][0-9]{0,3}) of ([1-9][0-9]{0,3}):")
"""Matches in the comment on top only, as a program may be long; four digits limit the number of stated parts."""


def split_motion(motion: StrutMotion, cuts: Sequence[int]) -> tuple[StrutMotion, ...]:
    """The parts of a motion, cut at knots where it rests, in order, without the first and the last."""
    edges = [0, *cuts, len(motion) - 1]
    return tuple(
        _slice(motion, first, last, last == edges[-1]) for first, last in zip(edges[:-1], edges[1:], strict=True)
    )


def _slice(motion: StrutMotion, first: int, last: int, ends: bool) -> StrutMotion:
    events = (event for event in motion.events if first <= event.row < last + ends)
    return StrutMotion(
        motion.time_ms[first : last + 1] - motion.time_ms[first],
        motion.length[first : last + 1],
        motion.speed[first : last + 1],
        tuple(replace(event, row=event.row - first) for event in events),
        motion.turns.slice(first, last),
    )


def headings(heading: Sequence[str], count: int) -> Iterator[list[str]]:
    """The heading of each part; unchanged if there is only one."""
    for number in range(1, count + 1):
        after = "the first" if number == 1 else f"start it where part {number - 1} ended, and only there"
        yield [*heading, *([f"part {number} of {count}: {after}"] if count > 1 else [])]


def stated_part(text: str) -> tuple[int, int]:
    """The part number that a program states, and the number of parts; 1 of 1 if it states none."""
    found = _STATED.match(text)
    return (int(found[1]), int(found[2])) if found else (1, 1)


def part_faults(texts: Sequence[tuple[str, str]]) -> Diagnostics:
    """Inconsistencies between the statements of the parts, file name and text of each, in order."""
    expected = [(number, len(texts)) for number in range(1, len(texts) + 1)]
    return tuple(
        Diagnostic("C105", Place(file), f"part {stated[0]} of {stated[1]}, expected part {due[0]} of {due[1]}")
        for (file, _), stated, due in zip(texts, (stated_part(text) for _, text in texts), expected, strict=True)
        if stated != due
    )


def join_motions(motions: Sequence[StrutMotion], files: Sequence[str]) -> tuple[StrutMotion | None, Diagnostics]:
    """Join the motions of the parts, if each begins where the previous one ended, at rest."""
    if len(motions) == 1:
        return motions[0], ()
    faults = tuple(_joint_faults(motions, files))
    if faults:
        return None, faults
    shift = np.cumsum([0, *(len(motion) - 1 for motion in motions)])
    behind = [slice(0 if number == 0 else 1, None) for number in range(len(motions))]
    begins = np.cumsum([0, *(motion.time_ms[-1] for motion in motions)])
    rows = list(zip(motions, behind, begins[:-1], shift[:-1], strict=True))
    events = [
        Event(event.row + int(first), event.kind, event.value) for part, _, _, first in rows for event in part.events
    ]
    return StrutMotion(
        np.concatenate([part.time_ms[knots] + begin for part, knots, begin, _ in rows]),
        np.concatenate([part.length[knots] for part, knots, _, _ in rows]),
        np.concatenate([part.speed[knots] for part, knots, _, _ in rows]),
        tuple(events),
        _joined_turns([part.turns for part in motions], shift[:-1]),
    ), ()


def _joined_turns(parts: Sequence[SpindleTurns], shift: Array) -> SpindleTurns:
    """The turns of all parts, with their knots shifted by (P,) given numbers."""
    knots = [part.knot + first for part, first in zip(parts, shift, strict=True)]
    return SpindleTurns(
        np.concatenate(knots),
        np.concatenate([part.angle for part in parts]),
        np.concatenate([part.speed for part in parts]),
    )


def _joint_faults(motions: Sequence[StrutMotion], files: Sequence[str]) -> Iterator[Diagnostic]:
    for before, after, file in zip(motions[:-1], motions[1:], files[1:], strict=True):
        if before.speed[-1].any():
            yield Diagnostic("C105", Place(file), "the part before it does not end at rest")
        elif not np.array_equal(before.length[-1], after.length[0]):
            apart = np.abs(before.length[-1] - after.length[0]).max()
            yield Diagnostic("C105", Place(file), f"it begins {apart:.6g} mm from where the part before it ended")
