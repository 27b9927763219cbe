# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tool path: symmetry, work offset, compensation and surface passes, from a program to a trajectory."""

from pkm_post.toolpath.compensation.compensate import compensate
from pkm_post.toolpath.compensation.contact import tip_from_contact
from pkm_post.toolpath.compensation.contour_elements import OffsetOptions
from pkm_post.toolpath.compensation.cutter import Cutter
from pkm_post.toolpath.compensation.swept_volume import Sweep, stock_left
from pkm_post.toolpath.place import place
from pkm_post.toolpath.segments import Segments
from pkm_post.toolpath.surface.moves import program_of
from pkm_post.toolpath.surface.options import CutMode, LeadMove, Lines, Order, Settings
from pkm_post.toolpath.surface.passes import cover
from pkm_post.toolpath.surface.poses import Poses, Tolerances
from pkm_post.toolpath.surface.stepover import Stepover
from pkm_post.toolpath.surface.surface import Array, Span, Surface
from pkm_post.toolpath.surface.tool_axis import AxisRule, tool_axes
from pkm_post.toolpath.surface_speed import SurfaceSpeed, with_surface_speed
from pkm_post.toolpath.symmetry.coverage import Coverage, Joint, beside_plane, coverage, joint, joints, sector
from pkm_post.toolpath.symmetry.cut_direction import cut_lengths
from pkm_post.toolpath.symmetry.passes import passes
from pkm_post.toolpath.symmetry.reverse import reversed_passes
from pkm_post.toolpath.symmetry.transform import joined, mirror, rotation, transform
from pkm_post.toolpath.tool_change import ToolPose, columns, safe_way

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
