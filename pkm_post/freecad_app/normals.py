# SPDX-License-Identifier: LGPL-2.1-or-later
"""Normals: where the surface of a Part face is, and which way it faces.

A face enters with surface parameters, or with points near it; points and unit normals leave as arrays, in mm, in the
frame of the shape. Normals point out of the material: they honour the orientation of the face in its solid, which the
surface below it does not know. OpenCASCADE answers point by point: some microseconds for parameters (u, v), half a
millisecond for a projection.
"""

from __future__ import annotations

from typing import Any

import FreeCAD as App
import numpy as np
from numpy.typing import ArrayLike

Array = np.ndarray[Any, np.dtype[np.float64]]


def surface_points(face: Any, u: ArrayLike, v: ArrayLike) -> tuple[Array, Array]:
    """Points and outward unit normals at pairs (u, v).

    Args:
        face: a Part face.
        u: (N,) surface parameters, in the face's own range.
        v: (N,) surface parameters, one for each u.

    Returns:
        Points (N, 3) in mm and unit normals (N, 3).

    Raises:
        ValueError: u and v are not columns of one length.
    """
    u, v = np.asarray(u, dtype=np.float64), np.asarray(v, dtype=np.float64)
    if u.ndim != 1 or u.shape != v.shape:
        raise ValueError(f"surface_points: expected u and v of one shape (N,), got {u.shape} and {v.shape}")
    pairs = list(zip(u.tolist(), v.tolist(), strict=True))
    return _rows(face.valueAt(*pair) for pair in pairs), _rows(face.normalAt(*pair) for pair in pairs)


def surface_grid(face: Any, u: ArrayLike, v: ArrayLike) -> tuple[Array, Array]:
    """Points and outward unit normals at every u with every v.

    Args:
        face: a Part face.
        u: (M,) surface parameters, in the face's own range.
        v: (N,) surface parameters, in the face's own range.

    Returns:
        Points (M, N, 3) in mm and unit normals (M, N, 3).
    """
    all_u, all_v = np.meshgrid(np.asarray(u, dtype=np.float64), np.asarray(v, dtype=np.float64), indexing="ij")
    points, normals = surface_points(face, all_u.ravel(), all_v.ravel())
    return points.reshape(*all_u.shape, 3), normals.reshape(*all_u.shape, 3)


def project(face: Any, points: ArrayLike) -> tuple[Array, Array, Array]:
    """Feet of the perpendiculars from points to the surface of a face; the edges of the face do not bound it.

    Args:
        face: a Part face.
        points: (N, 3) points in mm.

    Returns:
        Feet (N, 3) in mm, outward unit normals there (N, 3), and distances (N,) in mm, negative inside the material.

    Raises:
        ValueError: the points are not (N, 3).
    """
    points = np.asarray(points, dtype=np.float64)
    if points.ndim != 2 or points.shape[1] != 3:
        raise ValueError(f"project: expected points (N, 3), got {points.shape}")
    surface = face.Surface
    parameters = np.array([surface.parameter(App.Vector(*point)) for point in points.tolist()]).reshape(-1, 2)
    feet, normals = surface_points(face, parameters[:, 0], parameters[:, 1])
    way = points - feet
    outside = np.einsum("nj,nj->n", way, normals)
    return feet, normals, np.copysign(np.linalg.norm(way, axis=1), outside)


def _rows(vectors: Any) -> Array:
    """FreeCAD vectors as the rows of an array (N, 3)."""
    return np.array([(vector.x, vector.y, vector.z) for vector in vectors], dtype=np.float64).reshape(-1, 3)
