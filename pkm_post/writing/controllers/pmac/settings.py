# SPDX-License-Identifier: LGPL-2.1-or-later
"""Settings: wiring and communication of one machine's Turbo PMAC.

Enters: the ``[controller]`` table of the machine file. Leaves: settings with the memory of the controller.
"""

from __future__ import annotations

from dataclasses import dataclass

from pkm_post.model import Diagnostic, Machine
from pkm_post.writing.controllers.pvt import settings as pvt


@dataclass(frozen=True, kw_only=True)
class PmacSettings(pvt.Settings):
    """Settings of the Turbo PMAC of one machine; it stores about 10 significant digits of a number.

    Attributes:
        memory_words: 48-bit words of controller memory free for the program.
    """

    KIND = "turbo_pmac"

    memory_words: int


def settings_of(machine: Machine) -> tuple[PmacSettings | None, tuple[Diagnostic, ...]]:
    """Settings of a machine's controller, or None with diagnostics."""
    return pvt.settings_of(PmacSettings, machine)
