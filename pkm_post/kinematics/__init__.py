# SPDX-License-Identifier: LGPL-2.1-or-later
"""The 6-TPS machine: inverse and forward kinematics, Jacobian, rates, and what the machine can reach."""

from pkm_post.kinematics.forward import Solution, forward
from pkm_post.kinematics.interpolation import Stray, stray
from pkm_post.kinematics.inverse import platform_joints, strut_lengths, strut_vectors
from pkm_post.kinematics.jacobian import jacobian_of_platform, jacobian_of_tip, scaled_jacobian
from pkm_post.kinematics.orientation import platform_rotation
from pkm_post.kinematics.rates import strut_rates
from pkm_post.kinematics.workspace import Margins, reach_faults, reach_margins

__all__ = [
    "Margins",
    "Solution",
    "Stray",
    "forward",
    "jacobian_of_platform",
    "jacobian_of_tip",
    "platform_joints",
    "platform_rotation",
    "reach_faults",
    "reach_margins",
    "scaled_jacobian",
    "stray",
    "strut_lengths",
    "strut_rates",
    "strut_vectors",
]
