# SPDX-License-Identifier: LGPL-2.1-or-later
"""Program: strut motion written as Turbo PMAC motion programs, and read back.

Input: strut motion in mm, mm/s and whole ms, or texts, and the settings of the controller. Output: the moves with the
words and the frame of the Turbo PMAC, in one program or in as many parts as its memory requires; strut motion, or
diagnostics. The grammar is independent of the writer, so that the reader detects a fault of the writer.
"""

from __future__ import annotations

from collections.abc import Sequence

from pkm_post.model import Diagnostics, StrutMotion
from pkm_post.writing.controllers.pmac.memory import memory_cuts
from pkm_post.writing.controllers.pmac.settings import PmacSettings
from pkm_post.writing.controllers.pvt import parts, reader, writer
from pkm_post.writing.controllers.pvt.decimals import plain
from pkm_post.writing.controllers.pvt.settings import APPROACH_RAMP_MS
from pkm_post.writing.controllers.pvt.syntax import (
    FLOW_FROM_MODES,
    PRINTABLE,
    START,
    Flow,
    ProgramGrammar,
    body_forms,
    line_form,
)
from pkm_post.writing.controllers.pvt.writer import Keywords

KEYWORDS = Keywords(comment=";", linear="LINEAR", dwell="DWELL", interval="PVT", close="CLOSE")


def program_text(motion: StrutMotion, settings: PmacSettings, heading: Sequence[str]) -> str:
    """Write a motion as one motion program; as ``pvt.writer.program_text``."""
    return writer.program_text(motion, settings, KEYWORDS, _opening(settings), heading)


def program_parts(motion: StrutMotion, settings: PmacSettings, heading: Sequence[str]) -> tuple[str, ...]:
    """Write a motion as one program, or as several that each fit into the memory, all with the heading on top.

    Raises:
        ValueError: the motion cannot be written, or no rest is near enough; ``memory_faults`` reports this beforehand.
    """
    motions = parts.split_motion(motion, memory_cuts(motion, settings))
    headings = parts.headings(heading, len(motions))
    return tuple(program_text(part, settings, lines) for part, lines in zip(motions, headings, strict=True))


def buffer_opening(settings: PmacSettings) -> str:
    """The lines that open and clear the program buffer: everything before its modes and moves."""
    return f"CLOSE\nDELETE GATHER\nOPEN PROG {settings.program}\nCLEAR\n"


def _opening(settings: PmacSettings) -> str:
    speed = plain(settings.approach_speed)
    return (
        f"{buffer_opening(settings)}"
        f"ABS\nFRAX({','.join(settings.letters)})\nLINEAR\nTA{APPROACH_RAMP_MS} TS0 F{speed}\n"
    )


def rotary_opening(settings: PmacSettings) -> tuple[str, ...]:
    """The lines that open and clear the rotary buffer, with the coordinate system pointed to it."""
    # After OPEN ROT, B0 would be a move of axis B.
    return "CLOSE", "DELETE GATHER", f"&{settings.coordinate_system}B0", "OPEN ROT", "CLEAR"


def rotary_text(program: str, settings: PmacSettings) -> str:
    """The rotary form of a motion program in one part.

    Raises:
        ValueError: the text lacks the frame of a program for this controller.
    """
    opening = buffer_opening(settings)
    if program.count(opening) != 1:
        raise ValueError(f"program: expected {opening!r} once, got it {program.count(opening)} times")
    return program.replace(opening, "".join(f"{line}\n" for line in rotary_opening(settings)))


_FLOW: Flow = {
    START: {"comment": START, "close": "closed"},
    "closed": {"delete": "deleted"},
    "deleted": {"open": "opened"},
    "opened": {"clear": "cleared"},
    **FLOW_FROM_MODES,
}


def _grammar(settings: PmacSettings) -> ProgramGrammar:
    """The grammar of the programs of a Turbo PMAC."""
    forms = {
        "comment": line_form("a comment", ";", PRINTABLE),
        "delete": line_form("DELETE GATHER", "DELETE GATHER"),
        "open": line_form(f"OPEN PROG {settings.program}", "OPEN PROG ", str(settings.program)),
        "clear": line_form("CLEAR", "CLEAR"),
        **body_forms(settings, str.upper),
    }
    return ProgramGrammar(forms, _FLOW, (APPROACH_RAMP_MS, 0, settings.approach_speed))


def read_parts(texts: Sequence[tuple[str, str]], settings: PmacSettings) -> tuple[StrutMotion | None, Diagnostics]:
    """Read a motion program in one or several parts; as ``pvt.reader.read_parts``."""
    return reader.read_parts(texts, _grammar(settings), settings)


def read_part(text: str, settings: PmacSettings, file: str) -> tuple[StrutMotion | None, Diagnostics]:
    """Read a motion program, or a single part of it; its statements about other parts are ignored."""
    return reader.read_program(text, _grammar(settings), settings, file)


def read_program(text: str, settings: PmacSettings, file: str) -> tuple[StrutMotion | None, Diagnostics]:
    """Read a motion program in one part.

    Returns:
        The motion, or None if there are faults; and the first 20 faults in line order.
    """
    return read_parts([(file, text)], settings)
