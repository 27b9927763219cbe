# SPDX-License-Identifier: LGPL-2.1-or-later
"""Results: the rules of the trajectory file (T), controller (C), certificate (V) and files (F)."""

from __future__ import annotations

from pkm_post.model.rules.rule import Rule, error, warning

RESULT_RULES: dict[str, Rule] = {
    # T1: the binary trajectory
    "T101": error("the file is not a trajectory file", "give a .pkmt file"),
    "T102": error("the trajectory file has a version that this program does not know", "use a newer PKM Post"),
    "T103": error("the trajectory file is damaged", "make it again from its source"),
    "T104": error(
        "the trajectory was made for another machine", "name that machine, as by --machine, or post again for this one"
    ),
    "T105": error("the trajectory file does not state the requested tolerances", "post the job again"),
    "T106": error("the trajectory file is inconsistent", "make it again from its source"),
    "T107": error("the trajectory exceeds the limits of its machine", "post the job again for this machine"),
    # C1: the controller's program
    "C101": error("the program has an unknown or misplaced line", "post the job again; do not edit the program"),
    "C102": error(
        "the program is larger than the controller's memory and has no rest where it can be split",
        "post fewer operations at a time, or put a stop into the job where the tool is free; or post it with a higher"
        " controller.memory_words, and play the trajectory (pmac play)",
    ),
    "C103": error("the line is too long for the controller", "use fewer decimals in the machine file"),
    "C104": error("an event has no code of the controller", "give it one under [controller.codes] in the machine file"),
    "C105": error(
        "the parts of the program do not belong together", "keep all parts of one posting together; post the job again"
    ),
    "C106": error("the table has a malformed line", "post the job again; do not edit the table"),
    "C107": error("the table differs from the motion it was made from", "post the job again; do not edit the table"),
    "C108": error(
        "the program has a character that the controller does not accept, or executes immediately",
        "name a motion program as it was posted, of printable ASCII in lines that end with LF or CR LF, or post the job"
        " again",
    ),
    "C109": error(
        "the program was changed: the SHA-256 in its heading is not that of its lines",
        "post the job again; do not edit the program",
    ),
    "C110": error(
        "nothing shows that the program was certified",
        "keep the trajectory file, the report and all parts of one posting in the folder of the program, or post the"
        " job again; pmac --uncertified loads it nevertheless",
    ),
    "C111": error(
        "the program has tools of several lengths, and the form in tip and axis knows one",
        "post the operations of each tool as a program of their own, or load the program of strut lengths",
    ),
    "C115": error(
        "the program does not hold within the permitted changes at the machine",
        "permit less, by --tool-range and --origin-range, or move the part; the faults that follow are those at a"
        " corner of this range",
    ),
    "C116": error(
        "the program does not hold with this segment time",
        "take a shorter one for --segment-time and SegMoveTime against deviations and jerk, more tolerance against"
        " deviations, a dwell where the tool stops without a code, or 0, which is no segmentation; the faults that"
        " follow are those of the motion in segments",
    ),
    # C2: manual moves at the controller
    "C201": error(
        "the command moves nothing", "give a direction and a distance, or a code that switches, such as M3 or M8"
    ),
    "C202": error("no pose of the platform belongs to the strut lengths on the way", "jog less far, or jog the tool"),
    "C203": error(
        "a line that is entered by hand cannot change the tool", "change it by hand, and enter its gauge length"
    ),
    "C204": error("the motion needs more memory than one program has", "jog less far, or program a higher feed"),
    "C205": error(
        "the source lines of the program are unknown",
        "keep all results of a posting together in one folder, or post the job again",
    ),
    "C207": error(
        "the trajectory has no line to begin with",
        "name a line up to the last one that moves, and the operation it belongs to with --operation",
    ),
    "C208": error(
        "the trajectory has threads, which are neither played nor stepped through block by block",
        "run its motion program: pmac run, or Load and Start of the panel",
    ),
    "C209": error(
        "a change at the machine does not fit the program",
        "name tools of the program; where an arc follows a change of a tool in its place, post again with the new"
        " length",
    ),
    "C210": error(
        "another client controls the machine",
        "wait until it ends, or end it; if it no longer exists, stop the machine first (hold, then"
        " abort); status, monitor, hold and abort remain available",
    ),
    "C211": error(
        "another client has taken control of the machine",
        "check what the machine does, and start again when the other client has ended",
    ),
    "C212": error(
        "the lock of the controller cannot be kept on this computer", "make the folder for temporary files writable"
    ),
    "C213": error(
        "the variables that identify the controlling client have invalid values",
        "keep P8187 to P8191 free in the programs of the controller; P8187..8191=0 in the terminal frees them",
    ),
    "C214": error(
        "a program buffer is open that this port cannot close",
        "close it where it was opened, or disconnect what loads a program there",
    ),
    "C215": error(
        "the file with the known host keys cannot be read",
        "correct or remove that line, or name another file with --known-hosts",
    ),
    "C216": error(
        "no controller answers as expected",
        "check power, cable, address and port, --baud and --parity, and that no other program has the port open",
    ),
    "C217": error(
        "the computer at this address does not prove that it is the controller",
        "check the address; if the host key is the controller's, add it: ssh-keyscan -p PORT HOST >>FILE, and"
        " --known-hosts FILE",
    ),
    "C218": error(
        "the computer of the controller denies access",
        "offer a key, by an agent or in ~/.ssh, or the password in PKM_PMAC_PASSWORD",
    ),
    "C220": error(
        "the touch probe is touched before its move",
        "jog it free; if it is free, state the value of its input with --input, as M1000=0",
    ),
    "C221": error("the touch probe met nothing", "begin closer, or allow a longer way with --within"),
    "C222": error(
        "the touch probe stays touched where its move began", "jog it free and look at the probe and its input"
    ),
    "C223": error(
        "the touch probe was touched on a way that should be free",
        "jog it free, and give --diameter, --depth and --clearance as the part has them",
    ),
    "C224": error(
        "the code is not supported in a line that is entered by hand",
        "use others; M codes that the controller is to get belong in controller.codes.functions of the machine file",
    ),
    "C225": error("a cutting move that is entered by hand has no feed", "write F above zero in the line"),
    "C226": error(
        "the place of this coordinate system is unknown",
        "set it in the machine file: under work_offsets, or for the machine's zero in part_programs.machine_zero",
    ),
    "C227": error(
        "cutter compensation needs the diameter of the tool", "write the diameter as D, after G41.1 or G42.1"
    ),
    "C228": error("the jog leads out of the machine's reach", "jog less far, or in another direction"),
    # V1: the certificate
    "V101": error("the tool tip leaves the programmed path", "request a wider tolerance, or report this as a fault"),
    "V102": error("the tool axis leaves the programmed axis", "request a wider tolerance, or report this as a fault"),
    "V103": error("a strut is faster than the machine allows", "report this as a fault of the feed planner"),
    "V104": error("a strut accelerates more than the machine allows", "report this as a fault of the feed planner"),
    "V105": error("the program does not start or end at rest", "post the job again; do not edit the program"),
    "V106": error("a strut leaves its stroke", "move or turn the part on the table"),
    "V107": error("no pose of the platform belongs to the strut lengths", "post the job again; do not edit it"),
    "V108": error("the feed is exceeded", "report this as a fault of the feed planner"),
    "V109": error("the program does not execute the events of the job", "post the job again; do not edit it"),
    "V110": error("the program does not follow the whole path", "post the job again; do not edit it"),
    "V111": error("the struts deviate from their plan", "post the job again; do not edit the program"),
    "V112": error("the acceleration of a strut changes too fast", "report this as a fault of the feed planner"),
    "V113": error("the tool axis turns faster than the machine allows", "report this as a fault of the feed planner"),
    "V114": error("the tip accelerates more than the machine allows", "report this as a fault of the feed planner"),
    "V115": error("the acceleration of the tip changes too fast", "report this as a fault of the feed planner"),
    "V116": error("points are too close together for the controller", "report this as a fault of the feed planner"),
    "V117": error(
        "the point rate is too high for the controller",
        "lower the feed, request a wider tolerance, or correct controller.block_rate of the machine file",
    ),
    "V118": error(
        "the program has too few decimals",
        "state more in controller.length_decimals and controller.speed_decimals, and controller.line_limit for longer"
        " lines if the controller accepts them",
    ),
    "V119": error(
        "the path needs points closer together than the controller accepts",
        "request a wider tolerance, lower the feed, or correct controller.shortest_interval of the machine file",
    ),
    "V120": error(
        "the depth of a thread does not match the turns of the spindle",
        "post the job again; do not edit the program. If it was just posted, state more controller.length_decimals, or"
        " a wider spindle.axis.lead_tolerance",
    ),
    "V121": error(
        "the spindle turns faster in a thread than the machine allows", "report this as a fault of the feed planner"
    ),
    "V122": error(
        "the spindle accelerates more in a thread than the machine allows", "report this as a fault of the feed planner"
    ),
    # V13: how a program ends
    "V130": warning(
        "the spindle still turns at the end of the program", "let the program stop it, by M5, M2 or SPINDL/OFF"
    ),
    "V131": warning(
        "the program ends with the tool low",
        "check that the program is complete, and retract the tool at its end if it has to be clear",
    ),
    # F1: files
    "F101": error("the output cannot be written", "check the folder, its permissions and the free space"),
    "F102": warning(
        "the picture was not made: matplotlib is missing or cannot be imported",
        "install it, as by python3 -m pkm_post install matplotlib, in a version that fits NumPy",
    ),
    "F103": error("the file cannot be read", "check the path and its permissions"),
    "F104": warning(
        "the folder has files of an earlier result that do not belong to this one",
        "remove them, so that they are not run with this program",
    ),
    "F105": error(
        "results of two jobs would have the same name",
        "give them names that differ in letters or digits, not in case or an ending such as -setup, or post to"
        " different folders",
    ),
    "F106": error(
        "results are not those that were posted together",
        "post again, or bring back every file that the manifest lists",
    ),
    "F107": warning(
        "no manifest lists this file and its results",
        "post again, and keep the manifest and all that it lists with the program",
    ),
    "F108": error("the manifest of results cannot be read", "post again, or bring back the manifest"),
    "F109": error(
        "another process is moving its files into the folder",
        "try again when it has ended, or choose another folder",
    ),
    "F110": error(
        "not all files were replaced, and earlier files could not be restored",
        "close the programs that have the named files open, remove them, and try again",
    ),
    "F111": error(
        "CAM's dialog saves one text, and this result has several files",
        "post with Post of the PKM Post workbench, which writes them together",
    ),
    "F112": warning(
        "CAM's dialog saves the program alone",
        "post with Post of the PKM Post workbench to have its report, trajectory and set-up file beside it: a program"
        " without them is not loaded into the controller (C110)",
    ),
    "F113": error(
        "a file is open in another program",
        "close it there, or wait until a virus scanner or a cloud folder has done with it, and try again",
    ),
    "F114": error(
        "a result cannot have this name",
        "choose another name for the program or the job, or a folder with a shorter path",
    ),
    "F115": error("the number of threads is not a whole number above zero", "set PKM_THREADS to one, or do not set it"),
    "F116": error("the list of jobs is not valid", "write it as docs/command-line.md describes it"),
    "F119": error(
        "there is something of this name already",
        "choose another folder for the result, or remove what is there",
    ),
    "F120": error("a result would replace a file that it is made from", "choose another name or folder for the result"),
    "F121": error("the encoding of the file is not read", "save it as UTF-8 text"),
    "F122": error("files with this ending are not read", "give the file the ending of its kind"),
    "F130": error(
        "there is not enough memory",
        "close other programs, do fewer operations or files at a time, or use a computer with more memory",
    ),
    "F140": error(
        "FreeCAD could not be started",
        "install FreeCAD 1.0 or newer, or name its FreeCADCmd in the environment variable FREECADCMD",
    ),
    "F141": error(
        "FreeCAD ended before the command had run in it",
        "read the output above; FREECADCMD, if set, must name FreeCADCmd of FreeCAD 1.0 or newer",
    ),
    "F142": error(
        "a result is missing",
        "let no other post write into the folder at the same time, and nothing else remove its files, and post again",
    ),
    "F143": error(
        "a FreeCAD document is read only inside FreeCAD",
        "run the script in FreeCADCmd, or post with python3 -m pkm_post post, which starts it",
    ),
    "F144": error(
        "a process that posts a file did not run to its end",
        "start fewer at a time with --jobs, as memory or another limit may be short, and post again",
    ),
    # U: arguments of the command line
    "U101": error("there is no such command or option", "correct it; --help lists them"),
    "U102": error("an argument is missing", "add it; --help says what it is"),
    "U103": error("an argument is not valid", "correct it; --help says what it may be"),
}
