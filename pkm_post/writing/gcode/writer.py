# SPDX-License-Identifier: LGPL-2.1-or-later
"""Writer: convert a program to equivalent G-code, one block per row.

Input: a ``Program`` (mm, rad, mm/s). Output: text: mm or inch, degrees, feed per minute. The text is modal: a word is
written where its rounded value changes, and again after a tool change. Reading the text restores the program within the
decimals. What a dialect cannot express is refused, or replaced and reported; nothing is dropped silently.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable, Iterator, Mapping

import numpy as np

from pkm_post.model import Array, Diagnostic, Diagnostics, EventKind, Phrase, Place, Program, Tool, pieces, threads
from pkm_post.toolpath import CHORD_ERROR, with_chords
from pkm_post.writing.gcode.arcs import WrittenArcs, written_arcs
from pkm_post.writing.gcode.tool_axes import (
    MAX_AXIS_DEVIATION,
    NOTATIONS,
    GcodeDialect,
    axis_deviation,
    unsupported_axis,
)
from pkm_post.writing.gcode.words import (
    TEXTS,
    Codes,
    NumberFormat,
    WordColumn,
    codes_of,
    cutting,
    feed_as_written,
    words_of,
)

_MODES = "{unit} G17 G90 G94 G40 G49 G80 G64\n"
_COOLANT = {0: "M9", 1: "M8", 2: "M7"}
_STOP = {0: "M0", 1: "M1"}
_AT_TIP = ("G43.4", "G43.5")
"""Tip control codes to cancel before a tool change."""
_LONGEST_COMMENT = 200
"""Characters; LinuxCNC reads lines of 255."""


def heading(program: Program, dialect: GcodeDialect, inch: bool) -> str:
    """The lines before the first block: source, tools, modes."""
    tools = [program.tools[number] for number in sorted(program.tools)]
    lines = [
        _comment(f"from {program.source}"),
        *(_comment(", ".join(_known_of(tool))) for tool in tools),
    ]
    length_code = NOTATIONS[dialect].length_code
    starts_with_tool = any(event.row == 0 and event.kind is EventKind.TOOL_CHANGE for event in program.events)
    if not starts_with_tool and length_code in _AT_TIP:
        return "".join(lines) + _MODES.format(unit="G20" if inch else "G21") + length_code + "\n"
    return "".join(lines) + _MODES.format(unit="G20" if inch else "G21")


def _known_of(tool: Tool) -> Iterator[str]:
    """Yield what is known of a tool: 0 stands for an unstated diameter or length."""
    yield f"tool {tool.number}" + (f": {tool.name}" if tool.name else "")
    if tool.diameter > 0:
        yield f"diameter {_short(tool.diameter)} mm"
        if tool.corner_known:
            yield f"corner radius {_short(tool.corner_radius)} mm"
    if tool.length > 0:
        yield f"length {_short(tool.length)} mm"


def lines_between_blocks(program: Program, dialect: GcodeDialect) -> dict[int, str]:
    """Whole lines by the row that follows them; the row count as key places lines after the last row."""
    lines: dict[int, str] = {}
    for row in _first_rows(program) if any(program.operations) else ():
        lines[row] = _comment(f"operation: {program.operations[program.operation[row]]}")
    say = _EVENTS | {EventKind.TOOL_CHANGE: _tool_change(dialect)}
    for event in program.events:
        lines[event.row] = lines.get(event.row, "") + say[event.kind](event.value)
    return lines


def _first_rows(program: Program) -> list[int]:
    """First rows of operations."""
    changes = np.append(True, np.diff(program.operation) != 0)[: len(program)]
    return np.flatnonzero(changes).tolist()


def _tool_change(dialect: GcodeDialect) -> Callable[[float], str]:
    length_code = NOTATIONS[dialect].length_code
    cancel = "G49\n" if length_code in _AT_TIP else ""

    def say(number: float) -> str:
        return f"{cancel}T{number:.0f} M6\n{length_code} H{number:.0f}\n"

    return say


def _spindle(speed: float) -> str:
    return f"S{_short(abs(speed))} M{3 if speed > 0 else 4}\n" if speed else "M5\n"


_EVENTS: dict[EventKind, Callable[[float], str]] = {
    EventKind.SPINDLE: _spindle,
    EventKind.COOLANT: lambda value: _COOLANT[int(value)] + "\n",
    EventKind.DWELL: lambda seconds: f"G4 P{seconds:.4f}\n",  # without a point some controls read it as ms
    EventKind.STOP: lambda value: _STOP[int(value)] + "\n",
    EventKind.FUNCTION: lambda number: f"M{int(number)}\n",
}


def _short(value: float) -> str:
    """A number with up to four decimals, without trailing zeros."""
    return f"{value:.4f}".rstrip("0").rstrip(".")


def _comment(text: str) -> str:
    """A comment that every control accepts: ASCII, one line, limited length, no nested parentheses."""
    plain = text[:_LONGEST_COMMENT].translate({ord("("): "[", ord(")"): "]"}).encode("ascii", "replace").decode("ascii")
    return "(" + "".join(character if character.isprintable() else " " for character in plain) + ")\n"


_ROWS_AT_ONCE = 1 << 13


def block_texts(words: list[WordColumn], codes: Codes, between: Mapping[int, str]) -> Iterator[str]:
    """The text of all blocks, in pieces.

    The codes come before the words, with P after the path code and D after the compensation code; ``between`` are whole
    lines to insert before some rows.
    """
    columns = [codes.tolerance, codes.diameter, *words]
    templates, of_row = _templates(columns, codes)
    rows = sorted(between)
    for part in pieces(len(of_row), _ROWS_AT_ONCE):
        lines = templates[of_row[part]].tolist()
        for row in rows[bisect_left(rows, part.start) : bisect_left(rows, part.stop)]:
            lines[row - part.start] = between[row].replace("%", "%%") + lines[row - part.start]
        values = np.column_stack([word.values[part] for word in columns])
        written = np.column_stack([word.written[part] for word in columns])
        yield "".join(lines) % tuple(values[written].tolist())


def _templates(columns: list[WordColumn], codes: Codes) -> tuple[Array, Array]:
    """The distinct templates, and the template index of each row, (N,)."""
    radices = [len(TEXTS[group]) for group in Codes.ORDER] + [2] * len(columns)
    digits = [getattr(codes, group) for group in Codes.ORDER] + [word.written for word in columns]
    key = np.zeros(len(codes.motion), dtype=np.int64)
    for radix, digit in zip(reversed(radices), reversed(digits), strict=True):
        key = key * radix + digit
    used, of_row = np.unique(key, return_inverse=True)
    return np.array([_template(int(one), radices, columns) for one in used], dtype=object), of_row


def _template(key: int, radices: list[int], columns: list[WordColumn]) -> str:
    digits = []
    for radix in radices:
        key, digit = divmod(key, radix)
        digits.append(digit)
    code = {group: TEXTS[group][digit] for group, digit in zip(Codes.ORDER, digits, strict=False)}
    tolerance, diameter, *words = [
        f"{word.letter}%.{word.decimals}f" if written else ""
        for word, written in zip(columns, digits[len(Codes.ORDER) :], strict=True)
    ]
    parts = [code["plane"], code["side"], diameter, code["motion"], *words]
    if tolerance:  # on a separate line: other codes use P as well
        return f"{code['path']} {tolerance}\n" + _line(parts)
    return _line([code["path"], *parts])


def _line(parts: list[str]) -> str:
    return " ".join(part for part in parts if part) + "\n"


_INCH = 25.4


def write(
    program: Program, dialect: GcodeDialect, decimals: int | None = None, axis_decimals: int = 6, inch: bool = False
) -> tuple[str | None, Diagnostics]:
    """Write a program as G-code.

    Args:
        program: any; row 0 is written as a rapid move.
        dialect: tool axis notation.
        decimals: of coordinates, centres and diameters; None for four in mm and six in inches.
        axis_decimals: of vectors, and of angles in degrees.
        inch: whether to write lengths in inches (G20).

    Returns:
        The text, or None if the dialect cannot express the program; and the diagnostics.

    Raises:
        ValueError: a position, tool axis, feed, radius or tolerance is not finite.
    """
    _require_numbers(program)
    fault = unsupported_axis(program.tool_axis, dialect)
    if fault is not None:
        row, code, found = fault
        return None, (Diagnostic(code, program.place(row), found),)
    if taps := threads(program.events):
        return None, (Diagnostic("K157", program.place(taps[0].first), "as G-code"),)
    if program.contact.any():
        return None, (
            Diagnostic("N119", program.place(int(np.argmax(program.contact))), f"{program.contact.sum()} rows"),
        )
    decimals = (6 if inch else 4) if decimals is None else decimals
    numbers = NumberFormat(decimals, axis_decimals, _INCH if inch else 1.0)
    standing = np.flatnonzero(cutting(program) & (feed_as_written(program, numbers) <= 0))
    if len(standing):
        row = int(standing[0])
        return None, (Diagnostic("G506", program.place(row), f"{program.feed[row] * 60:g} mm/min"),)
    axis_may_change = not NOTATIONS[dialect].as_vector
    arcs = written_arcs(program, numbers.unit, axis_may_change)
    diagnostics = (*_chord_warnings(program, arcs), *_normal_warnings(program))
    if not arcs.expressible.all():
        program = with_chords(program, arcs.row[~arcs.expressible])
        arcs = written_arcs(program, numbers.unit, axis_may_change)
    diagnostics += _deviation_warnings(program, dialect)
    between = lines_between_blocks(program, dialect)
    codes = codes_of(program, arcs, numbers)
    blocks = block_texts(words_of(program, NOTATIONS[dialect], arcs, numbers), codes, between)
    end = between.get(len(program), "")
    return "".join([heading(program, dialect, inch), *blocks, end, "M2\n"]), diagnostics


def _require_numbers(program: Program) -> None:
    columns = {
        "position": program.position,
        "tool_axis": program.tool_axis,
        "feed of cutting moves": program.feed[cutting(program)],
        "side_offset": program.side_offset,
        "tip_tolerance": program.tip_tolerance,
    }
    for name, values in columns.items():
        if not np.isfinite(values).all():
            raise ValueError(f"{name}: expected finite numbers, got {int((~np.isfinite(values)).sum())} that are not")


def _chord_warnings(program: Program, arcs: WrittenArcs) -> Diagnostics:
    rows = arcs.row[~arcs.expressible]
    if not len(rows):
        return ()
    found = f"{len(rows)} of {len(arcs.row)} arcs, this is the first; the lines stay within {CHORD_ERROR} mm"
    return (Diagnostic("G503", program.place(int(rows[0])), found),)


def _deviation_warnings(program: Program, dialect: GcodeDialect) -> Diagnostics:
    swing = np.where(cutting(program), axis_deviation(program.tool_axis, program.spin, dialect), 0.0)
    rows = np.flatnonzero(swing > MAX_AXIS_DEVIATION)
    if not len(rows):
        return ()
    found = f"by up to {np.degrees(swing.max()):.2f} deg in {len(rows)} cutting moves, this is the first"
    return (Diagnostic("G505", program.place(int(rows[0])), found),)


def _normal_warnings(program: Program) -> Diagnostics:
    count = int(np.isfinite(program.normal).all(axis=1).sum())
    return (Diagnostic("G504", Place(program.source), Phrase("{} moves have one", count)),) if count else ()
