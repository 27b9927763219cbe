# SPDX-License-Identifier: LGPL-2.1-or-later
"""Interpolation: how far the tool strays when the controller plays cubics between the struts' knots.

Residuals of strut lengths are carried to the tool by the inverse Jacobian: tip by the linear part, tool axis by the
angular part across the axis; the turn about the axis cuts nothing.
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry import hermite_lengths, norm
from pkm_post.geometry.vectors import Array, cross
from pkm_post.kinematics.inverse import strut_lengths
from pkm_post.kinematics.jacobian import jacobian_of_tip
from pkm_post.kinematics.rates import strut_rates
from pkm_post.model import Machine, Poses


def interpolation_error(
    machine: Machine, start: Poses, end: Poses, inner: Poses, duration: Array, share: Array
) -> tuple[Array, Array]:
    """Largest errors of tip (mm) and tool axis (rad) at the inner poses of each interval, (N,) each.

    Args:
        machine: the geometry.
        start: N poses by time.
        end: N poses by time.
        inner: N * M poses, the true ones, interval by interval at the shares of its duration.
        duration: (N,) s.
        share: (M,) shares of the duration.
    """
    p0, v0, _ = strut_rates(machine, start)
    p1, v1, _ = strut_rates(machine, end)
    played = hermite_lengths(p0, v0, p1, v1, duration, share).reshape(-1, 6)
    pose = inner.tip, inner.axis, inner.spin, inner.tool_length
    residual = played - strut_lengths(machine, *pose)
    twist = np.linalg.solve(jacobian_of_tip(machine, *pose), residual[..., None])[..., 0]
    tip = norm(twist[:, :3])
    axis = norm(cross(twist[:, 3:], inner.axis))
    shape = len(duration), len(share)
    return tip.reshape(shape).max(axis=1), axis.reshape(shape).max(axis=1)
