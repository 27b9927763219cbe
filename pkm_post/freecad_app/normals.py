# SPDX-License-Identifier: LGPL-2.1-or-later
"""Normals: points and outward normals on the surface of a Part face.

Takes a face with surface parameters, or with points near it; returns points and unit normals as arrays, in mm, in the
frame of the shape. Normals point out of the material: they honour the orientation of the face in its solid, which the
underlying surface does not have.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from pkm_post.freecad_app.face_feet import finder
from pkm_post.freecad_app.face_trim import on_face
from pkm_post.freecad_app.progress import Stopped

Array = np.ndarray[Any, np.dtype[np.float64]]

_TOGETHER = 20_000
"""Points projected between two progress reports."""


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
    """Points and outward unit normals at every combination of u and v.

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


def project(
    face: Any,
    points: ArrayLike,
    *,
    progress: Callable[[float], Any] | None = None,
    trimmed: bool = False,
) -> tuple[Array, ...]:
    """Project points perpendicularly onto the surface of a face; the edges of the face do not bound it.

    Args:
        face: a Part face.
        points: (N, 3) points in mm.
        progress: called with the completed share, from 0 to 1, at intervals; returning False stops the work.
        trimmed: also return which feet lie within the edges of the face.

    Returns:
        Feet (N, 3) in mm, outward unit normals there (N, 3), and distances (N,) in mm, negative inside the material.
        With ``trimmed``, also whether the foot is on the face, or within a micron of its edge (N,). A normal is NaN
        where the surface has none.

    Raises:
        ValueError: the points are not (N, 3), or not finite.
        Stopped: progress returned False.
    """
    points = np.asarray(points, dtype=np.float64)
    if points.ndim != 2 or points.shape[1] != 3:
        raise ValueError(f"project: expected points (N, 3), got {points.shape}")
    if not np.isfinite(points).all():
        raise ValueError(f"project: expected finite points, got {int((~np.isfinite(points)).sum())} other numbers")
    find = finder(face)
    found, normals, inside = np.empty_like(points), np.empty_like(points), np.ones(len(points), dtype=np.bool_)
    for start in range(0, len(points), _TOGETHER):
        part = slice(start, start + _TOGETHER)
        feet = find(points[part])
        found[part], normals[part] = feet.points, feet.normals
        if trimmed:
            inside[part] = on_face(feet)
        done = min(start + _TOGETHER, len(points)) / len(points)
        if progress is not None and progress(done) is False:
            raise Stopped(f"{100 * done:.0f} % of the points were projected")
    way = points - found
    outside = np.einsum("nj,nj->n", way, normals)
    distances = np.copysign(np.linalg.norm(way, axis=1), outside)
    return (found, normals, distances, inside) if trimmed else (found, normals, distances)


def _rows(vectors: Any) -> Array:
    """FreeCAD vectors as the rows of an array (N, 3)."""
    return np.array([(vector.x, vector.y, vector.z) for vector in vectors], dtype=np.float64).reshape(-1, 3)
