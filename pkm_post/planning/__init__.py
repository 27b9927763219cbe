# SPDX-License-Identifier: LGPL-2.1-or-later
"""Planning: corner blending, look-ahead, feed profile and knots, from a trajectory to strut motion."""

from pkm_post.planning import motion
from pkm_post.planning.knots import LONGEST_MS
from pkm_post.planning.schedule import Schedule
from pkm_post.planning.tool_path import ToolPath

__all__ = [
    "LONGEST_MS",
    "Schedule",
    "ToolPath",
    "motion",
]
