# SPDX-License-Identifier: LGPL-2.1-or-later
"""A cutting tool: what compensation and kinematics need of it."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Tool:
    """A rotating cutter.

    Attributes:
        number: tool number, 0 when the source names none.
        name: the label shown to people.
        diameter: cutter diameter in mm, 0 when unknown.
        corner_radius: corner radius in mm: 0 for a flat end mill, half the diameter for a ball.
        length: gauge length in mm, from the spindle nose to the tip.
    """

    number: int
    name: str
    diameter: float
    corner_radius: float
    length: float
