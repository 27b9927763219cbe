# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reader: the steps from CL data to a program.

Input: the text of a file. Output: a ``Program`` in mm, mm/s and the work frame, and all faults. With an error there is
no program.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from pkm_post.model import Array, Diagnostics, EventKind, Program
from pkm_post.reading.cldata.arcs import resolve_arcs
from pkm_post.reading.cldata.copies import with_copies
from pkm_post.reading.cldata.cutcom import cutcom_offsets
from pkm_post.reading.cldata.cycle_statement import cycle_descriptions
from pkm_post.reading.cldata.diagnostics import StatementDiagnostics
from pkm_post.reading.cldata.interpreter import interpret
from pkm_post.reading.cldata.logical_lines import LONGEST_LINE, decoded, logical_lines, without_long_lines
from pkm_post.reading.cldata.nurbs import with_curves
from pkm_post.reading.cldata.options import DIALECTS, ReadOptions, detect_dialect
from pkm_post.reading.cldata.points import Points, ValueNames, all_points, bulk_rows, resolve_points
from pkm_post.reading.cldata.program import build_program
from pkm_post.reading.cldata.source_language import expanded
from pkm_post.reading.cldata.state import ReaderState
from pkm_post.reading.cldata.statements import scan
from pkm_post.reading.cldata.tools import record_tool, record_tool_if_used
from pkm_post.reading.cldata.units_and_frames import length_unit

_LARGE_INCHES = 2000.0
"""mm; a larger part in inches is more likely in mm."""


def read(text: bytes | str, file: str, options: ReadOptions | None = None) -> tuple[Program | None, Diagnostics]:
    """Read CL data.

    Returns:
        The program, or None if there are errors, and the diagnostics in file order.

    Raises:
        ImportError: lark is not installed.
    """
    options = options or ReadOptions()
    faults = StatementDiagnostics(file)
    text, too_long = without_long_lines(text)
    for line, size in too_long:
        faults.add("L104", (line, 0), f"a line of {size} bytes, at most {LONGEST_LINE}")
    whole = decoded(text)
    dialect = DIALECTS[options.dialect] if options.dialect else detect_dialect(whole)
    statements = with_copies(scan(expanded(logical_lines(whole), faults), faults), faults)
    bulk, names = bulk_rows(statements, options, dialect)
    unit = length_unit(statements, whole)
    state = ReaderState(statements, dialect, options, faults, np.flatnonzero(bulk), np.cumsum(bulk), unit)
    program = _program(state, bulk, names, file)
    return (None if faults.any_errors() else program), faults.diagnostics()


def _program(state: ReaderState, bulk: Array, names: ValueNames, file: str) -> Program | None:
    """The program of the statements; None on errors."""
    points = all_points(state, interpret(state, bulk), names)
    if not state.faults.any_errors() and not len(points.row):
        last = len(state.statements) - 1
        state.faults.add("L413", state.statements.place(last) if last >= 0 else (1, 0), "no GOTO")
    if not len(points.row):
        return None
    if not state.faults.any_errors():
        points = with_curves(state, points)
    frames = resolve_points(state, points)
    arcs = resolve_arcs(state, points, frames)
    if state.faults.any_errors():
        return None
    unit = _describe_unit(state, points)
    _check_tool_lengths(state, points)
    _check_cutters_of_contacts(state, points)
    offsets, reading = cutcom_offsets(state, points, frames, arcs)
    if state.faults.any_errors():
        return None
    options = [*_describe_feed(state), *_describe_contact(points)]
    described = [*unit, *options, *cycle_descriptions(state), *reading, *state.arc_reading]
    return build_program(state, points, arcs, file, offsets, described)


def _describe_unit(state: ReaderState, points: Points) -> list[str]:
    """Describe the source of the length unit without UNITS; report a doubtful or missing unit."""
    if state.options.units is not None:
        return [f"lengths are in {state.options.units}, as the option says"]
    unit, size, first = state.file_unit, float(np.ptp(points.position, axis=0).max()), int(points.row[0])
    if not unit.name:
        state.report("L431", first, unit.evidence)
        return []
    if not unit.stated:
        state.report("L410", first, f"there is no UNITS; {unit.name}, by {unit.evidence}")
    if unit.contradiction:
        state.report("L410", first, f"{unit.evidence}, but {unit.contradiction}: each is taken in its own unit")
    if state.unit == "inch" and size > _LARGE_INCHES:
        found = f"{unit.evidence}, and the path is {size / 25.4:.6g} inches = {size:.6g} mm wide"
        state.report("L410", first, found)
    return [] if unit.stated else [f"lengths are in {unit.name}, by {unit.evidence}"]


def _describe_feed(state: ReaderState) -> list[str]:
    """Describe the feed that the options supply."""
    feed = state.options.feed
    return [] if feed is None else [f"the feed before the first FEDRAT is {feed * 60:.10g} mm/min, as the option says"]


def _describe_contact(points: Points) -> list[str]:
    """Describe the number of positions that options turn into contact points."""
    count = int(points.contact.sum())
    return [f"{count} points are contact points, as the option says"] if count else []


def _check_cutters_of_contacts(state: ReaderState, points: Points) -> None:
    """Report tools with several cutters where there are contact points: the tip depends on the cutter."""
    for number, shapes in sorted(state.used_cutters.items()) if points.contact.any() else ():
        if len(shapes) > 1 and number not in state.options.tools:
            sizes = ", ".join(f"{diameter:.6g},{corner:.6g}" for diameter, corner, *_ in sorted(shapes))
            row = int(points.row[points.contact][0])
            state.report("L401", row, f"contact points with several cutters of tool {number}: {sizes} mm")


def _check_tool_lengths(state: ReaderState, points: Points) -> None:
    """Report tools with an unknown or ambiguous length, on which the position of the tip depends."""
    record_tool_if_used(state, len(state.statements) - 1)
    record_tool(state)
    given, changes = state.options.tools, dict[int, int]()
    for row, kind, value in state.events:
        if kind is EventKind.TOOL_CHANGE:
            changes.setdefault(int(value), row)
    rows = {number: changes.get(number, int(points.row[0])) for number in state.tools}
    for number, row in sorted(rows.items(), key=lambda each: (each[1], each[0])):
        tool, lengths = state.tools[number], state.stated_lengths.get(number, [])
        if len(lengths) > 1 and not (number in given and given[number].length > 0):
            state.tools[number] = replace(tool, length=0.0)
            found = f"tool {number}: {', '.join(f'{length:.10g}' for length in sorted(lengths))} mm"
            state.report("L443", row, found)
        elif not tool.length > 0:
            state.report("L411", row, f"tool {number}")
