# SPDX-License-Identifier: LGPL-2.1-or-later
"""Syntax: the opening lines of a Turbo PMAC program, for the reader.

Enters: the settings of the controller. Leaves: the grammar of its programs. It is independent of the writer, so that
the reader detects a fault of the writer.
"""

from __future__ import annotations

from pkm_post.writing.controllers.pmac.settings import PmacSettings
from pkm_post.writing.controllers.pvt.settings import APPROACH_RAMP_MS
from pkm_post.writing.controllers.pvt.syntax import FLOW_FROM_MODES, PRINTABLE, START, Flow, Grammar, body_forms, form

FLOW: Flow = {
    START: {"comment": START, "close": "closed"},
    "closed": {"delete": "deleted"},
    "deleted": {"open": "opened"},
    "opened": {"clear": "cleared"},
    **FLOW_FROM_MODES,
}


def grammar(settings: PmacSettings) -> Grammar:
    """The grammar of the programs of a Turbo PMAC."""
    forms = {
        "comment": form("a comment", ";", PRINTABLE),
        "delete": form("DELETE GATHER", "DELETE GATHER"),
        "open": form(f"OPEN PROG {settings.program}", "OPEN PROG ", str(settings.program)),
        "clear": form("CLEAR", "CLEAR"),
        **body_forms(settings, str.upper),
    }
    return Grammar(forms, FLOW, (APPROACH_RAMP_MS, 0, settings.approach_speed))
