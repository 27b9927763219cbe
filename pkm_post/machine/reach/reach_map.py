# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reach map: largest tilt of the tool, in all directions, at each place of a volume.

Takes a machine and a grid of places; returns the half angle of the cone of reachable tool axes, and its limit. The
spin is zero. The places are independent: any executor of ``concurrent.futures`` can distribute them to processes or
machines.
"""

from __future__ import annotations

import functools
import math
from concurrent.futures import Executor
from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array
from pkm_post.machine.spin.normalised_margins import normalised_margins
from pkm_post.model import Machine

NOWHERE = -1.0
"""Marks a place that even an upright tool does not reach."""

_POINTS_PER_TASK = 64
_ROUNDING = 1e-9
"""Of the number of steps."""
_AZIMUTHS = 24
"""Tilt directions."""


@dataclass(frozen=True)
class ReachMap:
    """Columns of N places.

    Attributes:
        tip: (N, 3) tool tip in {M}, mm.
        cone: (N,) half angle of the widest cone about upright in which the tool may tilt, rad; ``NOWHERE`` where there
            is no such cone.
        limit: (N,) first limit beyond it: 0 stroke, 1 joints, 2 a singular pose; -1 if there is none up to
            ``widest``.
        widest: the largest angle tried, rad.
    """

    tip: Array
    cone: Array
    limit: Array
    widest: float

    def as_csv(self) -> str:
        """The map as text with a header, one line per place, in mm and degrees."""
        rows = zip(self.tip.tolist(), np.degrees(self.cone), self.limit.tolist(), strict=True)
        lines = (
            f"{x:g},{y:g},{z:g},{'' if angle < 0 else f'{angle:.2f}'},{_LIMITS[limit]}"
            for (x, y, z), angle, limit in rows
        )
        return "\n".join(["x_mm,y_mm,z_mm,cone_deg,limited_by", *lines, ""])


_LIMITS = {-1: "", 0: "stroke", 1: "joints", 2: "singular pose"}


def reach_map(
    machine: Machine,
    tip: Array,
    tool_length: float,
    widest: float = np.radians(60.0),
    step: float = np.radians(1.0),
    executor: Executor | None = None,
) -> ReachMap:
    """Map the cone of tool axes.

    Args:
        tip: (N, 3) places in {M}, mm.
        tool_length: gauge length, mm.
        widest: largest angle to try, rad, below a half turn.
        step: largest step from one angle to the next, rad.
        executor: distributes the work; by default it runs in this process.

    Raises:
        ValueError: the places are not (N, 3).
    """
    tip = np.asarray(tip, dtype=np.float64)
    if tip.ndim != 2 or tip.shape[1] != 3:
        raise ValueError(f"tip: expected (N, 3), got {tip.shape}")
    angles = np.linspace(0.0, widest, math.ceil(widest / step - _ROUNDING) + 1)
    task = functools.partial(_cones, machine, tool_length, angles)
    parts = np.array_split(tip, -(-len(tip) // _POINTS_PER_TASK) or 1)
    done = executor.map(task, parts) if executor else map(task, parts)
    cone, limit = (np.concatenate(columns) for columns in zip(*done, strict=True))
    return ReachMap(tip, cone, limit, widest)


def _cones(machine: Machine, tool_length: float, angles: Array, tip: Array) -> tuple[Array, Array]:
    """Half angles and limits at some places, (P,) each."""
    axis = _leaning(angles)
    left = normalised_margins(
        machine,
        np.repeat(tip, len(axis), axis=0),
        np.tile(axis, (len(tip), 1)),
        np.zeros(len(tip) * len(axis)),
        np.full(len(tip) * len(axis), tool_length),
    )
    # Each share at its worst over all directions, by place and angle.
    worst = left.reshape(len(tip), len(angles), -1, 3).min(axis=2)
    beyond = worst.min(axis=2) < 0
    first = np.where(beyond.any(axis=1), beyond.argmax(axis=1), len(angles))
    cone = np.where(first > 0, angles[first - 1], NOWHERE)
    at_limit = worst[np.arange(len(tip)), np.minimum(first, len(angles) - 1)].argmin(axis=1)
    return cone, np.where(first < len(angles), at_limit, -1)


def _leaning(angles: Array) -> Array:
    """Tool axes by angle and direction, (A * D, 3)."""
    tilt, turn = np.meshgrid(angles, np.arange(_AZIMUTHS) * 2 * np.pi / _AZIMUTHS, indexing="ij")
    return np.stack([np.sin(tilt) * np.cos(turn), np.sin(tilt) * np.sin(turn), np.cos(tilt)], axis=-1).reshape(-1, 3)
