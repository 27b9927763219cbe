# SPDX-License-Identifier: LGPL-2.1-or-later
"""Faults: what is wrong with a block, and the collector of a program.

Enters: codes and what was found, by row. Leaves: diagnostics in line order.
"""

from __future__ import annotations

from pkm_post.model import Diagnostic, DiagnosticLog, Place

_MOST_REPORTED = 50
"""Faults of a kind that are reported with their own place."""


class BlockFault(Exception):  # noqa: N818 - a fault of the input
    """A block that cannot be carried out.

    Attributes:
        code: of the diagnostic.
        found: what was found.
        column: in the block, from 1; 0 for the whole block.
    """

    def __init__(self, code: str, found: str, column: int = 0) -> None:
        super().__init__(f"{code}: {found}")
        self.code, self.found, self.column = code, found, column


class Faults:
    """Collects the diagnostics of a program.

    Args:
        file: its name.
    """

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

    def in_order(self) -> tuple[Diagnostic, ...]:
        """The diagnostics in line order."""
        return self._log.in_order(lambda fault: (fault.place.line, fault.place.column, fault.code))
