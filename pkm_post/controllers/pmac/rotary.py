# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rotary: a motion program in the form that runs from a rotary buffer while it is still being sent.

Enters: the text of a program, as it was certified. Leaves: the same lines in the frame of the rotary buffer, and back.
A program that is larger than the memory and rests nowhere can run so: the controller forgets what it has carried out.
The buffer itself is defined once after each reset, by whoever set the machine up.
"""

from __future__ import annotations

from pkm_post.controllers.pmac.settings import Settings


def _frames(settings: Settings) -> tuple[str, str]:
    """What stands before the modes and the moves, in a program and in the rotary form."""
    program = f"CLOSE\nDELETE GATHER\nOPEN PROG {settings.program}\nCLEAR\n"
    # B0 points the coordinate system to the rotary buffer. Behind OPEN ROT it would be a move of axis B.
    rotary = f"CLOSE\nDELETE GATHER\n&{settings.coordinate_system}\nB0\nOPEN ROT\n"
    return program, rotary


def rotary_text(program: str, settings: Settings) -> str:
    """The rotary form of a program.

    Args:
        program: text of a motion program in one part.
        settings: of the controller it was written for.

    Raises:
        ValueError: the text has not the frame of a program of this controller.
    """
    return _reframed(program, *_frames(settings))


def program_of_rotary(text: str, settings: Settings) -> str:
    """The program that a rotary form was made of; ``read_program`` reads it.

    Raises:
        ValueError: the text has not the frame of the rotary form.
    """
    return _reframed(text, *reversed(_frames(settings)))


def _reframed(text: str, before: str, after: str) -> str:
    if text.count(before) != 1:
        raise ValueError(f"text: expected {before!r} once, got it {text.count(before)} times")
    return text.replace(before, after)
