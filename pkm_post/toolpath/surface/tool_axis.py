# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tool axis: from the surface normal by lead and tilt, then clamped to the cone that the machine allows.

Lead tilts the tool forward in the feed direction, tilt tilts it sideways. Along a pass both directions follow the
pattern. In a link the feed turns about the normal, at the end of a zigzag through the direction of the link, so a tool
with lead swivels around its contact. Through the normal it would tip from one side of its bottom to the other at once.
The side does not change. Angles in rad.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array, across, along, angle_between, cross, dot, norm, towards, unit, unit_or_nan
from pkm_post.toolpath.surface.contact_path import ContactPath, PassPattern
from pkm_post.toolpath.surface.surface import NO_LENGTH, SurfaceSamples


@dataclass(frozen=True)
class AxisRule:
    """Rule of the tool axis.

    Attributes:
        lead: angle from the normal forward, in the feed direction.
        tilt: angle from there to the side, by default to the left of the feed direction seen from outside.
        cone_axis: axis of the cone that the tool axis stays in, of any length.
        cone: half angle of that cone; pi for no limit.
    """

    lead: float = 0.0
    tilt: float = 0.0
    cone_axis: tuple[float, float, float] = (0.0, 0.0, 1.0)
    cone: float = math.pi

    def __post_init__(self) -> None:
        if not (abs(self.lead) < math.pi / 2 and abs(self.tilt) < math.pi / 2):
            raise ValueError(f"AxisRule: expected lead and tilt within 90 degrees, got {self.lead} and {self.tilt} rad")
        if not 0.0 <= self.cone <= math.pi:
            raise ValueError(f"AxisRule: expected a cone from 0 to pi, got {self.cone} rad")
        if not any(self.cone_axis):
            raise ValueError("AxisRule: expected a cone axis with a direction, got (0, 0, 0)")


def tool_axes(normal: Array, feed: Array, rule: AxisRule, side: Array | None = None) -> tuple[Array, Array]:
    """Tool axes along sin(lead) t + cos(lead) (cos(tilt) n + sin(tilt) s), clamped to the cone.

    Clamped axes are the nearest ones in the cone: on the great circle from the axis of the cone to the required one.
    They are continuous where the required ones are, except opposite to the cone.

    Args:
        normal: (N, 3) unit normals n.
        feed: (N, 3) feed directions; t is the component normal to n.
        rule: lead, tilt and cone.
        side: (N, 3) unit tangents s to which the tool tilts; left of the feed, n x t, by default.

    Returns:
        Unit axes (N, 3), NaN where the feed has no direction and the axis depends on it; and flags of clamped ones,
        (N,).
    """
    if rule.lead == 0.0 and rule.tilt == 0.0:
        wanted = normal
    else:
        t = unit_or_nan(across(feed, normal), NO_LENGTH)
        sideways = math.cos(rule.tilt) * normal + math.sin(rule.tilt) * (cross(normal, t) if side is None else side)
        wanted = unit_or_nan(math.sin(rule.lead) * t + math.cos(rule.lead) * sideways, NO_LENGTH)
    return clamp_to_cone(wanted, np.asarray(rule.cone_axis, dtype=np.float64), rule.cone)


def clamp_to_cone(axis: Array, cone_axis: Array, cone: float) -> tuple[Array, Array]:
    """The nearest axes inside a cone, (N, 3), and flags of the clamped ones, (N,)."""
    middle = np.broadcast_to(unit(cone_axis), axis.shape)
    away = angle_between(middle, axis)
    outside = away > cone
    shortened = towards(middle, axis) * (cone / np.maximum(away, cone + 1e-300))[:, None]
    return np.where(outside[:, None], along(middle, shortened), axis), outside


_REVERSAL = math.radians(150.0)
"""Turn of the feed from which the link defines the sense of rotation."""
_NO_DIRECTION = 1e-9


@dataclass(frozen=True)
class FeedFrame:
    """Unit tangents at N contacts.

    Attributes:
        feed: (N, 3) in the feed direction.
        side: (N, 3) to which the tool tilts: left of the lines of the pattern, whatever the travel direction.
    """

    feed: Array
    side: Array

    def take(self, rows: Array) -> FeedFrame:
        """Some of the rows."""
        return FeedFrame(self.feed[rows], self.side[rows])

    def with_links(self, links: LinkEnds, normal: Array, share: Array) -> FeedFrame:
        """The frame, turned where the share of a link is not NaN."""
        linking = ~np.isnan(share)
        if not linking.any():
            return self
        turned = links.take(linking).at(normal[linking], share[linking])
        feed, side = self.feed.copy(), self.side.copy()
        feed[linking], side[linking] = turned.feed, turned.side
        return FeedFrame(feed, side)


@dataclass(frozen=True)
class LinkEnds:
    """Ends of N links.

    Attributes:
        leaving: frame where a pass ends.
        coming: frame where the next one begins.
        chord: (N, 3) vector from one contact to the other.
    """

    leaving: FeedFrame
    coming: FeedFrame
    chord: Array

    def take(self, rows: Array) -> LinkEnds:
        """Some of the rows."""
        return LinkEnds(self.leaving.take(rows), self.coming.take(rows), self.chord[rows])

    def at(self, normal: Array, share: Array) -> FeedFrame:
        """The frame at a completed share of the link."""
        first, last = (_across(frame.feed, normal) for frame in (self.leaving, self.coming))
        angle = np.arctan2(dot(cross(first, last), normal), dot(first, last))
        round_by = np.where(dot(cross(first, self.chord), normal) < 0.0, -1.0, 1.0)
        wrong_way = (np.abs(angle) > _REVERSAL) & (np.sign(angle) != round_by)
        angle = (np.where(wrong_way, angle + round_by * 2.0 * np.pi, angle) * share)[:, None]
        left = (1.0 - share)[:, None]
        return FeedFrame(
            np.cos(angle) * first + np.sin(angle) * cross(normal, first),
            _across(left * self.leaving.side + (1.0 - left) * self.coming.side, normal),
        )


def feed_frame(pattern: PassPattern, path: ContactPath, samples: SurfaceSamples, travel: Array) -> FeedFrame:
    """The frame along passes: that of the pattern, or of travel where the pattern has no direction, as on a flat top.

    Args:
        pattern: the lines.
        path: the rows.
        samples: the surface there.
        travel: (N, 3) from row to row, of any length.
    """
    line = pattern.direction(samples)
    sense = path.sense[:, None]
    line = _across(np.where(norm(line)[:, None] > _NO_DIRECTION, line, travel * sense), samples.normal)
    return FeedFrame(sense * line, cross(samples.normal, line))


def _across(vectors: Array, normal: Array) -> Array:
    """Unit vectors of the components across the normals."""
    sideways = across(vectors, normal)
    return sideways / np.maximum(norm(sideways)[:, None], 1e-300)
