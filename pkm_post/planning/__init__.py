# SPDX-License-Identifier: LGPL-2.1-or-later
"""Planning: corner blending, look-ahead, feed profile and knots, from a trajectory to strut motion.

``feed_plan`` and ``motion`` are the two stages. ``profile`` and ``jerk`` find the fastest motion, without and with
limits of jerk; ``knots`` the points of the program; ``window`` the motions that are planned while the machine moves;
``short_lines`` the tolerance that a path of short lines needs.
"""

from typing import TYPE_CHECKING

from pkm_post import at_first_use
from pkm_post.planning.feed_plan import FeedPlan, plan_feed
from pkm_post.planning.motion import Plan, interpolate, plan, strut_motion
from pkm_post.planning.schedule import Schedule
from pkm_post.planning.short_lines import slow_corners
from pkm_post.planning.speed_limits import limits_jerk

if TYPE_CHECKING:
    from pkm_post.planning.window.planner import PathState, WindowPlanner
    from pkm_post.planning.window.smooth_planner import window_planner
else:
    __getattr__ = at_first_use(
        __name__, {"window.smooth_planner": "window_planner", "window.planner": "PathState WindowPlanner"}
    )
