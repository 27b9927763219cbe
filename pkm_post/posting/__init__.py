# SPDX-License-Identifier: LGPL-2.1-or-later
"""Posting: the only route from a program to the files for the controller and the user.

The order of the steps is in ``steps``. Either all files are written and certified, or none.
"""

from typing import TYPE_CHECKING

from pkm_post import at_first_use
from pkm_post.posting.machine_reading import with_machine
from pkm_post.posting.placement import check_path_of, effective_setup, trajectory_of, work_offset
from pkm_post.posting.post_file import Prepared, post_file, prepared_file
from pkm_post.posting.run import Log, Posted, Progress, no_log, no_progress
from pkm_post.posting.steps import SUFFIX, post, step_names, write_program
from pkm_post.posting.verify import verify, verify_texts

if TYPE_CHECKING:
    from pkm_post.posting.cartesian_form import cartesian_program
    from pkm_post.posting.cartesian_guard import Allowance
    from pkm_post.posting.machine_check import format_table, machine_faults, machine_summary
    from pkm_post.posting.machine_export import export_machine
    from pkm_post.posting.place_search import (
        PLACE_STEP,
        FoundPlace,
        find_place,
        may_be_mended,
        place_found,
        place_offer,
        place_options,
        work_offset_text,
    )
    from pkm_post.posting.reach_study import Study, study
    from pkm_post.posting.stiffness import SoftestPlace, StiffnessStudy, stiffness_study
else:
    __getattr__ = at_first_use(
        __name__,
        {
            "cartesian_form": "cartesian_program",
            "cartesian_guard": "Allowance",
            "machine_check": "format_table machine_faults machine_summary",
            "machine_export": "export_machine",
            "place_search": (
                "PLACE_STEP FoundPlace find_place may_be_mended place_found place_offer place_options work_offset_text"
            ),
            "reach_study": "Study study",
            "stiffness": "SoftestPlace StiffnessStudy stiffness_study",
        },
    )
