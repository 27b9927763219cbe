# SPDX-License-Identifier: LGPL-2.1-or-later
"""Options: user options, with the same names on the command line and in the arguments of a CAM job.

The argument table imports nothing else: FreeCAD reads it for a tooltip.
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
    solid_files,
    tolerances_from,
    tool_lengths_from,
    tools_from,
)
from pkm_post.options.fits import Source, fitting, misfits, source_of
from pkm_post.options.layers import (
    NOTHING_GIVEN,
    Given,
    Override,
    flag_of,
    given_in,
    layered,
    overrides,
    shown,
)
from pkm_post.options.said import said_by
from pkm_post.options.typed import TextParser, text_parser, typed

__all__ = [
    "ALSO",
    "FIXTURE_OF_THE_JOB",
    "HEADED",
    "NOTHING_GIVEN",
    "READING",
    "SPIN_WORDS",
    "Given",
    "Override",
    "Source",
    "TextParser",
    "add_machine",
    "add_options",
    "add_part_program",
    "fitting",
    "flag_of",
    "given_in",
    "layered",
    "misfits",
    "options_from",
    "overrides",
    "part_program_from",
    "solid_files",
    "said_by",
    "shown",
    "source_of",
    "text_parser",
    "tolerances_from",
    "tool_lengths_from",
    "tools_from",
    "typed",
]
