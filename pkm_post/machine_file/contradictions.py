# SPDX-License-Identifier: LGPL-2.1-or-later
"""Contradictions: entries of a machine file that are well formed each and cannot all be true.

Enters: the entries in mm and rad, by name; None for one that the file leaves out, and malformed ones are not there.
Leaves: a fault for each check that fails. A check runs when everything it needs is there.
"""

from __future__ import annotations

from pkm_post.machine_file import limit_pairs, rest_pose, strut_parts, tool_change
from pkm_post.machine_file.faults import Fault
from pkm_post.machine_file.rest_pose import Values

_CHECKS = rest_pose.CHECKS + strut_parts.CHECKS + limit_pairs.CHECKS + tool_change.CHECKS


def contradictions(values: Values) -> list[Fault]:
    """What the entries that could be read say against each other."""
    return [
        Fault("M103" if values[entry] is None else "M106", tuple(entry.split(".")), found)
        for needs, check in _CHECKS
        if all(values.get(need) is not None for need in needs)
        for entry, found in check(values)
    ]
