# SPDX-License-Identifier: LGPL-2.1-or-later
"""Model: frozen data that passes between the packages, and the faults that stop a job."""

from pkm_post.model.diagnostics import RULES, Diagnostic, Place, Refused, Rule, Severity
from pkm_post.model.event import Event, EventKind
from pkm_post.model.machine import Body, Box, Machine, ToolChange
from pkm_post.model.motion import Motion
from pkm_post.model.poses import Poses
from pkm_post.model.program import Kind, Program
from pkm_post.model.strut_motion import StrutMotion
from pkm_post.model.tool import Tool
from pkm_post.model.trajectory import Trajectory

__all__ = [
    "RULES",
    "Body",
    "Box",
    "Diagnostic",
    "Event",
    "EventKind",
    "Kind",
    "Machine",
    "Motion",
    "Place",
    "Poses",
    "Program",
    "Refused",
    "Rule",
    "Severity",
    "StrutMotion",
    "Tool",
    "ToolChange",
    "Trajectory",
]
