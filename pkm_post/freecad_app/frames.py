# SPDX-License-Identifier: LGPL-2.1-or-later
"""Frames: conversion between FreeCAD placements and (4, 4) numpy matrices."""

from __future__ import annotations

from typing import Any

import FreeCAD as App
import numpy as np

from pkm_post.geometry import Array


def matrix_of(placement: Any) -> Array:
    """The (4, 4) matrix of a placement."""
    return np.array(placement.Matrix.A).reshape(4, 4)


def placement_of(matrix: Array) -> Any:
    """The placement of a rigid (4, 4) matrix."""
    return App.Placement(App.Matrix(*(float(value) for value in np.asarray(matrix).ravel())))


def apply(matrix: Array, points: Array) -> Array:
    """Transform points (N, 3) to the other frame."""
    moved: Array = points @ matrix[:3, :3].T + matrix[:3, 3]
    return moved
