# SPDX-License-Identifier: LGPL-2.1-or-later
"""Walk: dispatch the statements other than plain GOTO, in order, to the handlers of their words.

Enters: statements. Leaves: a course with the state that they set.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Collection

import numpy as np

from pkm_post.model import Array
from pkm_post.reading.cldata.arc_statements import (
    arcdat,
    arcmov,
    arcslp,
    ccw,
    circle,
    commented,
    gocclw,
    helical,
    movarc,
    tell_unused,
)
from pkm_post.reading.cldata.check_surface import autops, indirp, indirv, psis, tlon
from pkm_post.reading.cldata.cutcom import cutcom, geometry_type, points_are
from pkm_post.reading.cldata.cycle_statement import cycle
from pkm_post.reading.cldata.feeds import coolnt, delay, fedrat, rapid, shown, spindl, stop
from pkm_post.reading.cldata.frames import frame, origin, trans, trntyp, units
from pkm_post.reading.cldata.points import bare, goto, multax, single, tlaxis
from pkm_post.reading.cldata.state import Course
from pkm_post.reading.cldata.statements import Statement, Statements
from pkm_post.reading.cldata.tools import cutter, insert, load, tldata

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
    "GOTO": goto, "FROM": single, "GODLTA": single, "TLAXIS": tlaxis,
    "MULTAX": multax,
    "": bare, "CIRCLE": circle, "CYLNDR": circle, "MOVARC": movarc,
    "_CIRCLE": commented, "_CYLNDR": commented,
    "INDIRV": indirv, "INDIRP": indirp, "PSIS": psis, "AUTOPS": autops,
    "TLON,GOFWD": tlon,
    "ARCSLP": arcslp, "ARCDAT": arcdat, "ARCMOV": arcmov,
    "GOCLW": gocclw, "GOCCLW": gocclw, "CW": ccw, "CCW": ccw,
    "HELICAL": helical,
    "CYCLE": cycle,
    "FEDRAT": fedrat, "RAPID": rapid, "SPINDL": spindl, "COOLNT": coolnt,
    "DELAY": delay, "DWELL": delay, "STOP": stop, "OPSTOP": stop,
    "CUTTER": cutter, "TLDATA": tldata, "LOADTL": load, "LOAD": load, "TOOLNO": load,
    "INSERT": insert,
    "CUTCOM": cutcom, "CUTCOM_GEOMETRY_TYPE": geometry_type, "_POINTS": points_are,
    "UNITS": units, "UNIT": units, "MSYS": frame, "CSYS": frame, "CATIA0": frame,
    "ORIGIN": origin, "TRANS": trans, "TRACUT": trans, "TRNTYP": trntyp,
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


_ENDS = re.compile(r"\s*(?:END-OF-PATH|PPRINT\s*/\s*END-SECTION\s*,\s*PROCESS-END-PATH)\s*", re.IGNORECASE)


def tell_open_end(course: Course, passed_over: Collection[str]) -> None:
    """Report a missing end where one is required.

    Args:
        course: with all statements read.
        passed_over: words without effect on the motion.
    """
    needs_one = course.options.needs_end and not course.ended and len(course.statements)
    if needs_one and not _is_closed(course, passed_over):
        course.tell("L441", len(course.statements) - 1, "no FINI or END-OF-PATH behind it")


def _is_closed(course: Course, passed_over: Collection[str]) -> bool:
    """Whether only words without effect follow a statement that ends a file."""
    statements = course.statements
    for row in reversed(range(len(statements))):
        if _ENDS.fullmatch(statements.lines.text[statements.index[row]]):
            return True
        if statements.word(row) not in passed_over:
            return False
    return False


LARGEST = 1e9
"""Numbers beyond this are not plausible lengths, feeds or speeds."""


def walk(course: Course, bulk: Array) -> Array:
    """Process the statements that are not in the bulk.

    Args:
        course: is updated by them.
        bulk: (N,) mask of plain GOTO statements.

    Returns:
        (N,) mask of valid plain GOTO statements: those with plausible numbers before the end.
    """
    statements = course.statements
    possible = _possible(course)
    unknown: dict[str, list[int]] = {}
    for row in np.flatnonzero(~bulk & possible).tolist():
        word = statements.word(row)
        handler = _handler(course, word)
        if handler is not None:
            handler(course, row, statements.statement(row))
        elif word in REFUSED:
            course.tell("L401", row, word)
        elif word not in PASSED_OVER:
            unknown.setdefault(word, []).append(row)
        if course.ended:
            possible[row + 1 :] = False
            _tell_behind(course, row)
            break
    tell_unused(course)
    tell_open_end(course, PASSED_OVER)
    for word, rows in unknown.items():
        times = f", {len(rows)} times" if len(rows) > 1 else ""
        course.tell("L404", rows[0], f"{word[:60]}{times}")
    return bulk & possible


def _handler(course: Course, word: str) -> Handler | None:
    """The handler of a word, None if it has no meaning here."""
    # An INSERT that does not name a tool is text for the NC program, which a motion cannot represent.
    return HANDLERS.get(word) if word != "INSERT" or course.dialect.insert_is_tool else None


def _possible(course: Course) -> Array:
    """Mask of statements with plausible numbers; report the others."""
    statements: Statements = course.statements
    size = np.diff(statements.number_start)
    owner = np.repeat(np.arange(len(statements)), size)
    takes_text = np.array([form.takes_text for form in statements.forms], dtype=np.bool_)
    wrong = ~(np.abs(statements.numbers) <= LARGEST) & ~takes_text[statements.form[owner]]
    possible = np.ones(len(statements), dtype=np.bool_)
    for index in np.flatnonzero(wrong).tolist():
        row = int(owner[index])
        course.tell("L103", row, f"{statements.numbers[index]:g}")
        possible[row] = False
    return possible


def _tell_behind(course: Course, row: int) -> None:
    """Report statements after the end."""
    behind = len(course.statements) - row - 1
    if behind:
        course.tell("L415", row + 1, f"{behind} statements")
