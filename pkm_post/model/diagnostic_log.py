# SPDX-License-Identifier: LGPL-2.1-or-later
"""Log of diagnostics: the first ones of each group are kept, the others counted.

A program of a million blocks may have the same fault in each. What a group is, the caller defines: a code, or the whole
file. Since explaining a fault takes time, callers ask first whether it would be kept.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Hashable
from dataclasses import dataclass, field, replace
from typing import Any

from pkm_post.model.diagnostics import Diagnostic, errors


@dataclass
class DiagnosticLog:
    """Diagnostics of one input.

    Attributes:
        most: number kept of each group.
    """

    most: int
    _kept: list[tuple[Hashable, Diagnostic]] = field(default_factory=list)
    _count: Counter[Hashable] = field(default_factory=Counter)

    def keeps(self, group: Hashable = "") -> bool:
        """Whether one more of a group would be kept."""
        return self._count[group] < self.most

    def add(self, diagnostic: Diagnostic, group: Hashable = "") -> None:
        """Keep a diagnostic, or count it if its group is complete."""
        if self.keeps(group):
            self._kept.append((group, diagnostic))
        self.count(1, group)

    def count(self, number: int, group: Hashable = "") -> None:
        """Count further diagnostics of a group without keeping them."""
        self._count[group] += number

    def more(self, group: Hashable = "") -> int:
        """Number that are counted but not kept."""
        return max(self._count[group] - self.most, 0)

    @property
    def kept(self) -> tuple[Diagnostic, ...]:
        """The kept diagnostics, in the order of their addition."""
        return tuple(diagnostic for _, diagnostic in self._kept)

    def has_errors(self) -> bool:
        """Whether errors are among them."""
        return bool(errors(self.kept))

    def in_order(self, key: Callable[[Diagnostic], Any]) -> tuple[Diagnostic, ...]:
        """The kept diagnostics by a sort key; the last one of a group states how many more there are."""
        ordered = sorted(self._kept, key=lambda entry: key(entry[1]))
        last = {group: index for index, (group, _) in enumerate(ordered)}
        diagnostics = [diagnostic for _, diagnostic in ordered]
        for group, index in last.items():
            if more := self.more(group):
                found = f"{diagnostics[index].found}, and {more} more like it"
                diagnostics[index] = replace(diagnostics[index], found=found)
        return tuple(diagnostics)
