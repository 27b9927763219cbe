# SPDX-License-Identifier: LGPL-2.1-or-later
"""Geometry: arrays in, arrays out; independent of machines, tools and files."""

from pkm_post.geometry import elementary
from pkm_post.geometry.arcs import across, arc_length, arc_points, arc_sweep
from pkm_post.geometry.cells import cells
from pkm_post.geometry.cylinder_triangle import nearest_of_triangle
from pkm_post.geometry.distances import segment_to_box, segment_to_cylinder, segment_to_segment
from pkm_post.geometry.gather import among, numbered, taken
from pkm_post.geometry.great_circle import along, along_rates, angle_between, towards
from pkm_post.geometry.hermite import (
    hermite_accelerations,
    hermite_column_speeds,
    hermite_columns,
    hermite_lengths,
    hermite_powers,
    hermite_speeds,
)
from pkm_post.geometry.nurbs import NurbsSurface
from pkm_post.geometry.nurbs_nearest import Closed, nearest
from pkm_post.geometry.outline import within
from pkm_post.geometry.separation import TRIANGLE_EDGES, Cylinders, cylinder_to_corners, separate, shadow
from pkm_post.geometry.torsion import fill_frame, tilt, torsion, turn_by_tilt, untwisted
from pkm_post.geometry.triangles import cut_small, inside, is_closed
from pkm_post.geometry.vectors import Array, cross, dot, length_of, norm, unit

__all__ = [
    "TRIANGLE_EDGES",
    "Array",
    "Closed",
    "Cylinders",
    "NurbsSurface",
    "across",
    "along",
    "along_rates",
    "among",
    "angle_between",
    "arc_length",
    "arc_points",
    "arc_sweep",
    "cells",
    "cross",
    "cut_small",
    "cylinder_to_corners",
    "dot",
    "elementary",
    "fill_frame",
    "hermite_accelerations",
    "hermite_column_speeds",
    "hermite_columns",
    "hermite_lengths",
    "hermite_powers",
    "hermite_speeds",
    "inside",
    "is_closed",
    "length_of",
    "nearest",
    "nearest_of_triangle",
    "norm",
    "numbered",
    "segment_to_box",
    "segment_to_cylinder",
    "segment_to_segment",
    "separate",
    "shadow",
    "taken",
    "tilt",
    "torsion",
    "towards",
    "turn_by_tilt",
    "unit",
    "untwisted",
    "within",
]
