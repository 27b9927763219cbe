# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reading: G-code, CL data, CAM documents and meshes, from their files to a program."""

from pkm_post.reading import check, gcode
from pkm_post.reading.cldata.options import CONTOUR_DATA, DIALECTS, UNITS
from pkm_post.reading.gcode.codes import SPINDLE_SYNCHRONISED
from pkm_post.reading.gcode.cycles import CycleSeries, Strokes, cycle_fault, cycle_strokes
from pkm_post.reading.gcode.events import LONG_DWELL
from pkm_post.reading.gcode.feeds import exact_codes
from pkm_post.reading.gcode.options import AXIS_WORDS, DWELL_UNITS
from pkm_post.reading.gcode.tool_axes import axis_of
from pkm_post.reading.mesh_file import mesh_of_triangles, read_mesh
from pkm_post.reading.program_text.checked import CheckedText, check_text
from pkm_post.reading.program_text.colours import Colour, spans
from pkm_post.reading.program_text.content import Content
from pkm_post.reading.program_text.extents import extent
from pkm_post.reading.program_text.languages import Language, language_of
from pkm_post.reading.program_text.renumber import renumbered
from pkm_post.reading.program_text.ways import ways_of_line
from pkm_post.reading.sources import AS_WRITTEN, SUFFIXES, Reading, is_part_program, read_part_program

__all__ = [
    "AS_WRITTEN",
    "AXIS_WORDS",
    "CONTOUR_DATA",
    "DIALECTS",
    "DWELL_UNITS",
    "SPINDLE_SYNCHRONISED",
    "LONG_DWELL",
    "SUFFIXES",
    "UNITS",
    "CheckedText",
    "Colour",
    "Content",
    "Language",
    "Reading",
    "CycleSeries",
    "Strokes",
    "axis_of",
    "check",
    "check_text",
    "exact_codes",
    "extent",
    "cycle_fault",
    "gcode",
    "is_part_program",
    "language_of",
    "mesh_of_triangles",
    "read_mesh",
    "read_part_program",
    "renumbered",
    "spans",
    "cycle_strokes",
    "ways_of_line",
]
