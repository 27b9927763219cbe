# SPDX-License-Identifier: LGPL-2.1-or-later
"""A cutting tool: what compensation and kinematics need of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

Array = np.ndarray[Any, np.dtype[Any]]


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


def lengths_of(tools: Mapping[int, Tool], numbers: Array) -> Array:
    """Gauge lengths of a column of tool numbers, (N,) in mm.

    Args:
        tools: the tools by number.
        numbers: (N,) numbers, all of them among the tools.
    """
    known = np.array(sorted(tools), dtype=np.int64)
    lengths: Array = np.array([tools[number].length for number in known])[np.searchsorted(known, numbers)]
    return lengths
