# SPDX-License-Identifier: LGPL-2.1-or-later
"""Surface paths: passes of a cutter over a parametric surface, with tool axes, as a program."""

from pkm_post.toolpath.surface.cover import cover
from pkm_post.toolpath.surface.moves import program_of
from pkm_post.toolpath.surface.poses import Poses, Tolerances
from pkm_post.toolpath.surface.settings import CutMode, LeadMove, Lines, Order, Settings
from pkm_post.toolpath.surface.spacing import Stepover
from pkm_post.toolpath.surface.surface import Span, Surface
from pkm_post.toolpath.surface.tool_axis import AxisRule

__all__ = [
    "AxisRule",
    "CutMode",
    "LeadMove",
    "Lines",
    "Order",
    "Poses",
    "Settings",
    "Span",
    "Stepover",
    "Surface",
    "Tolerances",
    "cover",
    "program_of",
]
