# SPDX-License-Identifier: LGPL-2.1-or-later
"""Certificate: what was asked for, what a program was found to do, and what was not looked at.

Each quantity has its limit, and the moment and the source line where it is worst. Each hazard says how far it is
covered.
"""

from __future__ import annotations

import enum
from dataclasses import dataclass

from pkm_post.model.diagnostics import Diagnostic, Place
from pkm_post.model.program import Array


@dataclass(frozen=True)
class Tolerances:
    """What was asked for.

    Attributes:
        tip: how far the tool tip may be from the programmed path, mm.
        axis: how far the tool axis may be from the programmed one, rad.
    """

    tip: float
    axis: float


@dataclass(frozen=True)
class Finding:
    """One quantity at its worst.

    Attributes:
        code: diagnostic that is given when it does not hold.
        name: what was measured.
        unit: unit of value and limit, as printed.
        value: the worst value, with what can hide between the moments looked at, in that unit.
        limit: what it must not exceed there.
        holds: whether it holds.
        time: s since the start: the moment where it is worst; of what is known of an interval between two knots as a
            whole, like the speed of a strut, its start.
        place: the source line that is executed at that time.
    """

    code: str
    name: str
    unit: str
    value: float
    limit: float
    holds: bool
    time: float
    place: Place

    def diagnostic(self) -> Diagnostic:
        """The fault, for a finding that does not hold."""
        found = f"{self.name} {self._with_unit(self.value)}, allowed {self._with_unit(self.limit)}"
        return Diagnostic(self.code, self.place, f"{found}, {self.time:.3f} s after the start")

    def _with_unit(self, value: float) -> str:
        return f"{value:.6g} {self.unit}".rstrip()


@dataclass(frozen=True)
class Figure:
    """One quantity at its largest, which has no limit.

    Attributes:
        name: what was measured.
        unit: as printed.
        value: in that unit.
        time: s since the start.
        place: the source line that is executed at that time.
    """

    name: str
    unit: str
    value: float
    time: float
    place: Place


class Topic(enum.Enum):
    """What a hazard is about; each topic is one line of what the certificate means."""

    PATH = "tool path"
    LIMITS = "machine limits"
    COLLISIONS = "collisions"
    BESIDE_THE_PATH = "approach, tool change, spindle"
    SETUP = "machine and set-up"


class Extent(enum.Enum):
    """How far a hazard is covered: by a bound that holds everywhere, by samples, or not at all."""

    PROVEN = "proven"
    SAMPLED = "sampled"
    NOT_COVERED = "not covered"


@dataclass(frozen=True)
class Coverage:
    """How far the certificate covers one hazard.

    Attributes:
        topic: what it is about.
        subject: the hazard, such as "spindle and holder against the part".
        extent: how far it is covered.
        detail: against what and how it was checked, or why it was not.
    """

    topic: Topic
    subject: str
    extent: Extent
    detail: str


def meaning(coverage: tuple[Coverage, ...]) -> tuple[str, ...]:
    """What certified means, and what it does not: one line for each topic, by extent."""
    lines = []
    for topic in Topic:
        rows = [row for row in coverage if row.topic is topic]
        by_extent = (
            f"{extent.value}: {', '.join(row.subject for row in rows if row.extent is extent)}"
            for extent in Extent
            if any(row.extent is extent for row in rows)
        )
        lines.append(f"{topic.value}: {'; '.join(by_extent)}")
    return tuple(lines)


@dataclass(frozen=True)
class Certificate:
    """The result of playing a program.

    Attributes:
        findings: one for each quantity, in a fixed order.
        duration: s, without dwells.
        intervals: number of cubics played.
        instants: number of poses that were measured.
        time: (K,) s, at the start of each interval.
        tip_deviation: (K,) largest in the interval by its tolerance, mm.
        tip_tolerance: (K,) what it may be there, mm: that of the program (G64 P), else what was asked for.
        axis_deviation: (K,) largest in the interval, rad.
        coverage: one row for each hazard, in the order of the topics.
        figures: what was measured and has no limit, in a fixed order.
    """

    findings: tuple[Finding, ...]
    duration: float
    intervals: int
    instants: int
    time: Array
    tip_deviation: Array
    tip_tolerance: Array
    axis_deviation: Array
    coverage: tuple[Coverage, ...]
    figures: tuple[Figure, ...]

    @property
    def holds(self) -> bool:
        """Whether everything holds."""
        return all(finding.holds for finding in self.findings)
