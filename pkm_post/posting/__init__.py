# SPDX-License-Identifier: LGPL-2.1-or-later
"""Posting: the single route from a program to files for the controller and the user.

Only ``steps`` defines the order of the steps. Either all files are written and certified, or none.
"""

from pkm_post.posting.frame import Posted
from pkm_post.posting.known_setup import known_setup
from pkm_post.posting.machine_check import as_text, machine_faults, summary
from pkm_post.posting.placed import trajectory_of, work_offset
from pkm_post.posting.post_file import post_file, prepared_file
from pkm_post.posting.prepared import Prepared
from pkm_post.posting.reach_study import Study, study, told_offset
from pkm_post.posting.run import Log, Progress, quiet, unwatched
from pkm_post.posting.steps import SUFFIX, post, step_names
from pkm_post.posting.verify import verify, verify_texts

__all__ = [
    "SUFFIX",
    "Log",
    "Posted",
    "Prepared",
    "Progress",
    "Study",
    "as_text",
    "known_setup",
    "machine_faults",
    "post",
    "post_file",
    "prepared_file",
    "quiet",
    "step_names",
    "study",
    "summary",
    "told_offset",
    "trajectory_of",
    "unwatched",
    "verify",
    "verify_texts",
    "work_offset",
]
