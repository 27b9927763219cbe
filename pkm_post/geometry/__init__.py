# SPDX-License-Identifier: LGPL-2.1-or-later
"""Geometry: arrays in, arrays out; independent of machines, tools and files."""

from pkm_post.geometry.arcs import arc_points, arc_sweep
from pkm_post.geometry.great_circle import along, along_rates, angle_between, towards
from pkm_post.geometry.hermite import (
    hermite_accelerations,
    hermite_column_speeds,
    hermite_columns,
    hermite_lengths,
    hermite_powers,
    hermite_speeds,
)
from pkm_post.geometry.torsion import torsion, untwisted
from pkm_post.geometry.vectors import dot, norm, unit

__all__ = [
    "along",
    "along_rates",
    "angle_between",
    "arc_points",
    "arc_sweep",
    "dot",
    "hermite_accelerations",
    "hermite_column_speeds",
    "hermite_columns",
    "hermite_lengths",
    "hermite_powers",
    "hermite_speeds",
    "norm",
    "torsion",
    "towards",
    "unit",
    "untwisted",
]
