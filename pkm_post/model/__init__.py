# SPDX-License-Identifier: LGPL-2.1-or-later
"""Model: frozen data that passes between the packages, and the faults that stop a job."""

from pkm_post.model.certificate import Certificate, Coverage, Extent, Figure, Finding, Tolerances, Topic, meaning
from pkm_post.model.columns import (
    Array,
    Filled,
    both_by_row,
    by_row,
    freeze,
    in_pieces,
    is_uniform,
    locked,
    pieces,
    rows_of,
    shifted,
    uniform,
)
from pkm_post.model.diagnostics import Diagnostic, Place, Refused, errors
from pkm_post.model.event import Event, EventKind
from pkm_post.model.machine import Body, Box, Machine, ToolChange
from pkm_post.model.motion import Motion
from pkm_post.model.poses import Poses
from pkm_post.model.program import MOTION_COLUMNS, OPTIONAL_COLUMNS, Kind, Program
from pkm_post.model.rules import RULES, Severity
from pkm_post.model.setup import NOTHING_KNOWN, Mesh, Setup, Shank
from pkm_post.model.strut_motion import StrutMotion
from pkm_post.model.tool import Tool, angles_fit, corner_reach, largest_corner, lengths_of
from pkm_post.model.trajectory import LEAST_TOLERANCE, MOST_SPIN, TRAJECTORY_COLUMNS, Trajectory

__all__ = [
    "LEAST_TOLERANCE",
    "MOST_SPIN",
    "MOTION_COLUMNS",
    "NOTHING_KNOWN",
    "OPTIONAL_COLUMNS",
    "RULES",
    "TRAJECTORY_COLUMNS",
    "Array",
    "Body",
    "Box",
    "Certificate",
    "Coverage",
    "Diagnostic",
    "Event",
    "EventKind",
    "Extent",
    "Figure",
    "Filled",
    "Finding",
    "Kind",
    "Machine",
    "Mesh",
    "Motion",
    "Place",
    "Poses",
    "Program",
    "Refused",
    "Setup",
    "Severity",
    "Shank",
    "StrutMotion",
    "Tolerances",
    "Tool",
    "ToolChange",
    "Topic",
    "Trajectory",
    "angles_fit",
    "both_by_row",
    "by_row",
    "corner_reach",
    "errors",
    "freeze",
    "in_pieces",
    "is_uniform",
    "largest_corner",
    "lengths_of",
    "locked",
    "meaning",
    "pieces",
    "rows_of",
    "shifted",
    "uniform",
]
