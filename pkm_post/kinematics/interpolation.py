# SPDX-License-Identifier: LGPL-2.1-or-later
"""Interpolation: what the machine does when the controller plays cubics between the struts' knots.

Enters: true poses by time at both ends of intervals and inside them. Leaves: by how much tool and struts differ from
them. Residuals of strut lengths are carried to the tool by the inverse Jacobian: tip by the linear part, tool axis by
the angular part across the axis; the turn about the axis cuts nothing.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import hermite_accelerations, hermite_lengths, hermite_speeds, norm
from pkm_post.geometry.vectors import Array, cross
from pkm_post.kinematics.inverse import strut_lengths
from pkm_post.kinematics.jacobian import jacobian_of_tip
from pkm_post.kinematics.rates import strut_rates
from pkm_post.model import Machine, Poses


@dataclass(frozen=True)
class Stray:
    """How N intervals of cubics differ from the true motion at M instants of each.

    Attributes:
        tip: (N, M) distance of the tool tip from where it ought to be, mm.
        axis: (N, M) angle of the tool axis from where it ought to be, rad.
        faster: (N, M) tip speed less the true one, mm/s.
        acceleration: (N,) highest acceleration of a strut, mm/s^2.
    """

    tip: Array
    axis: Array
    faster: Array
    acceleration: Array


def stray(machine: Machine, start: Poses, end: Poses, inner: Poses, duration: Array, share: Array) -> Stray:
    """Play the intervals and compare them with their inner poses.

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
    cubic = p0, v0, p1, v1, duration
    pose = inner.tip, inner.axis, inner.spin, inner.tool_length
    residual = hermite_lengths(*cubic, share).reshape(-1, 6) - strut_lengths(machine, *pose)
    speed = hermite_speeds(*cubic, share).reshape(-1, 6)
    twist = np.linalg.solve(jacobian_of_tip(machine, *pose), np.stack([residual, speed], axis=-1))
    shape = len(duration), len(share)
    return Stray(
        tip=norm(twist[:, :3, 0]).reshape(shape),
        axis=norm(cross(twist[:, 3:, 0], inner.axis)).reshape(shape),
        faster=(norm(twist[:, :3, 1]) - norm(inner.tip_1)).reshape(shape),
        acceleration=np.abs(np.stack(hermite_accelerations(*cubic))).max(axis=(0, 2)),
    )
