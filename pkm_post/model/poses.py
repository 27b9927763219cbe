# SPDX-License-Identifier: LGPL-2.1-or-later
"""Poses: tool poses with their first and second derivatives, by path parameter or by time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.model.columns import RowType, freeze
from pkm_post.model.program import Array

_VECTOR: RowType = (np.float64, (3,))
_NUMBER: RowType = (np.float64, ())


@dataclass(frozen=True)
class Poses:
    """Columns of N tool poses in {M}; ``_1`` and ``_2`` are derivatives by the same parameter.

    Attributes:
        tip, tip_1, tip_2: (N, 3) tool tip in mm.
        axis, axis_1, axis_2: (N, 3) unit tool axis.
        spin, spin_1, spin_2: (N,) rotation of the platform about the tool axis.
        tool_length: (N,) gauge length of the tool in use.
        segment: (N,) trajectory segment the pose lies on.
    """

    tip: Array
    tip_1: Array
    tip_2: Array
    axis: Array
    axis_1: Array
    axis_2: Array
    spin: Array
    spin_1: Array
    spin_2: Array
    tool_length: Array
    segment: Array

    def __post_init__(self) -> None:
        vectors = dict.fromkeys(("tip", "tip_1", "tip_2", "axis", "axis_1", "axis_2"), _VECTOR)
        numbers = dict.fromkeys(("spin", "spin_1", "spin_2", "tool_length"), _NUMBER)
        freeze(self, len(self.tip), vectors | numbers | {"segment": (np.int64, ())})

    def __len__(self) -> int:
        return len(self.tip)
