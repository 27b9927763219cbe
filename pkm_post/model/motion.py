# SPDX-License-Identifier: LGPL-2.1-or-later
"""Motion: tool poses by time in the machine frame {M}, with their exact rates."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.model.columns import RowType, freeze, uniform
from pkm_post.model.event import Event
from pkm_post.model.poses import Poses
from pkm_post.model.program import Array

MOTION_BY_TIME: dict[str, RowType] = {
    "time_ms": (np.int64, ()),
    "tip": (np.float64, (3,)),
    "axis": (np.float64, (3,)),
    "spin": (np.float64, ()),
    "tip_rate": (np.float64, (3,)),
    "axis_rate": (np.float64, (3,)),
    "spin_rate": (np.float64, ()),
    "tool_length": (np.float64, ()),
    "segment": (np.int32, ()),
}


@dataclass(frozen=True)
class Motion:
    """Columns of M knots in time.

    Attributes:
        time_ms: (M,) whole milliseconds since the start, strictly increasing; dwells do not count.
        tip: (M, 3) tool tip.
        axis: (M, 3) unit tool axis.
        spin: (M,) spin.
        tip_rate: (M, 3) velocity of the tip, mm/s.
        axis_rate: (M, 3) rate of the unit tool axis, 1/s.
        spin_rate: (M,) rate of the spin, rad/s.
        tool_length: (M,) gauge length of the tool in use.
        segment: (M,) the trajectory segment the knot lies on; at a joint the earlier one.
        joint_time: (N,) s, when the end of each of the N trajectory segments is passed.
        events: by knot: the motion rests at knot r, the event takes place, the motion continues.
    """

    time_ms: Array
    tip: Array
    axis: Array
    spin: Array
    tip_rate: Array
    axis_rate: Array
    spin_rate: Array
    tool_length: Array
    segment: Array
    joint_time: Array
    events: tuple[Event, ...]

    def __post_init__(self) -> None:
        freeze(self, len(self.time_ms), MOTION_BY_TIME)
        freeze(self, len(self.joint_time), {"joint_time": (np.float64, ())})

    def __len__(self) -> int:
        return len(self.time_ms)

    def poses(self, rows: slice | Array = slice(None)) -> Poses:
        """Poses at all or some knots, with their rates; second derivatives are unknown here and zero."""
        tip = self.tip[rows]
        unknown = uniform([0.0] * 3, len(tip))
        return Poses(
            tip=tip,
            tip_1=self.tip_rate[rows],
            tip_2=unknown,
            axis=self.axis[rows],
            axis_1=self.axis_rate[rows],
            axis_2=unknown,
            spin=self.spin[rows],
            spin_1=self.spin_rate[rows],
            spin_2=unknown[:, 0],
            tool_length=self.tool_length[rows],
            segment=self.segment[rows],
        )
