# SPDX-License-Identifier: LGPL-2.1-or-later
"""Planning: corner blending, look-ahead, feed profile and knots, from a trajectory to strut motion."""

from typing import TYPE_CHECKING

from pkm_post import at_first_use
from pkm_post.planning.knots import LONGEST_MS
from pkm_post.planning.motion import FeedPlan, Plan, interpolate, plan, plan_feed, strut_motion
from pkm_post.planning.schedule import Schedule
from pkm_post.planning.speed_limits import limits_jerk

if TYPE_CHECKING:
    from pkm_post.planning.smooth_window_planner import window_planner
    from pkm_post.planning.window import PathState, WindowPlanner
else:
    __getattr__ = at_first_use(
        __name__, {"smooth_window_planner": "window_planner", "window": "PathState WindowPlanner"}
    )

__all__ = [
    "LONGEST_MS",
    "WindowPlanner",
    "FeedPlan",
    "PathState",
    "Plan",
    "Schedule",
    "window_planner",
    "interpolate",
    "limits_jerk",
    "plan",
    "plan_feed",
    "strut_motion",
]
