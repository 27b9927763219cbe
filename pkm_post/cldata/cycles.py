# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cycles: what a CYCLE statement says once it is understood, in mm, mm/s and s, whoever wrote it.

Heights are along the tool axis and count from the point of the hole: depth down, all others up.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Strokes:
    """How a kind of cycle works its way to the bottom and back.

    Attributes:
        pecks: "none"; "out", out of the hole after each peck; "break", a little up to break the chip.
        feed_out: the tool leaves the hole at the feed.
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
        strokes: how it gets to the bottom.
        depth: of the bottom below the point.
        clearance: height in which the tool may move sideways.
        start: height where the feed begins, at most the clearance.
        height: to which the tool returns, at least the clearance.
        to_initial: it returns to where it was before the first hole instead, if that is higher than the clearance.
        step: largest depth of one peck; 0 for none.
        first_step: of the first one.
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
