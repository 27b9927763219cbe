# SPDX-License-Identifier: LGPL-2.1-or-later
"""Model: frozen data that every room uses, and the table of diagnostics."""

from typing import TYPE_CHECKING

from pkm_post import at_first_use
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
    distinct,
    find_rows,
    freeze,
    in_pieces,
    is_among,
    is_uniform,
    map_row_pairs,
    map_rows,
    pieces,
    read_only,
    select_rows,
    shifted,
    uniform,
)
from pkm_post.model.diagnostics import (
    Diagnostic,
    DiagnosticLog,
    Diagnostics,
    Place,
    Refused,
    errors,
    in_one_line,
    severity_of,
)
from pkm_post.model.machine import Body, Box, Machine, SpindleAxis, ToolChange
from pkm_post.model.motion import AT_FEED, NO_TURNS, FeedStudy, Motion, Poses, SpindleTurns, StrutMotion
from pkm_post.model.phrase import Amount, Pattern, Phrase
from pkm_post.model.program import (
    IN_SUBPROGRAM_FILE,
    MOTION_COLUMNS,
    OPTIONAL_COLUMNS,
    PROGRAM_COLUMNS,
    Event,
    EventKind,
    Kind,
    Program,
)
from pkm_post.model.rules import Severity
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
from pkm_post.model.thread import Thread, as_executed, cuts_by_speed, threads
from pkm_post.model.trajectory import APPROACH, MAX_SPIN, MIN_TOLERANCE, TRAJECTORY_COLUMNS, Trajectory

if TYPE_CHECKING:
    from pkm_post.model.rules import RULES
else:
    __getattr__ = at_first_use(__name__, {"rules": "RULES"})

__all__ = [
    "APPROACH",
    "AT_FEED",
    "EMPTY_SETUP",
    "MAX_SPIN",
    "MIN_TOLERANCE",
    "IN_SUBPROGRAM_FILE",
    "MOTION_COLUMNS",
    "NO_TURNS",
    "OPTIONAL_COLUMNS",
    "PROGRAM_COLUMNS",
    "RULES",
    "TRAJECTORY_COLUMNS",
    "Amount",
    "Array",
    "Body",
    "Box",
    "Certificate",
    "ColumnBuilder",
    "Coverage",
    "Diagnostic",
    "DiagnosticLog",
    "Diagnostics",
    "Event",
    "EventKind",
    "Extent",
    "FeedStudy",
    "Figure",
    "Finding",
    "Kind",
    "Machine",
    "Mesh",
    "Motion",
    "Pattern",
    "Phrase",
    "Place",
    "Poses",
    "Program",
    "Refused",
    "Setup",
    "Severity",
    "Shank",
    "SpindleAxis",
    "SpindleTurns",
    "StrutMotion",
    "Thread",
    "Tolerances",
    "Tool",
    "ToolChange",
    "Topic",
    "Trajectory",
    "as_executed",
    "corner_reach",
    "coverage_summary",
    "cuts_by_speed",
    "errors",
    "distinct",
    "find_rows",
    "freeze",
    "gauge_lengths",
    "checkpoint",
    "checkpoints",
    "in_one_line",
    "in_pieces",
    "is_among",
    "is_uniform",
    "largest_corner_radius",
    "map_row_pairs",
    "map_rows",
    "pieces",
    "read_only",
    "shifted",
    "select_rows",
    "severity_of",
    "threads",
    "uniform",
    "valid_cutter_angles",
]
