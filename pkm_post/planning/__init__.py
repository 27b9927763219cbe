# SPDX-License-Identifier: LGPL-2.1-or-later
"""Planning: corner blending, look-ahead, feed profile and knots, from a trajectory to strut motion."""

from typing import TYPE_CHECKING

from pkm_post import at_first_use
from pkm_post.planning.knots import LONGEST_MS
from pkm_post.planning.motion import FeedPlan, Plan, interpolate, plan, plan_feed, strut_motion
from pkm_post.planning.schedule import Schedule

if TYPE_CHECKING:
    from pkm_post.planning.window import Course, PathState, course
else:
    __getattr__ = at_first_use(__name__, {"window": "Course PathState course"})

__all__ = [
    "LONGEST_MS",
    "Course",
    "FeedPlan",
    "PathState",
    "Plan",
    "Schedule",
    "course",
    "interpolate",
    "plan",
    "plan_feed",
    "strut_motion",
]
