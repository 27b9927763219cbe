# SPDX-License-Identifier: LGPL-2.1-or-later
"""Syntax: what opens a Power PMAC program, for the reader.

Enters: the settings of the controller. Leaves: the grammar of its programs. It is stated here on its own, not taken
from the writer: a fault of the writer must not be read as if it were none. The controller takes capitals for small
letters and the other way round; the reader does not, for the writer has no choice either.
"""

from __future__ import annotations

from pkm_post.controllers.power_pmac.settings import Settings
from pkm_post.controllers.pvt.settings import APPROACH_RAMP_MS
from pkm_post.controllers.pvt.syntax import FLOW_FROM_MODES, PRINTABLE, START, Flow, Grammar, body_forms, form

FLOW: Flow = {START: {"comment": START, "open": "cleared"}, **FLOW_FROM_MODES}
"""Opening a program empties it."""


def grammar(settings: Settings) -> Grammar:
    """The grammar of the programs of a Power PMAC."""
    forms = {
        "comment": form("a comment", "//", PRINTABLE),
        "open": form(f"open prog {settings.program}", "open prog ", str(settings.program)),
        **body_forms(settings, str.lower),
    }
    return Grammar(forms, FLOW, (APPROACH_RAMP_MS, 0, settings.approach_speed))
