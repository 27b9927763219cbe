# SPDX-License-Identifier: LGPL-2.1-or-later
"""Offset options: rounding of corners, leads, and treatment of rows too narrow for the tool in 2D compensation."""

from __future__ import annotations

import math
from dataclasses import dataclass

CHOICES = {"corners": ("chord", "arc"), "leads": ("A", "B"), "swallowed": ("refuse", "remove")}


@dataclass(frozen=True)
class OffsetOptions:
    """Options of contour offsets.

    Attributes:
        corners: rounding of outer corners. "chord": the offset lines are extended until they meet, and beyond a
            right angle are cut off by a chord, as in the paper; "arc": an arc around the corner, as in LinuxCNC.
        leads: "A" leads straight to and from the offset point at the end of the contour; "B" goes around outer corners.
        swallowed: treatment of rows that the tool is too large for: "refuse" the program, or "remove" them.
        tolerance: mm by which the tool may come closer to the contour than its radius.
    """

    corners: str = "chord"
    leads: str = "A"
    swallowed: str = "refuse"
    tolerance: float = 1e-3

    def __post_init__(self) -> None:
        for name, choices in CHOICES.items():
            if getattr(self, name) not in choices:
                raise ValueError(f"OffsetOptions.{name}: expected one of {choices}, got {getattr(self, name)!r}")
        if not (math.isfinite(self.tolerance) and self.tolerance > 0.0):
            raise ValueError(f"OffsetOptions.tolerance: expected a length above 0 mm, got {self.tolerance}")
