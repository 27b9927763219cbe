# SPDX-License-Identifier: LGPL-2.1-or-later
"""The table of user options: for each its type, its default and its help, as argparse takes them.

Values are in the units of the user: mm, degrees, m/min.
"""

from __future__ import annotations

from typing import Any

from pkm_post.options.argument_types import above_zero, between, numbered, tool_length
from pkm_post.options.converters import (
    CL_DIALECTS,
    CYCLE_STROKES,
    CYCLE_VALUES,
    GCODE_FLAVOURS,
    MOST_FEED,
    OBJECTIVES,
    OPTIONAL_STOPS,
    SIDE_OUTPUTS,
    also,
    codes,
    copies,
    cycle_kinds,
    cycle_values,
    goto_values,
    listed,
    origin,
    point,
    side,
    sizes,
    spin,
    spin_words,
    start_line,
    surface_speed_or_none,
    switches,
    work_offset,
)
from pkm_post.options.layers import NOTHING

FIXTURE_OF_THE_JOB = "job"
"""Name of the work offset that selects the fixture of the CAM job."""

ARGUMENTS: dict[str, dict[str, Any]] = {
    "--machine": {
        "metavar": "NAME_OR_FILE",
        "default": "example_6tps",
        "help": "machine shipped with PKM Post, or path of a machine file (default: %(default)s)",
    },
    "--work-offset": {
        "metavar": "NAME_OR_POSE",
        "type": work_offset,
        "default": FIXTURE_OF_THE_JOB,
        "help": "work offset of the machine file, or X,Y,Z[,DEG]: origin in mm and rotation about z, as in"
        " --work-offset=-10,0,150,90 (default: the fixture of the CAM job; G54 for a part program)",
    },
    "--tip-tolerance": {
        "metavar": "MM",
        "type": between(1e-6, 100),
        "default": 0.001,
        "help": "largest deviation of the tool tip from the programmed path (default: %(default)s)",
    },
    "--axis-tolerance": {
        "metavar": "DEG",
        "type": between(1e-6, 45),
        "default": 0.001,
        "help": "largest deviation of the tool axis from the programmed axis (default: %(default)s)",
    },
    "--tool-length": {
        "metavar": "NUMBER=MM",
        "type": numbered(tool_length, "NUMBER=MM"),
        "action": "append",
        "default": [],
        "help": "gauge length of a tool; overrides GaugeLength of its tool controller; may be repeated",
    },
    "--corners": {
        "choices": ("chord", "arc"),
        "default": "chord",
        "help": "path around outer corners in 2D cutter compensation (default: %(default)s)",
    },
    "--leads": {
        "choices": ("A", "B"),
        "default": "A",
        "help": "lead-in and lead-out of 2D cutter compensation: A straight to the contour, B around outer corners"
        " (default: %(default)s)",
    },
    "--swallowed": {
        "choices": ("refuse", "remove"),
        "default": "refuse",
        "help": "what to do with blocks that the tool is too large for (default: %(default)s)",
    },
    "--tool": {
        "dest": "tools",
        "metavar": "NUMBER=D[,R]",
        "type": numbered(sizes, "NUMBER=D[,R]"),
        "action": "append",
        "default": [],
        "help": "diameter and corner radius in mm of the cutter that a part program was made for; overrides those"
        " in the program. G41 and G42 need the diameter, --actual-tool both; may be repeated",
    },
    "--tool-table": {
        "metavar": "FILE[,UNIT]",
        "help": "tools of a part program that are not given one by one: a tool table of LinuxCNC (.tbl) or a .csv"
        " file, with ,mm or ,inch appended for its unit, or a tool library of FreeCAD (.fctl, .json)",
    },
    "--actual-tool": {
        "metavar": "NUMBER=D[,R]",
        "type": numbered(sizes, "NUMBER=D[,R]"),
        "action": "append",
        "default": [],
        "help": "diameter and corner radius in mm of the cutter in the spindle, if it differs from the one that a"
        " program with surface normals was made for; may be repeated",
    },
    "--unit": {
        "choices": ("mm", "inch"),
        "help": "length unit of a part program: overrides that of CL data; for G-code it applies before G20 or G21",
    },
    "--feed": {
        "metavar": "MM/MIN",
        "type": above_zero(MOST_FEED),
        "help": "feed of cutting moves before the first feed in a part program (default: such moves are refused)",
    },
    "--flavour": {
        "choices": GCODE_FLAVOURS,
        "help": "dialect of the G-code: rs274 (LinuxCNC), fanuc (Fanuc and similar controls) or siemens (Sinumerik)"
        " (default: detected from its codes; the report states the evidence)",
    },
    "--machine-zero": {
        "metavar": "X,Y,Z",
        "type": point,
        "help": "position of the tool tip, mm in the work frame, at G53 X0 Y0 Z0, G28 and G30 of G-code and GOHOME"
        " of CL data",
    },
    "--origin": {
        "metavar": "NAME=POSE",
        "type": origin,
        "action": "append",
        "default": [],
        "help": "origin of a further work offset of G-code (G54 to G59.3, G54.1P1 to G54.1P300, G500 to G599) or of"
        " a further fixture of a CAM job: X,Y,Z[,DEG] in the work frame, in mm, and rotation about z, as in"
        " G55=100,0,0; may be repeated",
    },
    "--subprograms": {
        "metavar": "FOLDER",
        "type": listed,
        "action": "append",
        "default": [],
        "help": "folder searched for subprogram files of G-code before that of the program; may be repeated",
    },
    "--block-delete": {
        "action": "store_true",
        "help": "skip what follows a / in blocks of G-code; --no-block-delete undoes this",
    },
    "--delete-switches": {
        "metavar": "NUMBERS",
        "type": switches,
        "default": (),
        "help": "skip only what follows a / with these numbers, as in 2,3 for /2 and /3; a plain / is 1, in Siemens"
        " code 0",
    },
    "--leave-out": {
        "metavar": "CODES",
        "type": codes,
        "default": (),
        "help": "G and M codes to skip with their words, such as M21,G187: only unknown ones that do not move the"
        " tool; the report lists them",
    },
    "--optional-stops": {
        "choices": OPTIONAL_STOPS,
        "help": "M1 and OPSTOP: written with the code in the machine file, so that the controller's switch decides,"
        " written as program stops, or left out (default: as stated in the machine file, otherwise written)",
    },
    "--contour-data": {
        "choices": ("centre", "contour"),
        "help": "meaning of the points of CL data under CUTCOM: tool centre, which only the wear offsets, or"
        " contour of the part (default: as stated in the file)",
    },
    "--wear": {
        "metavar": "NUMBER=MM",
        "type": numbered(between(-100, 100), "NUMBER=MM"),
        "action": "append",
        "default": [],
        "help": "by how much the radius of a tool exceeds the one that CL data with CUTCOM was made for, negative"
        " for a worn tool; may be repeated",
    },
    "--cl-dialect": {
        "choices": CL_DIALECTS,
        "help": "CAM system that wrote the CL data (default: detected from its words)",
    },
    "--cycle-values": {
        "metavar": "NAMES",
        "type": cycle_values,
        "default": (),
        "help": "meanings of the numbers without words in CYCLE statements of CL data, in order, separated by"
        f" commas: {', '.join(CYCLE_VALUES)}",
    },
    "--cycle-kinds": {
        "metavar": "KIND=STROKES,...",
        "type": cycle_kinds,
        "default": (),
        "help": "strokes of kinds of CYCLE statements of CL data, as in BORE=ream,DEEPHL=deep, out of "
        f"{', '.join(CYCLE_STROKES)}: one stroke, out of the hole after each peck, a short retract after each peck, or"
        " out of the hole at feed (default: as the CAM system defines them)",
    },
    "--goto-values": {
        "metavar": "NAMES",
        "type": goto_values,
        "default": (),
        "help": "meanings of the values of GOTO statements of CL data that have as many: x,y,z tool tip, i,j,k tool"
        " axis, nx,ny,nz surface normal, px,py,pz contact point, in the order of the file; without x,y,z the tip is"
        " computed from contact point, normal and cutter",
    },
    "--allow-open-end": {
        "action": "store_true",
        "help": "accept a part program without an end (M2, M30 or %% of G-code, FINI or END-OF-PATH of CL data),"
        " although it may be truncated; --no-allow-open-end undoes this",
    },
    "--copies": {
        "metavar": "LIST",
        "type": copies,
        "default": (),
        "help": "copies that follow the program, separated by commas: xy, xz or yz for the mirror image in that"
        " plane of the work frame, a number for a rotation about z in degrees, as in xz,yz,180; none, the default,"
        " for no copies",
    },
    "--keep-climb": {
        "action": "store_true",
        "help": "reverse the passes of mirror images, so that climb milling stays climb milling; --no-keep-climb"
        " undoes this",
    },
    "--surface-speed": {
        "metavar": "M/MIN",
        "type": surface_speed_or_none,
        "default": None,
        "help": "cutting speed: each cut gets its own spindle speed; none, the default, keeps the programmed"
        " spindle speeds",
    },
    "--keep-chip-load": {
        "action": "store_true",
        "help": "scale feeds with the spindle speeds of --surface-speed; --no-keep-chip-load undoes this",
    },
    "--from-line": {
        "metavar": "[OPERATION:]N",
        "type": start_line,
        "default": None,
        "help": "start at this line of the source, or at the command of this number in an operation: the approach"
        " comes down along the tool axis, with spindle, coolant and tool of that line; none, the default, starts at"
        " the beginning",
    },
    "--repeat-codes": {
        "action": "store_true",
        "help": "with --from-line, repeat the machine-specific M codes before that line, each once, before the last"
        " move of the approach; --no-repeat-codes undoes this",
    },
    "--side": {
        "metavar": "N",
        "type": side,
        "default": None,
        "help": "side to post, from 1, of a part program in which the part is turned over: a side ends where the"
        " tool axis turns by half a turn; none, the default, posts the whole program",
    },
    "--part": {
        "metavar": "FILE",
        "help": "STL or STEP file of the finished part, mm in the work frame, checked against holder, spindle,"
        " struts, shanks and rapid moves, or none (default: the models of the CAM job)",
    },
    "--stock": {
        "metavar": "FILE",
        "help": "STL or STEP file of the stock before the first operation, mm in the work frame, or none (default:"
        " the stock of the CAM job)",
    },
    "--fixture": {
        "metavar": "FILE",
        "type": listed,
        "default": [],
        "help": "STL or STEP file of a clamp or vice, mm in the work frame, that nothing may touch; may be repeated",
    },
    "--spin": {
        "metavar": "RULE",
        "type": spin,
        "default": "zero",
        "help": f"rotation of the platform about the tool axis: {spin_words()}; DEG is the direction of its x axis"
        f" with the tool upright, OBJECTIVE one of {', '.join(OBJECTIVES)} (default: zero, the shortest rotation"
        " from upright)",
    },
    "--also": {
        "metavar": "NAMES",
        "type": also,
        "default": (),
        "help": f"additional outputs, separated by commas: {', '.join(SIDE_OUTPUTS)}; {NOTHING}, the default, for no"
        " others",
    },
    "--report-unit": {
        "choices": ("mm", "inch"),
        "default": "mm",
        "help": "unit of lengths and speeds on the report page; all other files stay in mm (default: mm; for a CAM"
        " job that of its document's unit system)",
    },
    "--report-date": {
        "metavar": "TEXT",
        "default": "",
        "help": "date or other text on the report page (default: none, so that the same job always gives the same"
        " bytes)",
    },
}
