# SPDX-License-Identifier: LGPL-2.1-or-later
"""Memory: whether a motion program fits into the controller.

Enters: strut motion. Leaves: an estimate of the program's size in the controller's 48-bit words, and a diagnostic when
that is more than there is. The controller keeps one word per value; ``SIZE`` tells what it has free.
"""

from __future__ import annotations

import numpy as np

from pkm_post.controllers.pmac.settings import Settings
from pkm_post.model import Diagnostic, Place, StrutMotion

WORDS_PER_KNOT = 12
"""Six lengths and six speeds."""

WORDS_PER_EVENT = 4
"""DWELL0, the code, which may have two words, and the PVT that resumes the motion."""

WORDS_OF_FRAME = 20
"""ABS, FRAX with six letters, LINEAR, TA, TS, F, two DWELL0, LINEAR, with some to spare."""


def program_words(motion: StrutMotion) -> int:
    """Estimate the memory of the program of a motion, in 48-bit words."""
    time_changes = int(np.count_nonzero(np.diff(np.diff(motion.time_ms), prepend=0)))
    return WORDS_OF_FRAME + WORDS_PER_KNOT * len(motion) + WORDS_PER_EVENT * len(motion.events) + time_changes


def memory_faults(motion: StrutMotion, settings: Settings, file: str) -> tuple[Diagnostic, ...]:
    """Compare the program of a motion with the memory of the controller.

    Args:
        motion: the motion to be written.
        settings: of the controller.
        file: name of the job, for the diagnostic.
    """
    words = program_words(motion)
    if words <= settings.memory_words:
        return ()
    found = f"about {words} words for {len(motion)} knots, the controller has {settings.memory_words}"
    return (Diagnostic("C102", Place(file), found),)
