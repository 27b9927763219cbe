# SPDX-License-Identifier: LGPL-2.1-or-later
"""CAM job: the rules of jobs and operations in FreeCAD (J)."""

from __future__ import annotations

from pkm_post.model.rules.rule import TAPPING, Rule, error, warning

_INTACT_COPY = "use an intact copy of the document, such as its backup file (.FCBak)"

CAM_JOB_RULES: dict[str, Rule] = {
    # J1: the CAM job
    "J101": error("the file cannot be opened as a FreeCAD document", "check the path, or save the document again"),
    "J102": error("there is no CAM job to post", "add a Job in the CAM workbench, or name the job with --job"),
    "J103": error(
        "the job has no active operation that moves the tool",
        "add or activate an operation, or mend one that CAM computed without a move, and recompute",
    ),
    "J104": error("the command is unknown or not allowed here", "remove it, or use a G0, G1, G2 or G3 move"),
    "J105": error("a cutting move has no feed", "set a feed above zero in the tool controller"),
    "J106": error("an arc in this plane is not supported", "use XY-plane arcs (G17), or straight moves"),
    "J107": error("the arc does not fit its end points", "regenerate the operation; the radii must agree to 0.005 mm"),
    "J108": error(
        "a dress-up or array that does not support tool-axis words contains moves with them",
        "remove it, or apply it to an operation without tool-axis words; Rotate operation makes copies around an axis",
    ),
    "J109": error("only some of the cutting moves have a tool axis", "give every G1 of the operation I J K words"),
    "J110": error("the tool axis has no direction", "give I J K words that are not all zero"),
    "J111": error(
        "two fixtures of the job are in the same place", "give the second one its own with --origin NAME=X,Y,Z"
    ),
    "J112": error("the operation has no tool controller", "choose a tool controller for it"),
    "J113": error(
        "the gauge length of the tool is unknown or too long",
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
    "J121": error("a property of a document object has an invalid value", "correct it in the property editor"),
    "J122": error(
        "the drilling cycle cannot be executed",
        "correct its words; cycles are drilled along Z (G17), after a move to a known height, in operations without"
        " tool-axis words",
    ),
    "J123": TAPPING,
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
        "recompute the operation and correct what CAM says of it in the Report view, or deactivate it",
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
    "J137": error(
        "the document is being recomputed, and the paths of its operations are not complete",
        "wait for the end of the recompute, then post or check again",
    ),
    "J138": warning(
        "an option gives the place of a fixture that the job does not have, or has as its first one",
        "correct its name, or leave it out; the first fixture is where --work-offset puts it",
    ),
    "J139": error(
        "a job with several fixtures is to be copied as a whole",
        "make the copies in the job, as operations of Mirror or Rotate, or leave --copies out",
    ),
    "J140": warning(
        "Split Output of the job is not followed: one program holds all of it",
        "deactivate operations, or take fixtures out of the job, to post a part of it",
    ),
    "J141": warning(
        "CAM computed an active operation without a cutting move",
        "see CAM's message in the Report view; correct its tool, geometry or depths, or deactivate it",
    ),
    "J142": error(
        "probing is not part of a program, which is computed before it runs",
        "deactivate the operation; pkm-post pmac measure probes between programs",
    ),
    "J143": error(
        "the tool controller and its tool bit turn the spindle in different directions",
        "set SpindleDir of the controller and SpindleDirection of the tool bit alike; for a standing spindle, speed 0",
    ),
    "J144": error(
        "each command needs one code, at its start",
        "write G1 Y5 for Y5 and M3 S9000 for S9000, and a second code on a line of its own",
    ),
    "J145": warning(
        "a state that an operation switched is reset at the next one",
        "set the speed in a tool controller and CoolantMode in the operation, or repeat the code there",
    ),
    "J146": error(
        "FreeCAD reads a line of a Custom operation as something else, or leaves it out",
        "write one code and its words, with decimal points, and a comment in ( ) on a line of its own; recompute",
    ),
    "J147": error(
        "several CAM jobs may be meant",
        "name one with --job by a label or name that no other job has; change a label in FreeCAD if there is none",
    ),
    "J148": error(
        "FreeCAD reads the label or comment of an operation as commands when it opens the document",
        "write it without ( and ), mark the operation to be recomputed, recompute and save; then open the document"
        " again",
    ),
    "J149": warning(
        "CAM leaves out holes, faces or holding tags of an operation",
        "see CAM's message, if any, in the Report view; enable or move them, take a narrower tool, or remove those that"
        " are not meant",
    ),
    "J150": warning(
        "the stock has changed since CAM computed the operation",
        "mark the operation to be recomputed, and recompute; then look at its depths and its path",
    ),
    "J151": warning(
        "the path of the operation is not the one that CAM computes for the present model and stock",
        "mark the operation to be recomputed, and recompute; then look at its depths and its path",
    ),
}
