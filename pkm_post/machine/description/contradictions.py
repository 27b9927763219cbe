# SPDX-License-Identifier: LGPL-2.1-or-later
"""Contradictions: entries of a machine file that are well formed but cannot all be true.

Input: the entries in mm and rad, by name; None for omitted ones, malformed ones are absent. Output: a fault for each
failed check. A check runs when all its entries are present.
"""

from __future__ import annotations

from pkm_post.machine.description import limit_pairs, rest_pose, strut_parts, tool_change
from pkm_post.machine.description.faults import Fault
from pkm_post.machine.description.rest_pose import Values

_CHECKS = rest_pose.CHECKS + strut_parts.CHECKS + limit_pairs.CHECKS + tool_change.CHECKS


def contradictions(values: Values) -> list[Fault]:
    """Faults from all cross-checks of the readable entries."""
    return [
        Fault("M103" if values[entry] is None else "M106", tuple(entry.split(".")), found)
        for needs, check in _CHECKS
        if all(values.get(need) is not None for need in needs)
        for entry, found in check(values)
    ]
