# SPDX-License-Identifier: LGPL-2.1-or-later
"""Frames: FreeCAD's placements as (4, 4) matrices of numpy, and back."""

from __future__ import annotations

from typing import Any

import FreeCAD as App
import numpy as np

from pkm_post.geometry.vectors import Array


def matrix_of(placement: Any) -> Array:
    """The (4, 4) matrix of a placement."""
    return np.array(placement.Matrix.A).reshape(4, 4)


def placement_of(matrix: Array) -> Any:
    """The placement of a (4, 4) matrix, a turn and a shift."""
    return App.Placement(App.Matrix(*(float(value) for value in np.asarray(matrix).ravel())))


def apply(matrix: Array, points: Array) -> Array:
    """Points (N, 3) in the other frame."""
    moved: Array = points @ matrix[:3, :3].T + matrix[:3, 3]
    return moved
