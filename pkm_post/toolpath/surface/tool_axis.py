# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tool axis: from the surface normal by lead and tilt, then clamped to the cone that the machine allows.

Takes normals and feed directions; returns unit tool axes. Angles in rad. Lead tilts the tool forward in the feed
direction, tilt tilts it sideways.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import along, angle_between, cross, dot, towards, unit
from pkm_post.toolpath.surface.surface import Array, unit_or_nan


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
        t = unit_or_nan(feed - dot(feed, normal)[:, None] * normal)
        sideways = math.cos(rule.tilt) * normal + math.sin(rule.tilt) * (cross(normal, t) if side is None else side)
        wanted = unit_or_nan(math.sin(rule.lead) * t + math.cos(rule.lead) * sideways)
    return clamped(wanted, np.asarray(rule.cone_axis, dtype=np.float64), rule.cone)


def clamped(wanted: Array, cone_axis: Array, cone: float) -> tuple[Array, Array]:
    """The nearest axes inside a cone, (N, 3), and flags of the clamped ones, (N,)."""
    middle = np.broadcast_to(unit(cone_axis), wanted.shape)
    away = angle_between(middle, wanted)
    outside = away > cone
    shortened = towards(middle, wanted) * (cone / np.maximum(away, cone + 1e-300))[:, None]
    return np.where(outside[:, None], along(middle, shortened), wanted), outside
