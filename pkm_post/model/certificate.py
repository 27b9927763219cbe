# SPDX-License-Identifier: LGPL-2.1-or-later
"""Certificate: requested tolerances, measured values of a program, and the coverage of hazards.

Each quantity has its limit, and the time and the source line of its worst value. Each hazard has an extent of coverage.
"""

from __future__ import annotations

import enum
from dataclasses import dataclass

from pkm_post.model.columns import Array
from pkm_post.model.diagnostics import Diagnostic, Place
from pkm_post.model.phrase import Amount, Pattern


@dataclass(frozen=True)
class Tolerances:
    """Requested tolerances.

    Attributes:
        tip: largest distance of the tool tip from the programmed path, mm.
        axis: largest angle of the tool axis from the programmed one, rad.
    """

    tip: float
    axis: float


_TOO_LARGE = Pattern("{name} {value}, allowed {limit}, {time:.3f} s after the start")
_TOO_SMALL = Pattern("{name} {value}, at least {limit}, {time:.3f} s after the start")


@dataclass(frozen=True)
class Finding:
    """One quantity at its worst.

    Attributes:
        code: diagnostic of a violation.
        name: measured quantity.
        unit: unit of value and limit, as printed.
        value: the worst value, including the bound between samples, in that unit.
        limit: the limit at that time.
        holds: whether the value is within the limit.
        time: s since the start, at the worst value; for a value of a whole interval between two knots, such as the
            speed of a strut, the start of that interval.
        place: source line executed at that time.
        is_least: whether the limit is a minimum rather than a maximum.
    """

    code: str
    name: str
    unit: str
    value: float
    limit: float
    holds: bool
    time: float
    place: Place
    is_least: bool = False

    def diagnostic(self) -> Diagnostic:
        """Diagnostic of a finding that does not hold."""
        pattern = _TOO_SMALL if self.is_least else _TOO_LARGE
        value, limit = (Amount(each, self.unit, ".6g") for each in (self.value, self.limit))
        found = pattern.phrase(name=self.name, value=value, limit=limit, time=self.time)
        return Diagnostic(self.code, self.place, found)


@dataclass(frozen=True)
class Figure:
    """One quantity without a limit, at its largest.

    Attributes:
        name: measured quantity.
        unit: as printed.
        value: in that unit.
        time: s since the start.
        place: source line executed at that time.
    """

    name: str
    unit: str
    value: float
    time: float
    place: Place


class Topic(enum.Enum):
    """Topic of a hazard; the summary of the certificate has one line per topic."""

    PATH = "tool path"
    LIMITS = "machine limits"
    COLLISIONS = "collisions"
    AUXILIARY = "approach, tool change, spindle"
    SETUP = "machine and set-up"


class Extent(enum.Enum):
    """Extent of coverage: a bound that holds everywhere, samples, or none."""

    PROVEN = "proven"
    SAMPLED = "sampled"
    NOT_COVERED = "not covered"


@dataclass(frozen=True)
class Coverage:
    """Coverage of one hazard by the certificate.

    Attributes:
        topic: topic of the hazard.
        subject: the hazard, such as "spindle and holder against the part".
        extent: extent of coverage.
        detail: the method and the reference of the check, or the reason for none.
    """

    topic: Topic
    subject: str
    extent: Extent
    detail: str


def coverage_summary(coverage: tuple[Coverage, ...]) -> tuple[str, ...]:
    """Scope of the certificate as text: one line for each topic, by extent of coverage."""
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
    """Result of playing a program.

    Attributes:
        findings: one for each quantity, in a fixed order.
        duration: s, without dwells.
        intervals: number of cubics played.
        instants: number of poses that were measured.
        time: (K,) s, at the start of each interval.
        tip_deviation: (K,) largest in the interval relative to its tolerance, mm.
        tip_tolerance: (K,) tolerance there, mm: from the program (G64 P), else the requested one.
        axis_deviation: (K,) largest in the interval, rad.
        coverage: one row for each hazard, in the order of the topics.
        figures: measured quantities without a limit, in a fixed order.
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
        """Whether all findings hold."""
        return all(finding.holds for finding in self.findings)
