# SPDX-License-Identifier: LGPL-2.1-or-later
"""Quantities: numbers in mm, mm/s and degrees, as texts in the units that the user chose in FreeCAD."""

from __future__ import annotations

import re

from FreeCAD import Units

from pkm_post.freecad_app.user_units import local

_ANY_DIGIT = re.compile(r"[1-9]")
"""None for a number rounded to zero, which has no sign."""


def _text(value: float, kind: object) -> str:
    shown = Units.Quantity(value, kind).UserString
    text = shown.decode() if isinstance(shown, bytes) else str(shown)
    return text if _ANY_DIGIT.search(text) else text.removeprefix("-")


def length_text(mm: float) -> str:
    """A length."""
    return _text(mm, Units.Length)


def angle_text(degrees: float) -> str:
    """An angle, without a blank: FreeCAD 1.0 has one, at which lines break."""
    return _text(degrees, Units.Angle).replace(" °", "°")


def volume_text(cubic_mm: float) -> str:
    """A volume."""
    return _text(cubic_mm, Units.Volume)


def speed_text(mm_per_second: float) -> str:
    """A feed or a speed."""
    return _text(mm_per_second, Units.Velocity)


def seconds_text(seconds: float, digits: int = 1) -> str:
    """A time in seconds."""
    return f"{local(f'{seconds:.{digits}f}')} s"


def time_text(seconds: float) -> str:
    """Hours, minutes and seconds."""
    minutes, rest = divmod(round(max(seconds, 0.0), 1), 60.0)
    hours, minutes = divmod(int(minutes), 60)
    return local(f"{hours}:{minutes:02d}:{rest:04.1f}" if hours else f"{minutes}:{rest:04.1f}")
