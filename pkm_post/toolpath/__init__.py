# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tool path: symmetry, work offset, compensation and surface passes, from a program to a trajectory."""

from pkm_post.toolpath.compensation.apply import compensate
from pkm_post.toolpath.compensation.contact import tip_from_contact
from pkm_post.toolpath.compensation.cutter import Cutter
from pkm_post.toolpath.compensation.envelope import stock_left
from pkm_post.toolpath.compensation.options import OffsetOptions
from pkm_post.toolpath.compensation.sweep import Sweep
from pkm_post.toolpath.placement.climb import cut_lengths
from pkm_post.toolpath.placement.coverage import Coverage, beside_plane, coverage, sector
from pkm_post.toolpath.placement.joined import joined
from pkm_post.toolpath.placement.joints import Joint, joint, joints
from pkm_post.toolpath.placement.passes import passes
from pkm_post.toolpath.placement.place import place
from pkm_post.toolpath.placement.reversed import reversed_passes
from pkm_post.toolpath.placement.safe_way import ToolPose, columns, safe_way
from pkm_post.toolpath.placement.symmetry import mirror, rotation, transform
from pkm_post.toolpath.segments import Segments
from pkm_post.toolpath.surface.cover import cover
from pkm_post.toolpath.surface.moves import program_of
from pkm_post.toolpath.surface.poses import Poses, Tolerances
from pkm_post.toolpath.surface.settings import CutMode, LeadMove, Lines, Order, Settings
from pkm_post.toolpath.surface.spacing import Stepover
from pkm_post.toolpath.surface.surface import Array, Span, Surface
from pkm_post.toolpath.surface.tool_axis import AxisRule, tool_axes
from pkm_post.toolpath.surface_speed import SurfaceSpeed, with_surface_speed

__all__ = [
    "Array",
    "AxisRule",
    "Coverage",
    "CutMode",
    "Cutter",
    "Joint",
    "LeadMove",
    "Lines",
    "OffsetOptions",
    "Order",
    "Poses",
    "Segments",
    "Settings",
    "Span",
    "Stepover",
    "Surface",
    "SurfaceSpeed",
    "Sweep",
    "Tolerances",
    "ToolPose",
    "beside_plane",
    "columns",
    "compensate",
    "cover",
    "coverage",
    "cut_lengths",
    "joined",
    "joint",
    "joints",
    "mirror",
    "passes",
    "place",
    "program_of",
    "reversed_passes",
    "rotation",
    "safe_way",
    "sector",
    "stock_left",
    "tip_from_contact",
    "tool_axes",
    "transform",
    "with_surface_speed",
]
