# SPDX-License-Identifier: LGPL-2.1-or-later
"""Settings: how one machine's Power PMAC is wired and spoken to.

Enters: the ``[controller]`` table of the machine file. Leaves: settings. The memory for programs is set in the
controller's own project, so the machine file does not say how much there is.
"""

from __future__ import annotations

from dataclasses import dataclass

from pkm_post.controllers.pvt import settings as pvt
from pkm_post.model import Diagnostic, Machine


@dataclass(frozen=True, kw_only=True)
class Settings(pvt.Settings):
    """Settings of the Power PMAC of one machine; its numbers are doubles."""

    KIND = "power_pmac"


def settings_of(machine: Machine) -> tuple[Settings | None, tuple[Diagnostic, ...]]:
    """Settings of a machine's controller, or why there are none."""
    return pvt.settings_of(Settings, machine)
