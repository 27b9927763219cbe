# SPDX-License-Identifier: LGPL-2.1-or-later
"""Exchanged: plunge and lift of each open pass, and their replacements when the pass is reversed.

Takes passes and links; returns leads at comparable heights. If the tool axis is the same at both ends of a pass,
heights are measured along it, so a clearance plane stays a plane; otherwise, or where a program keeps one distance to
all its passes, heights are distances from either end.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array, dot, norm
from pkm_post.model import Program
from pkm_post.toolpath.placement.leads import LEVEL, Lead, Rows, above_plane, approach, departure, gone_down, gone_up
from pkm_post.toolpath.placement.links import Link

_ONE_AXIS = 1e-3
"""rad within which tool axes count as equal."""
_ONE_HEIGHT = 1e-5
"""mm within which heights count as equal, with six decimals."""


@dataclass(frozen=True)
class Exchange:
    """The leads of an open pass.

    Attributes:
        plunge: the approach.
        lift: the departure.
        feed: feed of the first row of the pass, mm/s: that of the plunge where the pass was reached only by rapid
            moves.
    """

    plunge: Lead
    lift: Lead
    feed: float

    def is_high(self) -> bool:
        """Whether the lift ends at or above the height that rapid moves came down to, or there is no lift."""
        return not len(self.lift.way) or bool(self.lift.height[-1] >= self.plunge.rapid_to - LEVEL)

    def ways(self) -> tuple[Rows, Rows, int, int]:
        """The rows to the pass and from it, and the old rows that end where the former begin and the latter end."""
        slow = self.plunge.feed[0] if np.isfinite(self.plunge.feed[:1]).any() else self.feed
        enter, leave = gone_down(self.lift, self.plunge, slow), gone_up(self.plunge, self.lift, slow)
        return enter, leave, int(self.lift.point[-1]), int(self.plunge.point[-1])


def exchanges(program: Program, runs: Array, between: list[Link], whole: Array) -> Mapping[int, Exchange]:
    """The leads of the open passes by their number.

    Args:
        program: the old one.
        runs: (P, 2) its passes.
        between: the P + 1 links.
        whole: (P,) closed passes.
    """
    made = {}
    for number in np.flatnonzero(~whole).tolist():
        first, behind = runs[number].tolist()
        plunge = approach(program, between[number].approach, first)
        lift = departure(program, between[number + 1].departure, behind)
        made[number] = Exchange(plunge, lift, float(program.feed[first]))
    by_distance = _by_distance(list(made.values()))
    return {number: each if by_distance else _on_planes(each) for number, each in made.items()}


def _by_distance(leads: list[Exchange]) -> bool:
    """Whether rapid moves come down to one distance from all passes rather than to one plane."""
    distance = np.array([each.plunge.rapid_to for each in leads])
    start, axis = (np.array([getattr(each.plunge, name)[0] for each in leads]) for name in ("position", "tool_axis"))
    if len(leads) < 2 or np.ptp(distance) > _ONE_HEIGHT:
        return False
    steady = bool((norm(axis - axis[0]) < _ONE_AXIS).all())
    return not steady or float(np.ptp(dot(start, axis[:1]))) > _ONE_HEIGHT


def _on_planes(pair: Exchange) -> Exchange:
    """The leads with heights from one plane, if it is normal to both tool axes, and rapid moves end above the pass."""
    if norm(pair.plunge.tool_axis[0] - pair.lift.tool_axis[0]) > _ONE_AXIS:
        return pair
    plunge, lift = (above_plane(lead, pair.plunge.position[0]) for lead in (pair.plunge, pair.lift))
    return Exchange(plunge, lift, pair.feed) if plunge.rapid_to > lift.height[0] + _ONE_HEIGHT else pair
