# SPDX-License-Identifier: LGPL-2.1-or-later
"""Geometry: arrays in, arrays out; independent of machines, tools and files."""

from typing import TYPE_CHECKING

from pkm_post import at_first_use
from pkm_post.geometry.cells import Pairs, grid_cells, groups_of, pairs_together
from pkm_post.geometry.curves import (
    arc_length,
    arc_points,
    arc_sweep,
    arc_turning_points,
    bounding_box,
    chord_counts,
    cubic_ranges,
    hermite_accelerations,
    hermite_column_speeds,
    hermite_columns,
    hermite_lengths,
    hermite_powers,
    hermite_speeds,
    move_lengths,
)
from pkm_post.geometry.cylinders import TRIANGLE_EDGES, Cylinders, half_extents, nearest_on_triangle, separation
from pkm_post.geometry.distances import point_to_segment, segment_to_box, segment_to_cylinder, segment_to_segment
from pkm_post.geometry.orientation import (
    along,
    along_rates,
    angle_between,
    largest_tilt,
    tilt,
    torsion,
    torsion_free_axes,
    towards,
    turn_by_tilt,
    turned_angles,
    write_frames,
)
from pkm_post.geometry.vectors import (
    Array,
    across,
    between_rows,
    cross,
    distinct_with_rows,
    dot,
    dot_columns,
    expand_counts,
    height_and_radius,
    length_of,
    norm,
    take_rows,
    unit,
    unit_or_nan,
)

if TYPE_CHECKING:
    from pkm_post.geometry.nurbs import NurbsSurface, bspline_points
    from pkm_post.geometry.polygons import grid_points_inside, is_closed, points_within, subdivide
    from pkm_post.geometry.projection import (
        Closed,
        cone_feet,
        cylinder_feet,
        nearest_on_nurbs,
        plane_feet,
        sphere_feet,
        torus_feet,
    )
else:
    __getattr__ = at_first_use(
        __name__,
        {
            "nurbs": "NurbsSurface bspline_points",
            "polygons": "grid_points_inside is_closed points_within subdivide",
            "projection": "Closed cone_feet cylinder_feet nearest_on_nurbs plane_feet sphere_feet torus_feet",
        },
    )
