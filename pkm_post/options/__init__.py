# SPDX-License-Identifier: LGPL-2.1-or-later
"""Options: user options, with the same names on the command line and in the arguments of a CAM job.

The argument table imports nothing else: FreeCAD reads it for a tooltip.
"""

from typing import TYPE_CHECKING, Any

from pkm_post.options.argument_fields import ArgumentField, argument_fields, text_of_fields
from pkm_post.options.argument_table import FIXTURE_OF_THE_JOB
from pkm_post.options.argument_types import (
    FARTHEST_OFFSET,
    LONGEST_JOG,
    LONGEST_TOOL,
    OVERRIDE_PERCENT,
    above_zero,
    between,
    count,
    number,
    numbered,
    offset,
    positive,
    tool_length,
    validated,
    whole,
    whole_from,
)
from pkm_post.options.arguments import (
    APPROACH_MM_S,
    MANUAL_MOVE_PROGRAM,
    PARITIES,
    PLAYER_PROGRAM,
    READING_STEP,
    START_TOLERANCE_MM,
    TextParser,
    UsageParser,
    add_machine,
    add_options,
    add_part_program,
    parse_text,
    text_parser,
)
from pkm_post.options.conversion import (
    argument_values,
    gauge_length_faults,
    options_from,
    part_program_from,
    solid_files,
    tool_lengths_from,
)
from pkm_post.options.converters import (
    MOST_FEED,
    RULES_WITH_HEADING,
    SIDE_OUTPUTS,
    SPIN_WORDS,
    cycle_kinds,
    goto_values,
    origin,
    shift,
)
from pkm_post.options.layers import (
    NO_VALUES,
    ArgumentValues,
    InputKind,
    Override,
    add_recorded,
    applicable_values,
    explicit_values,
    flag_of,
    format_value,
    inapplicable_options,
    input_kind,
    overridden,
    overrides,
)
from pkm_post.options.result_names import PostItem, job_stem, missing_results, overwritten_sources, result_conflicts

if TYPE_CHECKING:
    from pkm_post.options.choices import CARTESIAN, LINUXCNC, NO_MESH, PICTURE, MeshFiles, Options

_WITH_NUMPY = ("CARTESIAN", "LINUXCNC", "NO_MESH", "PICTURE", "MeshFiles", "Options")

if not TYPE_CHECKING:

    def __getattr__(name: str) -> Any:
        """Import names that need NumPy on first use; the arguments do not need it."""
        if name in _WITH_NUMPY:
            from pkm_post.options import choices

            return getattr(choices, name)
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
