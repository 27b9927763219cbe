# SPDX-License-Identifier: LGPL-2.1-or-later
"""Findings: what the checks of a way found, by row; as data, and as diagnostics with their places."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np

from pkm_post.geometry.vectors import Array
from pkm_post.model import Diagnostic, Trajectory

SHOWN: dict[str, tuple[str, float]] = {
    "mm": ("mm", 1.0),
    "rad": ("degrees", float(np.degrees(1.0))),
    "mm/s": ("mm/s", 1.0),
    "N/mm": ("N/mm", 1.0),
    "": ("", 1.0),
}
"""For each unit inside, the one that people are shown, and its factor."""


@dataclass(frozen=True)
class Subject:
    """What is checked.

    Attributes:
        name: for people.
        code: of the diagnostic of a violation.
        unit: of the margin, a key of ``SHOWN``.
        parts: what may have the least margin: struts, pairs of bodies.
        told: how a violation is told, with {part} and {by}.
    """

    name: str
    code: str
    unit: str
    parts: tuple[str, ...]
    told: str

    def tell(self, part: int, margin: float) -> str:
        """A violation in words."""
        return self.told.format(part=self.parts[part], by=-margin * SHOWN[self.unit][1])


@dataclass(frozen=True)
class ReachFinding:
    """What one check says of a way of N rows.

    Attributes:
        subject: what was checked.
        margin: (N,) least margin found on the cell that ends at the row, its end included; negative is a violation.
            Where much is left it may not have been computed: then it is less than it need be, but not the least.
        part: (N,) index into ``subject.parts`` of what has this margin.
        at_least: proven lower bound of the margin on the whole way, between the rows as well; minus infinity where
            only the rows were looked at.
    """

    subject: Subject = field(repr=False)
    margin: Array
    part: Array
    at_least: float

    @property
    def worst_row(self) -> int:
        """The row of the least margin."""
        return int(np.argmin(self.margin))

    @property
    def first_bad_row(self) -> int | None:
        """The first row with a violation on its cell, if there is one."""
        bad = self.margin < 0
        return int(np.argmax(bad)) if bad.any() else None


def faults_of(findings: Iterable[ReachFinding], trajectory: Trajectory, segment: Array) -> tuple[Diagnostic, ...]:
    """Diagnostics of violations: one for each operation and check, at the worst row.

    Args:
        findings: of a way along the trajectory.
        trajectory: says where each segment comes from.
        segment: (N,) segment each row of the way lies on.
    """
    operation = trajectory.operation[segment]
    faults = []
    for finding in findings:
        for number in np.unique(operation[finding.margin < 0]):
            row = int(np.argmin(np.where(operation == number, finding.margin, np.inf)))
            found = finding.subject.tell(int(finding.part[row]), float(finding.margin[row]))
            faults.append(Diagnostic(finding.subject.code, trajectory.place(int(segment[row])), found))
    return tuple(sorted(faults, key=lambda fault: (fault.place.operation, fault.place.line, fault.code)))
