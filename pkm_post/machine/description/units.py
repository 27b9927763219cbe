# SPDX-License-Identifier: LGPL-2.1-or-later
"""Units of a machine file: the file states its units once, and every number is converted by its dimension.

Input: the names under ``[units]``. Output: for each dimension the factor from file units to mm, rad and s. No other
module converts units.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

UNITS: dict[str, dict[str, float]] = {
    "length": {"mm": 1.0, "inch": 25.4},
    "angle": {"deg": math.pi / 180.0, "rad": 1.0},
    "time": {"s": 1.0},
}
"""Allowed units of each base quantity and their size in mm, rad, s. The first one is assumed in a file with an
unknown unit, to check the rest of it."""


class Dimension(NamedTuple):
    """Dimension of an entry, and its plausible range.

    Attributes:
        noun: name in the documentation.
        unit: its unit in a file that uses mm, deg and s; ``-`` for plain numbers and texts.
        least: smallest plausible magnitude of a positive number, in that unit.
        most: largest plausible magnitude of any number, in that unit.
        length: exponent of the length unit.
        angle: exponent of the angle unit.
        time: exponent of the time unit.
    """

    noun: str
    unit: str
    least: float
    most: float
    length: int = 0
    angle: int = 0
    time: int = 0


PLAIN = Dimension("plain number", "-", 0.0, 1e12)
LENGTH = Dimension("length", "mm", 1e-3, 1e6, length=1)
SPEED = Dimension("speed", "mm/s", 1e-3, 1e6, length=1, time=-1)
ACCELERATION = Dimension("acceleration", "mm/s^2", 1e-2, 1e9, length=1, time=-2)
JERK = Dimension("jerk", "mm/s^3", 1e-1, 1e12, length=1, time=-3)
ANGLE = Dimension("angle", "deg", 1e-3, 1e4, angle=1)
TIME = Dimension("time", "s", 1e-3, 1e4, time=1)
TURNING_RATE = Dimension("turning rate", "deg/s", 1e-3, 1e6, angle=1, time=-1)
MILLISECONDS = Dimension("interval", "ms", 1, 1e3)
"""Whole ms regardless of the file units: controllers count them."""
RATE = Dimension("gain", "1/s", 1e-3, 1e6)
"""Per second, the only time unit of a file."""
BLOCK_RATE = Dimension("block rate", "1/s", 10, 1e6)
"""Points of a motion per second, the only time unit of a file."""
SPINDLE_SPEED = Dimension("spindle speed", "1/min", 1e-2, 1e6)
"""Revolutions per minute regardless of the file units, as is usual for spindles."""
COUNT_DENSITY = Dimension("counts per length", "1/mm", 1e-3, 1e9)
"""Per mm regardless of the file units: the name of the entry includes the unit."""
SPINDLE_ACCELERATION = Dimension("spindle acceleration", "turn/s^2", 1e-2, 1e6)
"""Turns regardless of the file units, as revolutions are for the speed of spindles."""
COUNTS_OF_A_TURN = Dimension("counts per turn", "1/turn", 1.0, 1e9)
STIFFNESS = Dimension("stiffness", "N/mm", 1e-3, 1e12)
"""N/mm regardless of the file units, as a file states no unit of force."""
FORCE = Dimension("force", "N", 1e-3, 1e12)
SINGULAR_VALUE = Dimension("singular value", "-", 1e-6, 1e3)
DIMENSIONS = (
    LENGTH, SPEED, ACCELERATION, JERK, ANGLE, TIME, TURNING_RATE, RATE, BLOCK_RATE, SPINDLE_SPEED,
    SPINDLE_ACCELERATION, COUNT_DENSITY, COUNTS_OF_A_TURN, STIFFNESS, FORCE, SINGULAR_VALUE,
)  # fmt: skip
"""Dimensions with their own plausible range, in the order of the documentation."""
_OF_THE_TABLE = {quantity: next(iter(sizes.values())) for quantity, sizes in UNITS.items()}
"""Units of ``Dimension.unit``: mm, deg and s."""


class Scale(NamedTuple):
    """Conversion factor and plausible range of the numbers of an entry.

    Attributes:
        factor: from file units to mm, rad and s.
        least: smallest plausible magnitude of a positive number, in mm, rad and s.
        most: largest plausible magnitude, in mm, rad and s.
        words: the range as text.
    """

    factor: float
    least: float
    most: float
    words: str

    @classmethod
    def of(cls, dimension: Dimension, units: dict[str, float]) -> Scale:
        """Scale of a quantity in a file with these units, from ``stated_units``."""
        size, unit = factor(dimension, _OF_THE_TABLE), "" if dimension.unit == "-" else f" {dimension.unit}"
        words = f"sizes from {dimension.least:g} to {dimension.most:g}{unit} make sense"
        return cls(factor(dimension, units), dimension.least * size, dimension.most * size, words)


def stated_units(document: dict[str, Any]) -> dict[str, float]:
    """Size of each base unit of the file; the default one where the file states no known unit."""
    stated = document.get("units")
    table = stated if isinstance(stated, dict) else {}
    return {
        quantity: sizes.get(str(table.get(quantity)), next(iter(sizes.values()))) for quantity, sizes in UNITS.items()
    }


def factor(dimension: Dimension, units: dict[str, float]) -> float:
    """Conversion factor of a quantity from file units to mm, rad, s.

    Args:
        dimension: the dimension of the quantity.
        units: the sizes of the base units, from ``stated_units``.
    """
    return float(
        units["length"] ** dimension.length * units["angle"] ** dimension.angle * units["time"] ** dimension.time
    )
