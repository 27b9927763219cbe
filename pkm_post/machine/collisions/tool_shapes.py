# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tool shapes: the cutter and the shank of a tool as solids about the tool axis.

In collision checks a cutter is reduced by an allowance, since it touches the workpiece on purpose: reported collisions
are then certain. Its profile defines what it cuts. Units: mm, rad.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array
from pkm_post.machine.collisions.movers import Piece
from pkm_post.model import Shank, Tool
from pkm_post.toolpath import Cutter

_ARC_CHORDS = 24
_STEPS = 6
"""Cylinders that approximate one slanted line of a profile."""


@dataclass(frozen=True)
class Profile:
    """Radii of a solid of revolution about the tool axis, by height above the tip.

    Attributes:
        height: (K,) heights, ascending.
        radius: (K,) radii, linear between heights.
    """

    height: Array
    radius: Array

    @property
    def farthest(self) -> float:
        """The largest distance of any of its points from the tip, mm."""
        return float(np.hypot(self.height, self.radius).max())

    def contains(self, high: Array, out: Array, more: float = 0.0) -> Array:
        """Whether points at heights and distances from the axis, (N,), are inside the profile offset by ``more``.

        An outward offset may include slightly more than this distance, never less; an inward one slightly less, never
        more.
        """
        low, top = self.height[0] - more, self.height[-1] + more
        radius = self._widest(high, more) if more > 0 else self._narrowest(high, -more)
        inside: Array = (high >= low) & (high <= top) & (out <= radius + more)
        return inside

    def _widest(self, high: Array, within: float) -> Array:
        if (np.diff(self.radius) >= 0).all():
            return self._at(high + within)
        return np.full(len(high), self.radius.max())

    def _narrowest(self, high: Array, within: float) -> Array:
        """Cutters bulge at most once: the smallest radius of a stretch is at one of its ends."""
        return np.minimum(self._at(high - within), self._at(high + within))

    def _at(self, high: Array) -> Array:
        return np.interp(high, self.height, self.radius)


def cylinder(start: float, end: float, radius: float) -> Profile:
    """The profile of a cylinder."""
    return Profile(np.array([start, end]), np.array([radius, radius]))


def cutter_profile(tool: Tool, length: float) -> Profile:
    """The cutting part of a tool of known diameter, up to a height; chords of the corner arc are inside it."""
    cutter = Cutter.of(tool)
    angle = np.linspace(cutter.corner_start, cutter.corner_end, _ARC_CHORDS + 1)
    radius = cutter.radial_offset + cutter.corner_radius * np.sin(angle)
    height = cutter.axial_offset - cutter.corner_radius * np.cos(angle)
    height, radius = np.append(0.0, height), np.append(0.0, np.maximum(radius, 0.0))
    if length > height[-1]:
        side = radius[-1] + (length - height[-1]) * math.tan(tool.side_angle)
        return Profile(np.append(height, length), np.append(radius, max(side, 0.0)))
    kept = height < length
    return Profile(np.append(height[kept], length), np.append(radius[kept], np.interp(length, height, radius)))


def cutter_pieces(tool: Tool, length: float, allowance: float) -> tuple[Piece, ...]:
    """Cylinders inside a cutter reduced by an allowance on all sides."""
    less = min(allowance, tool.diameter / 4)
    if tool.bottom_angle == 0.0 and tool.side_angle == 0.0:
        rounding = max(min(tool.corner_radius, tool.diameter / 2) - less, 0.0)
        start = less + rounding
        return (Piece(start, max(length - rounding, start), tool.diameter / 2 - less - rounding, rounding),)
    profile = cutter_profile(tool, length)
    edges = np.unique(np.concatenate([np.linspace(*ends, _STEPS + 1) for ends in _sections(profile)]))
    edges = edges[edges >= less]
    wide = (
        np.minimum(*(np.interp(one, profile.height, profile.radius) for one in (edges[:-1] - less, edges[1:]))) - less
    )
    return tuple(
        Piece(low, high, radius)
        for low, high, radius in zip(edges[:-1].tolist(), edges[1:].tolist(), wide.tolist(), strict=True)
        if radius > 0
    )


def _sections(profile: Profile) -> list[tuple[float, float]]:
    """Heights between which the radius changes along one line or the corner arc."""
    corner = [
        profile.height[0],
        profile.height[min(1, len(profile.height) - 1)],
        profile.height[-2],
        profile.height[-1],
    ]
    return [(float(low), float(high)) for low, high in zip(corner[:-1], corner[1:], strict=True) if high > low]


def shank_pieces(tool: Tool, shank: Shank, allowance: float) -> tuple[Piece, ...]:
    """The shank below the spindle nose, reduced by an allowance; it may rub where the cutter has been."""
    start, radius = shank.start + allowance, shank.diameter / 2 - min(allowance, shank.diameter / 4)
    return (Piece(start, tool.length, radius),) if start < tool.length else ()
