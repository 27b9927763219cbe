# SPDX-License-Identifier: LGPL-2.1-or-later
"""User units: amounts of the core, in mm, degrees and their rates, in the units that the user chose in FreeCAD.

FreeCAD's own texts have a fixed number of decimals, too few for micrometres; here an amount has four digits.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from FreeCAD import Units

_PARSED = {"mm": "mm", "um": "um", "degrees": "deg", "deg": "deg", "mm/s": "mm/s", "N/mm": "N/mm"}
"""Units of the core as FreeCAD writes them."""
_AS_THEY_ARE = {"degrees/s": "°/s"}
"""The same with symbols that need no translation."""
_BY_LENGTH = {"mm/s^2": "{}/s^2", "mm/s^3": "{}/s^3"}
"""Units that most schemas of FreeCAD lack; derived from that of lengths."""
_TYPICAL = "100 mm"
"""A length with the general unit of lengths; FreeCAD has others for small ones."""
_FOUR_DIGITS, _LARGE = 9999.5, 1e7


def in_user_units(values: Sequence[float | None], unit: str) -> tuple[tuple[str, ...], str]:
    """Numbers for comparison, all in FreeCAD's unit for the largest of them.

    Args:
        values: in the given unit; None and non-finite values become a dash.
        unit: a unit of the core; one unknown to FreeCAD is not converted.

    Returns:
        The numbers as texts, and the displayed unit.
    """
    finite = [value for value in values if value is not None and math.isfinite(value)]
    factor, shown = scale_of(max(map(abs, finite), default=0.0), unit)
    return tuple(_number(value / factor) if value in finite else "–" for value in values), shown


def amount_text(value: float, unit: str) -> str:
    """A number with its unit, as displayed to the user."""
    (number,), shown = in_user_units([value], unit)
    return f"{number}{'' if shown == '°' else ' '}{shown}".rstrip()


def scale_of(value: float, unit: str) -> tuple[float, str]:
    """Size of the user's unit in units of the core, for amounts of this size, and the user's unit."""
    if unit in _PARSED:
        one = Units.Quantity(f"1 {_PARSED[unit]}").Value
        factor, shown = _preferred(f"{value:.12g} {_PARSED[unit]}")
        return factor / one, shown
    if unit in _BY_LENGTH:
        factor, length = _preferred(_TYPICAL)
        return factor, _BY_LENGTH[unit].format(length)
    return 1.0, _AS_THEY_ARE.get(unit, unit)


def _preferred(quantity: str) -> tuple[float, str]:
    """Factor and unit of the user's schema for a quantity."""
    _, factor, unit = Units.Quantity(quantity).getUserPreferred()
    return float(factor), "in" if unit == '"' else str(unit)


def _number(value: float) -> str:
    """Four digits, without an exponent for numbers of everyday size."""
    return local(f"{value:.0f}" if _FOUR_DIGITS <= abs(value) < _LARGE else f"{value:.4g}")


def local(number: str) -> str:
    """A number with the decimal separator of FreeCAD's own numbers."""
    return number.replace(".", decimal_point())


def decimal_point() -> str:
    """The decimal separator of FreeCAD's own numbers, by its setting of the number format."""
    return "," if "," in Units.Quantity(0.5).UserString else "."
