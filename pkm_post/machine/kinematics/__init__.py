# SPDX-License-Identifier: LGPL-2.1-or-later
"""The 6-TPS machine: inverse and forward kinematics, Jacobian, rates, and what the machine can reach."""

from pkm_post.machine.kinematics.findings import ReachFinding, faults_of
from pkm_post.machine.kinematics.following import follow
from pkm_post.machine.kinematics.forward import Solution, forward
from pkm_post.machine.kinematics.interpolation import Ends, Inside, Stray, carried, fastest, moving, steepest, stray
from pkm_post.machine.kinematics.inverse import platform_joints, strut_lengths, strut_vectors
from pkm_post.machine.kinematics.jacobian import jacobian_of_platform, jacobian_of_tip, scaled_jacobian
from pkm_post.machine.kinematics.margins import Margins, reach_margins
from pkm_post.machine.kinematics.near import NearPoses, moved, near_poses
from pkm_post.machine.kinematics.orientation import attitude_rates, platform_rotation
from pkm_post.machine.kinematics.part import Part
from pkm_post.machine.kinematics.rate_bounds import strut_rate_bounds
from pkm_post.machine.kinematics.rates import strut_rates
from pkm_post.machine.kinematics.stiffness import stiffness_along
from pkm_post.machine.kinematics.tool_cubics import Demand, ToolCubics, bounded_demand, measured_demand
from pkm_post.machine.kinematics.way import Way
from pkm_post.machine.kinematics.workspace import reach_faults, reach_findings

__all__ = [
    "Demand",
    "Ends",
    "Inside",
    "Margins",
    "NearPoses",
    "Part",
    "ReachFinding",
    "Solution",
    "Stray",
    "ToolCubics",
    "Way",
    "attitude_rates",
    "bounded_demand",
    "carried",
    "fastest",
    "faults_of",
    "follow",
    "forward",
    "jacobian_of_platform",
    "jacobian_of_tip",
    "measured_demand",
    "moved",
    "moving",
    "near_poses",
    "platform_joints",
    "platform_rotation",
    "reach_faults",
    "reach_findings",
    "reach_margins",
    "scaled_jacobian",
    "steepest",
    "stiffness_along",
    "stray",
    "strut_lengths",
    "strut_rate_bounds",
    "strut_rates",
    "strut_vectors",
]
