# SPDX-License-Identifier: LGPL-2.1-or-later
"""Units of a machine file: the file names its units once, every number in it is converted by its dimension.

Enters: the names under ``[units]``. Leaves: for each dimension the factor that takes a number of the file to mm, rad
and s. Conversion takes place here and nowhere further in.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

UNITS: dict[str, dict[str, float]] = {
    "length": {"mm": 1.0, "inch": 25.4},
    "angle": {"deg": math.pi / 180.0, "rad": 1.0},
    "time": {"s": 1.0},
}
"""Per base quantity the units a file may use and their size in mm, rad, s. The first one is taken to check the
rest of a file whose own unit is unknown."""


@dataclass(frozen=True)
class Dimension:
    """What kind of quantity an entry is.

    Attributes:
        unit: its unit in a file that uses mm, deg and s; ``-`` for plain numbers and texts.
        length: exponent of the length unit.
        angle: exponent of the angle unit.
        time: exponent of the time unit.
    """

    unit: str
    length: int = 0
    angle: int = 0
    time: int = 0


PLAIN = Dimension("-")
LENGTH = Dimension("mm", length=1)
SPEED = Dimension("mm/s", length=1, time=-1)
ACCELERATION = Dimension("mm/s^2", length=1, time=-2)
JERK = Dimension("mm/s^3", length=1, time=-3)
ANGLE = Dimension("deg", angle=1)
TIME = Dimension("s", time=1)
TURNING_RATE = Dimension("deg/s", angle=1, time=-1)
MILLISECONDS = Dimension("ms")
"""Whole ms whatever the units of the file: controllers count them."""
RATE = Dimension("1/s")
"""Per second, the only unit of time that a file may have."""
SPINDLE_SPEED = Dimension("1/min")
"""Revolutions per minute whatever the units of the file: every spindle is named so."""
COUNT_DENSITY = Dimension("1/mm")
"""Per mm whatever the units of the file: the entry carries its unit in its name."""
STIFFNESS = Dimension("N/mm")
"""N/mm whatever the units of the file, as a file states no unit of force."""
FORCE = Dimension("N")


def stated_units(document: dict[str, Any]) -> dict[str, float]:
    """The size of each base unit of the file; the usual one where the file states none that is known."""
    stated = document.get("units")
    table = stated if isinstance(stated, dict) else {}
    return {
        quantity: sizes.get(str(table.get(quantity)), next(iter(sizes.values()))) for quantity, sizes in UNITS.items()
    }


def factor(dimension: Dimension, units: dict[str, float]) -> float:
    """The number that takes a quantity from the units of the file to mm, rad, s.

    Args:
        dimension: what kind of quantity it is.
        units: the sizes of the base units, from ``stated_units``.
    """
    return float(
        units["length"] ** dimension.length * units["angle"] ** dimension.angle * units["time"] ** dimension.time
    )
