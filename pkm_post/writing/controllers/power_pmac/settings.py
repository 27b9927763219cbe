# SPDX-License-Identifier: LGPL-2.1-or-later
"""Settings: wiring and communication of one machine's Power PMAC.

Enters: the ``[controller]`` table of the machine file. Leaves: settings. The program memory is configured in the
controller's own project, so the machine file does not state it.
"""

from __future__ import annotations

from dataclasses import dataclass

from pkm_post.model import Diagnostic, Machine
from pkm_post.writing.controllers.pvt import settings as pvt


@dataclass(frozen=True, kw_only=True)
class PowerPmacSettings(pvt.Settings):
    """Settings of the Power PMAC of one machine; its numbers are doubles."""

    KIND = "power_pmac"


def settings_of(machine: Machine) -> tuple[PowerPmacSettings | None, tuple[Diagnostic, ...]]:
    """Settings of a machine's controller, or None with diagnostics."""
    return pvt.settings_of(PowerPmacSettings, machine)
