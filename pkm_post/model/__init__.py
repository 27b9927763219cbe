# SPDX-License-Identifier: LGPL-2.1-or-later
"""Model: frozen data that every room uses, and the table of diagnostics."""

from pkm_post.model.certificate import (
    Certificate,
    Coverage,
    Extent,
    Figure,
    Finding,
    Tolerances,
    Topic,
    coverage_summary,
)
from pkm_post.model.checkpoint import checkpoint, checkpoints
from pkm_post.model.columns import (
    Array,
    ColumnBuilder,
    freeze,
    in_pieces,
    is_uniform,
    map_row_pairs,
    map_rows,
    pieces,
    read_only,
    select_rows,
    shifted,
    uniform,
)
from pkm_post.model.diagnostic_log import DiagnosticLog
from pkm_post.model.diagnostics import Diagnostic, Place, Refused, errors
from pkm_post.model.machine import Body, Box, Machine, ToolChange
from pkm_post.model.motion import Motion, Poses, StrutMotion
from pkm_post.model.program import MOTION_COLUMNS, OPTIONAL_COLUMNS, Event, EventKind, Kind, Program
from pkm_post.model.rules import RULES, Severity
from pkm_post.model.setup import (
    EMPTY_SETUP,
    Mesh,
    Setup,
    Shank,
    Tool,
    corner_reach,
    gauge_lengths,
    largest_corner_radius,
    valid_cutter_angles,
)
from pkm_post.model.trajectory import MAX_SPIN, MIN_TOLERANCE, TRAJECTORY_COLUMNS, Trajectory

__all__ = [
    "EMPTY_SETUP",
    "MAX_SPIN",
    "MIN_TOLERANCE",
    "MOTION_COLUMNS",
    "OPTIONAL_COLUMNS",
    "RULES",
    "TRAJECTORY_COLUMNS",
    "Array",
    "Body",
    "Box",
    "Certificate",
    "ColumnBuilder",
    "Coverage",
    "Diagnostic",
    "DiagnosticLog",
    "Event",
    "EventKind",
    "Extent",
    "Figure",
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
    "corner_reach",
    "coverage_summary",
    "errors",
    "freeze",
    "gauge_lengths",
    "checkpoint",
    "checkpoints",
    "in_pieces",
    "is_uniform",
    "largest_corner_radius",
    "map_row_pairs",
    "map_rows",
    "pieces",
    "read_only",
    "shifted",
    "select_rows",
    "uniform",
    "valid_cutter_angles",
]
