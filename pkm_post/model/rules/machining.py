# SPDX-License-Identifier: LGPL-2.1-or-later
"""Machining: the rules of the machine file (M), of what the machine can reach (K), and of tool paths (N)."""

from __future__ import annotations

from pkm_post.model.rules.rule import Rule, error, warning

_PLACE = "; Find a place in the panel of Reach and python3 -m pkm_post reach --place look for one that suffices"

MACHINING_RULES: dict[str, Rule] = {
    # M1: the machine file
    "M101": error("the machine file cannot be read", "check the path; python3 -m pkm_post machine list shows presets"),
    "M102": error("the machine file is not valid TOML", "correct it at the place shown"),
    "M103": error("an entry is missing", "add it; docs/machine-file.md describes every entry"),
    "M104": error("an entry has the wrong form", "correct it; docs/machine-file.md describes every entry"),
    "M105": error("an entry is not known", "remove it or correct its spelling"),
    "M106": error("entries contradict each other", "correct the one shown, or what it is compared with"),
    "M107": error(
        "an entry of this machine is unknown", 'measure it or ask the maker, and write it in place of "unknown"'
    ),
    "M108": warning(
        "the machine cannot reach its home pose", "correct tool_path.home_tip, or the limit that is in the way"
    ),
    "M115": warning(
        "the machine cannot reach the tool-change pose", "correct tool_change.nose, or the limit that is in the way"
    ),
    # M2: calibration of the machine
    "M201": error("the measurements cannot be read", "check the path; docs/machine-file.md describes the file"),
    "M202": error("a row of the measurements is malformed", "correct it; docs/machine-file.md describes the file"),
    "M203": error("no machine fits the measurements", "look for wrong rows, units and frames in the measurements"),
    "M204": error("the calibrated machine cannot be written", "correct the faults reported for the written file"),
    "M205": warning("the poses do not determine all parameters", "measure at more poses, with more tilt and spin"),
    "M206": error("the machine file is too large", "remove what docs/machine-file.md does not describe"),
    "M207": error("the machine file is nested too deeply", "write tables and lists as docs/machine-file.md has them"),
    "M208": error("there are more faults than are shown", "correct those that are shown, then check again"),
    # K1: what the machine can reach
    "K101": error(
        "a strut would be too short", f"move or turn the part on the table, or use another tool length{_PLACE}"
    ),
    "K102": error(
        "a strut would be too long", f"move or turn the part on the table, or use another tool length{_PLACE}"
    ),
    "K103": error("a base joint would swing too far", f"tilt the tool less, or move the part{_PLACE}"),
    "K104": error("a platform joint would swing too far", f"tilt the tool less, or move the part{_PLACE}"),
    "K105": error("the path comes too close to a singular pose", f"tilt the tool less, or move the part{_PLACE}"),
    "K106": error(
        "the tool axis turns by half a turn in one move",
        "insert a move that defines the direction of rotation; where the part is turned over, post each side by"
        " --side N, with its work offset",
    ),
    "K107": error("the spindle does not support this speed", "program a speed within its limits"),
    "K108": error(
        "the work offset is unknown to the machine",
        "add it to the machine file, or pass --work-offset, or --origin for a further fixture of a CAM job",
    ),
    "K109": error("the matrix is not a rotation, a mirror or a shift", "use a matrix without scale or shear"),
    "K110": warning("the feed is beyond the machine and is limited", "program a feed that the machine can run"),
    "K112": error("cutter compensation would leave its plane", "compensate before the path is turned or mirrored"),
    "K113": error("two struts come too close to each other", "turn the platform about the tool axis, or move the part"),
    "K114": error("a strut comes too close to the spindle or its platform", "tilt the tool less, or turn the platform"),
    "K115": error("a strut comes too close to an object on the table", "move the part or the fixture"),
    "K116": error("the spindle or holder comes too close to an object on the table", "use a longer tool, or tilt it"),
    "K117": error("the spindle or holder comes too close to the part", "use a longer tool, or tilt it"),
    "K118": warning("a strut cannot keep up with the feed, and the tool will be slower", "program a lower feed"),
    "K119": error("the machine is too compliant along the surface normal", "tilt the tool less, or move the part"),
    "K120": error("the tool axis is perpendicular to the plane of the spin rule", "choose another spin"),
    "K121": error("a strut comes too close to the part", "move or turn the part on the table"),
    "K122": error(
        "a pass cannot be reversed: its approach and retract moves are unknown",
        "lift the tool along its axis between the passes, or do without climb milling",
    ),
    "K123": warning(
        "the path begins with a rapid move to a point in the material, where the original ends",
        "check that the point is free, or lift the tool along its axis at the end of the original",
    ),
    "K124": warning("a reversed pass begins at its deep end", "check that the cutter can start there"),
    "K125": error(
        "an event lies within a pass that is to be reversed",
        "move it between the passes, or do without climb milling",
    ),
    "K126": error("an arc begins at a change to a tool of another length", "make a straight move before the arc"),
    "K127": error("a move takes longer than a day", "give it a higher feed"),
    "K128": warning(
        "a strut cannot keep up with a rapid move, and the tool will be slower there",
        "nothing has to be done, the move takes longer; tool_path.rapid_speed of the machine file is the speed of rapid"
        " moves",
    ),
    "K130": error(
        "the shank of the tool goes into the part",
        "use a tool with longer cutting edges or a thinner shank, or tilt it",
    ),
    "K131": error(
        "a rapid move takes the cutter through the part", "raise the clearance and retract heights of the operation"
    ),
    "K132": warning(
        "the cutter goes deeper into the part than its surface",
        "check the depths and the flank of the cutter",
    ),
    "K133": error(
        "the tool or the machine comes too close to a fixture", "move the fixture or the path, or use a longer tool"
    ),
    "K134": error(
        "a body other than the cutter enters uncut stock",
        "rough the part before, use a longer tool, or give the stock as it is before the first operation",
    ),
    "K135": warning(
        "a body other than the cutter enters stock that may still be there",
        "check that it is cut before, or give the stock as it is before the first operation",
    ),
    "K136": error(
        "a rapid move goes through uncut stock",
        "raise the clearance and retract heights, or give the stock as it is before the first operation",
    ),
    "K137": warning(
        "a rapid move goes through stock that may still be there",
        "check that it is cut before, or give the stock as it is before the first operation",
    ),
    "K138": error(
        "the solid cannot be read",
        "write it as an STL file, ASCII or binary, in mm and in work coordinates, or as STEP where FreeCAD is"
        " installed",
    ),
    "K139": warning(
        "the mesh of the stock is not closed, and only its surface is checked", "write a closed solid as STL"
    ),
    # K14: tools, tool changes and the spindle
    "K140": error(
        "the tool is larger than the spindle accepts",
        "use a smaller tool, or correct spindle.largest_tool_diameter or spindle.longest_tool of the machine file",
    ),
    "K141": error(
        "the tip of a tool would be below the safe height at the tool-change pose",
        "raise tool_change.nose, lower tool_change.safe_height, or use a shorter tool",
    ),
    "K142": error(
        "the tool is tilted too far to be retracted along its axis to the safe height",
        "tilt the tool less before the tool change and after it",
    ),
    "K143": error(
        "the program cuts after a tool change without starting the spindle",
        "start the spindle with M3 or M4 between the tool change and the cut",
    ),
    "K144": warning(
        "the diameter of a tool is unknown, and the limit of the spindle is not checked",
        "give the diameter: --tool NUMBER=D for G-code, the tool of the CAM job, or the tool statement of CL data",
    ),
    "K145": error(
        "the motion takes longer than can be planned",
        "raise the feeds, or the speeds and accelerations of the machine file; or post fewer operations at a time",
    ),
    "K146": error("the tolerance of a move is too small", "raise P of its G64, or leave P out"),
    "K147": error("the platform is turned too far about the tool axis", "write the spin within a few turns"),
    "K148": error(
        "a copy of the program would be reached by a feed move",
        "begin the program with a rapid move (G0, RAPID) above the part",
    ),
    "K149": error(
        "an operation has the name of moves that are added for tool changes", "give the operation another name"
    ),
    # K15: a program that begins at a line
    "K150": error(
        "the program has no line to begin at",
        "name a line up to the last one that moves, and its operation: --from-line OPERATION:N",
    ),
    "K151": error(
        "the tool is tilted too far to come down to the line along its axis",
        "begin at an earlier line, where it is tilted less",
    ),
    "K152": warning(
        "M codes of the machine before the line are not repeated",
        "bring the machine into the state that they left it in, repeat them with --repeat-codes, or begin at an earlier"
        " line",
    ),
    "K153": error("the program has no such side", "name one of its sides, counted from 1: --side N"),
    "K154": error(
        "a thread needs a spindle that is an axis, and the machine file states none",
        "state [spindle.axis] and its codes in the machine file if the spindle is one, or mill the threads as helices",
    ),
    "K155": error("a thread is not made of feed moves along the tool axis", "tap along the tool axis"),
    "K156": warning(
        "the spindle as an axis cannot keep up with the feed of a thread, and the thread will be slower",
        "nothing has to be done, the lead is kept; a lower spindle speed of the thread has the same effect",
    ),
    "K157": error(
        "threads cannot be tapped in this way", "leave that option out, or post the threads as a program of their own"
    ),
    "K158": error(
        "the machine file states no stiffness of the struts",
        "state struts.stiffness in it, and struts.rigidity where screws are long",
    ),
    "K159": error(
        "the tool would point straight up, where its spin is not defined",
        "turn the part over, and post what is cut from below as a program of its own",
    ),
    "K160": warning(
        "corners between short lines slow the tool",
        "request the tolerance shown if the part allows it: --tip-tolerance and --axis-tolerance, or in the panel; or"
        " let the CAM system compute its points more closely",
    ),
    # N1: surface normals, and compensation with them
    "N101": error("a contact point, normal or tool axis is not a number or has no direction", "regenerate the path"),
    "N102": error("the surface is undercut: the corner of the cutter does not touch it", "lean the tool further back"),
    "N103": error("the normal is parallel to the tool axis and no direction of travel is known", "lean the tool"),
    "N104": error(
        "the surface is flatter than the bottom of the cutter: its corner does not touch it",
        "lean the tool, or take a cutter with a flatter bottom",
    ),
    "N105": warning(
        "normal and tool axis are nearly parallel, and the side on which the cutter lies depends on rounding",
        "lean the tool, or give normals with more decimals",
    ),
    "N106": warning(
        "the tip jumps sideways where normal and tool axis are nearly parallel",
        "lean the tool there, or take a ball end mill",
    ),
    "N107": error("an arc would not stay an arc in 3D compensation", "let the CAM system write straight moves"),
    "N108": error("there are no surface normals to compensate with", "let the CAM system write normals"),
    "N109": error(
        "the cutter the path was made for is not known",
        "pass --tool NUMBER=D,R with its diameter and corner radius; in a CAM job complete the tool bit",
    ),
    "N111": error(
        "a cutting move ends on no face of the model",
        "correct the operation; give the faces it cuts, a LeadLength for leads, or a wider Tolerance",
    ),
    "N112": error(
        "a point is at an edge between faces with different normals",
        "choose the face that is cut in the property Faces, or keep the path off the edge",
    ),
    "N113": error(
        "the surface normal or the tool axis turns too much from one point to the next",
        "put the points of the operation closer together, end the cut at the edge, or allow more as ChordTolerance",
    ),
    "N114": error(
        "the tool leans in the direction of travel, and there is none at a contact point",
        "keep the tool axis of the operation, or let the cut continue from there",
    ),
    "N115": error("there is no face to touch", "choose the faces again, or leave Faces empty for all of the model"),
    "N116": error("compensation does not support the shape of the tool", "use a flat, ball or bull nose end mill"),
    "N117": error(
        "the corner radius of a cutter is not known",
        "pass it behind the diameter, 0 for a flat end mill, D/2 for a ball nose: --tool NUMBER=D,R for the cutter the"
        " path was made for, --actual-tool NUMBER=D,R for the one in the spindle",
    ),
    "N118": error("the program has no such tool", "pass --actual-tool with the number of a tool of the program"),
    "N119": error("points of contact are not tool tips", "post the program, which makes tips of them by the cutter"),
    # N2: cutter compensation in a plane
    "N201": error("cutter compensation begins or ends on an arc", "begin and end it on a straight move"),
    "N202": error("the tool is too large for the block", "use a smaller tool, or let such blocks be removed"),
    "N203": warning("the tool is too large for the block, which is left out", "check what is not cut there"),
    "N204": error("the tool would cut into the contour", "use a smaller tool, or change the contour there"),
    "N205": warning(
        "the tool cuts into the contour where compensation begins, ends or changes its side",
        "begin and end it farther from the contour, at right angles to it",
    ),
    "N206": error(
        "the plane of cutter compensation is not unique here", "keep plane and tool axis, and arcs in the plane"
    ),
    # N3: paths over a surface
    "N301": error("only closed lines along u or v can be joined to a spiral", "choose Zigzag or One way"),
    "N302": error("the faces have no area to cover", "choose faces that have an area"),
    "N303": error(
        "the cutter does not fit into a hollow of the surface, so there is no stepover for a scallop height",
        "take a smaller cutter, or give the stepover as a distance",
    ),
    "N304": error(
        "the tool is tilted too far to be lifted along its axis",
        "lower ConeLimit, the field Cone limit of the operation, or lower Lead and Tilt",
    ),
    "N305": error("the tolerances cannot be kept by straight moves", "raise the tolerances, or lean the tool less"),
    "N306": warning("the surface has an edge, where the tool axis jumps", "cover the faces at the edge one by one"),
    "N307": error("the path lies above the height at which the tool traverses", "raise SafeHeight and ClearanceHeight"),
    "N308": error("no face is chosen", "add faces as base geometry"),
    "N309": error("a value is not valid", "correct the property"),
    "N310": error("the machine cannot reach the part with the tool upright", "move the part, or take another tool"),
    "N311": error(
        "the cutter goes deeper into the model than ChordTolerance",
        "lean the tool away from what is beside the face, take a smaller cutter, or choose other faces; CheckSpacing 0"
        " shows the path without the measurement",
    ),
}
