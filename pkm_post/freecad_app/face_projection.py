# SPDX-License-Identifier: LGPL-2.1-or-later
"""Face projection: the feet of points on the surface of a Part face, with outward normals.

Takes a face and points near it; returns feet, unit normals and signed distances as arrays, in mm, in the frame of the
shape. Normals point out of the material: they follow the orientation of the face in its solid, which the underlying
surface does not have.

Planes, cylinders, cones, spheres and tori use closed forms, B-spline surfaces their poles, and others the B-splines
into which OpenCASCADE converts them. Points without a result are projected by OpenCASCADE, at about half a
millisecond each.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import FreeCAD as App
import numpy as np
import Part
from numpy.typing import ArrayLike

from pkm_post.geometry import (
    Array,
    Closed,
    NurbsSurface,
    cone_feet,
    cross,
    cylinder_feet,
    nearest_on_nurbs,
    norm,
    plane_feet,
    points_within,
    sphere_feet,
    torus_feet,
)

_SINGULAR = 1e-9
"""Sine of the angle between both derivatives, times their lengths in mm: below this a surface has no normal."""
_CHORDS = 32
"""Number of chords that approximate an edge in the parameter plane."""
_SHARE = 1e-3
"""Least length of a derivative, as a share of its greatest length."""
_SHORT = 1e-9
"""Least length of a derivative as a divisor, mm."""
_EDGE = 1e-3
"""A foot this close to the edge of a face, in mm, counts as on the face."""


@dataclass(frozen=True)
class FootPoints:
    """Feet of N points on the surface of a face.

    Attributes:
        points: (N, 3) the feet, mm.
        normals: (N, 3) unit normals out of the material; NaN where the surface has none.
        parameters: (N, 2) u and v of the feet; NaN where not yet known.
        by_occ: (N,) whether OpenCASCADE projected the point.
        face: the face to which the parameters of these rows belong.
        nurbs_face: the face to which the other parameters belong: the same one, or its B-spline form.
    """

    points: Array
    normals: Array
    parameters: Array
    by_occ: Array
    face: Any
    nurbs_face: Any


def project(face: Any, points: ArrayLike) -> tuple[Array, Array, Array, Array]:
    """Project points perpendicularly onto the surface of a face; the edges of the face do not bound it.

    Args:
        face: a Part face.
        points: (N, 3) points in mm.

    Returns:
        Feet (N, 3) in mm, outward unit normals there (N, 3), distances (N,) in mm, negative inside the material, and
        whether the foot is on the face, or within a micron of its edge (N,). A normal is NaN where the surface has
        none.

    Raises:
        ValueError: the points are not (N, 3), or not finite.
    """
    points = np.asarray(points, dtype=np.float64)
    if points.ndim != 2 or points.shape[1] != 3:
        raise ValueError(f"project: expected points (N, 3), got {points.shape}")
    if not np.isfinite(points).all():
        raise ValueError(f"project: expected finite points, got {int((~np.isfinite(points)).sum())} other numbers")
    formula = _formula(face.Surface)
    feet = _by_formula(face, formula, points) if formula else _by_poles(face, points)
    unknown = np.flatnonzero(~np.isfinite(feet.points).all(axis=1) | ~np.isfinite(feet.normals).all(axis=1))
    _project_by_occ(points, feet, unknown)
    offsets = points - feet.points
    outside = np.einsum("nj,nj->n", offsets, feet.normals)
    distances = np.copysign(np.linalg.norm(offsets, axis=1), outside)
    return feet.points, feet.normals, distances, _on_face(feet)


def _formula(surface: Any) -> Callable[[Array], tuple[Array, Array]] | None:
    """The closed form for an OpenCASCADE surface, if it has one."""
    kind = surface.TypeId
    if kind == "Part::GeomPlane":
        return partial(plane_feet, origin=_vector(surface.Position), axis=_vector(surface.Axis))
    if kind == "Part::GeomSphere":
        return partial(sphere_feet, centre=_vector(surface.Center), radius=surface.Radius)
    about = {"axis": _vector(surface.Axis)} if hasattr(surface, "Axis") else {}
    if kind == "Part::GeomCylinder":
        return partial(cylinder_feet, centre=_vector(surface.Center), radius=surface.Radius, **about)
    if kind == "Part::GeomCone":
        return partial(cone_feet, apex=_vector(surface.Apex), half_angle=abs(surface.SemiAngle), **about)
    if kind == "Part::GeomToroid" and surface.MajorRadius > surface.MinorRadius:
        sizes = {"major": surface.MajorRadius, "minor": surface.MinorRadius}
        return partial(torus_feet, centre=_vector(surface.Center), **sizes, **about)
    return None


def _by_formula(face: Any, formula: Callable[[Array], tuple[Array, Array]], points: Array) -> FootPoints:
    """Feet by the closed form, with normals oriented like the face."""
    first_u, last_u, first_v, last_v = face.ParameterRange
    u, v = (first_u + last_u) / 2, (first_v + last_v) / 2
    _, own = formula(_vector(face.valueAt(u, v))[None])
    side = np.sign(float(own[0] @ _vector(face.normalAt(u, v))))
    feet, normals = formula(points)
    unknown, by_occ = np.full((len(points), 2), np.nan), np.zeros(len(points), dtype=np.bool_)
    return FootPoints(feet, side * normals, unknown, by_occ, face, face)


def _by_poles(face: Any, points: Array) -> FootPoints:
    """Feet by Newton's method on the poles; NaN at the border of a patch of a larger surface, for OpenCASCADE."""
    own = face.Surface.TypeId == "Part::GeomBSplineSurface"
    nurbs_face = face if own else face.toNurbs().Faces[0]
    surface, closed = nurbs_of(nurbs_face)
    side = -1.0 if nurbs_face.Orientation == "Reversed" else 1.0
    at, known = nearest_on_nurbs(surface, points, closed)
    if not own:
        low, high = surface.bounds.T
        known &= (((at > low) & (at < high)) | np.array(closed)).all(axis=1)
    feet, along_u, along_v = surface.derivatives(*at.T, order=1)
    normals = cross(along_u, along_v)
    length = norm(normals)
    normals *= (side / np.where(length > _SINGULAR, length, np.nan))[:, None]
    feet[~known] = np.nan
    return FootPoints(feet, normals, at, np.zeros(len(points), dtype=np.bool_), face, nurbs_face)


def nurbs_of(face: Any) -> tuple[NurbsSurface, Closed]:
    """The B-spline surface of a face, and whether it is closed in u and in v.

    Args:
        face: a Part face on a B-spline surface; ``face.toNurbs()`` converts any face to one.
    """
    surface = face.Surface.copy()
    closed = bool(surface.isUClosed()), bool(surface.isVClosed())
    surface.setUNotPeriodic()
    surface.setVNotPeriodic()
    knots = (
        np.repeat(surface.getUKnots(), surface.getUMultiplicities()),
        np.repeat(surface.getVKnots(), surface.getVMultiplicities()),
    )
    poles = np.array([[_vector(pole) for pole in row] for row in surface.getPoles()])
    return NurbsSurface((surface.UDegree, surface.VDegree), knots, poles, np.array(surface.getWeights())), closed


def _project_by_occ(points: Array, feet: FootPoints, rows: Array) -> None:
    """Project some rows by OpenCASCADE."""
    surface = feet.face.Surface
    feet.by_occ[rows] = True
    for row in rows.tolist():
        u, v = surface.parameter(App.Vector(*points[row]))
        feet.points[row], feet.parameters[row] = _vector(feet.face.valueAt(u, v)), (u, v)
        try:
            feet.normals[row] = _vector(feet.face.normalAt(u, v))
        except Part.OCCError:  # raised where the surface has no normal
            feet.normals[row] = np.nan


def _vector(vector: Any) -> Array:
    return np.array([vector.x, vector.y, vector.z])


def _on_face(feet: FootPoints) -> Array:
    """Whether the feet are on the face, or within a micron of its edge: (N,) bool.

    The edges of the face are polylines in the parameter plane. OpenCASCADE decides where a foot is near one of them:
    about 12 us each, and more for faces with many edges.
    """
    at = feet.parameters.copy()
    for row in np.flatnonzero(np.isnan(at).any(axis=1)).tolist():
        at[row] = feet.nurbs_face.Surface.parameter(App.Vector(*feet.points[row]))
    inside = np.zeros(len(at), dtype=np.bool_)
    for face, rows in ((feet.nurbs_face, ~feet.by_occ), (feet.face, feet.by_occ)):
        if rows.any():
            inside[rows] = _in_domain(face, at[rows])
    return inside


def _in_domain(face: Any, at: Array) -> Array:
    """Whether parameters (N, 2) are on or almost on the face."""
    first_u, _, first_v, _ = face.ParameterRange
    surface = face.Surface
    u, v = at.T
    u = first_u + np.mod(u - first_u, surface.UPeriod()) if surface.isUPeriodic() else u
    v = first_v + np.mod(v - first_v, surface.VPeriod()) if surface.isVPeriodic() else v
    inside, doubt = points_within(np.column_stack([u, v]), *_edges(face))
    for row in np.flatnonzero(doubt).tolist():
        inside[row] = face.isPartOfDomain(*at[row].tolist()) or _near_edge(face, *at[row].tolist())
    return inside


def _edges(face: Any) -> tuple[Array, Array]:
    """The edges of a face as segments in the parameter plane (S, 4), and the uncertain distance around them (S,)."""
    segments, sags = [], []
    for edge in (edge for wire in face.Wires for edge in wire.OrderedEdges):
        curve, first, last = face.curveOnSurface(edge)
        count = 1 if isinstance(curve, Part.Geom2d.Line2d) else _CHORDS
        values = [curve.value(share) for share in np.linspace(first, last, 2 * count + 1).tolist()]
        points = np.array([(value.x, value.y) for value in values])
        ends, middles = points[::2], points[1::2]
        sags.append(np.linalg.norm(middles - (ends[:-1] + ends[1:]) / 2, axis=1))
        segments.append(np.hstack([ends[:-1], ends[1:]]))
    lines = np.vstack(segments)
    return lines, 2 * np.concatenate(sags) + _micron(face, lines[:, :2])


def _micron(face: Any, at: Array) -> Array:
    """Upper bound of two microns in parameters, at each of some places on the face."""
    lengths = np.array([[derivative.Length for derivative in face.derivative1At(u, v)] for u, v in at.tolist()])
    # At a pole one derivative is 0: use the other one, and the neighbouring places.
    least: Array = np.maximum(lengths, _SHARE * lengths.max(axis=0)).min(axis=1)
    return 2 * _EDGE / least


def _near_edge(face: Any, u: float, v: float) -> bool:
    along_u, along_v = (max(derivative.Length, _SHORT) for derivative in face.derivative1At(u, v))
    steps = ((_EDGE / along_u, 0.0), (-_EDGE / along_u, 0.0), (0.0, _EDGE / along_v), (0.0, -_EDGE / along_v))
    return any(face.isPartOfDomain(u + du, v + dv) for du, dv in steps)
