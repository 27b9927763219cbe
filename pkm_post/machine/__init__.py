# SPDX-License-Identifier: LGPL-2.1-or-later
"""The machine: its description, kinematics, reach, collisions, spin and calibration."""

from pkm_post.machine.calibration.calibrated import calibrate_file
from pkm_post.machine.collisions.check import find_collisions, names_of, placed_part
from pkm_post.machine.collisions.coverage import NO_SETUP
from pkm_post.machine.description.named import machine_named
from pkm_post.machine.description.presets import find_machine, presets, templates
from pkm_post.machine.kinematics.bodies import has_strut_bodies
from pkm_post.machine.kinematics.findings import SHOWN, ReachFinding, faults_of
from pkm_post.machine.kinematics.following import follow
from pkm_post.machine.kinematics.forward import Solution, forward, newton
from pkm_post.machine.kinematics.interpolation import Ends, Inside, carried, moving
from pkm_post.machine.kinematics.inverse import platform_joints, strut_lengths
from pkm_post.machine.kinematics.jacobian import jacobian_of_tip, linearise, scaled_jacobian, solve_regular
from pkm_post.machine.kinematics.margins import reach_margins
from pkm_post.machine.kinematics.near import NearPoses, moved, near_poses
from pkm_post.machine.kinematics.orientation import attitude_rates, platform_rotation
from pkm_post.machine.kinematics.part import Part
from pkm_post.machine.kinematics.rate_bounds import strut_rate_bounds
from pkm_post.machine.kinematics.rates import strut_rates
from pkm_post.machine.kinematics.stiffness import stiffness_along
from pkm_post.machine.kinematics.tool_cubics import Demand, ToolCubics, bounded_demand, measured_demand
from pkm_post.machine.kinematics.tool_rates import tool_rates
from pkm_post.machine.kinematics.way import Pose, Way
from pkm_post.machine.kinematics.workspace import reach_faults, reach_findings
from pkm_post.machine.position.best_position import best_position
from pkm_post.machine.position.reach_map import reach_map
from pkm_post.machine.reach import Reach, reach
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
