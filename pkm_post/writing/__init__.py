# SPDX-License-Identifier: LGPL-2.1-or-later
"""Writing: trajectory files, controller programs, G-code, and the files beside them."""

from typing import TYPE_CHECKING

from pkm_post import at_first_use
from pkm_post.writing import manifest, outputs, trajectory_file
from pkm_post.writing.controllers import program_files
from pkm_post.writing.controllers.program_files import read_text, read_texts
from pkm_post.writing.controllers.pvt.parts import split_motion
from pkm_post.writing.controllers.registry import TABLES, ControllerModule, controller_of, controller_settings

if TYPE_CHECKING:
    from pkm_post.writing import kinematics
    from pkm_post.writing.controllers import pmac, power_pmac
    from pkm_post.writing.controllers.pmac import read_part
    from pkm_post.writing.controllers.pmac.program import rotary_opening
    from pkm_post.writing.controllers.pmac.settings import PmacSettings
    from pkm_post.writing.controllers.power_pmac import PowerPmacSettings
    from pkm_post.writing.conversion import TARGETS, convert
    from pkm_post.writing.gcode.tool_axes import GcodeDialect
    from pkm_post.writing.gcode.writer import write
else:
    __getattr__ = at_first_use(
        __name__,
        {
            "": "kinematics",
            "controllers": "pmac power_pmac",
            "controllers.pmac": "read_part",
            "conversion": "TARGETS convert",
            "controllers.pmac.program": "rotary_opening",
            "controllers.pmac.settings": "PmacSettings",
            "controllers.power_pmac": "PowerPmacSettings",
            "gcode.tool_axes": "GcodeDialect",
            "gcode.writer": "write",
        },
    )
