# SPDX-License-Identifier: LGPL-2.1-or-later
"""G-code: the rules of part programs in G-code and in Siemens's language (G)."""

from __future__ import annotations

from pkm_post.model.rules.rule import TAPPING, Rule, error, warning

GCODE_RULES: dict[str, Rule] = {
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
    "G208": error("a name is malformed", "write names as <name>, of letters, digits, blanks, _, ., : and -"),
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
    "G215": warning("another program of the file is not read", "put it into a file of its own to post it"),
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
    "G311": error(
        "this is not a label", "write a whole number that is not negative, or a name in < >, and its keyword"
    ),
    "G312": error("this is not allowed here", "call with call and end with endsub, or with M98 and M99"),
    "G313": error(
        "the program does not end",
        "change in each loop what its condition depends on; end with M30, not with a jump back; divide longer programs",
    ),
    "G314": error("subprograms call each other too deeply", "let none call itself, and nest calls less deeply"),
    "G315": error("a call has too many arguments", "pass at most 30"),
    "G316": error(
        "this is not a call of a subprogram",
        "write M98 P and L with whole numbers, P always, and no M99; G67 before what may not stand under G66",
    ),
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
        " part_programs.leave_out of the machine file; M codes that the controller is to get belong in"
        " controller.codes.functions there",
    ),
    "G402": error(
        "the code has no meaning on this machine",
        "write the program without it; an M code that does not move the tool can be left out with --leave-out",
    ),
    "G403": error("two codes of one group in a block exclude each other", "write them in two blocks"),
    "G404": error("no code of the block uses the word", "remove it, or add the code that it belongs to"),
    "G405": error("a word is missing", "add it"),
    "G406": error(
        "a word has an invalid value",
        "write one that its code takes: whole numbers of tools, offsets and turns, no feed, speed or dwell below 0",
    ),
    "G407": error(
        "the axis words are ambiguous",
        "write each code in a block of its own, with its words; @ and ^ without X and Y",
    ),
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
        "give the rotary axes with --axis-words, and write G43.4 before cuts with a tilted tool, G69 and G50.1 before"
        " words that tilt it",
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
    "G425": TAPPING,
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
        "the orientation of the tool to the tilted plane is unclear here",
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
    "G436": error(
        "no move has a known position",
        "give X, Y and Z in the first moves: a control would begin them wherever the tool stands",
    ),
    "G437": error(
        "controls differ in whether this code acts before the move of its block or after it",
        "write it in a block of its own",
    ),
    "G438": error(
        "controls forbid this while a rotation or mirror image is in force, or differ in where it leads",
        "write G69 or G50.1 before it, and G68 or G51.1 again after it",
    ),
    "G439": error("the axis words have no motion to apply to", "make G0 or G1 the motion of the block"),
    "G440": error("controls differ in whether this is incremental under G91", "write G90 before it"),
    "G441": error("a cycle needs a feed, which inverse time does not give", "write G94 and F before it"),
    "G442": error(
        "controls differ in which tool this loads, that of an earlier T or that of its block",
        "write T in a block of its own: before M6 that of the tool to load, after it that of the next one",
    ),
    "G443": warning(
        "the tool is still tilted, and the place to which this moves its tip depends on another machine:"
        " it is left out",
        "check the way there: the next move goes straight to the next known place; or retract in the plane, before G69",
    ),
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
    "G606": error("the value is not possible here", "write one of the type and in the range that is needed here"),
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
}
