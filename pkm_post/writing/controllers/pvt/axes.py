# SPDX-License-Identifier: LGPL-2.1-or-later
"""Axes: the axis definitions that make axis values true strut lengths, and the stroke in counts.

    counts = counts_per_mm * (strut length - zero_length)

Enters: settings, and the stroke of the struts in mm. Leaves: lines of text, and exact decimals: binary rounding would
add spurious digits to the file.
"""

from __future__ import annotations

import math
from decimal import Decimal

from pkm_post.writing.controllers.pvt.decimals import exact, plain
from pkm_post.writing.controllers.pvt.settings import Settings

ROTARY_LETTERS = "ABC"
"""Axes that controllers of the family treat as rotary."""


def check_stroke(stroke: tuple[float, float]) -> None:
    """Check that the stroke is two increasing lengths.

    Raises:
        ValueError: it is not.
    """
    shortest, longest = stroke
    if not (math.isfinite(shortest) and math.isfinite(longest) and shortest < longest):
        raise ValueError(f"stroke: expected two finite lengths, the shorter first, got {stroke}")


def axis_definitions(settings: Settings) -> list[str]:
    """The axis definition of each motor: ``#motor->SCALE LETTER OFFSET``, without the spaces."""
    scale = exact(settings.counts_per_mm)
    offsets = [-scale * exact(length) for length in settings.zero_length]
    return [
        f"#{motor}->{plain(scale)}{letter}{'' if offset < 0 else '+'}{plain(offset)}"
        for motor, (letter, offset) in enumerate(zip(settings.letters, offsets, strict=True), start=1)
    ]


def stroke_counts(settings: Settings, stroke: tuple[float, float]) -> list[tuple[Decimal, Decimal]]:
    """The lowest and highest count of each strut."""
    scale = exact(settings.counts_per_mm)
    ends = [[scale * (exact(length) - exact(zero)) for length in stroke] for zero in settings.zero_length]
    return [(min(counts), max(counts)) for counts in ends]
