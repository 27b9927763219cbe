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
        "help": "machine that comes with PKM Post, or path of a machine file (default: %(default)s)",
    },
    "--work-offset": {
        "metavar": "NAME_OR_POSE",
        "type": work_offset,
        "default": FIXTURE_OF_THE_JOB,
        "help": "work offset of the machine file, or X,Y,Z[,DEG] in mm with a turn about z, as in "
        "--work-offset=-10,0,150,90 (default: the fixture of the CAM job, for a part program G54)",
    },
    "--tip-tolerance": {
        "metavar": "MM",
        "type": between(1e-6, 100),
        "default": 0.001,
        "help": "how far the tool tip may be from the programmed path (default: %(default)s)",
    },
    "--axis-tolerance": {
        "metavar": "DEG",
        "type": between(1e-6, 45),
        "default": 0.001,
        "help": "how far the tool axis may be from the programmed axis (default: %(default)s)",
    },
    "--tool-length": {
        "metavar": "NUMBER=MM",
        "type": numbered(tool_length, "NUMBER=MM"),
        "action": "append",
        "default": [],
        "help": "gauge length of a tool, instead of the GaugeLength of its tool controller; may be repeated",
    },
    "--corners": {
        "choices": ("chord", "arc"),
        "default": "chord",
        "help": "what goes round outer corners in 2D cutter compensation (default: %(default)s)",
    },
    "--leads": {
        "choices": ("A", "B"),
        "default": "A",
        "help": "how 2D cutter compensation begins and ends: A straight to the contour, B round outer corners"
        " (default: %(default)s)",
    },
    "--swallowed": {
        "choices": ("refuse", "remove"),
        "default": "refuse",
        "help": "what becomes of blocks that the tool is too large for (default: %(default)s)",
    },
    "--tool": {
        "dest": "tools",
        "metavar": "NUMBER=D[,R]",
        "type": numbered(sizes, "NUMBER=D[,R]"),
        "action": "append",
        "default": [],
        "help": "diameter and corner radius in mm of the cutter a part program was made for, instead of those that it"
        " states: G41 and G42 need the diameter, --actual-tool both; may be repeated",
    },
    "--tool-table": {
        "metavar": "FILE[,UNIT]",
        "help": "tools of a part program that are not given one by one: a tool table of LinuxCNC (.tbl) or a .csv, with"
        " mm or inch behind a comma, or a tool library of FreeCAD (.fctl, .json)",
    },
    "--actual-tool": {
        "metavar": "NUMBER=D[,R]",
        "type": numbered(sizes, "NUMBER=D[,R]"),
        "action": "append",
        "default": [],
        "help": "diameter and corner radius in mm of the cutter in the spindle, where it is not the one that a program"
        " with surface normals was made for; may be repeated",
    },
    "--unit": {
        "choices": ("mm", "inch"),
        "help": "unit of length of a part program: of CL data whatever it says itself, of G-code before G20 or G21",
    },
    "--feed": {
        "metavar": "MM/MIN",
        "type": above_zero(MOST_FEED),
        "help": "feed of the cutting moves of a part program before the first feed that it states (default: they are"
        " refused)",
    },
    "--flavour": {
        "choices": GCODE_FLAVOURS,
        "help": "whose G-code a part program is: rs274, that of LinuxCNC, fanuc, that of controls of Fanuc's kind, or"
        " siemens, the language of Sinumerik controls (default: the one whose codes it has; the report says which and"
        " why)",
    },
    "--machine-zero": {
        "metavar": "X,Y,Z",
        "type": point,
        "help": "where G-code brings the tool tip with G53 X0 Y0 Z0, and with G28 and G30, and CL data with GOHOME: mm"
        " in the work frame",
    },
    "--origin": {
        "metavar": "NAME=POSE",
        "type": origin,
        "action": "append",
        "default": [],
        "help": "origin of a work offset of G-code, G54 to G59.3, G54.1P1 to G54.1P300 or G500 to G599, or of a further"
        " fixture of a CAM job, as X,Y,Z[,DEG] in mm in the work frame with a turn about z, as in G55=100,0,0; may be"
        " repeated",
    },
    "--subprograms": {
        "metavar": "FOLDER",
        "type": listed,
        "action": "append",
        "default": [],
        "help": "where the files of subprograms that G-code calls are looked for before the folder of the program; may"
        " be repeated",
    },
    "--block-delete": {
        "action": "store_true",
        "help": "leave out what stands behind / in blocks of G-code; --no-block-delete takes it back",
    },
    "--delete-switches": {
        "metavar": "NUMBERS",
        "type": switches,
        "default": (),
        "help": "leave out only what stands behind / with these numbers, as in 2,3 for /2 and /3; / alone is 1, in"
        " Siemens's language 0",
    },
    "--leave-out": {
        "metavar": "CODES",
        "type": codes,
        "default": (),
        "help": "G and M codes of G-code that do not move the tool and are not known here, such as M21,G187: left out"
        " with their words, and named in the report",
    },
    "--optional-stops": {
        "choices": OPTIONAL_STOPS,
        "help": "what becomes of M1 and OPSTOP: written as the code that the machine file has for them, so that the"
        " switch of the controller decides, written as program stops, or left out (default: as the machine file says,"
        " written if it says nothing)",
    },
    "--contour-data": {
        "choices": ("centre", "contour"),
        "help": "what the points of CL data under CUTCOM are: the centre of the tool, which wear alone offsets, or the"
        " contour of the part (default: as the file says)",
    },
    "--wear": {
        "metavar": "NUMBER=MM",
        "type": numbered(between(-100, 100), "NUMBER=MM"),
        "action": "append",
        "default": [],
        "help": "by how much a tool is larger in radius than the one CL data with CUTCOM was made for, below 0 for a"
        " worn one; may be repeated",
    },
    "--cl-dialect": {
        "choices": CL_DIALECTS,
        "help": "the CAM system that wrote CL data (default: the one whose words it has)",
    },
    "--cycle-values": {
        "metavar": "NAMES",
        "type": cycle_values,
        "default": (),
        "help": "what the numbers of CYCLE statements of CL data are where they have no words, in order and joined by"
        f" commas: {', '.join(CYCLE_VALUES)}",
    },
    "--cycle-kinds": {
        "metavar": "KIND=STROKES,...",
        "type": cycle_kinds,
        "default": (),
        "help": "what kinds of CYCLE statements of CL data do, such as BORE=ream,DEEPHL=deep, with strokes out of"
        f" {', '.join(CYCLE_STROKES)}: in one stroke, out of the hole after each peck, a short way back after each"
        " peck, or out of the hole at the feed (default: as the CAM system means them)",
    },
    "--goto-values": {
        "metavar": "NAMES",
        "type": goto_values,
        "default": (),
        "help": "what the values of those GOTO statements of CL data are that have as many: x,y,z the tool tip, i,j,k"
        " the tool axis, nx,ny,nz the surface normal, px,py,pz the contact point, in the order of the file; without"
        " x,y,z the tip follows from contact point, normal and cutter",
    },
    "--allow-open-end": {
        "action": "store_true",
        "help": "take a part program without an end (M2, M30 or %% of G-code, FINI or END-OF-PATH of CL data), although"
        " it may have been cut short; --no-allow-open-end takes it back",
    },
    "--copies": {
        "metavar": "LIST",
        "type": copies,
        "default": (),
        "help": "copies that follow the program, joined by commas: xy, xz or yz is the mirror image in that plane of"
        " the work frame, a number the rotation about z in degrees, as in xz,yz,180; none is the default",
    },
    "--keep-climb": {
        "action": "store_true",
        "help": "reverse each pass of the mirror images of --copies, to keep climb milling; --no-keep-climb takes it"
        " back",
    },
    "--surface-speed": {
        "metavar": "M/MIN",
        "type": surface_speed_or_none,
        "default": None,
        "help": "speed of the cutting edge over the work: each cut gets its own spindle speed; none leaves the spindle"
        " as programmed, the default",
    },
    "--keep-chip-load": {
        "action": "store_true",
        "help": "change feeds as the spindle speed changes with --surface-speed; --no-keep-chip-load takes it back",
    },
    "--from-line": {
        "metavar": "[OPERATION:]N",
        "type": start_line,
        "default": None,
        "help": "begin at this line of the source, or number of the command in an operation: the way there comes down"
        " along the tool axis, with spindle, coolant and tool of that line; none begins at the beginning, the default",
    },
    "--repeat-codes": {
        "action": "store_true",
        "help": "repeat the M codes of the machine before the line of --from-line, each once, before the last move to"
        " it; --no-repeat-codes takes it back",
    },
    "--side": {
        "metavar": "N",
        "type": side,
        "default": None,
        "help": "the side of a part that is turned over in one part program, counted from 1: a side ends where the tool"
        " axis turns by half a turn; none posts the whole program, the default",
    },
    "--part": {
        "metavar": "FILE",
        "help": "STL or STEP file of the finished part, mm in the work frame: holder, spindle, struts, shanks and rapid"
        " moves are checked against it, or none (default: the models of the CAM job)",
    },
    "--stock": {
        "metavar": "FILE",
        "help": "STL or STEP file of the stock as it is before the first operation, likewise, or none (default: the"
        " stock of the CAM job)",
    },
    "--fixture": {
        "metavar": "FILE",
        "type": listed,
        "default": [],
        "help": "STL or STEP file of a clamp or vice, mm in the work frame, which nothing may touch; may be repeated",
    },
    "--spin": {
        "metavar": "RULE",
        "type": spin,
        "default": "zero",
        "help": f"how the platform turns about the tool axis: {spin_words()}; DEG is where its x axis points when the"
        f" tool is upright, OBJECTIVE one of {', '.join(OBJECTIVES)} (default: zero, the shortest rotation from"
        " upright)",
    },
    "--also": {
        "metavar": "NAMES",
        "type": also,
        "default": (),
        "help": f"what to write beside the program, joined by commas: {', '.join(SIDE_OUTPUTS)}; or {NOTHING},"
        " the default",
    },
    "--report-unit": {
        "choices": ("mm", "inch"),
        "default": "mm",
        "help": "unit of lengths and speeds on the page of the report; all other files stay in mm (default: mm, for a"
        " CAM job that of the unit system of its document)",
    },
    "--report-date": {
        "metavar": "TEXT",
        "default": "",
        "help": "a date, or another text, that stands on the page of the report (default: none, so that the same job"
        " gives the same bytes at any time)",
    },
}
