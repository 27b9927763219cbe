# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tool path: compensation, symmetry, surface passes, work offset and spindle speeds, from a program to a trajectory."""

from typing import TYPE_CHECKING

from pkm_post import at_first_use
from pkm_post.toolpath.compressor.compress import compress
from pkm_post.toolpath.compressor.splines import Splines, direction
from pkm_post.toolpath.place import MOST_TILT, largest_tilts, place
from pkm_post.toolpath.segments import Segments, highest_tip
from pkm_post.toolpath.tool_change import ToolPose, clearance_path, pose_columns

if TYPE_CHECKING:
    from pkm_post.toolpath.chords import CHORD_ERROR, with_chords
    from pkm_post.toolpath.compensation.compensate import compensate
    from pkm_post.toolpath.compensation.contact import tip_from_contact
    from pkm_post.toolpath.compensation.cutter import Cutter
    from pkm_post.toolpath.compensation.offset_options import OffsetOptions
    from pkm_post.toolpath.compensation.stock_left import stock_left
    from pkm_post.toolpath.compensation.swept_volume import SweptVolume
    from pkm_post.toolpath.compressor.bounds import SplineBounds, tip_jerk_bound
    from pkm_post.toolpath.from_line import (
        StartLine,
        lines_to_begin_at,
        modal_events,
        not_repeated,
        row_of_line,
        started_at_line,
    )
    from pkm_post.toolpath.machine_offsets import MachineOffsets, with_machine_offsets
    from pkm_post.toolpath.optional_stops import OPTIONAL_STOPS, with_optional_stops
    from pkm_post.toolpath.sides import with_side
    from pkm_post.toolpath.surface.moves import program_from_poses
    from pkm_post.toolpath.surface.options import CutMode, LeadMove, PassLines, PassOrder, SurfaceOptions
    from pkm_post.toolpath.surface.passes import surface_poses
    from pkm_post.toolpath.surface.poses import SurfacePoses, SurfaceTolerances
    from pkm_post.toolpath.surface.stepover import Stepover
    from pkm_post.toolpath.surface.surface import ParameterRange, Surface
    from pkm_post.toolpath.surface.tool_axis import AxisRule, tool_axes
    from pkm_post.toolpath.surface_speed import SurfaceSpeed, with_surface_speed
    from pkm_post.toolpath.symmetry.copies import Copies, with_copies
    from pkm_post.toolpath.symmetry.coverage import AngularCoverage, Seam, coverage, mirror_gap, seam, seams, sector
    from pkm_post.toolpath.symmetry.cut_direction import cut_lengths
    from pkm_post.toolpath.symmetry.passes import pass_rows
    from pkm_post.toolpath.symmetry.reverse import reversed_passes
    from pkm_post.toolpath.symmetry.transform import concatenate, mirror, rotation, transform
else:
    __getattr__ = at_first_use(
        __name__,
        {
            "chords": "CHORD_ERROR with_chords",
            "compensation.compensate": "compensate",
            "compensation.contact": "tip_from_contact",
            "compensation.cutter": "Cutter",
            "compensation.offset_options": "OffsetOptions",
            "compensation.stock_left": "stock_left",
            "compensation.swept_volume": "SweptVolume",
            "compressor.bounds": "SplineBounds tip_jerk_bound",
            "from_line": "StartLine lines_to_begin_at started_at_line modal_events not_repeated row_of_line",
            "machine_offsets": "MachineOffsets with_machine_offsets",
            "optional_stops": "OPTIONAL_STOPS with_optional_stops",
            "sides": "with_side",
            "surface.moves": "program_from_poses",
            "surface.options": "CutMode LeadMove PassLines PassOrder SurfaceOptions",
            "surface.passes": "surface_poses",
            "surface.poses": "SurfacePoses SurfaceTolerances",
            "surface.stepover": "Stepover",
            "surface.surface": "ParameterRange Surface",
            "surface.tool_axis": "AxisRule tool_axes",
            "surface_speed": "SurfaceSpeed with_surface_speed",
            "symmetry.copies": "Copies with_copies",
            "symmetry.coverage": "AngularCoverage Seam coverage mirror_gap seam seams sector",
            "symmetry.cut_direction": "cut_lengths",
            "symmetry.passes": "pass_rows",
            "symmetry.reverse": "reversed_passes",
            "symmetry.transform": "concatenate mirror rotation transform",
        },
    )
