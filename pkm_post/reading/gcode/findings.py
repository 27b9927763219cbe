# SPDX-License-Identifier: LGPL-2.1-or-later
"""Semantic faults: faults of syntactically valid blocks, collected by row and reported in file order.

Enters: rows of blocks. Leaves: diagnostics. Every faulty block counts, but only the first ones of each kind are
reported individually: a program of a million blocks may have the same fault in each.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from pkm_post.model import Array, Diagnostic, Place, errors
from pkm_post.reading.gcode.blocks import Blocks

_TOLD = 50
"""Faults per code reported with their own location."""


@dataclass
class Findings:
    """Collects the diagnostics of a program."""

    blocks: Blocks
    diagnostics: list[Diagnostic] = field(default_factory=list)
    _count: Counter[str] = field(default_factory=Counter)

    def tell(self, code: str, row: int, found: str) -> None:
        """Add a diagnostic of one block, or of the whole file if there are no blocks."""
        self._count[code] += 1
        if self._count[code] <= _TOLD:
            place = self.blocks.place(row) if len(self.blocks) else Place(self.blocks.source)
            self.diagnostics.append(Diagnostic(code, place, found))

    def tell_all(self, code: str, wrong: Array, found: Callable[[int], str]) -> None:
        """Add a diagnostic for every faulty block.

        Args:
            code: diagnostic code.
            wrong: (N,) mask of faulty blocks.
            found: returns what was found in a row.
        """
        rows = np.flatnonzero(wrong)
        for row in rows[:_TOLD].tolist():
            self.tell(code, row, found(row))
        self._count[code] += max(len(rows) - _TOLD, 0)

    def stop(self) -> bool:
        """Whether there are errors."""
        return bool(errors(self.diagnostics))

    def in_order(self) -> tuple[Diagnostic, ...]:
        """The diagnostics in line order; the last one of a code states how many more there are."""
        diagnostics = sorted(self.diagnostics, key=lambda fault: (fault.place.line, fault.code))
        last = {fault.code: index for index, fault in enumerate(diagnostics)}
        for code, index in last.items():
            more = self._count[code] - sum(fault.code == code for fault in diagnostics)
            if more:
                fault = diagnostics[index]
                diagnostics[index] = Diagnostic(code, fault.place, f"{fault.found}, and {more} more like it")
        return tuple(diagnostics)
