# SPDX-License-Identifier: LGPL-2.1-or-later
"""Samples: poses along a trajectory at which a spin is judged, and the nodes at which it is chosen.

A trajectory enters. Leave: the ends of stretches long enough for the spin to change by one step, and poses close
enough to each other to tell what the machine has left between. Units: mm, rad.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.feed import Segments
from pkm_post.geometry.vectors import Array
from pkm_post.model import Trajectory

_APART = 10.0
"""mm between samples on a long segment; a degree that the tool axis turns counts as 1 mm."""


@dataclass(frozen=True)
class Samples:
    """Columns of S samples of a path with K nodes.

    Attributes:
        s: (S,) path length of each sample from the start.
        tip: (S, 3) tool tip in {M}.
        axis: (S, 3) unit tool axis in {M}.
        tool_length: (S,) gauge length of the tool in use.
        node: (S,) the node next to the sample, not decreasing; -1 for the start of the path.
        node_s: (K,) path length of each node; the last one is the end of the path.
        row_s: (N,) path length at the end of each segment.
    """

    s: Array
    tip: Array
    axis: Array
    tool_length: Array
    node: Array
    node_s: Array
    row_s: Array

    @classmethod
    def of(cls, trajectory: Trajectory, least: float) -> Samples:
        """The samples of a trajectory, with nodes at ends of segments, ``least`` mm or more from one to the next."""
        segments = Segments.of(trajectory)
        count = np.ceil(segments.extent / _APART).astype(np.int64)
        segment = np.repeat(np.arange(len(segments)), count)
        number = np.arange(len(segment)) - np.repeat(np.cumsum(count) - count, count) + 1
        u = segments.extent[segment] * (number / count[segment])
        row_s = np.cumsum(segments.extent)
        s = row_s[segment] - segments.extent[segment] + u
        node_s = row_s[_nodes(row_s, least)]
        halfway = (np.concatenate([[0.0], node_s[:-1]]) + node_s) / 2
        return cls(
            s=s,
            tip=segments.tip_at(segment, u)[0],
            axis=segments.axis_at(segment, u)[0],
            tool_length=trajectory.tool_length()[segment],
            node=np.searchsorted(halfway, s, side="right") - 1,
            node_s=node_s,
            row_s=row_s,
        )


def _nodes(row_s: Array, least: float) -> list[int]:
    """Segments whose ends are nodes: each the first one that is far enough from the node before, and the last."""
    nodes, at, last = [], 0.0, len(row_s) - 1
    while at + least < row_s[-1]:
        nodes.append(min(int(np.searchsorted(row_s, at + least)), last))
        at = row_s[nodes[-1]]
    if not nodes or nodes[-1] != last:
        nodes[-1:] = [last]
    return nodes
