# SPDX-License-Identifier: LGPL-2.1-or-later
"""The vocabulary: the treatment of each major word.

A word has a handler, or does not affect the motion and is ignored, or is refused by name because ignoring it would
change the motion. All other words are reported once with their count.
"""

from __future__ import annotations

import re
from collections.abc import Callable

from pkm_post.reading.cldata import arc_moves, arcs, cutcom, feeds, frames, guided, holes, points, tools
from pkm_post.reading.cldata.course import Course
from pkm_post.reading.cldata.feeds import shown
from pkm_post.reading.cldata.statements import Statement

Handler = Callable[[Course, int, Statement], None]


def _operation(course: Course, row: int, statement: Statement) -> None:
    """TOOL PATH/name,TOOL,tool of NX, OPERATION NAME of CATIA, FEATNO of Creo: start of an operation."""
    if statement.word == "TOOL PATH":  # the header of each path defines the meaning of its points
        course.points_said = None
    name, _, tool = statement.text.partition(",TOOL,")
    course.insert = tool or course.insert
    number = statement.numbers
    course.starts.append((row, len(course.operations)))
    course.operations.append(f"{statement.word} {number[0]:g}" if number else name.strip())


def _tlcomp(course: Course, row: int, statement: Statement) -> None:
    """TLCOMP/OFF ends a control-side compensation, which no path here uses; any other form requests one."""
    if statement.items != ("OFF",):
        course.tell("L401", row, f"TLCOMP/{shown(statement)}")


def _syn(course: Course, row: int, statement: Statement) -> None:
    """SYN/'new','old',... redefines words: refused where such a word follows."""
    words = [item.strip("'\"") for item in statement.words[::2]]
    later = "\n".join(course.statements.lines.text[course.statements.index[row] + 1 :])
    renamed = [word for word in words if re.search(rf"(?<![\w-]){re.escape(word)}(?![\w-])", later, re.IGNORECASE)]
    if renamed:
        course.tell("L401", row, f"SYN/{shown(statement)} with {renamed[0]} behind it")


def _fini(course: Course, row: int, statement: Statement) -> None:
    course.ended = True


HANDLERS: dict[str, Handler] = {
    "GOTO": points.goto, "FROM": points.single, "GODLTA": points.single, "TLAXIS": points.tlaxis,
    "MULTAX": points.multax,
    "": points.bare, "CIRCLE": arcs.circle, "CYLNDR": arcs.circle, "MOVARC": arcs.movarc,
    "_CIRCLE": arcs.commented, "_CYLNDR": arcs.commented,
    "INDIRV": guided.indirv, "INDIRP": guided.indirp, "PSIS": guided.psis, "AUTOPS": guided.autops,
    "TLON,GOFWD": guided.tlon,
    "ARCSLP": arc_moves.arcslp, "ARCDAT": arc_moves.arcdat, "ARCMOV": arc_moves.arcmov,
    "GOCLW": arc_moves.gocclw, "GOCCLW": arc_moves.gocclw, "CW": arc_moves.ccw, "CCW": arc_moves.ccw,
    "HELICAL": arc_moves.helical,
    "CYCLE": holes.cycle,
    "FEDRAT": feeds.fedrat, "RAPID": feeds.rapid, "SPINDL": feeds.spindl, "COOLNT": feeds.coolnt,
    "DELAY": feeds.delay, "DWELL": feeds.delay, "STOP": feeds.stop, "OPSTOP": feeds.stop,
    "CUTTER": tools.cutter, "TLDATA": tools.tldata, "LOADTL": tools.load, "LOAD": tools.load, "TOOLNO": tools.load,
    "INSERT": tools.insert,
    "CUTCOM": cutcom.cutcom, "CUTCOM_GEOMETRY_TYPE": cutcom.geometry_type, "_POINTS": cutcom.points_are,
    "UNITS": frames.units, "UNIT": frames.units, "MSYS": frames.frame, "CSYS": frames.frame, "CATIA0": frames.frame,
    "ORIGIN": frames.origin, "TRANS": frames.trans, "TRACUT": frames.trans, "TRNTYP": frames.trntyp,
    "TLCOMP": _tlcomp, "SYN": _syn,
    "TOOL PATH": _operation, "OPERATION NAME": _operation, "FEATNO": _operation, "FINI": _fini,
}  # fmt: skip
"""Words with a handler."""

PASSED_OVER = frozenset({
    "PARTNO", "PPRINT", "TPRINT", "LETTER", "DISPLY", "REMARK", "MACHIN", "PPWORD", "PAINT", "END-OF-PATH", "SETUP",
    "SELECT", "SWITCH", "END", "REWIND", "LINTOL", "INTOL", "OUTTOL", "TOLER", "SET",
    "CSI_SET_FLUTE_LENGTH", "CSI_SET_EXTENSION_LENGTH", "CLPRNT", "NOPOST", "LEADER", "CLEARP",
    "MODE", "PRINT", "SEQNO",
})  # fmt: skip
"""Words without effect on the motion."""

REFUSED = frozenset({
    "SPLINE", "BSPLINE", "NURBS",
    "POLYGON", "ROTABL", "ROTHED", "ROTATE", "PIVOT", "TURRET", "MIRROR", "COPY", "INDEX", "LOOPST", "LOOPND", "JUMPTO",
    "MACRO", "CALL", "IF", "DO", "GO", "GOFWD", "GOBACK", "GOLFT", "GORGT", "GOUP", "GODOWN", "OFFSET", "GOHOME",
    "TLLFT", "TLRGT", "TLON", "TLLFT,GOFWD", "TLRGT,GOFWD", "TLON,GOLFT", "TLON,GORGT", "THREAD", "PITCH", "REFSYS",
    "RETRCT", "CALSUB", "DEFSUB", "ENDSUB", "PIVOTZ", "PROBE", "DNTCUT",
})  # fmt: skip
"""Words that change the motion and are not supported."""
