# SPDX-License-Identifier: LGPL-2.1-or-later
"""Certificate: what was asked for, and what a program was found to do.

Each quantity has its limit, and the moment and the source line where it is worst.
"""

from __future__ import annotations

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
    """

    findings: tuple[Finding, ...]
    duration: float
    intervals: int
    instants: int
    time: Array
    tip_deviation: Array
    tip_tolerance: Array
    axis_deviation: Array

    @property
    def holds(self) -> bool:
        """Whether everything holds."""
        return all(finding.holds for finding in self.findings)
