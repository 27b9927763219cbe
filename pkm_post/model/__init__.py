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
    batches,
    batches_of_work,
    distinct,
    fill_gaps,
    find_rows,
    forward_fill,
    freeze,
    in_pieces,
    intervals_at,
    is_among,
    is_uniform,
    joined,
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
    required,
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
    tool_change_rows,
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
from pkm_post.model.thread import as_executed, cuts_by_speed, threads
from pkm_post.model.trajectory import APPROACH, MAX_SPIN, MIN_TOLERANCE, TRAJECTORY_COLUMNS, Trajectory

if TYPE_CHECKING:
    from pkm_post.model.rules import RULES
else:
    __getattr__ = at_first_use(__name__, {"rules": "RULES"})
