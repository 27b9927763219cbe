# SPDX-License-Identifier: LGPL-2.1-or-later
"""Policy: what the user wants of the spin."""

from __future__ import annotations

import enum
import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from pkm_post.spin.shares import JOINTS, SINGULAR, STROKE


class Rule(enum.Enum):
    """Where the spin comes from."""

    ZERO = "zero"
    """Zero torsion: the platform takes the shortest rotation from upright."""
    X_IN_PLANE = "x-in-plane"
    """The x axis of the platform stays parallel to a vertical plane: a fixed angle C of Rz(C) Ry(B) Rx(A)."""
    Y_IN_PLANE = "y-in-plane"
    """The y axis of the platform stays parallel to a vertical plane."""
    FILE = "file"
    """The part program says it; zero torsion where it does not."""
    OPTIMISED = "optimise"
    """The whole path is searched for the spin that leaves most room."""


OBJECTIVES: Mapping[str, Mapping[int, float]] = MappingProxyType(
    {
        "stroke": {STROKE: 1.0},
        "joints": {JOINTS: 1.0},
        "singular": {SINGULAR: 1.0},
        "weighted": {STROKE: 1.0, JOINTS: 1.0, SINGULAR: 1.0},
    }
)
"""By name the weight of each share; a share without a weight need only be above zero."""


@dataclass(frozen=True)
class Policy:
    """A rule and its numbers.

    Attributes:
        rule: where the spin comes from.
        heading: of the plane of a rule that has one, rad from x towards y.
        objective: what is to be as large as possible, a key of ``OBJECTIVES``.
        rate: largest change of the spin by path length, rad/mm; a degree that the tool axis turns counts as 1 mm.
        widest: largest difference from the spin at home, rad. Beyond 90 degrees lies a singular pose.
        step: first step of the search, rad; it is refined to a sixteenth.
    """

    rule: Rule = Rule.ZERO
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


ZERO_TORSION = Policy()
