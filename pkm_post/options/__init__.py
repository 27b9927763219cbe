# SPDX-License-Identifier: LGPL-2.1-or-later
"""Options: user options, with the same names on the command line and in the arguments of a CAM job.

The argument table imports nothing else: FreeCAD reads it for a tooltip.
"""

from typing import TYPE_CHECKING, Any

from pkm_post.options.argument_types import (
    LONGEST_TOOL,
    above_zero,
    accepting,
    between,
    count,
    number,
    offset,
    positive,
    tool_length,
    whole,
    whole_from,
)
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
    tool_lengths_from,
)
from pkm_post.options.fits import Source, fitting, misfits, source_of
from pkm_post.options.layers import NOTHING_GIVEN, Given, Override, flag_of, given_in, layered, overrides, shown
from pkm_post.options.pmac_defaults import APPROACH_MM_S, NEAR_MM, OWN_PROGRAM, PARITIES
from pkm_post.options.result_names import Item, job_stem, lost_results, lost_sources, missing_results
from pkm_post.options.said import said_by
from pkm_post.options.typed import TextParser, text_parser, typed

if TYPE_CHECKING:
    from pkm_post.options.choices import LINUXCNC, NO_MESH, MeshFiles, Options

__all__ = [
    "ALSO",
    "APPROACH_MM_S",
    "FIXTURE_OF_THE_JOB",
    "HEADED",
    "LINUXCNC",
    "LONGEST_TOOL",
    "NEAR_MM",
    "NOTHING_GIVEN",
    "NO_MESH",
    "OWN_PROGRAM",
    "PARITIES",
    "READING",
    "SPIN_WORDS",
    "Given",
    "Item",
    "MeshFiles",
    "Options",
    "Override",
    "Source",
    "TextParser",
    "above_zero",
    "accepting",
    "add_machine",
    "add_options",
    "add_part_program",
    "between",
    "count",
    "fitting",
    "flag_of",
    "given_in",
    "job_stem",
    "layered",
    "lost_results",
    "lost_sources",
    "misfits",
    "missing_results",
    "number",
    "offset",
    "options_from",
    "overrides",
    "part_program_from",
    "positive",
    "said_by",
    "shown",
    "solid_files",
    "source_of",
    "text_parser",
    "tool_length",
    "tool_lengths_from",
    "typed",
    "whole",
    "whole_from",
]

_WITH_NUMPY = ("LINUXCNC", "NO_MESH", "MeshFiles", "Options")


def __getattr__(name: str) -> Any:
    """Import what needs NumPy at its first use: the arguments do without."""
    if name in _WITH_NUMPY:
        from pkm_post.options import choices

        return getattr(choices, name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
