# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rules: the table of all input faults by code, with the severity, cause and cure of each.

A code is a letter for the topic, a digit for its part, and two digits. Rows follow the order of the families in
docs/diagnostics.md, and the number within each. A published code never changes its meaning.
"""

from pkm_post.model.rules.cam_job import CAM_JOB_RULES
from pkm_post.model.rules.cldata import CLDATA_RULES
from pkm_post.model.rules.gcode import GCODE_RULES
from pkm_post.model.rules.machining import MACHINING_RULES
from pkm_post.model.rules.results import RESULT_RULES
from pkm_post.model.rules.rule import Rule, Severity

__all__ = ["RULES", "Rule", "Severity"]

RULES: dict[str, Rule] = CAM_JOB_RULES | GCODE_RULES | CLDATA_RULES | MACHINING_RULES | RESULT_RULES
