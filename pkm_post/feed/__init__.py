# SPDX-License-Identifier: LGPL-2.1-or-later
"""Feed: corner blending, look-ahead and timing. Works on arrays only: no machine, no kinematics."""

from pkm_post.feed.glimpse import Glimpse, glimpse, glimpse_within
from pkm_post.feed.jerk import Ceilings, for_jerk
from pkm_post.feed.knots import even_marks, knots
from pkm_post.feed.limits import PLANNED_SHARE, Bounded, limits, rough_limits
from pkm_post.feed.pace import SLOWER, factors_of_crowds, slower_feed
from pkm_post.feed.path_bounds import PathBounds
from pkm_post.feed.places import Intervals, Places
from pkm_post.feed.profile import cell_times, speed_profile
from pkm_post.feed.schedule import Schedule, by_time
from pkm_post.feed.segments import Segments
from pkm_post.feed.stations import Stations, stations
from pkm_post.feed.tool_path import ToolPath

__all__ = [
    "PLANNED_SHARE",
    "SLOWER",
    "Bounded",
    "Ceilings",
    "Glimpse",
    "Intervals",
    "PathBounds",
    "Places",
    "Schedule",
    "Segments",
    "Stations",
    "ToolPath",
    "by_time",
    "cell_times",
    "even_marks",
    "factors_of_crowds",
    "for_jerk",
    "glimpse",
    "glimpse_within",
    "knots",
    "limits",
    "rough_limits",
    "slower_feed",
    "speed_profile",
    "stations",
]
