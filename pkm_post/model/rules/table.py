# SPDX-License-Identifier: LGPL-2.1-or-later
"""Table: the rules of all families as one."""

from pkm_post.model.rules.cam_job import CAM_JOB_RULES
from pkm_post.model.rules.cldata import CLDATA_RULES
from pkm_post.model.rules.gcode import GCODE_RULES
from pkm_post.model.rules.machining import MACHINING_RULES
from pkm_post.model.rules.results import RESULT_RULES
from pkm_post.model.rules.rule import Rule

RULES: dict[str, Rule] = CAM_JOB_RULES | GCODE_RULES | CLDATA_RULES | MACHINING_RULES | RESULT_RULES
