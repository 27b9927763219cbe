# SPDX-License-Identifier: LGPL-2.1-or-later
"""Interpreter: dispatch the statements other than plain GOTO, in order, to the handlers of their words.

Input: statements. Output: the state that they set. A word has a handler, or does not affect the motion and is ignored,
or is refused by name because ignoring it would change the motion. All other words are reported once with their count.

FINI ends CL data, and so do END and REWIND. CLSF of NX has none of them: each of its tool paths ends with END-OF-PATH;
and APT-CL of Makino ends with a section for the end of its process. No statement with an effect may follow.
"""

from __future__ import annotations

import re
from collections.abc import Callable

import numpy as np

from pkm_post.model import Array, EventKind
from pkm_post.reading.cldata.arc_statements import (
    arcdat,
    arcmov,
    arcslp,
    ccw,
    circle,
    commented_circle,
    gocclw,
    helical,
    movarc,
    report_unused_arcdat,
)
from pkm_post.reading.cldata.check_surface import autops, indirp, indirv, psis, tlon
from pkm_post.reading.cldata.copies import MATRIX
from pkm_post.reading.cldata.cutcom import cutcom, geometry_type, points_comment
from pkm_post.reading.cldata.cycle_statement import cycle, cycle_goes_on
from pkm_post.reading.cldata.feeds import coolnt, delay, fedrat, rapid, report_unknown_speeds, spindl, stop
from pkm_post.reading.cldata.logical_lines import JOINT
from pkm_post.reading.cldata.nurbs import movnrb
from pkm_post.reading.cldata.points import from_or_godlta, goto, multax, numbers_only, tlaxis
from pkm_post.reading.cldata.state import ReaderState
from pkm_post.reading.cldata.statements import Statement, Statements
from pkm_post.reading.cldata.tools import cutter, insert, load, tldata
from pkm_post.reading.cldata.units_and_frames import (
    copy_matrix,
    machining_frame,
    origin,
    path_index,
    trans,
    trntyp,
    units,
    zero,
)

_LARGEST = 1e9
"""Numbers beyond this are not plausible lengths, feeds or speeds."""
_END = re.compile(r"\s*(?:END-OF-PATH|PPRINT\s*/\s*END-SECTION\s*,\s*PROCESS-END-PATH)\s*", re.IGNORECASE)

_CONTINUED = re.compile(rf"{JOINT}\s*(\w+)\s*(?:/|$|{JOINT})")
"""A line that continues a text, as a statement: a word with a slash, or alone."""

_Handler = Callable[[ReaderState, int, Statement], None]


def _operation(state: ReaderState, row: int, statement: Statement) -> None:
    """TOOL PATH/name,TOOL,tool of NX, OPERATION NAME of CATIA, FEATNO of Creo: start of an operation."""
    if statement.word == "TOOL PATH":  # the header of each path defines the meaning of its points
        state.point_meaning = None
    name, _, tool = statement.text.partition(",TOOL,")
    state.inserted_name = tool or state.inserted_name
    number = statement.numbers
    state.operation_starts.append((row, len(state.operations)))
    state.operations.append(f"{statement.word} {number[0]:g}" if number else name.strip())


def _tlcomp(state: ReaderState, row: int, statement: Statement) -> None:
    """TLCOMP/OFF ends a control-side compensation, which no path here uses; any other form requests one."""
    if statement.items != ("OFF",):
        state.report("L401", row, f"TLCOMP/{statement.items_text()}")


def _rotary(state: ReaderState, row: int, statement: Statement) -> None:
    """ROTABL, ROTHED and ROTATE: a zero rotation does not affect the motion; a hexapod has no table or head to turn."""
    if not statement.numbers or any(statement.numbers):
        state.report("L401", row, f"{statement.word}/{statement.items_text()}, a rotary axis")


def _syn(state: ReaderState, row: int, statement: Statement) -> None:
    """SYN/'new','old',... redefines words; refused if such a word follows."""
    words = [item.strip("'\"") for item in statement.words[::2]]
    later = "\n".join(state.statements.lines.text[state.statements.index[row] + 1 :])
    renamed = [word for word in words if re.search(rf"(?<![\w-]){re.escape(word)}(?![\w-])", later, re.IGNORECASE)]
    if renamed:
        state.report("L401", row, f"SYN/{statement.items_text()} with {renamed[0]} after it")


def _end(state: ReaderState, row: int, statement: Statement) -> None:
    """END and REWIND stop spindle and coolant, as M2 and M30 do."""
    state.end_of_program = row
    for kind in (EventKind.SPINDLE, EventKind.COOLANT):
        if next((value for _, each, value in reversed(state.events) if each is kind), 0.0):
            state.events.append((row, kind, 0.0))


def _fini(state: ReaderState, row: int, statement: Statement) -> None:
    state.ended = True


PROGRAM_ENDS = frozenset({"END", "REWIND"})
"""Words that write the end of the NC program, M2 and M30 [UG/Post]."""

HANDLERS: dict[str, _Handler] = {
    "GOTO": goto, "FROM": from_or_godlta, "GODLTA": from_or_godlta, "GOHOME": from_or_godlta,
    "TLAXIS": tlaxis, "MULTAX": multax,
    "": numbers_only, "CIRCLE": circle, "CYLNDR": circle, "MOVARC": movarc,
    "_CIRCLE": commented_circle, "_CYLNDR": commented_circle,
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
    "CUTCOM": cutcom, "CUTCOM_GEOMETRY_TYPE": geometry_type, "_POINTS": points_comment,
    "UNITS": units, "UNIT": units, "MSYS": machining_frame, "CSYS": machining_frame, "CATIA0": machining_frame,
    "MCS": machining_frame, "MCSYS": machining_frame, "ZERO": zero,
    "ORIGIN": origin, "TRANS": trans, "TRACUT": trans, "TRNTYP": trntyp,
    "INDEX": path_index, MATRIX: copy_matrix,
    "MOVNRB": movnrb,
    "TLCOMP": _tlcomp, "ROTABL": _rotary, "ROTHED": _rotary, "ROTATE": _rotary, "SYN": _syn,
    "TOOL PATH": _operation, "OPERATION NAME": _operation, "FEATNO": _operation, "FINI": _fini,
    **dict.fromkeys(PROGRAM_ENDS, _end),
}  # fmt: skip
"""Words with a handler."""

_NESTED = frozenset({"TLON,GOFWD", "PSIS"})
"""Words with statements in parentheses among their items."""

_ALONE: dict[str, frozenset[str]] = {
    "MULTAX": frozenset({"ON", "OFF"}), "AUTOPS": frozenset(), "STOP": frozenset(), "OPSTOP": frozenset(),
}  # fmt: skip
"""Words with at most one item, and the words that it may be."""

_CHANGES_CYCLES = frozenset({"FEDRAT", "SPINDL", "CUTTER", "TLDATA"})
"""Words that may change the feed or the spindle speed of a cycle: a surface speed follows the cutter."""

_STARTED_BY = (EventKind.TOOL_CHANGE, EventKind.SPINDLE, EventKind.COOLANT)

IGNORED = frozenset({
    "PARTNO", "PPRINT", "TPRINT", "LETTER", "DISPLY", "REMARK", "MACHIN", "PPWORD", "PAINT", "END-OF-PATH", "SETUP",
    "SELECT", "SWITCH", "LINTOL", "INTOL", "OUTTOL", "TOLER", "SET",
    "CSI_SET_FLUTE_LENGTH", "CSI_SET_EXTENSION_LENGTH", "CLPRNT", "NOPOST", "LEADER", "CLEARP",
    "MODE", "PRINT", "SEQNO", "CSI_TOOL_PATH", "CSI_PATH_TOLERANCE", "CSI_SET_PATH_PARAM", "MCS2",
})  # fmt: skip
"""Words without effect on the motion."""

UNSUPPORTED = frozenset({
    "SPLINE", "BSPLINE", "NURBS",
    "POLYGON", "PIVOT", "TURRET", "MIRROR", "LOOPST", "LOOPND", "JUMPTO",
    "MACRO", "CALL", "TERMAC", "IF", "DO", "GO", "GOFWD", "GOBACK", "GOLFT", "GORGT", "GOUP", "GODOWN", "OFFSET",
    "TLLFT", "TLRGT", "TLON", "TLLFT,GOFWD", "TLRGT,GOFWD", "TLON,GOLFT", "TLON,GORGT", "THREAD", "PITCH", "REFSYS",
    "RETRCT", "CALSUB", "DEFSUB", "ENDSUB", "PIVOTZ", "PROBE", "DNTCUT", "INCLUDE", "READ",
})  # fmt: skip
"""Words that change the motion and are not supported."""


def interpret(state: ReaderState, bulk: Array) -> Array:
    """Update the state by the statements that are not in the bulk, the (N,) mask of plain GOTO statements.

    Returns:
        (N,) mask of valid plain GOTO statements: those with plausible numbers before the end.
    """
    statements = state.statements
    valid = _plausible(state)
    with_rapid = np.array([template.rapid for template in statements.templates], dtype=np.bool_)
    state.rapids += np.flatnonzero(with_rapid[statements.template]).tolist()
    unknown: dict[str, list[int]] = {}
    for row in np.flatnonzero(~bulk & valid).tolist():
        word = statements.word(row)
        handler = _handler(state, word)
        if handler is not None:
            _handle(state, row, handler)
            if word in _CHANGES_CYCLES:
                cycle_goes_on(state, row)
        elif word in UNSUPPORTED or _known_parts(word):
            state.report("L401", row, word)
        elif word not in IGNORED:
            unknown.setdefault(word, []).append(row)
        _report_statement_in_text(state, row)
        if state.ended:
            valid[row + 1 :] = False
            _report_after_end(state, row)
            break
    report_unused_arcdat(state)
    report_unknown_speeds(state)
    _report_missing_end(state)
    _report_motion_after_program(state, bulk & valid)
    for word, rows in unknown.items():
        times = f", {len(rows)} times" if len(rows) > 1 else ""
        state.report("L404", rows[0], f"{word[:60]}{times}")
    return bulk & valid


def _handle(state: ReaderState, row: int, handler: _Handler) -> None:
    """Let its handler read a statement, unless it has items that no handler of its word reads."""
    statement = state.statements.statement(row)
    word, items = statement.word, [item for item in statement.items if item is not None]
    alone = _ALONE.get(word)
    if alone is not None and (len(items) > 1 or not set(items) <= alone):
        state.report_items(row, statement, " or ".join(["no items", *sorted(alone)]))
    elif word not in _NESTED and any(isinstance(item, Statement) for item in items):
        state.report_items(row, statement, "no parentheses")
    else:
        handler(state, row, statement)


def _report_statement_in_text(state: ReaderState, row: int) -> None:
    """Report a statement that a $ or ~ at the end of a text would make part of that text, and so lose."""
    statements = state.statements
    text = statements.lines.text[statements.index[row]]
    if JOINT not in text or not statements.templates[statements.template[row]].takes_text:
        return
    for match in _CONTINUED.finditer(text):
        word = match[1].upper()
        if word in HANDLERS or word in UNSUPPORTED:
            state.report("L401", row, f"{statements.word(row)} that continues in a line with the statement {word}")
            return


def _known_parts(word: str) -> bool:
    """Whether several words before the slash contain one with a meaning, as in TLLFT,GORGT."""
    parts = word.split(",")
    return len(parts) > 1 and any(part in HANDLERS or part in UNSUPPORTED for part in parts)


def _handler(state: ReaderState, word: str) -> _Handler | None:
    """The handler of a word, None if it is unknown."""
    # An INSERT that does not name a tool is text for the NC program, which a motion cannot represent.
    return HANDLERS.get(word) if word != "INSERT" or state.dialect.insert_is_tool else None


def _plausible(state: ReaderState) -> Array:
    """Mask of statements with plausible numbers; report the others."""
    statements: Statements = state.statements
    size = np.diff(statements.number_start)
    owner = np.repeat(np.arange(len(statements)), size)
    takes_text = np.array([template.takes_text for template in statements.templates], dtype=np.bool_)
    implausible = ~(np.abs(statements.numbers) <= _LARGEST) & ~takes_text[statements.template[owner]]
    valid = np.ones(len(statements), dtype=np.bool_)
    for index in np.flatnonzero(implausible).tolist():
        row = int(owner[index])
        state.report("L103", row, f"{statements.numbers[index]:g}")
        valid[row] = False
    return valid


def _report_after_end(state: ReaderState, row: int) -> None:
    """Report statements after the end."""
    count = len(state.statements) - row - 1
    if count:
        state.report("L415", row + 1, f"{count} statements")


def _report_missing_end(state: ReaderState) -> None:
    """Report a missing end where one is required: the file may be truncated."""
    needs_end = state.options.needs_end and not state.ended and len(state.statements)
    if needs_end and not _is_closed(state):
        state.report("L441", len(state.statements) - 1, "no FINI or END-OF-PATH after it")


def _report_motion_after_program(state: ReaderState, goto: Array) -> None:
    """Report a motion, a tool change or a start of spindle or coolant after END or REWIND, which is never reached.

    ``goto`` is the (N,) mask of the plain GOTO statements.
    """
    end = state.end_of_program
    rows = [*(np.flatnonzero(goto[end + 1 :]) + end + 1)[:1].tolist(), *(row for row, _ in state.points if row > end)]
    begun = [row for row, kind, value in state.events if row > end and value and kind in _STARTED_BY]
    if end >= 0 and (rows or begun):
        word, line = state.statements.word(end), state.statements.place(end)[0]
        first = min((*rows, *begun))
        what = "a motion" if first in rows else state.statements.word(first)
        state.report("L401", first, f"{what} after {word} in line {line}, the end of the program")


def _is_closed(state: ReaderState) -> bool:
    """Whether only words without effect follow a statement that ends a file."""
    statements = state.statements
    for row in reversed(range(len(statements))):
        word, text = statements.word(row), statements.lines.text[statements.index[row]]
        if word in PROGRAM_ENDS or _END.fullmatch(text):
            return True
        if word not in IGNORED:
            return False
    return False
