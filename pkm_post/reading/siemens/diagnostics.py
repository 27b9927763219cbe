# SPDX-License-Identifier: LGPL-2.1-or-later
"""Diagnostics of Siemens programs: collected by row, and located in their lines.

Input: codes and findings, by row. Output: diagnostics in line order.
"""

from __future__ import annotations

import re
from dataclasses import replace

from pkm_post.model import Diagnostic, DiagnosticLog, Diagnostics, Place
from pkm_post.reading.gcode.parameters import ExecutionFault

_MOST_REPORTED = 50
"""Most faults of a kind reported individually."""


_NAME = re.compile(r"[A-Z$_][A-Z0-9$_]*")
_ARCS, _ARC_CODES = re.compile(r"G0*[23](?![0-9])|CIP|CT(?![A-Z])", re.IGNORECASE), ("G409", "G410")
_FIRST_WORD = re.compile(r"[\s/0-9]*(?:N[0-9]+)?\s*(?=\S)", re.IGNORECASE)


def with_column(fault: Diagnostic, text: str) -> Diagnostic:
    """A diagnostic of a line with its column: that of the word it names, of the arc, or of the first word."""
    if fault.place.column or not fault.place.line or not text.strip():
        return fault
    name = _NAME.match(fault.found)
    found = _ARCS.search(text) if fault.code in _ARC_CODES else None
    if found is None and name is not None:
        found = re.search(rf"(?<![A-Z$_]){re.escape(name[0])}", text, re.IGNORECASE)
    first = _FIRST_WORD.match(text)
    column = found.start() if found is not None else first.end() if first is not None else 0
    return replace(fault, place=replace(fault.place, column=column + 1))


class BlockFault(ExecutionFault):
    """A block that cannot be executed."""


class LineDiagnostics:
    """Collects the diagnostics of a program."""

    def __init__(self, file: str) -> None:
        self._file = file
        self._log = DiagnosticLog(_MOST_REPORTED)

    def add(self, row: int, code: str, found: str, column: int = 0) -> None:
        """Add a diagnostic of the line of a row, or of the whole file for a negative row."""
        place = Place(self._file, line=row + 1, column=column)
        self._log.add(Diagnostic(code, place, found), (code, found))

    def add_fault(self, row: int, fault: BlockFault) -> None:
        """Add the fault of a block."""
        self.add(row, fault.code, fault.found, fault.column)

    def has_errors(self) -> bool:
        """Whether there are errors."""
        return self._log.has_errors()

    def in_order(self) -> Diagnostics:
        """The diagnostics in line order."""
        return self._log.in_order(lambda fault: (fault.place.line, fault.place.column, fault.code))
