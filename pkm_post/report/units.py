# SPDX-License-Identifier: LGPL-2.1-or-later
"""Units: the lengths and speeds of the page of a report in mm or inch; the report itself is in mm."""

from __future__ import annotations

from dataclasses import dataclass

_MM_IN_INCH = 25.4
_SMALL = 0.1
"""mm: quantities with a limit up to this are shown in um."""


@dataclass(frozen=True)
class Shown:
    """Display form of a unit.

    Attributes:
        unit: its text.
        factor: of a value in the unit of the report.
    """

    unit: str
    factor: float = 1.0

    def text(self, value: float) -> str:
        """A value with its unit."""
        return f"{self.factor * value:.4g} {self.unit}".rstrip()


INCH = {
    "mm": Shown("in", 1 / _MM_IN_INCH),
    "um": Shown("in", 1e-3 / _MM_IN_INCH),
    "mm/s": Shown("in/min", 60 / _MM_IN_INCH),
    "mm/s^2": Shown("in/s^2", 1 / _MM_IN_INCH),
    "mm/s^3": Shown("in/s^3", 1 / _MM_IN_INCH),
}
"""Units with lengths, by those of the report."""


def shown(unit: str, of_page: str, limit: float | None = None) -> Shown:
    """Display form of a unit of the report on a page.

    Args:
        unit: such as mm or degrees.
        of_page: mm or inch.
        limit: of the quantity, in ``unit``; small lengths are in um.
    """
    if of_page == "inch":
        return INCH.get(unit, Shown(unit))
    return Shown("um", 1000.0) if unit == "mm" and limit is not None and 0.0 < limit <= _SMALL else Shown(unit)
