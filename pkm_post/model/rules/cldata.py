# SPDX-License-Identifier: LGPL-2.1-or-later
"""CL data: the rules of cutter location files (L)."""

from __future__ import annotations

from pkm_post.model.rules.rule import TAPPING, Rule, error, warning

CLDATA_RULES: dict[str, Rule] = {
    # L1: the letters of CL data
    "L101": error("a character is not allowed here", "remove it, or put the text into a comment after $$"),
    "L102": error("a number is malformed", "write it as -12.5 or 1.0E-05"),
    "L103": error("a number is too large", "correct the number"),
    "L104": error("a statement is too long", "split it"),
    "L105": error("a text in quotes is not closed", "close it on the same line"),
    "L106": error("a $ is inside a line", "put $ at the end of a line that is continued, $$ before a comment"),
    "L199": error("there are more faults than are shown", "correct those that are shown, then check again"),
    # L2: the grammar of CL data
    "L201": error("a statement does not begin with a word", "begin it with its major word, such as GOTO"),
    "L202": error("unexpected text in the statement", "write WORD/item,item,... on a line of its own"),
    "L203": error("a parenthesis is not closed", "close it with )"),
    "L204": error("a closing parenthesis has no opening one", "remove it, or add the opening one"),
    "L205": error("parentheses are nested too deeply", "write the statement without them"),
    # L4: what CL data means
    "L401": error("the statement is not supported", "let the CAM system write the motion in plain points and arcs"),
    "L402": error("the items of the statement are not valid", "give it the items described in docs/cl-data.md"),
    "L403": error(
        "a value is not possible",
        "write one that the statement takes: no feed or length below 0; feeds per turn need a speed before them",
    ),
    "L404": warning("the word is unknown and was ignored", "check that the job does not need it"),
    "L405": error("the tool axis has no direction", "give I, J and K, not all zero"),
    "L406": warning("the tool axis was not of unit length and was normalised", "write unit vectors with 6 decimals"),
    "L407": error("a cutting move has no feed", "write FEDRAT before it, or give --feed"),
    "L408": error("the arc does not fit its end points", "regenerate the path; the radii must agree to 0.05 mm"),
    "L409": warning("the arc fits its end points badly", "write more decimals; the radii should agree to 0.0005 mm"),
    "L410": warning("the unit of length is uncertain", "check the size of the part, and give --unit mm or --unit inch"),
    "L411": warning("the gauge length of the tool is unknown; 0 is used", "give the tool with its length"),
    "L412": error("the cycle cannot be executed", "correct its items, or let the CAM system write single moves"),
    "L413": error("the file contains no motion", "check the file"),
    "L414": error("an arc has no end point", "write GOTO after it"),
    "L415": warning("statements after FINI were ignored", "remove them, or remove FINI"),
    "L416": error("an inverse time feed needs a move of non-zero length", "give such moves a feed in mm/min"),
    "L417": error("the position of the tool is not yet known", "write FROM or GOTO first"),
    "L418": warning(
        "e and f do not put the corner of the cutter against its bottom and side, and were ignored",
        "write the e and f of a corner that touches both, or leave them out",
    ),
    "L419": error(
        "the words of this cycle differ between CAM systems",
        "name the CAM system with --cl-dialect, or let the CAM system write single moves",
    ),
    "L420": error(
        "the numbers of the cycle have no words, and their meaning is unknown",
        "give the meaning with --cycle-values, such as depth,feed,clearance",
    ),
    "L421": error(
        "the tool axis turns by more than 60 degrees on the way to a hole", "let the CAM system write the moves between"
    ),
    "L422": error(
        "a motion begins or ends at a hole of a cycle, where the tool is not", "write CYCLE/OFF and a GOTO before it"
    ),
    "L429": error(
        "CUTCOM has two readings: its points may be the contour of the part or the centre of the tool",
        "give --contour-data contour or --contour-data centre, or set ContourData of the program object",
    ),
    "L430": warning(
        "the points under CUTCOM were taken for the centre of the tool, by their arcs",
        "check the size of the part, and give --contour-data centre or contour",
    ),
    "L431": error("the unit of length is unknown", "give --unit mm or --unit inch, or set Unit of the program object"),
    "L432": error("the wear of a tool has no effect", "give --wear for a tool that the CL data compensates by CUTCOM"),
    "L433": error(
        "nothing in the file shows whether arcs are right-handed or left-handed about their axis",
        "name the CAM system with --cl-dialect; with creo they are right-handed, with nx left-handed",
    ),
    "L440": TAPPING,
    "L441": error(
        "the file has no end: it may be truncated",
        "get the complete file; if it is complete, add FINI at its end, give --allow-open-end, or set OpenEnd of the"
        " program"
        " object",
    ),
    "L442": error("an option does not apply to this input", "leave it out"),
    "L443": warning(
        "the file gives a tool several gauge lengths; none of them is used", "give its length with --tool-length"
    ),
    "L444": error(
        "the home position of the machine is unknown",
        "give it with --machine-zero X,Y,Z, or set MachineZero of the program object",
    ),
    "L445": error(
        "the strokes of this kind of cycle are not known",
        "give them with --cycle-kinds, such as BORE=ream, or let the CAM system write single moves",
    ),
    "L448": warning(
        "a dwell lasts longer than a minute",
        "check it; times of CL data are in s, and with REV in turns of the spindle",
    ),
    "L449": error("a cut comes before the first tool change", "write LOADTL before it"),
    "L450": warning(
        "LENGTH beside IN may be the length outside the holder, and is not used",
        "give the gauge length with --tool-length",
    ),
    "L447": error(
        "the tool table is not valid",
        "write it as docs/g-code.md describes it: LinuxCNC's .tbl or .csv with the unit, as in --tool-table"
        " tools.tbl,mm, or FreeCAD's .fctl or .json",
    ),
    "L446": error("the curve cannot be followed", "let the CAM system write the motion in plain points and arcs"),
}
