# SPDX-License-Identifier: LGPL-2.1-or-later
"""Policy: user options of the spin."""

from __future__ import annotations

import enum
import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

STROKE, JOINTS, SINGULAR = range(3)
"""Columns of ``normalised_margins``, the shares that an objective weighs."""


class SpinRule(enum.Enum):
    """Source of the spin."""

    ZERO = "zero"
    """Zero torsion: the platform takes the shortest rotation from upright."""
    X_IN_PLANE = "x-in-plane"
    """The x axis of the platform stays parallel to a vertical plane: a fixed angle C of Rz(C) Ry(B) Rx(A)."""
    Y_IN_PLANE = "y-in-plane"
    """The y axis of the platform stays parallel to a vertical plane."""
    FILE = "file"
    """Spin from the part program; zero torsion where it gives none."""
    OPTIMISED = "optimise"
    """Spin with the largest margins, by a search over the whole path."""


OBJECTIVES: Mapping[str, Mapping[int, float]] = MappingProxyType(
    {
        "stroke": {STROKE: 1.0},
        "joints": {JOINTS: 1.0},
        "singular": {SINGULAR: 1.0},
        "weighted": {STROKE: 1.0, JOINTS: 1.0, SINGULAR: 1.0},
    }
)
"""Weights of the shares by name; a share without a weight only has to be above zero."""


@dataclass(frozen=True)
class SpinPolicy:
    """A rule and its parameters.

    Attributes:
        rule: source of the spin.
        heading: heading of the plane of a rule that has one, rad from x towards y.
        objective: quantity to maximise, a key of ``OBJECTIVES``.
        rate: largest change of the spin by path length, rad/mm; a degree of tool axis rotation counts as 1 mm.
        widest: largest difference from the spin at home, rad. Beyond 90 degrees lies a singular pose.
        step: first step of the search, rad; it is refined to a sixteenth.
    """

    rule: SpinRule = SpinRule.ZERO
    heading: float = 0.0
    objective: str = "stroke"
    rate: float = math.radians(0.5)
    widest: float = math.radians(40.0)
    step: float = math.radians(2.0)

    def __post_init__(self) -> None:
        if self.objective not in OBJECTIVES:
            raise ValueError(f"objective: expected one of {', '.join(OBJECTIVES)}, got {self.objective!r}")
        if not (self.rate > 0 and self.widest > 0 and self.step > 0):
            raise ValueError(f"expected rate, widest and step above 0, got {self.rate}, {self.widest}, {self.step}")

    @property
    def weights(self) -> Mapping[int, float]:
        """The shares that count, by column, with their weights."""
        return OBJECTIVES[self.objective]


ZERO_TORSION = SpinPolicy()
