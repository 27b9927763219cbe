# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tools in use: cutting and rapid cells of each tool on a path, and material possibly cut before. Units: mm."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from pkm_post.geometry import Array, expand_counts, height_and_radius
from pkm_post.machine.collisions.contacts import Contacts, TrajectoryPath
from pkm_post.machine.collisions.moving_bodies import RevolvedProfile, cutter_profile
from pkm_post.model import Kind, Setup, Shank, Tool, largest_corner_radius

_STEP = 0.2
"""mm: a workpiece point within half of it of a cutter counts as cut."""


@dataclass(frozen=True)
class ToolUse:
    """A tool and the cells in which it is used.

    Attributes:
        tool: smallest possible tool: a ball nose where the corner is unknown.
        largest: largest possible tool: a flat end mill there.
        shank: None if the length of the cutting edges is unknown.
        cutting: (K,) cells of the path in which it moves at feed.
        rapid: (K,) cells in which it moves at rapid.
    """

    tool: Tool
    largest: Tool
    shank: Shank | None
    cutting: Array
    rapid: Array

    @property
    def name(self) -> str:
        """Its name in messages."""
        return f"T{self.tool.number}"

    @property
    def edge_length(self) -> float:
        """Height of the cutting edges; up to the spindle nose if unknown."""
        return self.tool.length if self.shank is None else min(self.shank.start, self.tool.length)

    @property
    def has_size(self) -> bool:
        """Whether the size of its cutter is known."""
        return self.tool.diameter > 0 and self.edge_length > 0

    def cells(self) -> Array:
        """All cells in which it is used, (K,) ascending."""
        return np.sort(np.concatenate([self.cutting, self.rapid]))

    def profile(self) -> RevolvedProfile:
        """Inner bound of its cutting part."""
        return cutter_profile(self.tool, self.edge_length)

    def largest_profile(self) -> RevolvedProfile:
        """Outer bound of its cutting part, except for the chords of its corner."""
        return cutter_profile(self.largest, self.edge_length)


def tools_in_use(driven: TrajectoryPath, setup: Setup) -> tuple[ToolUse, ...]:
    """The tools of a trajectory by number."""
    trajectory, cells = driven.trajectory, np.arange(1, len(driven.poses))
    number, rapid = trajectory.tool[driven.segment[1:]], trajectory.kind[driven.segment[1:]] == Kind.RAPID
    return tuple(
        ToolUse(
            *sizes_between(trajectory.tools[one], setup),
            setup.shanks.get(one),
            cells[mine & ~rapid],
            cells[mine & rapid],
        )
        for one, mine in ((int(one), number == one) for one in np.unique(number))
    )


def sizes_between(tool: Tool, setup: Setup) -> tuple[Tool, Tool]:
    """The smallest and the largest possible size of a tool."""
    if tool.number in setup.cores:
        return setup.core_of(tool), tool
    if tool.corner_known and tool.number not in setup.unknown_corners:
        return tool, tool
    return replace(tool, corner_radius=largest_corner_radius(tool.diameter, tool.bottom_angle, tool.side_angle)), tool


def not_cut_before(driven: TrajectoryPath, used: Sequence[ToolUse], met: Contacts) -> Contacts:
    """The contacts whose points no cutter has reached at feed before."""
    cut = np.zeros(len(met), dtype=bool)
    for one in used:
        if not one.has_size:
            cut |= met.cell > (one.cutting[0] if len(one.cutting) else np.inf)
            continue
        for row in np.flatnonzero(~cut):
            cut[row] = _reaches(driven, one, one.cutting[one.cutting < met.cell[row]], met.point[row])
    return Contacts(met.cell[~cut], met.share[~cut], met.point[~cut], met.distance[~cut])


def _reaches(driven: TrajectoryPath, used: ToolUse, cells: Array, point: Array) -> bool:
    """Whether a cutter reaches a point in some cells, or nearly so."""
    profile, path = used.largest_profile(), driven.poses
    change = path.travel[cells] + path.angle[cells] * profile.farthest
    wide = float(profile.radius.max())
    high, out = height_and_radius(point - path.tip[cells], path.axis[cells])
    cells = cells[(high > -change) & (high < profile.height[-1] + change) & (out < wide + change)]
    change = path.travel[cells] + path.angle[cells] * profile.farthest
    row, number = expand_counts(np.maximum(np.ceil(change / _STEP), 1).astype(np.int64))
    share = (number + 1) / np.maximum(np.ceil(change / _STEP), 1)[row]
    tip, axis, _, _ = path.inside(cells[row], share)
    return bool(profile.contains(*height_and_radius(point - tip, axis), _STEP).any())
