# SPDX-License-Identifier: LGPL-2.1-or-later
"""Scan: convert the text of a G-code program to columns of blocks; the first step of reading.

Enters: the content of a file, any bytes. Leaves: ``Blocks``, or all lexical and syntax faults. Two implementations give
the same result. ``scan_by_block`` parses every line with lark: the reference. ``scan`` parses one block of each shape
with lark and reads the numbers of all lines of that shape at once; lines that lark rejects, and blocks with more than
plain words, use the reference.
"""

from __future__ import annotations

import numpy as np

from pkm_post.model import Array, Diagnostic, Place
from pkm_post.reading.gcode.blocks import Blocks
from pkm_post.reading.gcode.faults import Faults, readable
from pkm_post.reading.gcode.lexer import Lexed, lex
from pkm_post.reading.gcode.lines import clean, pieces, without_comments, without_lines
from pkm_post.reading.gcode.percent import Demarcated, demarcated
from pkm_post.reading.gcode.row import LONGEST_LINE, Row, read_row
from pkm_post.reading.gcode.shapes import BY_ITSELF, NOTHING, Shapes
from pkm_post.reading.gcode.table import Table
from pkm_post.system import DecimalReader

Scanned = tuple[Blocks | None, tuple[Diagnostic, ...]]
_SHOWN = 40
"""Characters of a line shown in a message."""


def scan(text: bytes | str, file: str) -> Scanned:
    """Scan a G-code program to blocks, or report the faults of its text.

    Args:
        text: content of the file.
        file: its name, for the diagnostics.

    Raises:
        ImportError: lark is not installed.
    """
    whole = clean(text)
    part = demarcated(whole)
    faults, shapes, table = Faults(file), Shapes(), Table(part.text.count(b"\n"))
    for piece in pieces(part.text):
        _scan_piece(piece, shapes, table, faults)
    return _scanned(whole, part, table, faults, file)


def scan_by_block(text: bytes | str, file: str) -> Scanned:
    """Reference implementation of ``scan``: parse line by line with lark.

    Args:
        text: content of the file.
        file: its name, for the diagnostics.

    Raises:
        ImportError: lark is not installed.
    """
    whole = clean(text)
    part = demarcated(whole)
    faults, table = Faults(file), Table(part.text.count(b"\n"))
    for line in part.text.split(b"\n")[:-1]:
        row = read_row(line)
        spoken: list[tuple[int, str]] = []
        if isinstance(row, Row):
            without_comments(line, spoken)
            table.comments.extend((table.next_line, comment) for _, comment in spoken)
            table.add_row(row)
        else:
            faults.add(table.next_line, line, row)
            table.add_row(Row())
    return _scanned(whole, part, table, faults, file)


def _scanned(whole: bytes, part: Demarcated, table: Table, faults: Faults, file: str) -> Scanned:
    """The blocks of the table if there are no faults; report any block after the end of the file."""
    told = faults.diagnostics()
    blocks = None if told else table.blocks(file, part.closed)
    if part.behind >= 0:
        line = whole.count(b"\n", 0, part.behind) + 1
        told += (Diagnostic("G212", Place(file, line=line, column=1), _beginning(whole, part.behind)),)
    return blocks, told


def _beginning(text: bytes, offset: int) -> str:
    """The first characters of the line at an offset, in printable form."""
    line = text[offset : text.find(b"\n", offset)][:_SHOWN]
    return "".join(character if character.isprintable() else "?" for character in readable(line).strip())


def _scan_piece(piece: bytes, shapes: Shapes, table: Table, faults: Faults) -> None:
    """Append the blocks of a piece to the table, and its faults to ``faults``."""
    line_start = np.concatenate([[0], np.flatnonzero(np.frombuffer(piece, np.uint8) == ord("\n")) + 1])
    too_long = np.flatnonzero(np.diff(line_start) - 1 > LONGEST_LINE)
    spoken: list[tuple[int, str]] = []
    text = without_comments(without_lines(piece, line_start, too_long) if len(too_long) else piece, spoken)
    lexed = lex(text)
    shape = np.fromiter(map(shapes.__getitem__, lexed.shapes), np.intp, len(lexed.shapes))
    shape[too_long] = BY_ITSELF
    values = _values(text, lexed, line_start, shape)
    alone, faulty = _read_alone(piece, line_start, shape, table.next_line, faults)
    shape[sorted(faulty)] = NOTHING
    lines = _lines_at(np.array([offset for offset, _ in spoken], np.int64), line_start)
    said = zip(lines.tolist(), (comment for _, comment in spoken), strict=True)
    table.comments.extend((table.next_line + index, comment) for index, comment in said if index not in faulty)
    table.add_lines(shape, shapes.layouts(), values, alone)


def _read_alone(
    piece: bytes, line_start: Array, shape: Array, first: int, faults: Faults
) -> tuple[dict[int, Row], set[int]]:
    """Read the lines without a plain shape one by one; return their rows, and which lines are faulty."""
    rows: dict[int, Row] = {}
    faulty: set[int] = set()
    for index in np.flatnonzero(shape == BY_ITSELF).tolist():
        line = piece[line_start[index] : line_start[index + 1] - 1]
        row = read_row(line)
        if isinstance(row, Row):
            rows[index] = row
        else:
            faulty.add(index)
            faults.add(first + index, line, row)
    return rows, faulty


def _values(text: bytes, lexed: Lexed, line_start: Array, shape: Array) -> Array:
    """The numbers of all lines with a shape; lines with a malformed number lose their shape."""
    values = DecimalReader(text).numbers(lexed.starts, lexed.ends)
    wrong = np.concatenate([lexed.suspicious, lexed.starts[~np.isfinite(values)]])
    shape[_lines_at(wrong, line_start)] = BY_ITSELF
    if (shape == BY_ITSELF).any():
        values = values[shape[_lines_at(lexed.starts, line_start)] != BY_ITSELF]
    return values


def _lines_at(offsets: Array, line_start: Array) -> Array:
    """The lines, from 0, that contain the given offsets."""
    return np.searchsorted(line_start, offsets, side="right") - 1
