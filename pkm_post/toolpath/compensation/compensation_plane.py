# SPDX-License-Identifier: LGPL-2.1-or-later
"""Compensation plane: the plane in which the path of each row is offset.

Takes the plane that a row selects and the tool axis; returns unit normals, NaN where the axis defines no plane. Where
the axis is normal to the selected plane, or lies in it (a ball in G18, as controls allow), the selected plane applies.
Where the axis is tilted, as in side milling, the plane is normal to the axis; left and right are those of the selected
plane.
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry import Array, dot

PARALLEL = 1e-5
"""rad below which two directions count as parallel: axes are written with six decimals, so they may be 1e-6 off."""

_LEAST_COSINE = 0.5
"""An axis tilted by more than 60 degrees that does not lie in the plane is ambiguous."""


def plane_normals(plane: Array, tool_axis: Array) -> Array:
    """Unit normals of the compensation planes, (N, 3); NaN where the axis is tilted too far.

    Args:
        plane: (N,) the coordinate that the selected plane is normal to.
        tool_axis: (N, 3) unit tool axes.
    """
    named = np.eye(3)[plane]
    cosine = dot(named, tool_axis)
    sine = np.sqrt(np.maximum(1.0 - cosine**2, 0.0))
    keeps = (sine < PARALLEL) | (np.abs(cosine) < PARALLEL)
    leans = np.abs(cosine) >= _LEAST_COSINE
    normal = np.where(leans[:, None], tool_axis * np.sign(cosine)[:, None], np.nan)
    return np.where(keeps[:, None], named, normal)
