# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reader: Turbo PMAC programs read back as strut motion.

Input: the text of a program or of its parts, and the settings of the controller it was written for. Output: strut
motion, or diagnostics. The grammar is independent of the writer, so that the reader detects a fault of the writer.
"""

from __future__ import annotations

from collections.abc import Sequence

from pkm_post.model import Diagnostic, StrutMotion
from pkm_post.writing.controllers.pmac.settings import PmacSettings
from pkm_post.writing.controllers.pvt import reader
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


def read_parts(
    texts: Sequence[tuple[str, str]], settings: PmacSettings
) -> tuple[StrutMotion | None, tuple[Diagnostic, ...]]:
    """Read a motion program in one or several parts; as ``pvt.reader.read_parts``."""
    return reader.read_parts(texts, _grammar(settings), settings)


def read_part(text: str, settings: PmacSettings, file: str) -> tuple[StrutMotion | None, tuple[Diagnostic, ...]]:
    """Read a motion program, or a single part of it; its statements about other parts are ignored."""
    return reader.read_program(text, _grammar(settings), settings, file)


def read_program(text: str, settings: PmacSettings, file: str) -> tuple[StrutMotion | None, tuple[Diagnostic, ...]]:
    """Read a motion program in one part.

    Args:
        text: the program.
        settings: settings of the controller it was written for.
        file: its name, for the diagnostics.

    Returns:
        The motion, or None if there are faults; and the first 20 faults in line order.
    """
    return read_parts([(file, text)], settings)
