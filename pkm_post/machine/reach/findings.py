# SPDX-License-Identifier: LGPL-2.1-or-later
"""Findings: check results along a path, by row, as data and as diagnostics with their source positions."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

import numpy as np

from pkm_post.geometry import Array
from pkm_post.model import Amount, Diagnostic, Diagnostics, Kind, Pattern, Phrase, Trajectory

DISPLAY_UNITS: dict[str, tuple[str, float]] = {
    "mm": ("mm", 1.0),
    "rad": ("degrees", float(np.degrees(1.0))),
    "mm/s": ("mm/s", 1.0),
    "N/mm": ("N/mm", 1.0),
    "": ("", 1.0),
}
"""Display unit and factor for each internal unit."""
_DIGITS = {"mm": ".3f", "degrees": ".3f", "": ".4f"}
"""Format of the amount of a violation by its display unit; one decimal for others."""


@dataclass(frozen=True)
class CheckedLimit:
    """Subject of a check.

    Attributes:
        name: display name.
        code: diagnostic code of a violation.
        unit: of the margin, a key of ``DISPLAY_UNITS``.
        parts: the items with a margin each: struts, pairs of bodies.
        violation: pattern of the message of a violation, with {part} and {by}.
        rapid_code: diagnostic code of a violation in a rapid move; empty for the same one.
        values: further values of the pattern.
    """

    name: str
    code: str
    unit: str
    parts: tuple[str, ...]
    violation: Pattern
    rapid_code: str = field(default="", kw_only=True)
    values: Mapping[str, object] = field(default_factory=dict, kw_only=True)

    def code_of(self, kind: int) -> str:
        """The diagnostic code of a violation in a move of a kind."""
        return self.rapid_code if self.rapid_code and kind == Kind.RAPID else self.code

    def describe(self, part: int, margin: float) -> Phrase:
        """The message of a violation."""
        unit, factor = DISPLAY_UNITS[self.unit]
        by = Amount(-margin * factor, unit, _DIGITS.get(unit, ".1f"))
        return self.violation.phrase(part=self.parts[part], by=by, **self.values)


@dataclass(frozen=True)
class ReachFinding:
    """Result of one check on a path of N rows.

    Attributes:
        subject: the checked subject.
        margin: (N,) least margin found on the cell that ends at the row, its end included; negative is a violation.
            A comfortable margin may be a lower bound, but is never the least.
        part: (N,) index into ``subject.parts`` of the item with this margin.
        at_least: proven lower bound of the margin on the whole path, also between the rows; minus infinity where
            only the rows were checked.
    """

    subject: CheckedLimit = field(repr=False)
    margin: Array
    part: Array
    at_least: float

    @property
    def worst_row(self) -> int:
        """Row of the least margin."""
        return int(np.argmin(self.margin))

    @property
    def first_bad_row(self) -> int | None:
        """First row with a violation on its cell, or None."""
        bad = self.margin < 0
        return int(np.argmax(bad)) if bad.any() else None


def finding_diagnostics(findings: Iterable[ReachFinding], trajectory: Trajectory, segment: Array) -> Diagnostics:
    """Diagnostics of violations: one for each operation, check and code, at the worst row.

    Args:
        findings: of a path along the trajectory.
        trajectory: source positions of the segments.
        segment: (N,) segment of each row.
    """
    operation, rapid = trajectory.operation[segment], trajectory.kind[segment] == Kind.RAPID
    faults = []
    for finding in findings:
        subject = finding.subject
        group = 2 * operation + rapid if subject.rapid_code else operation
        for number in np.unique(group[finding.margin < 0]):
            row = int(np.argmin(np.where(group == number, finding.margin, np.inf)))
            found = subject.describe(int(finding.part[row]), float(finding.margin[row]))
            code = subject.code_of(int(trajectory.kind[segment[row]]))
            faults.append(Diagnostic(code, trajectory.place(int(segment[row])), found))
    return tuple(sorted(faults, key=lambda fault: (fault.place.operation, fault.place.line, fault.code)))
