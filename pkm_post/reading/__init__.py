# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reading: G-code, CL data, CAM documents and meshes, from their files to a program."""

from pkm_post.reading import check, gcode
from pkm_post.reading.cldata.options import CONTOUR_DATA, DIALECTS, UNITS
from pkm_post.reading.gcode.axes import axis_of
from pkm_post.reading.gcode.chords import CHORD_ERROR, with_chords
from pkm_post.reading.gcode.codes import IN_STEP_WITH_SPINDLE
from pkm_post.reading.gcode.cycles import Series, Strokes, fault_of, strokes
from pkm_post.reading.gcode.dwells import LONG
from pkm_post.reading.gcode.options import AXIS_WORDS, DWELL_UNITS
from pkm_post.reading.gcode.path_modes import exact_codes
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
    "CHORD_ERROR",
    "CONTOUR_DATA",
    "DIALECTS",
    "DWELL_UNITS",
    "IN_STEP_WITH_SPINDLE",
    "LONG",
    "SUFFIXES",
    "UNITS",
    "CheckedText",
    "Colour",
    "Content",
    "Language",
    "Reading",
    "Series",
    "Strokes",
    "axis_of",
    "check",
    "check_text",
    "exact_codes",
    "extent",
    "fault_of",
    "gcode",
    "is_part_program",
    "language_of",
    "mesh_of_triangles",
    "read_mesh",
    "read_part_program",
    "renumbered",
    "spans",
    "strokes",
    "ways_of_line",
    "with_chords",
]
