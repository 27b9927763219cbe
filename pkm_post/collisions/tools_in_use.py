# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tools in use: where on a way each tool cuts and moves rapidly, and what may have been cut before. Units: mm."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from pkm_post.collisions.against_meshes import Driven
from pkm_post.collisions.contacts import Contacts
from pkm_post.collisions.tool_shapes import Profile, cutter_profile
from pkm_post.geometry.gather import numbered
from pkm_post.geometry.vectors import Array, dot
from pkm_post.model import Kind, Tool
from pkm_post.model.setup import Setup, Shank
from pkm_post.model.tool import largest_corner

_STEP = 0.2
"""mm: within half of it a point of the part that a cutter came to counts as cut."""


@dataclass(frozen=True)
class InUse:
    """A tool and where it is used.

    Attributes:
        tool: the tool, the smallest that it can be: a ball nose where its corner is not known.
        largest: the largest that it can be: a flat end mill there.
        shank: None where it is not known where its cutting edges end.
        cutting: (K,) cells of the way in which it moves at a feed.
        rapid: (K,) cells in which it moves rapidly.
    """

    tool: Tool
    largest: Tool
    shank: Shank | None
    cutting: Array
    rapid: Array

    @property
    def name(self) -> str:
        """How messages call it."""
        return f"T{self.tool.number}"

    @property
    def edge_length(self) -> float:
        """How far up it cuts; to the spindle nose where nothing else is known."""
        return self.tool.length if self.shank is None else min(self.shank.start, self.tool.length)

    @property
    def has_size(self) -> bool:
        """Whether its cutter can be looked at."""
        return self.tool.diameter > 0 and self.edge_length > 0

    def cells(self) -> Array:
        """All cells in which it is used, (K,) rising."""
        return np.sort(np.concatenate([self.cutting, self.rapid]))

    def profile(self) -> Profile:
        """Of its cutting part, no larger than it is."""
        return cutter_profile(self.tool, self.edge_length)

    def largest_profile(self) -> Profile:
        """Of its cutting part, no smaller than it is but for the chords of its corner."""
        return cutter_profile(self.largest, self.edge_length)


def tools_in_use(driven: Driven, setup: Setup) -> tuple[InUse, ...]:
    """The tools of a trajectory by number."""
    trajectory, cells = driven.trajectory, np.arange(1, len(driven.way))
    number, rapid = trajectory.tool[driven.segment[1:]], trajectory.kind[driven.segment[1:]] == Kind.RAPID
    return tuple(
        InUse(*_sizes(trajectory.tools[one], setup), setup.shanks.get(one), cells[mine & ~rapid], cells[mine & rapid])
        for one, mine in ((int(one), number == one) for one in np.unique(number))
    )


def _sizes(tool: Tool, setup: Setup) -> tuple[Tool, Tool]:
    """The smallest and the largest that a tool can be."""
    if tool.corner_known and tool.number not in setup.unknown_corners:
        return tool, tool
    return replace(tool, corner_radius=largest_corner(tool.diameter, tool.bottom_angle, tool.side_angle)), tool


def not_cut_before(driven: Driven, used: Sequence[InUse], met: Contacts) -> Contacts:
    """Those contacts whose points no cutter has come to at a feed before."""
    cut = np.zeros(len(met), dtype=bool)
    for one in used:
        if not one.has_size:
            cut |= met.cell > (one.cutting[0] if len(one.cutting) else np.inf)
            continue
        for row in np.flatnonzero(~cut):
            cut[row] = _reaches(driven, one, one.cutting[one.cutting < met.cell[row]], met.point[row])
    return Contacts(met.cell[~cut], met.share[~cut], met.point[~cut], met.distance[~cut])


def _reaches(driven: Driven, used: InUse, cells: Array, point: Array) -> bool:
    """Whether a cutter comes to a point in some cells, or nearly so."""
    profile, way = used.largest_profile(), driven.way
    change = way.travel[cells] + way.angle[cells] * profile.farthest
    wide = float(profile.radius.max())
    high, out = _in_tool(way.tip[cells], way.axis[cells], point)
    cells = cells[(high > -change) & (high < profile.height[-1] + change) & (out < wide + change)]
    change = way.travel[cells] + way.angle[cells] * profile.farthest
    row, number = numbered(np.maximum(np.ceil(change / _STEP), 1).astype(np.int64))
    share = (number + 1) / np.maximum(np.ceil(change / _STEP), 1)[row]
    tip, axis, _, _ = way.inside(cells[row], share)
    return bool(profile.contains(*_in_tool(tip, axis, point), _STEP).any())


def _in_tool(tip: Array, axis: Array, point: Array) -> tuple[Array, Array]:
    """Height of a point above the tips of tools, and its distance from their axes, (M,) each."""
    away = point - tip
    high = dot(away, axis)
    return high, np.sqrt(np.maximum(dot(away, away) - high * high, 0.0))
