# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pipeline: the single route from a program to files for the controller and the user.

Only ``steps`` defines the order of the steps. Either all files are written and certified, or none.
"""

from pkm_post.pipeline.frame import Posted
from pkm_post.pipeline.known_setup import known_setup
from pkm_post.pipeline.options import LINUXCNC, MeshFiles, Options
from pkm_post.pipeline.placed import trajectory_of, work_offset
from pkm_post.pipeline.prepared import Prepared
from pkm_post.pipeline.run import Log, Progress, quiet, unwatched
from pkm_post.pipeline.steps import SUFFIX, post, step_names

__all__ = [
    "LINUXCNC",
    "SUFFIX",
    "Log",
    "MeshFiles",
    "Options",
    "Posted",
    "Prepared",
    "Progress",
    "known_setup",
    "post",
    "quiet",
    "step_names",
    "trajectory_of",
    "unwatched",
    "work_offset",
]
