# SPDX-License-Identifier: LGPL-2.1-or-later
"""Samples: poses along a trajectory at which a spin is evaluated, dense enough to represent the margins between them.

Takes a trajectory; returns columns of poses by path length. Units: mm, rad.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array
from pkm_post.model import Trajectory
from pkm_post.toolpath import Segments

_APART = 10.0
"""mm between samples on a long segment; a degree of tool axis rotation counts as 1 mm."""


@dataclass(frozen=True)
class Samples:
    """Columns of S samples of a path with N segments.

    Attributes:
        s: (S,) path length of each sample from the start.
        tip: (S, 3) tool tip in {M}.
        axis: (S, 3) unit tool axis in {M}.
        tool_length: (S,) gauge length of the tool in use.
        spin: (S,) spin of the trajectory, rad.
        segment: (S,) segment of each sample.
        row_s: (N,) path length at the end of each segment.
    """

    s: Array
    tip: Array
    axis: Array
    tool_length: Array
    spin: Array
    segment: Array
    row_s: Array

    @classmethod
    def of(cls, trajectory: Trajectory) -> Samples:
        """The samples of a trajectory, including the end of each segment."""
        segments = Segments.of(trajectory)
        count = np.ceil(segments.extent / _APART).astype(np.int64)
        segment = np.repeat(np.arange(len(segments)), count)
        number = np.arange(len(segment)) - np.repeat(np.cumsum(count) - count, count) + 1
        u = segments.extent[segment] * (number / count[segment])
        row_s = np.cumsum(segments.extent)
        return cls(
            s=row_s[segment] - segments.extent[segment] + u,
            tip=segments.tip_at(segment, u)[0],
            axis=segments.axis_at(segment, u)[0],
            tool_length=trajectory.tool_length()[segment],
            spin=segments.spin[segment] + u * segments.spin_rate[segment],
            segment=segment,
            row_s=row_s,
        )
