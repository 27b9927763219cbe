# SPDX-License-Identifier: LGPL-2.1-or-later
"""Turning: feed direction and side of the tilt, along passes and in the links between them.

Along a pass both follow the pattern. In a link the feed turns about the normal, at the end of a zigzag through the
direction of the link, so a tool with lead swivels around its contact. Through the normal it would tip from one side of
its bottom to the other at once. The side does not change.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import cross, dot, norm
from pkm_post.toolpath.surface.course import Course, Pattern
from pkm_post.toolpath.surface.surface import Array, Patch

_REVERSAL = math.radians(150.0)
"""Turn of the feed from which the link defines the sense of rotation."""
_NO_DIRECTION = 1e-9


@dataclass(frozen=True)
class Frame:
    """Unit tangents at N contacts.

    Attributes:
        feed: (N, 3) in the feed direction.
        side: (N, 3) to which the tool tilts: left of the lines of the pattern, whatever the travel direction.
    """

    feed: Array
    side: Array

    def taken(self, rows: Array) -> Frame:
        """Some of the rows."""
        return Frame(self.feed[rows], self.side[rows])

    def with_links(self, links: Links, normal: Array, share: Array) -> Frame:
        """The frame, turned where the share of a link is not NaN."""
        linking = ~np.isnan(share)
        if not linking.any():
            return self
        turned = links.taken(linking).at(normal[linking], share[linking])
        feed, side = self.feed.copy(), self.side.copy()
        feed[linking], side[linking] = turned.feed, turned.side
        return Frame(feed, side)


@dataclass(frozen=True)
class Links:
    """Ends of N links.

    Attributes:
        leaving: frame where a pass ends.
        coming: frame where the next one begins.
        way: (N, 3) vector from one contact to the other.
    """

    leaving: Frame
    coming: Frame
    way: Array

    def taken(self, rows: Array) -> Links:
        """Some of the rows."""
        return Links(self.leaving.taken(rows), self.coming.taken(rows), self.way[rows])

    def at(self, normal: Array, share: Array) -> Frame:
        """The frame at a completed share of the link."""
        first, last = (_across(frame.feed, normal) for frame in (self.leaving, self.coming))
        angle = np.arctan2(dot(cross(first, last), normal), dot(first, last))
        round_by = np.where(dot(cross(first, self.way), normal) < 0.0, -1.0, 1.0)
        wrong_way = (np.abs(angle) > _REVERSAL) & (np.sign(angle) != round_by)
        angle = (np.where(wrong_way, angle + round_by * 2.0 * np.pi, angle) * share)[:, None]
        left = (1.0 - share)[:, None]
        return Frame(
            np.cos(angle) * first + np.sin(angle) * cross(normal, first),
            _across(left * self.leaving.side + (1.0 - left) * self.coming.side, normal),
        )


def frame_of(pattern: Pattern, course: Course, patch: Patch, travel: Array) -> Frame:
    """The frame along passes: that of the pattern, or of travel where the pattern has no direction, as on a flat top.

    Args:
        pattern: the lines.
        course: the rows.
        patch: the surface there.
        travel: (N, 3) from row to row, of any length.
    """
    line = pattern.direction(patch)
    sense = course.sense[:, None]
    line = _across(np.where(norm(line)[:, None] > _NO_DIRECTION, line, travel * sense), patch.normal)
    return Frame(sense * line, cross(patch.normal, line))


def _across(vectors: Array, normal: Array) -> Array:
    """Unit vectors of the components across the normals."""
    across = vectors - dot(vectors, normal)[:, None] * normal
    unit: Array = across / np.maximum(norm(across)[:, None], 1e-300)
    return unit
