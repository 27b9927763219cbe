# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rotary: a motion program in the form that runs from a rotary buffer during its transfer.

Enters: the text of a certified program. Leaves: the same lines in the frame of the rotary buffer. This runs programs
larger than the memory, as the controller discards executed lines. The buffer itself is defined once after each reset,
as part of the machine's set-up.
"""

from __future__ import annotations

from pkm_post.writing.controllers.pmac.program import buffer_opening
from pkm_post.writing.controllers.pmac.settings import PmacSettings


def rotary_opening(settings: PmacSettings) -> tuple[str, ...]:
    """The lines that open and clear the rotary buffer, with the coordinate system pointed to it."""
    # After OPEN ROT, B0 would be a move of axis B.
    return "CLOSE", "DELETE GATHER", f"&{settings.coordinate_system}B0", "OPEN ROT", "CLEAR"


def rotary_text(program: str, settings: PmacSettings) -> str:
    """The rotary form of a program.

    Args:
        program: text of a motion program in one part.
        settings: settings of the controller it was written for.

    Raises:
        ValueError: the text lacks the frame of a program for this controller.
    """
    opening = buffer_opening(settings)
    if program.count(opening) != 1:
        raise ValueError(f"program: expected {opening!r} once, got it {program.count(opening)} times")
    return program.replace(opening, "".join(f"{line}\n" for line in rotary_opening(settings)))
