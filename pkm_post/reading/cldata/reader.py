# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reader: the processing sequence from CL data to a program.

Enters: the text of a file. Leaves: a ``Program`` in mm, mm/s and the work frame, and all faults. With an error there is
no program.
"""

from __future__ import annotations

import numpy as np

from pkm_post.model import Array, Diagnostic, Program
from pkm_post.reading.cldata.arcs import fit_arcs
from pkm_post.reading.cldata.cutcom import contour_offsets
from pkm_post.reading.cldata.cycle_statement import cycles_told
from pkm_post.reading.cldata.faults import Faults
from pkm_post.reading.cldata.interpreter import walk
from pkm_post.reading.cldata.length_unit import length_unit
from pkm_post.reading.cldata.logical_lines import LONGEST_LINE, decoded, logical_lines, without_long_lines
from pkm_post.reading.cldata.options import DIALECTS, ReadOptions, detect
from pkm_post.reading.cldata.points import Points, ValueNames, all_points, bulk_rows, resolve
from pkm_post.reading.cldata.program import program_of
from pkm_post.reading.cldata.state import Course
from pkm_post.reading.cldata.statements import scan
from pkm_post.reading.cldata.tools import keep

LARGE_INCHES = 2000.0
"""mm; a larger part in inches is more likely in mm."""


def read(
    text: bytes | str, file: str, options: ReadOptions | None = None
) -> tuple[Program | None, tuple[Diagnostic, ...]]:
    """Read CL data.

    Args:
        text: content of the file.
        file: its name, for messages.
        options: settings that the file omits or states wrongly.

    Returns:
        The program, or None if there are errors, and the diagnostics in file order.

    Raises:
        ImportError: lark is not installed.
    """
    options = options or ReadOptions()
    faults = Faults(file)
    text, too_long = without_long_lines(text)
    for line, size in too_long:
        faults.add("L104", (line, 0), f"a line of {size} bytes, at most {LONGEST_LINE}")
    whole = decoded(text)
    dialect = DIALECTS[options.dialect] if options.dialect else detect(whole)
    statements = scan(logical_lines(whole), faults)
    bulk, names = bulk_rows(statements, options, dialect)
    unit = length_unit(statements, whole)
    course = Course(statements, dialect, options, faults, np.flatnonzero(bulk), np.cumsum(bulk), unit)
    program = _program(course, bulk, names, file)
    return (None if faults.any_errors() else program), faults.diagnostics()


def _program(course: Course, bulk: Array, names: ValueNames, file: str) -> Program | None:
    """The program of the statements; None on errors."""
    counted = walk(course, bulk)
    points = all_points(course, counted, names)
    if not course.faults.any_errors() and not len(points.row):
        course.faults.add("L413", (0, 0), "no GOTO")
    if course.faults.any_errors():
        return None
    frames = resolve(course, points)
    if course.faults.any_errors():
        return None
    arcs = fit_arcs(course, points, frames)
    if course.faults.any_errors():
        return None
    unit = _unit(course, points)
    _lengths(course)
    offsets, reading = contour_offsets(course, points, frames, arcs)
    if course.faults.any_errors():
        return None
    return program_of(course, points, arcs, file, offsets, [*unit, *cycles_told(course), *reading])


def _unit(course: Course, points: Points) -> list[str]:
    """Describe how the length unit was determined without UNITS; report a doubtful or missing unit."""
    if course.options.units is not None:
        return [f"lengths are in {course.options.units}, as the option says"]
    unit, size = course.file_unit, float(np.ptp(points.position, axis=0).max())
    if not unit.name:
        course.faults.add("L431", (0, 0), unit.words)
        return []
    if not unit.stated:
        course.faults.add("L410", (0, 0), f"there is no UNITS; {unit.name}, by {unit.words}")
    if unit.doubt:
        course.faults.add("L410", (0, 0), f"{unit.words}, but {unit.doubt}: each is taken as it says")
    if course.unit == "inch" and size > LARGE_INCHES:
        found = f"{unit.words}, and the path is {size / 25.4:.6g} inches = {size:.6g} mm wide"
        course.faults.add("L410", (0, 0), found)
    return [] if unit.stated else [f"lengths are in {unit.name}, by {unit.words}"]


def _lengths(course: Course) -> None:
    """Report tools of unknown length."""
    keep(course)
    for number, tool in sorted(course.tools.items()):
        if not tool.length > 0:
            course.faults.add("L411", (0, 0), f"tool {number}")
