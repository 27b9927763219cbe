# SPDX-License-Identifier: LGPL-2.1-or-later
"""Typed length: parses a length typed with or without a unit, and formats one for editing.

Converts between text and mm. Inputs that FreeCAD's own fields accept and misread are refused here, since a wrong length
does harm: their ``12,5 cm`` is 1250 mm, their ``4 1/2 in`` 4 mm, and for ``abc`` they keep the previous value. FreeCAD
drops letters beyond ASCII.
"""

from __future__ import annotations

import math

import FreeCAD as App

_DIGITS = 9
"""Significant digits shown: nanometres of a metre."""
_MICRO = "µ"
"""The only non-ASCII letter in FreeCAD's units of length."""
_USUAL = "100 mm"
"""A length typical of a tool; a number without a unit is in the unit in which this one is displayed."""


def typed_length(text: str, point: str = ".") -> float | None:
    """The typed length, mm; None if it is not a positive length.

    Args:
        text: such as ``120``, ``120 mm``, ``4.5 in`` or ``3*40 mm``.
        point: decimal separator in the user's language; a full stop is always accepted. A comma that is not the
            decimal separator is invalid.
    """
    text = text.replace(point, ".")
    if not text.strip() or "," in text or not text.replace(_MICRO, "").isascii():
        return None
    try:
        quantity = App.Units.Quantity(text)
    except ValueError:  # raised for a syntax error
        return None
    if quantity.Unit not in (App.Units.Unit(), App.Units.Length):
        return None
    _, usual, _ = App.Units.Quantity(_USUAL).getUserPreferred()
    mm = float(quantity.Value * (1.0 if quantity.Unit == App.Units.Length else usual))
    return mm if 0.0 < mm < math.inf else None


def length_text(mm: float, point: str = ".") -> str:
    """A length in the unit that FreeCAD is set to, with all its digits."""
    _, factor, unit = App.Units.Quantity(f"{mm!r} mm").getUserPreferred()
    return f"{mm / factor:.{_DIGITS}g} {unit}".replace(".", point)
