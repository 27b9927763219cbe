# SPDX-License-Identifier: LGPL-2.1-or-later
"""Syntax: the opening lines of a Power PMAC program, for the reader.

Enters: the settings of the controller. Leaves: the grammar of its programs. It is independent of the writer, so that
the reader detects a fault of the writer. The controller ignores case; the reader does not, as the writer's case is
fixed.
"""

from __future__ import annotations

from pkm_post.writing.controllers.power_pmac.settings import PowerPmacSettings
from pkm_post.writing.controllers.pvt.settings import APPROACH_RAMP_MS
from pkm_post.writing.controllers.pvt.syntax import FLOW_FROM_MODES, PRINTABLE, START, Flow, Grammar, body_forms, form

FLOW: Flow = {START: {"comment": START, "open": "cleared"}, **FLOW_FROM_MODES}
"""Opening a program clears it."""


def grammar(settings: PowerPmacSettings) -> Grammar:
    """The grammar of the programs of a Power PMAC."""
    forms = {
        "comment": form("a comment", "//", PRINTABLE),
        "open": form(f"open prog {settings.program}", "open prog ", str(settings.program)),
        **body_forms(settings, str.lower),
    }
    return Grammar(forms, FLOW, (APPROACH_RAMP_MS, 0, settings.approach_speed))
