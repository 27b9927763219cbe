# SPDX-License-Identifier: LGPL-2.1-or-later
"""Controllers: convert strut motion to controller programs, and programs back to strut motion.

A folder for each controller, a table of controllers by ``controller.kind``, and tables of the motion for other readers.
"""

from typing import TYPE_CHECKING

from pkm_post import at_first_use
from pkm_post.writing.controllers.program_files import read_text, read_texts, text_of
from pkm_post.writing.controllers.registry import (
    CONTROLLERS,
    TABLES,
    Table,
    controller_of,
    part_names,
    part_siblings,
)

if TYPE_CHECKING:
    from pkm_post.writing.controllers import pmac, power_pmac
else:
    __getattr__ = at_first_use(__name__, {"": "pmac power_pmac"})
