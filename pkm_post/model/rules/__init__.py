# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rules: the table of all input faults by code, with the severity, cause and cure of each.

A code is a letter for the topic, a digit for its part, and two digits. Rows are in the order of the families in
docs/diagnostics.md and, within a family, of the numbers. A published code never changes its meaning. The table is
imported on the first fault.
"""

from typing import TYPE_CHECKING

from pkm_post import at_first_use
from pkm_post.model.rules.rule import Severity

if TYPE_CHECKING:
    from pkm_post.model.rules.table import RULES
else:
    __getattr__ = at_first_use(__name__, {"table": "RULES"})
