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
    from pkm_post.writing.controllers.pmac.program import program_text, rotary_opening
    from pkm_post.writing.controllers.pmac.settings import PmacSettings, setup_text
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
            "controllers.pmac.program": "program_text rotary_opening",
            "controllers.pmac.settings": "PmacSettings setup_text",
            "controllers.power_pmac": "PowerPmacSettings",
            "gcode.tool_axes": "GcodeDialect",
            "gcode.writer": "write",
        },
    )

__all__ = [
    "TABLES",
    "TARGETS",
    "ControllerModule",
    "GcodeDialect",
    "PmacSettings",
    "PowerPmacSettings",
    "controller_of",
    "controller_settings",
    "convert",
    "kinematics",
    "manifest",
    "outputs",
    "split_motion",
    "pmac",
    "power_pmac",
    "program_files",
    "program_text",
    "read_part",
    "read_text",
    "read_texts",
    "rotary_opening",
    "setup_text",
    "trajectory_file",
    "write",
]
