# SPDX-License-Identifier: LGPL-2.1-or-later
"""The machine: its description, kinematics, reach, collisions, spin and calibration."""

from typing import TYPE_CHECKING

from pkm_post import at_first_use
from pkm_post.machine.description.presets import find_machine, machine_named, presets, templates
from pkm_post.machine.kinematics.forward import (
    ForwardSolution,
    displaced,
    forward,
    forward_along_path,
    forward_from_rotation,
    refine_poses,
)
from pkm_post.machine.kinematics.inverse import (
    ToolPoses,
    attitude_rates,
    lengths_at,
    platform_joints,
    platform_rotation,
    strut_lengths,
)
from pkm_post.machine.kinematics.jacobian import jacobian_of_tip, linearise, scaled_jacobian, solve_regular
from pkm_post.machine.kinematics.placed_machine import has_strut_bodies
from pkm_post.machine.kinematics.rates import strut_jerk_bound, strut_rate_bounds, strut_rates, tool_rates
from pkm_post.machine.kinematics.stiffness import stiffness_along
from pkm_post.machine.kinematics.strut_cubics import KnotState, map_to_tool, strut_state
from pkm_post.machine.kinematics.tool_cubics import DRIFT_SHARES, Demand, ToolCubics, bounded_demand, measured_demand
from pkm_post.machine.reach.findings import DISPLAY_UNITS, ReachFinding, finding_diagnostics
from pkm_post.machine.reach.limit_checks import reach_margins
from pkm_post.machine.reach.path_checks import reach_faults, reach_findings
from pkm_post.machine.reach.pose_path import PosePath
from pkm_post.machine.spin.policy import ZERO_TORSION, SpinPolicy, SpinRule

if TYPE_CHECKING:
    from pkm_post.machine.calibration.calibrate_file import Repetition, calibrate_file
    from pkm_post.machine.calibration.identification import MeasuredPoses, calibrate
    from pkm_post.machine.calibration.uncertainty import MeasurementNoise, calibration_uncertainty
    from pkm_post.machine.collisions.check import Collisions, find_collisions, placed_workpiece, setup_names
    from pkm_post.machine.collisions.coverage import NO_SETUP
    from pkm_post.machine.reach.best_position import WorkpiecePosition, best_position, good_positions
    from pkm_post.machine.reach.collision_mesh import CollisionMesh
    from pkm_post.machine.reach.reach_map import reach_map
    from pkm_post.machine.reach.report import ReachReport, check_reach, pose_path_of, poses_along
    from pkm_post.machine.reach.stiffness_map import StiffnessMap, stiffness_map, table_poses
    from pkm_post.machine.spin.apply import with_spin
    from pkm_post.machine.spin.optimise import least_normalised_margins
else:
    __getattr__ = at_first_use(
        __name__,
        {
            "calibration.calibrate_file": "Repetition calibrate_file",
            "calibration.identification": "MeasuredPoses calibrate",
            "calibration.uncertainty": "MeasurementNoise calibration_uncertainty",
            "collisions.check": "Collisions find_collisions placed_workpiece setup_names",
            "collisions.coverage": "NO_SETUP",
            "reach.best_position": "WorkpiecePosition best_position good_positions",
            "reach.collision_mesh": "CollisionMesh",
            "reach.reach_map": "reach_map",
            "reach.report": "ReachReport check_reach pose_path_of poses_along",
            "reach.stiffness_map": "StiffnessMap stiffness_map table_poses",
            "spin.apply": "with_spin",
            "spin.optimise": "least_normalised_margins",
        },
    )
