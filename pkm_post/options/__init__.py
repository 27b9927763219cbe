# SPDX-License-Identifier: LGPL-2.1-or-later
"""Options: what a user may choose, the same words on the command line and in the arguments of a CAM job.

Nothing else is imported for the table of arguments: FreeCAD reads it for a tooltip.
"""

from pkm_post.options.arguments import (
    ALSO,
    FIXTURE_OF_THE_JOB,
    HEADED,
    READING,
    SPIN_WORDS,
    add_machine,
    add_options,
    add_part_program,
    options_from,
    part_program_from,
    tolerances_from,
    tool_lengths_from,
    tools_from,
)

__all__ = [
    "ALSO",
    "FIXTURE_OF_THE_JOB",
    "HEADED",
    "READING",
    "SPIN_WORDS",
    "add_machine",
    "add_options",
    "add_part_program",
    "options_from",
    "part_program_from",
    "tolerances_from",
    "tool_lengths_from",
    "tools_from",
]
