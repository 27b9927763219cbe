# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reading: G-code, CL data, CAM documents and meshes, from their files to a program."""

from typing import TYPE_CHECKING

from pkm_post import at_first_use
from pkm_post.reading import gcode
from pkm_post.reading.gcode.codes import SPINDLE_SYNCHRONISED
from pkm_post.reading.gcode.flavours import FLAVOURS
from pkm_post.reading.gcode.options import AXIS_WORDS, DWELL_UNITS
from pkm_post.reading.gcode.tool_axes import axis_of
from pkm_post.reading.language import SUFFIXES, VERSIONED, Language, is_part_program, language_of, program_stem
from pkm_post.reading.part_program import AS_WRITTEN, FLAVOUR_NAMES, ReadingOptions, read_part_program, with_tool_table
from pkm_post.reading.threads import without_idle_starts
from pkm_post.reading.units import LONG_DWELL, UNITS

if TYPE_CHECKING:
    from pkm_post.reading.check import check_file, checks_as_json, checks_as_text, listing_lines
    from pkm_post.reading.cldata.options import CONTOUR_DATA, DIALECTS
    from pkm_post.reading.editing import (
        CheckedText,
        TextFile,
        check_text,
        jump_by_number,
        renumbered,
        tip_paths_of_line,
    )
    from pkm_post.reading.freecad_tools import Bit, core_of, plain_shape, shank_of, sizes_of
    from pkm_post.reading.gcode.subprograms import files_in_notes
    from pkm_post.reading.highlighting import Colour, coloured_spans, shown_language, underlined
    from pkm_post.reading.mesh_file import MESH_READERS, STEP_SUFFIXES, mesh_of_triangles, read_mesh
else:
    __getattr__ = at_first_use(
        __name__,
        {
            "check": "check_file checks_as_json checks_as_text listing_lines",
            "cldata.options": "CONTOUR_DATA DIALECTS",
            "editing": "CheckedText TextFile check_text jump_by_number renumbered tip_paths_of_line",
            "freecad_tools": "Bit core_of plain_shape shank_of sizes_of",
            "gcode.subprograms": "files_in_notes",
            "highlighting": "Colour coloured_spans shown_language underlined",
            "mesh_file": "MESH_READERS STEP_SUFFIXES mesh_of_triangles read_mesh",
        },
    )
