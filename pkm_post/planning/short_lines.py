# SPDX-License-Identifier: LGPL-2.1-or-later
"""Short lines: the tolerance with which lines that slow the tool at their corners would become curves.

The points of a CAM system are often farther from a smooth path than the requested tolerance. Their lines remain lines,
and the tool slows at each corner between them. Input: a feed plan, and the feed along it. Output: a warning, if that
takes much of the cutting time and a somewhat wider tolerance helps. Units: mm, rad, s.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from pkm_post.geometry import Array
from pkm_post.model import AT_FEED, Amount, Diagnostic, Diagnostics, FeedStudy, Kind, Phrase, Tolerances, checkpoint
from pkm_post.planning.feed_plan import FeedPlan, curves
from pkm_post.toolpath import Segments

_WIDER = (0.002, 0.005, 0.01, 0.02, 0.05, 0.1)
"""mm and degrees: the tolerances that are tried."""
_MUCH = 0.25
"""Share of the cutting time slowed in this way from which there is a warning."""
_MOST = 0.8
"""Share of that time that is spent on lines which a tolerance makes curves of, for it to be named."""


def slow_corners(plan: FeedPlan, feed: FeedStudy) -> Diagnostics:
    """K160 with the least tolerance that helps, if corners between short lines slow the tool for much of its time."""
    slow = feed.cutting & (feed.planned < AT_FEED * np.minimum(feed.programmed, feed.possible))
    slow &= _lines_left(plan)[feed.row]
    share = float(slow[feed.cutting].mean()) if feed.cutting.any() else 0.0
    if share < _MUCH:
        return ()
    rows, segments = feed.row[slow], Segments.of(plan.trajectory)
    for wider in _wider(plan.tolerances):
        checkpoint()
        joined = np.isin(rows, curves(plan.trajectory, segments, wider).row)
        if joined.mean() >= _MOST:
            place = plan.trajectory.place(int(rows[np.argmin(feed.planned[slow])]))
            return (Diagnostic("K160", place, _found(share, wider, plan.tolerances)),)
    return ()


def _lines_left(plan: FeedPlan) -> Array:
    """Segments that are lines, and in no curve, (N,)."""
    lines: Array = plan.trajectory.kind == Kind.LINE
    lines[plan.path.segments.splines.row] = False
    return lines


def _wider(asked: Tolerances) -> Iterator[Tolerances]:
    """Tolerances to try: wider ones of the tip first, then of the axis as well."""
    wider = [size for size in _WIDER if size > asked.tip]
    yield from (Tolerances(size, asked.axis) for size in wider)
    yield from (Tolerances(size, np.radians(size)) for size in wider if np.radians(size) > asked.axis)


def _found(share: float, wider: Tolerances, asked: Tolerances) -> Phrase:
    time, tip = Amount(100 * share, "%", ".0f"), Amount(wider.tip, "mm")
    if wider.axis == asked.axis:
        return Phrase("in {} of the cutting time; with a tip tolerance of {} they become curves", time, tip)
    return Phrase(
        "in {} of the cutting time; with a tip tolerance of {} and an axis tolerance of {} they become curves",
        time,
        tip,
        Amount(float(np.degrees(wider.axis)), "degrees"),
    )
