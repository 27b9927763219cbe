# SPDX-License-Identifier: LGPL-2.1-or-later
"""Part programs: the rules of the CAM job (J), of G-code (G) and of CL data (L)."""

from __future__ import annotations

from pkm_post.model.rules.rule import Rule, error, warning

_TAPPING = error(
    "tapping needs a feed synchronised with the spindle, which this machine's programs do not support",
    "tap the threads on another machine, or mill them as helices",
)
"""One rule, with a code for each kind of input."""
_INTACT_COPY = "use an intact copy of the document, such as its backup file (.FCBak)"

PART_PROGRAM_RULES: dict[str, Rule] = {
    # J1: the CAM job
    "J101": error("the file cannot be opened as a FreeCAD document", "check the path, or save the document again"),
    "J102": error("there is no CAM job to post", "add a Job in the CAM workbench, or name the job with --job"),
    "J103": error("the job has no active operation with a path", "activate an operation and recompute"),
    "J104": error("the command is unknown or not allowed here", "remove it, or use a G0, G1, G2 or G3 move"),
    "J105": error("a cutting move has no feed", "set the feed in the tool controller, in mm/min above zero"),
    "J106": error("an arc in this plane is not supported", "use XY-plane arcs (G17), or straight moves"),
    "J107": error("the arc does not fit its end points", "regenerate the operation; the radii must agree to 0.005 mm"),
    "J108": error(
        "a dress-up or array that does not support tool-axis words contains moves with them",
        "remove it, or apply it to an operation without tool-axis words",
    ),
    "J109": error("only some of the cutting moves have a tool axis", "give every G1 of the operation I J K words"),
    "J110": error("the tool axis has no direction", "give I J K words that are not all zero"),
    "J111": error("the job uses several fixtures", "post one fixture at a time"),
    "J112": error("the operation has no tool controller", "choose a tool controller for it"),
    "J113": error(
        "the gauge length of the tool is unknown",
        "enter it under Gauge lengths in the panel of Post to a hexapod, set the property GaugeLength of its tool"
        " controller, or pass --tool-length NUMBER=MM",
    ),
    "J114": error("two tools have the same number", "give every tool controller its own tool number"),
    "J115": error("rotary words have no meaning on this machine", "give the tool axis as I J K words"),
    "J116": error("the operation could not be computed", "repair it in FreeCAD until it recomputes without error"),
    "J117": error("the job's options are not valid", "correct the arguments of the post-processor"),
    "J118": warning("the tool axis was not of unit length and was normalised", "write unit vectors with 6 decimals"),
    "J119": error("a coordinate of a move is not a finite number", "regenerate the operation"),
    "J120": warning("a CAM operation cannot represent all of the part program", "post the part program itself"),
    "J121": error("a property of a document object has an invalid value", "correct it"),
    "J122": error(
        "the drilling cycle cannot be executed",
        "correct its words; cycles are drilled along Z (G17), after a move to a known height, in operations without"
        " tool-axis words",
    ),
    "J123": _TAPPING,
    "J124": warning(
        "a dwell lasts longer than a minute", "correct it if it is not intended; dwells of CAM commands are in seconds"
    ),
    "J125": warning(
        "an option overrides a value of the job or the program",
        "leave the option out if this is not intended",
    ),
    "J126": error(
        "an option gives the length of a tool that does not exist", "correct the number of the tool, or leave it out"
    ),
    "J127": error("CAM requests an operation that is not in the job", "choose among the operations of the job"),
    "J128": error(
        "the active length offset (H) is not that of the tool, and its value is unknown",
        "pass its value with --tool-length NUMBER=MM; if it holds the length of the tool, pass that length",
    ),
    "J129": error("the file of the document is damaged", _INTACT_COPY),
    "J130": error("the content of the document is inconsistent", _INTACT_COPY),
    "J131": error("FreeCAD did not read all operations of the job", _INTACT_COPY),
    "J132": error(
        "the path of an active operation is empty",
        "mark the operation to be recomputed and recompute the document, or deactivate the operation",
    ),
    "J133": error(
        "an operation is out of date: it or its inputs changed after it was computed",
        "switch Skip Recomputes off and recompute the document",
    ),
    "J134": error("FreeCAD could not read the path or another property of an operation", _INTACT_COPY),
    "J135": error(
        "the path of an operation holds characters that are not UTF-8",
        "remove them from the inputs of the operation, mark it to be recomputed, and recompute the document",
    ),
    "J136": error("an object among the operations of the job has no path", "remove it from the operations"),
    # G1: the letters of G-code
    "G101": error("a character is not allowed here", "remove it, or put the text into a comment"),
    "G102": error("a number is malformed", "write it as -12.5: one sign, one point, no blanks and no exponent"),
    "G103": error("a number is too large", "correct the number"),
    "G104": error("a line is too long", "split it; a block has at most 10000 characters"),
    "G105": error("the G or M code does not exist", "write G with at most one decimal, M with none, no sign"),
    "G199": error("there are more faults than are shown", "correct those that are shown, then check again"),
    # G2: the grammar of G-code
    "G201": error("a word has no number", "write a number, a parameter or an expression after the letter"),
    "G202": error("a block has two values of one letter", "remove one of them, or make it two blocks"),
    "G203": error("a comment contains another comment", "remove the inner parentheses"),
    "G204": error("a comment is not closed", "close it with ) on the same line"),
    "G205": error("a bracket is not closed", "close it with ] on the same line"),
    "G206": error("unexpected text in the block", "write what is expected there, or put it on a line of its own"),
    "G207": error("an end has no matching beginning", "remove it, or add the beginning"),
    "G208": error("a name is malformed", "write names as <name>, of letters, digits, blanks, _, . and -"),
    "G209": error("a value is missing", "write a number, a parameter or an expression in its place"),
    "G210": error(
        "a part of the block is in the wrong place",
        "write / first, then N; O words, LN and % begin a block; NX to TZ stand after LN",
    ),
    "G211": error("an expression is nested too deeply", "split it, with parameters for its parts"),
    "G212": warning("blocks after the percent sign that ends the file are not read", "remove them, or the sign"),
    "G213": error(
        "the program is in another language than G-code",
        "read Siemens's language with --flavour siemens; else post it again for a control that reads G-code",
    ),
    "G214": warning(
        "a length has no decimal point, and is taken in whole units",
        "write a point; some controls take such a number for thousandths, others for whole mm or inches as here",
    ),
    # G3: the execution of a G-code program
    "G301": error("a parameter has no value", "assign a value first"),
    "G302": error("the parameter does not exist", "use whole numbers from 1 to 5601, or a name"),
    "G303": error("the parameter belongs to the control, and its value is unknown", "write the value itself"),
    "G304": error("a division by zero", "correct the divisor"),
    "G305": error("the value cannot be computed", "use values for which the function or operator is defined"),
    "G306": error(
        "the value is not a G or M code", "use a number with at most one decimal for G, a whole number for M"
    ),
    "G307": error("an O word has no matching beginning", "write the beginning first, with the same label"),
    "G308": error(
        "a subprogram, loop or branch has no end", "end it: sub, if, while, do and repeat by O word, O numbers by M99"
    ),
    "G309": error(
        "there is no such subprogram",
        "put it into the program, or into a file of its number or name, such as O1234.nc or name.ngc, beside it or in a"
        " folder that --subprograms names",
    ),
    "G310": error("a label is used twice", "give each its own label"),
    "G311": error("this is not a label", "write a whole number that is not negative, or a name in < >"),
    "G312": error("this is not allowed here", "call with call and end with endsub, or with M98 and M99"),
    "G313": error("the program does not end", "correct its loops, or raise the limit"),
    "G314": error("subprograms call each other too deeply", "correct the calls, or raise the limit"),
    "G315": error("a call has too many arguments", "pass at most 30"),
    "G316": error("this is not a call of a subprogram", "write M98 P and L with whole numbers, P always, and no M99"),
    "G317": error(
        "the tool axis or normal cannot be given in this way here", "write the tool axis alone, on straight moves"
    ),
    "G318": error(
        "several files may be the subprogram",
        "leave one of them in the folder, or give the folder with the right one with --subprograms",
    ),
    "G319": error(
        "the program stops with an alarm of its own",
        "correct what the message beside it says, such as a missing argument",
    ),
    "G320": error("there is no block with this sequence number", "write the block's N, or correct the jump"),
    # G4: what a G-code program means
    "G401": error(
        "the code is not supported",
        "replace it by supported codes, or, if it does not move the tool, leave it out with --leave-out or with"
        " part_programs.leave_out of the machine file",
    ),
    "G402": error(
        "the code has no meaning on this machine",
        "write the program without it, or leave it out with --leave-out if it does not move the tool",
    ),
    "G403": error("two codes of one group in a block exclude each other", "write them in two blocks"),
    "G404": error("no code of the block uses the word", "remove it, or add the code that it belongs to"),
    "G405": error("a word is missing", "add it"),
    "G406": error("a word has an invalid value", "correct it"),
    "G407": error("the axis words are ambiguous", "write one motion in a block, with its words"),
    "G408": error(
        "a cutting move has no feed",
        "write F above zero before the move, or in it with G93, or give --feed",
    ),
    "G409": error("the arc does not fit its end points", "correct end point, centre or radius"),
    "G410": error("the arc has no centre", "write I J K of its plane, or R, which is CR= in Siemens's language"),
    "G411": error("the tool is unknown", "give its diameter and corner radius: --tool NUMBER=D[,R]"),
    "G412": error(
        "the offset of this coordinate system is unknown",
        "give it with --origin NAME=X,Y,Z, or set it with G10 L2; for G53"
        " give the place of the machine's zero with --machine-zero X,Y,Z",
    ),
    "G413": error("the reference point is unknown", "give it with --machine-zero X,Y,Z, or set it with G28.1 or G30.1"),
    "G414": error(
        "rotary words have no meaning here",
        "give the rotary axes with --axis-words, and write G43.4 before cuts with a tilted tool",
    ),
    "G415": error("the tool axis is unknown", "write I, J and K, not all zero, after G43.5"),
    "G416": error("the position of the tool is not yet known", "first move to X, Y and Z"),
    "G417": warning("the path tolerance of the program is not used", "write G64 with a P above zero, alone"),
    "G418": error("the cycle cannot be executed", "correct its words"),
    "G419": error("this is not allowed while cutter compensation is active", "cancel it with G40 first"),
    "G420": error("the program contains no motion", "check the file"),
    "G421": error(
        "the active length offset is not that of the tool, and the tool axis can tilt", "write the tool's own H"
    ),
    "G422": error("the surface normal is unknown", "write NX, NY and NZ, not all zero"),
    "G423": warning(
        "the surface normal was not of unit length and was normalised", "write unit vectors with 6 decimals"
    ),
    "G424": error(
        "the tool is tilted, and X Y Z do not refer to its tip",
        "write upright words for the tool axis before TRAFOOF, G43 or G49, or TRAORI, G43.4 or G43.5 before the move",
    ),
    "G425": _TAPPING,
    "G426": error(
        "the modal words of the cycle are ambiguous here",
        "write R and the depth again where G90, G91 or the unit changes; write G80 before another plane or height of"
        " the origin, and the whole cycle after it",
    ),
    "G427": error(
        "a dwell in milliseconds has a decimal point",
        "write whole milliseconds without a point, or seconds in the whole program and --dwell-unit s",
    ),
    "G428": warning(
        "a dwell lasts longer than a minute",
        "check it; read a part program whose dwells are in ms with --dwell-unit ms",
    ),
    "G429": error(
        "a cycle drills along the normal of its plane, and the tool is tilted against it",
        "write the hole as G0 and G1 along the tool, or set the tool upright before the cycle",
    ),
    "G430": error(
        "the program has no end: it may be truncated",
        "get the complete file; if it is complete, add M2 or M30 at its end, give --allow-open-end, or set OpenEnd"
        " of the"
        " program object",
    ),
    "G431": warning(
        "the tool is tilted before G43.4, where the place of its tip depends on another machine",
        "check the way there: the next move goes straight to the first place with G43.4; or write G43.4 first",
    ),
    "G432": error(
        "it is not clear here how the tool stands to the tilted plane",
        "write G53.1 directly after G68.2, G69 with the tool retracted, and rotary words of 0 before the next cut",
    ),
    "G433": warning(
        "the tool turns to a tilted plane, where the place of its tip depends on another machine",
        "check the way there: the next move goes straight to the first place in the plane",
    ),
    "G434": error(
        "a factor of scaling has no decimal point, and counts in units that a parameter of the control sets",
        "write it with a point, as in P2. for twice the size",
    ),
    "G435": error("controls differ in what this means while scaling is in force", "write G50 before it"),
    # G5: writing G-code
    "G501": error("the tool axis tilts, and this form of G-code cannot express it", "choose a form with five axes"),
    "G502": error("the tool axis points down, and this form of G-code cannot express it", "choose vectors or a head"),
    "G503": warning("arcs that this form of G-code cannot express are written as lines", "no action is needed"),
    "G504": warning(
        "surface normals cannot be expressed in this form of G-code and are left out", "keep the source of the program"
    ),
    "G505": warning(
        "a control that interpolates these angles linearly swings the tool axis off its programmed path",
        "divide the moves in the CAM system, or write the tool axis as vectors",
    ),
    "G506": error("a feed is so slow that it would be written as zero", "program a feed of 0.001 a minute at least"),
    # G6: programs in Siemens's language
    "G601": error(
        "the statement is malformed", "write it as the programming manual of the control does; docs/siemens.md lists it"
    ),
    "G602": error(
        "this part of Siemens's language is not read", "let the CAM system write plain moves and tool axes as vectors"
    ),
    "G603": error(
        "the name is not known",
        "define the variable with DEF, put the subprogram into the file, or remove what is for another machine",
    ),
    "G604": error("the jump has no destination in this program", "write the label or block number"),
    "G605": error("a loop, branch or subprogram has no matching end", "write it, in the same program"),
    "G606": error("the value is not possible here", "correct it"),
    "G607": error(
        "rotary words have no meaning here, or several",
        "write the tool axis as a vector, A3= B3= C3=; or give the rotary axes with --axis-words AC, BC or AB, and"
        " write them after TRAORI in a frame that is not turned",
    ),
    "G608": error(
        "the angles of the tool axis have two readings, Euler angles and RPY angles",
        "write ORIEULER or ORIRPY before them",
    ),
    "G609": error(
        "the place of this coordinate system is unknown",
        "give it with --origin, such as G55=X,Y,Z; for SUPA, G53 and G153 give --machine-zero X,Y,Z",
    ),
    "G610": warning(
        "the way of the tool while the plane swivels depends on another machine",
        "check the way there: the next move goes straight to the first place in the new plane",
    ),
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
    "L403": error("a value is not possible", "correct it"),
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
    "L440": _TAPPING,
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
    "L446": error("the curve cannot be followed", "let the CAM system write the motion in plain points and arcs"),
}
