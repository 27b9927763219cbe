# SPDX-License-Identifier: LGPL-2.1-or-later
"""Memory: whether a motion program fits into the controller, and where to cut it if it does not.

Input: strut motion. Output: an estimate of the program's size in the controller's 48-bit words, the knots where it is
cut into parts that fit, and a diagnostic if there is no rest for a cut. The controller stores one word per value;
``SIZE`` reports its free memory.
"""

from __future__ import annotations

import numpy as np

from pkm_post.model import Array, Diagnostic, Diagnostics, EventKind, Place, StrutMotion, is_among
from pkm_post.writing.controllers.pmac.settings import PmacSettings
from pkm_post.writing.controllers.pvt.writer import rest_knots

WORDS_PER_KNOT = 12
"""Six lengths and six speeds."""

WORDS_OF_TURNS = 2
"""Angle and speed of the spindle, at the knots of threads."""

WORDS_PER_EVENT = 6
"""DWELL0, the code, which may assign and dwell, and the PVT that resumes the motion."""

WORDS_OF_FRAME = 20
"""ABS, FRAX with six letters, LINEAR, TA, TS, F, two DWELL0, LINEAR, with margin."""

_GOOD_FOR_A_CUT = {EventKind.TOOL_CHANGE: 2, EventKind.STOP: 1}
"""Merit of cutting at an event, where the machine waits anyway; 0 for any other rest."""


def _words_by_knot(motion: StrutMotion) -> Array:
    """Words of each knot and its events, (M,)."""
    words = np.full(len(motion), WORDS_PER_KNOT)
    words[1:] += np.diff(np.diff(motion.time_ms), prepend=0) != 0
    words[motion.turns.knot] += WORDS_OF_TURNS
    np.add.at(words, [event.row for event in motion.events], WORDS_PER_EVENT)
    return words


def memory_cuts(motion: StrutMotion, settings: PmacSettings) -> tuple[int, ...]:
    """The knots where a motion is cut for each part to fit into the controller.

    Each part ends at the best rest within the memory, at the last of equals.

    Raises:
        ValueError: there is no rest within the memory; ``memory_faults`` reports this beforehand.
    """
    cuts, stuck = _cuts(motion, settings)
    if stuck is not None:
        raise ValueError(f"motion: expected a rest within {settings.memory_words} words, got none behind knot {stuck}")
    return cuts


def memory_faults(motion: StrutMotion, settings: PmacSettings, file: str) -> Diagnostics:
    """Compare the program of a motion, in parts, with the memory of the controller; ``file`` is the name of the job."""
    _, stuck = _cuts(motion, settings)
    if stuck is None:
        return ()
    resting = _cut_candidates(motion, settings)
    end = int(resting[resting > stuck].min(initial=len(motion) - 1))
    words = WORDS_OF_FRAME + int(_words_by_knot(motion)[stuck : end + 1].sum())
    found = (
        f"about {words} words for {end - stuck + 1} knots without a rest from {motion.time_ms[stuck] / 1000:g} s on, "
        f"the controller has {settings.memory_words}"
    )
    return (Diagnostic("C102", Place(file), found),)


def _cuts(motion: StrutMotion, settings: PmacSettings) -> tuple[tuple[int, ...], int | None]:
    """The cuts, and the knot after which no rest fits into the memory, if any."""
    own = _words_by_knot(motion)
    if own.sum() <= _room(settings, 0):
        return (), None
    behind = np.cumsum(own)
    resting, merit = _cut_candidates(motion, settings), _merit(motion)
    cuts: list[int] = []
    first, last = 0, len(motion) - 1
    while behind[last] - behind[first] + own[first] > (room := _room(settings, first)):
        reach = np.searchsorted(behind, room + behind[first] - own[first], side="right") - 1
        near = resting[(resting > first) & (resting <= reach)]
        if not len(near):
            return tuple(cuts), first
        first = int(near[merit[near] == merit[near].max()][-1])
        cuts.append(first)
    return tuple(cuts), None


def _cut_candidates(motion: StrutMotion, settings: PmacSettings) -> Array:
    """Knots at rest outside threads: no part may start with the spindle as an axis."""
    resting = rest_knots(motion, settings)
    return resting[~is_among(resting, motion.turns.knot)]


def _room(settings: PmacSettings, first: int) -> int:
    """Words for the knots of a part; a part after a cut needs one more, for the time of its first interval."""
    return settings.memory_words - WORDS_OF_FRAME - (first > 0)


def _merit(motion: StrutMotion) -> Array:
    """Merit of each knot for a cut, (M,)."""
    merit = np.zeros(len(motion), dtype=np.int64)
    for event in motion.events:
        merit[event.row] = max(merit[event.row], _GOOD_FOR_A_CUT.get(event.kind, 0))
    return merit
