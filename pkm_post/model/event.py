# SPDX-License-Identifier: LGPL-2.1-or-later
"""Events: actions between motions, by row number. The machine is at rest at each of them.

An event at row r takes place before the motion of row r; r = N, one past the last row, is after the last motion.
"""

from __future__ import annotations

import enum
from dataclasses import dataclass


class EventKind(enum.IntEnum):
    """Kind of event. Trajectory files store the numbers: kinds may be added, never changed."""

    TOOL_CHANGE = 1
    """value: the tool number."""
    SPINDLE = 2
    """value: speed in revolutions per minute, positive clockwise seen from the spindle, 0 stops it."""
    COOLANT = 3
    """value: 0 off, 1 flood, 2 mist."""
    DWELL = 4
    """value: duration in s."""
    STOP = 5
    """value: 0 program stop, 1 optional stop."""


@dataclass(frozen=True)
class Event:
    """One event at a row of a table of motions."""

    row: int
    kind: EventKind
    value: float
