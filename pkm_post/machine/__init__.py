# SPDX-License-Identifier: LGPL-2.1-or-later
"""The machine: its description, kinematics, reach, collisions, spin and calibration."""

from pkm_post.machine.best_position import best_position
from pkm_post.machine.calibration.calibrate_file import calibrate_file
from pkm_post.machine.collisions.check import NO_SETUP, find_collisions, names_of, placed_part
from pkm_post.machine.description.presets import find_machine, machine_named, presets, templates
from pkm_post.machine.kinematics.forward import NearPoses, Solution, follow, forward, moved, near_poses, newton
from pkm_post.machine.kinematics.inverse import Pose, attitude_rates, platform_joints, platform_rotation, strut_lengths
from pkm_post.machine.kinematics.jacobian import (
    jacobian_of_tip,
    linearise,
    scaled_jacobian,
    solve_regular,
    stiffness_along,
)
from pkm_post.machine.kinematics.placed_machine import has_strut_bodies
from pkm_post.machine.kinematics.rates import strut_rate_bounds, strut_rates, tool_rates
from pkm_post.machine.kinematics.strut_cubics import Ends, Inside, carried, moving
from pkm_post.machine.kinematics.tool_cubics import Demand, ToolCubics, bounded_demand, measured_demand
from pkm_post.machine.reach.collision_mesh import Part
from pkm_post.machine.reach.findings import SHOWN, ReachFinding, faults_of
from pkm_post.machine.reach.limit_checks import reach_margins
from pkm_post.machine.reach.path_checks import reach_faults, reach_findings
from pkm_post.machine.reach.pose_path import Way
from pkm_post.machine.reach.report import Reach, reach
from pkm_post.machine.reach_map import reach_map
from pkm_post.machine.spin.apply import with_spin
from pkm_post.machine.spin.optimise import least_shares
from pkm_post.machine.spin.policy import ZERO_TORSION, Policy, Rule

__all__ = [
    "NO_SETUP",
    "SHOWN",
    "ZERO_TORSION",
    "Demand",
    "Ends",
    "Inside",
    "NearPoses",
    "Part",
    "Policy",
    "Pose",
    "Reach",
    "ReachFinding",
    "Rule",
    "Solution",
    "ToolCubics",
    "Way",
    "attitude_rates",
    "best_position",
    "bounded_demand",
    "calibrate_file",
    "carried",
    "faults_of",
    "find_collisions",
    "find_machine",
    "follow",
    "forward",
    "has_strut_bodies",
    "jacobian_of_tip",
    "least_shares",
    "linearise",
    "machine_named",
    "measured_demand",
    "moved",
    "moving",
    "names_of",
    "near_poses",
    "newton",
    "placed_part",
    "platform_joints",
    "platform_rotation",
    "presets",
    "reach",
    "reach_faults",
    "reach_findings",
    "reach_map",
    "reach_margins",
    "scaled_jacobian",
    "solve_regular",
    "stiffness_along",
    "strut_lengths",
    "strut_rate_bounds",
    "strut_rates",
    "templates",
    "tool_rates",
    "with_spin",
]
