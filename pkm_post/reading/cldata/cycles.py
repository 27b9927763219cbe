# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cycles: an interpreted CYCLE statement of any CAM system, in mm, mm/s and s.

Heights are along the tool axis, relative to the hole point: depth is positive downwards, all others upwards.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Strokes:
    """Stroke pattern of a kind of cycle.

    Attributes:
        pecks: "none"; "out", full retract after each peck; "break", short retract to break the chip.
        feed_out: the tool retracts at feed.
    """

    pecks: str = "none"
    feed_out: bool = False


DRILL = Strokes()
DEEP = Strokes("out")
BREAK_CHIP = Strokes("break")
REAM = Strokes(feed_out=True)


@dataclass(frozen=True)
class Cycle:
    """One cycle.

    Attributes:
        strokes: stroke pattern.
        depth: of the bottom below the point.
        clearance: height of lateral moves.
        start: height at which feed starts, at most the clearance.
        height: return height, at least the clearance.
        to_initial: the tool returns to its height before the first hole instead, if above the clearance.
        step: maximum depth of one peck; 0 for none.
        first_step: depth of the first peck.
        dwell: at the bottom, s.
        feed: mm/s.
    """

    strokes: Strokes
    depth: float
    clearance: float
    start: float
    height: float
    to_initial: bool
    step: float
    first_step: float
    dwell: float
    feed: float
