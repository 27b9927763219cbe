# SPDX-License-Identifier: LGPL-2.1-or-later
"""Limit table: the certificate row, or other check, that enforces each limit a machine file can state.

Enters: nothing. Leaves: the table, by the entries of ``machine_file.fields.FIELDS``.
tests/certificate/test_limit_table.py fails for an entry that is neither here nor among those that limit nothing.
"""

from __future__ import annotations

CERTIFIED = {
    "struts.stroke": ("strut shorter than its stroke", "strut longer than its stroke"),
    "struts.speed": ("strut speed",),
    "struts.acceleration": ("strut acceleration",),
    "struts.jerk": ("strut jerk",),
    "controller.shortest_interval": ("interval shorter than the controller takes",),
    "controller.block_rate": ("blocks in one second",),
    "tool_path.rapid_speed": ("tip speed",),
    "tool_path.feed_speed": ("tip speed",),
    "tool_path.tip_acceleration": ("tip acceleration",),
    "tool_path.tip_jerk": ("tip jerk",),
    "tool_path.axis_speed": ("turning rate of the tool axis",),
}
"""Findings of the certificate, by name: figures of the written program."""

_ON_THE_PLAN = "proven on the planned path, between its points as well, before the program is written"
_BEFORE_PLANNING = "a job that asks for what is outside is refused, or warned of, before anything is planned"
_WAITS = "dwells that wait for it are events of the job, which the program is compared with"
_READ_BACK = "the reader of the program refuses what does not keep it"
_NOT_PLANNED = "the way to the first point is not planned; no strut can be faster than all six together"

CHECKED_ELSEWHERE = {
    "joints.base_cone": _ON_THE_PLAN,
    "joints.platform_cone": _ON_THE_PLAN,
    "interference.clearance": _ON_THE_PLAN,
    "singularity.least_singular_value": _ON_THE_PLAN,
    "spindle.speed": _BEFORE_PLANNING,
    "spindle.least_speed": _BEFORE_PLANNING,
    "spindle.largest_tool_diameter": _BEFORE_PLANNING,
    "spindle.longest_tool": _BEFORE_PLANNING,
    "spindle.spin_up_time": _WAITS,
    "spindle.spin_down_time": _WAITS,
    "tool_change.safe_height": "the way to the pose of the tool change is placed to keep it",
    "controller.line_limit": _READ_BACK,
    "controller.memory_words": "a program that is too long is cut into parts, or refused, before it is written",
    "controller.approach_speed": _NOT_PLANNED,
}
"""Limits without a finding, and what enforces them."""
