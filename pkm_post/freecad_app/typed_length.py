# SPDX-License-Identifier: LGPL-2.1-or-later
"""Typed length: a length as a person types it, with or without a unit, and as it is shown to be typed over.

Text enters, mm leave, and the other way round. What FreeCAD's own fields take for a length where a wrong one does harm
is not taken here: their ``12,5 cm`` is 1250 mm, their ``4 1/2 in`` 4 mm, and for ``abc`` they keep what was there
before. Letters beyond ASCII FreeCAD leaves out.
"""

from __future__ import annotations

import math

import FreeCAD as App

_DIGITS = 9
"""Shown of a length: nanometres of a metre."""
_MICRO = "µ"
"""The one letter of FreeCAD's units of length that is not of ASCII."""
_USUAL = "100 mm"
"""A length of the size of a tool; a number without a unit is in the unit that it is shown in."""


def typed_length(text: str, point: str = ".") -> float | None:
    """The length that was typed, mm; None if it is none above zero.

    Args:
        text: such as ``120``, ``120 mm``, ``4.5 in`` or ``3*40 mm``.
        point: what stands before decimals in the language of the user; a full stop always does. A comma that is no
            decimal point has no meaning.
    """
    text = text.replace(point, ".")
    if not text.strip() or "," in text or not text.replace(_MICRO, "").isascii():
        return None
    try:
        quantity = App.Units.Quantity(text)
    except ValueError:  # a syntax error
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
