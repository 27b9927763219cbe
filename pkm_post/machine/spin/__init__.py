# SPDX-License-Identifier: LGPL-2.1-or-later
"""Spin: rotation of the platform about the tool axis, which cuts nothing and moves every strut."""

from pkm_post.machine.spin.apply import with_spin
from pkm_post.machine.spin.optimise import least_shares, optimise
from pkm_post.machine.spin.policy import OBJECTIVES, ZERO_TORSION, Policy, Rule
from pkm_post.machine.spin.rules import spin_in_plane

__all__ = [
    "OBJECTIVES",
    "ZERO_TORSION",
    "Policy",
    "Rule",
    "least_shares",
    "optimise",
    "spin_in_plane",
    "with_spin",
]
