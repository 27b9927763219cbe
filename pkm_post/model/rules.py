# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rules: the table of all input faults by code: severity, cause and cure.

A code is a letter for the topic, a digit for its part, and two digits. Rows follow the order of the families in
docs/diagnostics.md, and the number within each. A published code never changes its meaning.
"""

from __future__ import annotations

import enum
from dataclasses import dataclass


class Severity(enum.Enum):
    """Severity of a fault: an error stops the job, a warning is shown and the job continues."""

    ERROR = "error"
    WARNING = "warning"


@dataclass(frozen=True)
class Rule:
    """One row of the table of faults: severity, cause and cure."""

    severity: Severity
    cause: str
    cure: str


def _error(cause: str, cure: str) -> Rule:
    return Rule(Severity.ERROR, cause, cure)


def _warning(cause: str, cure: str) -> Rule:
    return Rule(Severity.WARNING, cause, cure)


_TAPPING = _error(
    "tapping needs a feed in step with the spindle, which this machine's programs do not have",
    "leave the threads out and tap them elsewhere, or mill them as helices",
)
"""One rule, with a code for each kind of input."""
_INTACT_COPY = "take an intact copy of the document, such as the backup beside it (.FCBak)"

RULES: dict[str, Rule] = {
    # J1: the CAM job
    "J101": _error("the file cannot be opened as a FreeCAD document", "check the path, or save the document again"),
    "J102": _error("there is no CAM job to post", "add a Job in the CAM workbench, or name the job with --job"),
    "J103": _error("the job has no active operation with a path", "activate an operation and recompute"),
    "J104": _error("the command is unknown or has no meaning here", "remove it, or use a G0, G1, G2 or G3 move"),
    "J105": _error("a cutting move has no feed", "set the feed in the tool controller, in mm/min above zero"),
    "J106": _error("an arc in this plane is not supported", "use XY-plane arcs (G17), or straight moves"),
    "J107": _error("the arc does not fit its end points", "regenerate the operation; the radii must agree to 0.005 mm"),
    "J108": _error(
        "a dress-up or array that does not know tool-axis words stands above moves that have them",
        "remove it, or apply it to an operation without tool-axis words",
    ),
    "J109": _error("only some of the cutting moves have a tool axis", "give every G1 of the operation I J K words"),
    "J110": _error("the tool axis has no direction", "give I J K words that are not all zero"),
    "J111": _error("the job uses several fixtures", "post one fixture at a time"),
    "J112": _error("the operation has no tool controller", "choose a tool controller for it"),
    "J113": _error(
        "the gauge length of the tool is unknown",
        "enter it under Gauge lengths in the panel of Post to a hexapod, set the property GaugeLength of its tool"
        " controller, or pass --tool-length NUMBER=MM",
    ),
    "J114": _error("two tools have the same number", "give every tool controller its own tool number"),
    "J115": _error("rotary words have no meaning on this machine", "give the tool axis as I J K words"),
    "J116": _error("the operation could not be computed", "repair it in FreeCAD until it recomputes without error"),
    "J117": _error("the job's options are not understood", "correct the arguments of the post-processor"),
    "J118": _warning("the tool axis was not of unit length and was normalised", "write unit vectors with 6 decimals"),
    "J119": _error("a move is not a finite number", "regenerate the operation"),
    "J120": _warning("an operation of CAM cannot hold all that the part program says", "post the part program itself"),
    "J121": _error("a property of a document object has no meaning", "set it to another value"),
    "J122": _error(
        "the drilling cycle cannot be carried out",
        "correct its words; cycles are drilled along Z (G17), after a move to a known height, in operations without"
        " tool-axis words",
    ),
    "J123": _TAPPING,
    "J124": _warning(
        "a dwell lasts longer than a minute", "dwells of CAM commands are in seconds: correct it if not meant"
    ),
    "J125": _warning(
        "an option stands in for what the job or the program says",
        "leave the option out where that is not meant",
    ),
    "J126": _error(
        "an option gives a length to a tool that is not there", "correct the number of the tool, or leave it out"
    ),
    "J127": _error("CAM asks for an operation that is not in the job", "choose among the operations of the job"),
    "J128": _error(
        "a length offset (H) of another number than the tool's is in force, and its value is not known",
        "pass it with --tool-length NUMBER=MM; if it holds the length of the tool, that length",
    ),
    "J129": _error("the file of the document is damaged", _INTACT_COPY),
    "J130": _error("the content of the document contradicts itself", _INTACT_COPY),
    "J131": _error("FreeCAD did not read all operations of the job", _INTACT_COPY),
    "J132": _error(
        "the path of an active operation is empty",
        "mark the operation to be recomputed and recompute the document, or switch the operation off",
    ),
    "J133": _error(
        "an operation was not computed after it, or what it is made from, was changed",
        "let the document be recomputed (Skip Recomputes off), and recompute it",
    ),
    "J134": _error("FreeCAD could not read the path or another property of an operation", _INTACT_COPY),
    "J135": _error(
        "the path of an operation holds characters that are not UTF-8",
        "take them out of what the operation is made from, mark it to be recomputed, and recompute the document",
    ),
    "J136": _error("something in the job has no path", "take it out of the operations of the job"),
    # G1: the letters of G-code
    "G101": _error("a character has no meaning here", "remove it, or put the text into a comment"),
    "G102": _error("a number is malformed", "write it as -12.5: one sign, one point, no blanks and no exponent"),
    "G103": _error("a number is too large", "write a number that the machine can reach"),
    "G104": _error("a line is too long", "split it; a block has at most 10000 characters"),
    "G105": _error("there is no such G or M code", "write G with at most one decimal, M with none, no sign"),
    "G199": _error("there are more faults than are told", "correct those that are told, then check again"),
    # G2: the grammar of G-code
    "G201": _error("a word has no number", "write a number, a parameter or an expression after the letter"),
    "G202": _error("a block has two values of one letter", "remove one of them, or make it two blocks"),
    "G203": _error("a comment stands in a comment", "remove the inner parentheses"),
    "G204": _error("a comment is not closed", "close it with ) on the same line"),
    "G205": _error("a bracket is not closed", "close it with ] on the same line"),
    "G206": _error(
        "the block does not go on like this", "write what is expected there, or put it on a line of its own"
    ),
    "G207": _error("something is closed that was not opened", "remove it, or open it before"),
    "G208": _error("a name is malformed", "write names as <name>, of letters, digits, blanks, _, . and -"),
    "G209": _error("a value is missing", "write a number, a parameter or an expression in its place"),
    "G210": _error(
        "something stands in the wrong place of the block",
        "write / first, then N; O words, LN and % begin a block; NX to TZ stand after LN",
    ),
    "G211": _error("an expression is nested too deeply", "split it, with parameters for its parts"),
    "G212": _warning("blocks behind the percent sign that ends the file are not read", "remove them, or the sign"),
    # G3: the execution of a G-code program
    "G301": _error("a parameter has no value", "assign it before"),
    "G302": _error("there is no such parameter", "use whole numbers from 1 to 5601, or a name"),
    "G303": _error("the parameter belongs to the control, and its value is not known here", "write the value itself"),
    "G304": _error("a division by zero", "correct the divisor"),
    "G305": _error("the value cannot be computed", "keep to what the function or operator is defined for"),
    "G306": _error("the value is no G or M code", "let G be whole or have one decimal, and M be whole"),
    "G307": _error("an O word belongs to nothing", "begin it before, with the same label"),
    "G308": _error("something is not ended", "end it: sub, if, while, do and repeat by O word, O numbers by M99"),
    "G309": _error("the subprogram is not in this file", "put it into the file; other files are not called"),
    "G310": _error("a label is used twice", "give each its own label"),
    "G311": _error("this is no label", "write a whole number that is not negative, or a name in < >"),
    "G312": _error("this must not stand here", "call with call and end with endsub, or with M98 and M99"),
    "G313": _error("the program does not come to an end", "correct its loops, or raise the limit"),
    "G314": _error("subprograms call each other too deeply", "correct the calls, or raise the limit"),
    "G315": _error("a call has too many arguments", "pass at most 30"),
    "G316": _error("this is no call of a subprogram", "write M98 P and L with whole numbers, P always, and no M99"),
    "G317": _error("the tool axis or normal cannot be said so here", "write the tool axis alone, on straight moves"),
    # G4: what a G-code program means
    "G401": _error("the code is not supported", "remove it, or write what it does in other codes"),
    "G402": _error("the code has no meaning on this machine", "write the program without it"),
    "G403": _error("two codes of one group in a block exclude each other", "write them in two blocks"),
    "G404": _error("no code of the block uses the word", "remove it, or add the code that it belongs to"),
    "G405": _error("a word is missing", "add it"),
    "G406": _error("a word has a value that it cannot have", "correct it"),
    "G407": _error("it is not clear what the axis words belong to", "write one motion in a block, with its words"),
    "G408": _error("a cutting move has no feed", "write F above zero before the move, or in it with G93"),
    "G409": _error("the arc does not fit its end points", "correct end point, centre or radius"),
    "G410": _error("the arc has no centre", "write I J K of its plane, or R"),
    "G411": _error("the tool is unknown", "say what its cutter measures: --tool NUMBER=D[,R]"),
    "G412": _error("where this coordinate system lies is unknown", "give its offset, or set it with G10 L2"),
    "G413": _error("the reference point is unknown", "give it as an option, or set it with G28.1 or G30.1"),
    "G414": _error("rotary words have no meaning here", "say which axes they turn, and write G43.4 before them"),
    "G415": _error("the tool axis is not known", "write I, J and K, not all zero, after G43.5"),
    "G416": _error("the tool's position is not known yet", "move to X, Y and Z before"),
    "G417": _warning("the tolerance of a path is not taken from the program", "write G64 with a P above zero, alone"),
    "G418": _error("the cycle cannot be carried out", "correct its words"),
    "G419": _error("this cannot be done while cutter compensation is on", "switch it off before with G40"),
    "G420": _error("nothing moves in the program", "check the file"),
    "G421": _error("the length offset is not the tool's own, and the tool axis can tilt", "write the tool's own H"),
    "G422": _error("the surface normal is not known", "write NX, NY and NZ, not all zero"),
    "G423": _warning(
        "the surface normal was not of unit length and was normalised", "write unit vectors with 6 decimals"
    ),
    "G424": _error(
        "the tool is tilted, and X Y Z are not those of its tip",
        "write upright words for the tool axis before TRAFOOF, G43 or G49, or TRAORI, G43.4 or G43.5 before the move",
    ),
    "G425": _TAPPING,
    "G426": _error(
        "it is not clear what the words in force of the cycle mean here",
        "write R and the depth again where G90, G91 or the unit changes; write G80 before another plane or height of"
        " the origin, and the whole cycle after it",
    ),
    "G427": _error(
        "a dwell in milliseconds has a decimal point",
        "write whole milliseconds without a point, or seconds in the whole program and --dwell-unit s",
    ),
    "G428": _warning(
        "a dwell lasts longer than a minute",
        "check it; read a part program whose dwells are in ms with --dwell-unit ms",
    ),
    "G429": _error(
        "a cycle drills along the normal of its plane, and the tool leans out of it",
        "write the hole as G0 and G1 along the tool, or set the tool upright before the cycle",
    ),
    "G430": _error(
        "the program has no end: it may have been cut short",
        "get the whole file; if it is whole, write M2 or M30 behind it, give --allow-open-end, or set OpenEnd of the"
        " program object",
    ),
    # G5: writing G-code
    "G501": _error("the tool axis tilts, and this form of G-code cannot say it", "choose a form with five axes"),
    "G502": _error("the tool axis points down, and this form of G-code cannot say it", "choose vectors or a head"),
    "G503": _warning("arcs that this form of G-code cannot say are written as lines", "none is needed"),
    "G504": _warning(
        "surface normals cannot be said in this form of G-code and are left out", "keep the source of the program"
    ),
    "G505": _warning(
        "a control that moves these angles evenly swings the tool out of its way",
        "divide the moves in the CAM system, or write the tool axis as vectors",
    ),
    "G506": _error("a feed is so slow that it would be written as zero", "program a feed of 0.001 a minute at least"),
    # L1: the letters of CL data
    "L101": _error("a character has no meaning here", "remove it, or put the text into a comment after $$"),
    "L102": _error("a number is malformed", "write it as -12.5 or 1.0E-05"),
    "L103": _error("a number is too large", "write a number that the machine can reach"),
    "L104": _error("a statement is too long", "split it"),
    "L105": _error("a text in quotes is not closed", "close it on the same line"),
    "L106": _error("a $ stands within a line", "put $ at the end of a line that is continued, $$ before a comment"),
    "L199": _error("there are more faults than are told", "correct those that are told, then check again"),
    # L2: the grammar of CL data
    "L201": _error("a statement does not begin with a word", "begin it with its major word, such as GOTO"),
    "L202": _error("the statement does not go on like this", "write WORD/item,item,... on a line of its own"),
    "L203": _error("a parenthesis is not closed", "close it with )"),
    "L204": _error("a parenthesis is closed that was not opened", "remove it, or open it before"),
    "L205": _error("parentheses are nested too deeply", "write the statement without them"),
    # L4: what CL data means
    "L401": _error("the statement is not supported", "let the CAM system write the motion in plain points and arcs"),
    "L402": _error(
        "the items of the statement are not what it needs", "give it the items described in docs/cl-data.md"
    ),
    "L403": _error("a value is not possible", "correct it"),
    "L404": _warning("the word is unknown and was passed over", "check that the job does not need it"),
    "L405": _error("the tool axis has no direction", "give I, J and K, not all zero"),
    "L406": _warning("the tool axis was not of unit length and was normalised", "write unit vectors with 6 decimals"),
    "L407": _error("a cutting move has no feed", "write FEDRAT before it"),
    "L408": _error("the arc does not fit its end points", "regenerate the path; the radii must agree to 0.05 mm"),
    "L409": _warning("the arc fits its end points badly", "write more decimals; the radii should agree to 0.0005 mm"),
    "L410": _warning(
        "the unit of length is doubtful", "check the size of the part, and say it by --unit mm or --unit inch"
    ),
    "L411": _warning("the gauge length of the tool is unknown and 0 is taken", "give the tool with its length"),
    "L412": _error("the cycle cannot be carried out", "correct its items, or let the CAM system write single moves"),
    "L413": _error("nothing moves in the file", "check the file"),
    "L414": _error("an arc has no end point", "write GOTO after it"),
    "L415": _warning("statements after FINI were passed over", "remove them, or remove FINI"),
    "L416": _error("an inverse time feed needs a way to go", "give such moves a feed in mm/min"),
    "L417": _error("it is not known where the tool is", "write FROM or GOTO before"),
    "L418": _warning(
        "e and f do not put the corner of the cutter against its bottom and side, and were passed over",
        "write the e and f of a corner that touches both, or leave them out",
    ),
    "L419": _error(
        "makers of CAM systems mean different things by the words of this cycle",
        "name the CAM system with --cl-dialect, or let it write single moves",
    ),
    "L420": _error(
        "the cycle has numbers without words, and what they are is not known",
        "say it with --cycle-values, such as depth,feed,clearance",
    ),
    "L421": _error(
        "the tool axis turns by more than 60 degrees on the way to a hole", "let the CAM system write the moves between"
    ),
    "L422": _error(
        "a motion begins or ends at a hole of a cycle, where the tool is not", "write CYCLE/OFF and a GOTO before it"
    ),
    "L429": _error(
        "CUTCOM has two readings: its points may be the contour of the part or the centre of the tool",
        "say which by --contour-data contour or --contour-data centre, or by ContourData of the program object",
    ),
    "L430": _warning(
        "the points under CUTCOM were taken for the centre of the tool, by their arcs",
        "check the size of the part, and say it by --contour-data centre or contour",
    ),
    "L431": _error(
        "the unit of length is not known", "say it by --unit mm or --unit inch, or by Unit of the program object"
    ),
    "L432": _error(
        "the wear of a tool changes nothing", "give --wear for a tool that the CL data compensates by CUTCOM"
    ),
    "L440": _TAPPING,
    "L441": _error(
        "the file has no end: it may have been cut short",
        "get the whole file; if it is whole, write FINI behind it, give --allow-open-end, or set OpenEnd of the program"
        " object",
    ),
    "L442": _error("an option means nothing for what is read", "leave it out"),
    # M1: the machine file
    "M101": _error("the machine file cannot be read", "check the path; python3 -m pkm_post machine list shows presets"),
    "M102": _error("the machine file is not valid TOML", "correct it at the place shown"),
    "M103": _error("an entry is missing", "add it; docs/machine-file.md describes every entry"),
    "M104": _error("an entry has the wrong form", "correct it; docs/machine-file.md describes every entry"),
    "M105": _error("an entry is not known", "remove it or correct its spelling"),
    "M106": _error("entries contradict each other", "correct the one shown, or what it is compared with"),
    "M107": _error(
        "something of this machine is not known", 'measure it or ask the maker, and write it in place of "unknown"'
    ),
    "M108": _warning("the machine cannot stand at home", "correct tool_path.home_tip, or the limit that is in the way"),
    "M115": _warning(
        "the machine cannot stand at the tool-change pose", "correct tool_change.nose, or the limit that is in the way"
    ),
    # M2: calibration of the machine
    "M201": _error("the measurements cannot be read", "check the path; docs/machine-file.md describes the file"),
    "M202": _error("a row of the measurements is malformed", "correct it; docs/machine-file.md describes the file"),
    "M203": _error("no machine fits the measurements", "look for wrong rows, units and frames in the measurements"),
    "M204": _error("the calibrated machine cannot be written", "correct what is said of the file that was written"),
    "M205": _warning("the poses do not determine all parameters", "measure at more places, with more tilt and spin"),
    "M206": _error("the machine file is too large", "leave out what no entry of docs/machine-file.md is"),
    "M207": _error("the machine file is nested too deeply", "write tables and lists as docs/machine-file.md has them"),
    "M208": _error("there are more faults than are shown", "correct those that are shown, then check again"),
    # K1: what the machine can reach
    "K101": _error("a strut would be too short", "move or turn the part on the table, or use another tool length"),
    "K102": _error("a strut would be too long", "move or turn the part on the table, or use another tool length"),
    "K103": _error("a base joint would swing too far", "tilt the tool less, or move the part"),
    "K104": _error("a platform joint would swing too far", "tilt the tool less, or move the part"),
    "K105": _error("the path comes too near to a singular pose", "tilt the tool less, or move the part"),
    "K106": _error("the tool axis turns by half a turn in one move", "put a move between that says which way to turn"),
    "K107": _error("the spindle does not turn at this speed", "program a speed that the machine has"),
    "K108": _error("the work offset is unknown to the machine", "add it to the machine file, or pass --work-offset"),
    "K109": _error("the matrix is not a rotation, a mirror or a shift", "use a matrix without scale or shear"),
    "K110": _warning("the feed is beyond the machine and is limited", "program a feed that the machine can run"),
    "K112": _error("cutter compensation would leave its plane", "compensate before the path is turned or mirrored"),
    "K113": _error("two struts come too near to each other", "turn the platform about the tool axis, or move the part"),
    "K114": _error("a strut comes too near to the spindle or its platform", "tilt the tool less, or turn the platform"),
    "K115": _error("a strut comes too near to what stands on the table", "move the part or the fixture"),
    "K116": _error("the spindle or holder comes too near to what stands on the table", "use a longer tool, or tilt it"),
    "K117": _error("the spindle or holder comes too near to the part", "use a longer tool, or tilt it"),
    "K118": _warning("a strut cannot keep up with the feed, and the tool will be slower", "program a lower feed"),
    "K119": _error("the machine is too compliant along the surface normal", "tilt the tool less, or move the part"),
    "K120": _error("the tool axis is at right angles to the plane that the spin is kept to", "choose another spin"),
    "K121": _error("a strut comes too near to the part", "move or turn the part on the table"),
    "K122": _error(
        "a pass cannot be run the other way: how the tool would come and go is not known",
        "lift the tool along its axis between the passes, or do without climb milling",
    ),
    "K123": _warning(
        "the path begins by a rapid move to where the tool stood in the material at its end",
        "see that it is free there, or lift the tool along its axis at the end of the original",
    ),
    "K124": _warning("a pass begins at its deep end, for it is run the other way", "see that the cutter can take it"),
    "K125": _error(
        "something happens in the middle of a pass that is to be run the other way",
        "let it happen between the passes, or do without climb milling",
    ),
    "K126": _error("an arc begins where a tool of another length was taken", "make a straight move before the arc"),
    "K127": _error("a move takes longer than a day", "give it a higher feed"),
    "K130": _error(
        "the shank of the tool goes into the part",
        "use a tool with longer cutting edges or a thinner shank, or tilt it",
    ),
    "K131": _error(
        "a rapid move takes the cutter through the part", "raise the clearance and retract heights of the operation"
    ),
    "K132": _warning(
        "the cutter goes deeper into the part than its surface",
        "check the depths, and what the flank of the cutter does",
    ),
    "K133": _error("something comes too near to a fixture", "move the fixture or the path, or use a longer tool"),
    "K134": _error(
        "something other than the cutter goes into stock that nothing has cut",
        "rough the part before, use a longer tool, or give the stock as it is before the first operation",
    ),
    "K135": _warning(
        "something other than the cutter goes into stock that may still be there",
        "see that it is cut before, or give the stock as it is before the first operation",
    ),
    "K136": _error(
        "a rapid move goes through stock that nothing has cut",
        "raise the clearance and retract heights, or give the stock as it is before the first operation",
    ),
    "K137": _warning(
        "a rapid move goes through stock that may still be there",
        "see that it is cut before, or give the stock as it is before the first operation",
    ),
    "K138": _error(
        "the solid cannot be read",
        "write it as an STL file, ASCII or binary, in mm and in work coordinates, or as STEP where FreeCAD is",
    ),
    "K139": _warning(
        "the mesh of the stock is not closed, and only its surface is looked at", "write a closed solid as STL"
    ),
    # K14: tools, tool changes and the spindle
    "K140": _error(
        "the tool is larger than the spindle takes",
        "use a smaller tool, or correct spindle.largest_tool_diameter or spindle.longest_tool of the machine file",
    ),
    "K141": _error(
        "the tip of a tool would be below the safe height at the tool-change pose",
        "raise tool_change.nose, lower tool_change.safe_height, or use a shorter tool",
    ),
    "K142": _error(
        "the tool lies too flat to be retracted along its axis to the safe height",
        "tilt the tool less before the tool change and after it",
    ),
    "K143": _error(
        "the program cuts after a tool change without starting the spindle",
        "start the spindle with M3 or M4 between the tool change and the cut",
    ),
    "K144": _warning(
        "the diameter of a tool is unknown, and whether the spindle takes it is not checked",
        "say the diameter: --tool NUMBER=D for G-code, the tool of the CAM job, or the tool statement of CL data",
    ),
    "K145": _error(
        "the motion takes longer than can be planned",
        "raise the feeds, or the speeds and accelerations of the machine file; or post fewer operations at a time",
    ),
    "K146": _error("the tolerance of a move is too small", "raise P of its G64, or leave P out"),
    "K147": _error("the platform is turned too far about the tool axis", "write the spin within a few turns"),
    # N1: surface normals, and compensation with them
    "N101": _error("a contact point, normal or tool axis is no number or has no direction", "regenerate the path"),
    "N102": _error("the surface is undercut: the corner of the cutter does not touch it", "lean the tool further back"),
    "N103": _error("the normal is parallel to the tool axis and no direction of travel is known", "lean the tool"),
    "N104": _error(
        "the surface is flatter than the bottom of the cutter: its corner does not touch it",
        "lean the tool, or take a cutter with a flatter bottom",
    ),
    "N105": _warning(
        "normal and tool axis are nearly parallel, and the side on which the cutter lies hangs on rounding",
        "lean the tool, or give normals with more decimals",
    ),
    "N106": _warning(
        "the tip jumps sideways where normal and tool axis are nearly parallel",
        "lean the tool there, or take a ball end mill",
    ),
    "N107": _error("an arc would not stay an arc in 3D compensation", "let the CAM system write straight moves"),
    "N108": _error("there are no surface normals to compensate with", "let the CAM system write normals"),
    "N109": _error(
        "the cutter the path was made for is not known",
        "pass --tool NUMBER=D,R with its diameter and corner radius; in a CAM job complete the tool bit",
    ),
    "N111": _error(
        "a cutting move ends on no face of the model",
        "correct the operation; give the faces it cuts, a LeadLength for leads, or a wider Tolerance",
    ),
    "N112": _error(
        "a point is at an edge between faces with different normals",
        "choose the face that is cut in the property Faces, or keep the path off the edge",
    ),
    "N113": _error(
        "the surface normal or the tool axis turns too much from one point to the next",
        "put the points of the operation closer together, end the cut at the edge, or allow more as ChordTolerance",
    ),
    "N114": _error(
        "the tool leans in the direction of travel, and there is none at a contact point",
        "keep the tool axis of the operation, or let the cut go on from there",
    ),
    "N115": _error("there is no face to touch", "choose the faces anew, or leave Faces empty for all of the model"),
    "N116": _error("compensation does not know the shape of the tool", "take a flat, ball or bull nose end mill"),
    "N117": _error(
        "the corner radius of a cutter is not known",
        "pass it behind the diameter, 0 for a flat end mill, D/2 for a ball nose: --tool NUMBER=D,R for the cutter the"
        " path was made for, --actual-tool NUMBER=D,R for the one in the spindle",
    ),
    "N118": _error("the program has no such tool", "pass --actual-tool with the number of a tool of the program"),
    # N2: cutter compensation in a plane
    "N201": _error("cutter compensation begins or ends on an arc", "begin and end it on a straight move"),
    "N202": _error("the tool is too large for the block", "use a smaller tool, or let such blocks be removed"),
    "N203": _warning("the tool is too large for the block, which is left out", "check what is not cut there"),
    "N204": _error("the tool would cut into the contour", "use a smaller tool, or change the contour there"),
    "N205": _warning(
        "the tool cuts into the contour where compensation begins, ends or changes its side",
        "begin and end it farther from the contour, at right angles to it",
    ),
    "N206": _error("cutter compensation has no one plane here", "keep plane and tool axis, and arcs in the plane"),
    # N3: paths over a surface
    "N301": _error("only closed lines along u or v can be joined to a spiral", "choose Zigzag or One way"),
    "N302": _error("there is nothing to be covered", "choose faces that have an area"),
    "N303": _error(
        "the cutter does not fit into a hollow of the surface, so there is no stepover for a scallop height",
        "take a smaller cutter, or give the stepover as a distance",
    ),
    "N304": _error("the tool lies too flat to be lifted along its axis", "limit the cone of the tool axis"),
    "N305": _error("the tolerances cannot be kept by straight moves", "raise the tolerances, or lean the tool less"),
    "N306": _warning("the surface has an edge, where the tool turns at once", "cover the faces beside it one by one"),
    "N307": _error("the path lies above the height at which the tool crosses", "raise SafeHeight and ClearanceHeight"),
    "N308": _error("no face is chosen", "add faces as base geometry"),
    "N309": _error("a value has no meaning", "correct the property"),
    "N310": _error("the machine cannot reach the part with the tool upright", "move the part, or take another tool"),
    "N311": _error(
        "the cutter goes deeper into the model than ChordTolerance",
        "lean the tool away from what is beside the face, take a smaller cutter, or choose other faces; CheckSpacing 0"
        " shows the path without the measurement",
    ),
    # T1: the binary trajectory
    "T101": _error("the file is not a trajectory file", "give a .pkmt file"),
    "T102": _error("the trajectory file has a version that this program does not know", "use a newer PKM Post"),
    "T103": _error("the trajectory file is damaged", "make it again from its source"),
    "T104": _error(
        "the trajectory was made for another machine", "name that machine, as by --machine, or post again for this one"
    ),
    "T105": _error("the trajectory file does not say what tolerances were asked for", "post the job again"),
    "T106": _error("the trajectory file contradicts itself", "make it again from its source"),
    "T107": _error("the trajectory asks for more than its machine can do", "post the job again for this machine"),
    # C1: the controller's program
    "C101": _error("the program has a line that is not understood", "post the job again; do not edit the program"),
    "C102": _error(
        "the program is larger than the controller's memory and rests nowhere to be cut",
        "post fewer operations at a time, or put a stop into the job where the tool is free",
    ),
    "C103": _error("the line is too long for the controller", "use fewer decimals in the machine file"),
    "C104": _error(
        "an event has no code of the controller", "give it one under [controller.codes] in the machine file"
    ),
    "C105": _error(
        "the parts of the program do not belong together", "keep all parts of one posting together; post the job again"
    ),
    "C106": _error("the table has a line that is not understood", "post the job again; do not edit the table"),
    "C107": _error("the table differs from the motion it was made from", "post the job again; do not edit the table"),
    "C108": _error(
        "the program has a character that the controller does not take, or obeys at once",
        "post the job again; do not edit the program: it is printable ASCII, in lines that end with LF or CR LF",
    ),
    "C109": _error(
        "the program was changed: its lines do not have the SHA-256 of its heading",
        "post the job again; do not edit the program",
    ),
    "C110": _error(
        "nothing shows that the program was certified",
        "keep the trajectory file, the report and all parts of one posting beside the program, or post the job again;"
        " pmac --uncertified loads it all the same",
    ),
    # C2: moves by hand, at the controller
    "C201": _error("nothing moves", "say which way, and how far"),
    "C202": _error("no pose of the platform belongs to the strut lengths on the way", "jog less far, or jog the tool"),
    "C203": _error("a line by hand cannot change the tool", "change it, and say its gauge length"),
    "C204": _error("the way needs more memory than one program has", "jog less far, or program a higher feed"),
    "C205": _error(
        "the lines of the program's source are not known",
        "keep all results of a posting together in one folder, or post the job again",
    ),
    "C210": _error(
        "another client has the machine",
        "wait until it has ended, or end it there; where nothing of it is left, stop the machine first (hold, then"
        " abort); status, monitor, hold and abort work meanwhile",
    ),
    "C211": _error(
        "another client has taken the machine meanwhile",
        "look what the machine does, and begin again when the other client has ended",
    ),
    "C212": _error(
        "the lock of the controller cannot be kept on this computer", "make the folder for temporary files writable"
    ),
    "C213": _error(
        "the variables that say who has the machine hold what no client writes",
        "keep P8187 to P8191 free in the programs of the controller; P8187..8191=0 in the terminal frees them",
    ),
    "C214": _error(
        "a program buffer is open that this port cannot close",
        "close it where it was opened, or disconnect what loads a program there",
    ),
    "C215": _error(
        "the file with the known host keys cannot be read",
        "correct or remove that line, or name another file with --known-hosts",
    ),
    # V1: the certificate
    "V101": _error("the tool tip leaves the programmed path", "ask for a wider tolerance, or report this as a fault"),
    "V102": _error("the tool axis leaves the programmed axis", "ask for a wider tolerance, or report this as a fault"),
    "V103": _error("a strut is faster than the machine allows", "report this as a fault of the feed planner"),
    "V104": _error("a strut accelerates more than the machine allows", "report this as a fault of the feed planner"),
    "V105": _error("the program does not start or end at rest", "post the job again; do not edit the program"),
    "V106": _error("a strut leaves its stroke", "move or turn the part on the table"),
    "V107": _error("no pose of the platform belongs to the strut lengths", "post the job again; do not edit it"),
    "V108": _error("the feed is exceeded", "report this as a fault of the feed planner"),
    "V109": _error("the program does not carry out the events of the job", "post the job again; do not edit it"),
    "V110": _error("the program does not follow the whole path", "post the job again; do not edit it"),
    "V111": _error("the struts leave their plan", "post the job again; do not edit the program"),
    "V112": _error("the acceleration of a strut changes too fast", "report this as a fault of the feed planner"),
    "V113": _error("the tool axis turns faster than the machine allows", "report this as a fault of the feed planner"),
    "V114": _error("the tip accelerates more than the machine allows", "report this as a fault of the feed planner"),
    "V115": _error("the acceleration of the tip changes too fast", "report this as a fault of the feed planner"),
    "V116": _error("points come too close for the controller", "report this as a fault of the feed planner"),
    "V117": _error(
        "points come too fast for the controller",
        "lower the feed, ask for a wider tolerance, or correct controller.block_rate of the machine file",
    ),
    "V118": _error(
        "the program has too few decimals",
        "state more in controller.length_decimals and controller.speed_decimals, and controller.line_limit for longer"
        " lines if the controller takes them",
    ),
    "V119": _error(
        "the path needs points closer together than the controller takes them",
        "ask for a wider tolerance, lower the feed, or correct controller.shortest_interval of the machine file",
    ),
    # V13: how a program ends
    "V130": _warning(
        "the spindle turns on at the end of the program", "let the program stop it, by M5, M2 or SPINDL/OFF"
    ),
    "V131": _warning(
        "the tool ends low", "check that the program is whole, and retract the tool at its end if it has to be clear"
    ),
    # F1: files
    "F101": _error("the output cannot be written", "check the folder, its permissions and the free space"),
    "F102": _warning(
        "the picture was not made: matplotlib is missing or cannot be imported",
        "install python3-matplotlib, in a version that fits NumPy",
    ),
    "F103": _error("the file cannot be read", "check the path and its permissions"),
    "F104": _warning(
        "files of an earlier result are beside this one and do not belong to it",
        "remove them, so that nobody runs them with this program",
    ),
    "F105": _error(
        "results of two jobs would have one name",
        "give the jobs labels that differ in letters or digits, not in their case and not in an ending such as -setup",
    ),
    "F106": _error(
        "results are not those that were posted together",
        "post again, or bring back every file that the manifest lists",
    ),
    "F107": _warning(
        "no manifest says which results belong to this file",
        "post again, and keep the manifest and all that it lists with the program",
    ),
    "F108": _error("the manifest of results cannot be read", "post again, or bring back the manifest"),
    "F109": _error(
        "another process is moving its files into the folder",
        "try again when it has ended, or choose another folder",
    ),
    "F110": _error(
        "files were not all replaced, and earlier ones could not be put back",
        "close the programs that have the named files open, remove them, and try again",
    ),
    "F130": _error(
        "there is not enough memory",
        "close other programs, do fewer operations or files at a time, or use a computer with more memory",
    ),
    "F140": _error(
        "FreeCAD could not be started",
        "install FreeCAD 1.0 or newer, or name its FreeCADCmd in the environment variable FREECADCMD",
    ),
    "F141": _error(
        "FreeCAD ended before the command had run in it",
        "see what was printed before, and that FREECADCMD, if it is set, names FreeCADCmd of FreeCAD 1.0 or newer",
    ),
    "F142": _error("a result is missing", "see that nothing else removes files from the folder, and post again"),
}
