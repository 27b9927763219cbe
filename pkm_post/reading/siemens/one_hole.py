# SPDX-License-Identifier: LGPL-2.1-or-later
"""One hole: common parts of the cycles: heights, and moves along the normal of the plane."""

from __future__ import annotations

import math
from dataclasses import dataclass

from pkm_post.reading.gcode.frames import PLANES
from pkm_post.reading.siemens.blocks import Call
from pkm_post.reading.siemens.machine import SiemensMachine

NAMES = ("X", "Y", "Z")


@dataclass(frozen=True)
class Hole:
    """Heights of a cycle, in the active unit: retraction plane, reference plane, start of the feed, bottom."""

    retract: float
    reference: float
    start: float
    bottom: float


class Drill:
    """One hole at the tool position."""

    def __init__(self, machine: SiemensMachine, row: int, call: Call) -> None:
        self.machine, self.row, self.call = machine, row, call
        self._normal = NAMES[PLANES[machine.state.plane][2]]

    def to(self, motion: int, height: float, feed: float = math.nan) -> None:
        """Move along the normal of the plane."""
        words = {self._normal: height} | ({} if math.isnan(feed) else {"F": feed})
        self.machine.move(self.row, motion, words)

    def dwell(self, value: float, in_turns: bool = False) -> None:
        """Wait some seconds or, for a negative value, spindle turns [SiemensCycles, DTB]."""
        if value < 0 or (in_turns and value):
            self.machine.dwell(self.row, self.machine.seconds_of_turns(abs(value)))
        elif value:
            self.machine.dwell(self.row, value)
