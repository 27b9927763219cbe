# SPDX-License-Identifier: LGPL-2.1-or-later
"""Placement: position of the program, by symmetry of the workpiece (T_C) and by the work offset on the machine (D)."""

from pkm_post.toolpath.placement.climb import CutDirection, CutLengths, cut_directions, cut_lengths
from pkm_post.toolpath.placement.coverage import Coverage, Sector, beside_plane, coverage, sector
from pkm_post.toolpath.placement.joined import joined
from pkm_post.toolpath.placement.joints import Joint, joint, joints
from pkm_post.toolpath.placement.passes import passes
from pkm_post.toolpath.placement.place import place
from pkm_post.toolpath.placement.reversed import reversed_passes
from pkm_post.toolpath.placement.symmetry import mirror, mirrors, rotation, transform

__all__ = [
    "Coverage",
    "CutDirection",
    "CutLengths",
    "Joint",
    "Sector",
    "beside_plane",
    "coverage",
    "cut_directions",
    "cut_lengths",
    "joined",
    "joint",
    "joints",
    "mirror",
    "mirrors",
    "passes",
    "place",
    "reversed_passes",
    "rotation",
    "sector",
    "transform",
]
