# SPDX-License-Identifier: LGPL-2.1-or-later
"""Feet on faces: a numeric form of a face, to find the feet of many points without OpenCASCADE.

Takes a Part face; returns a function from points (N, 3) to feet. Planes, cylinders, cones, spheres and tori use closed
forms, B-spline surfaces their poles, and others the B-splines into which OpenCASCADE converts them. Rows without a
result are marked and projected by OpenCASCADE itself, about half a millisecond each.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import FreeCAD as App
import numpy as np
import Part

from pkm_post.geometry import Array, Closed, NurbsSurface, cross, elementary, nearest, norm

_SINGULAR = 1e-9
"""Sine of the angle between both derivatives, times their lengths in mm: below this a surface has no normal."""


@dataclass(frozen=True)
class Feet:
    """Feet of N points on the surface of a face.

    Attributes:
        points: (N, 3) the feet, mm.
        normals: (N, 3) unit normals out of the material; NaN where the surface has none.
        parameters: (N, 2) u and v of the feet; NaN where not known yet.
        asked: (N,) whether OpenCASCADE projected the point.
        face: the face to which the parameters of these rows belong.
        written: the face to which the other parameters belong: the same one, or its B-spline form.
    """

    points: Array
    normals: Array
    parameters: Array
    asked: Array
    face: Any
    written: Any


def finder(face: Any) -> Callable[[Array], Feet]:
    """Return the function that finds feet on a face.

    Args:
        face: a Part face.
    """
    formula = _formula(face.Surface)
    quick = _by_formula(face, formula) if formula else _by_poles(face)

    def find(points: Array) -> Feet:
        feet = quick(points)
        unknown = np.flatnonzero(~np.isfinite(feet.points).all(axis=1) | ~np.isfinite(feet.normals).all(axis=1))
        _ask(points, feet, unknown)
        return feet

    return find


def _formula(surface: Any) -> Callable[[Array], elementary.Feet] | None:
    """The closed form for an OpenCASCADE surface, if it has one."""
    kind = surface.TypeId
    if kind == "Part::GeomPlane":
        return partial(elementary.plane_feet, origin=_vector(surface.Position), axis=_vector(surface.Axis))
    if kind == "Part::GeomSphere":
        return partial(elementary.sphere_feet, centre=_vector(surface.Center), radius=surface.Radius)
    about = {"axis": _vector(surface.Axis)} if hasattr(surface, "Axis") else {}
    if kind == "Part::GeomCylinder":
        return partial(elementary.cylinder_feet, centre=_vector(surface.Center), radius=surface.Radius, **about)
    if kind == "Part::GeomCone":
        return partial(elementary.cone_feet, apex=_vector(surface.Apex), half_angle=abs(surface.SemiAngle), **about)
    if kind == "Part::GeomToroid" and surface.MajorRadius > surface.MinorRadius:
        sizes = {"major": surface.MajorRadius, "minor": surface.MinorRadius}
        return partial(elementary.torus_feet, centre=_vector(surface.Center), **sizes, **about)
    return None


def _by_formula(face: Any, formula: Callable[[Array], elementary.Feet]) -> Callable[[Array], Feet]:
    """The closed form, with normals oriented as the face is."""
    u, v = _middle(face)
    _, own = formula(_vector(face.valueAt(u, v))[None])
    side = np.sign(float(own[0] @ _vector(face.normalAt(u, v))))

    def find(points: Array) -> Feet:
        feet, normals = formula(points)
        return Feet(feet, side * normals, np.full((len(points), 2), np.nan), _none(points), face, face)

    return find


def _by_poles(face: Any) -> Callable[[Array], Feet]:
    """Newton's method on the poles; feet at the border of a patch of a larger surface are left to OpenCASCADE."""
    own = face.Surface.TypeId == "Part::GeomBSplineSurface"
    written = face if own else face.toNurbs().Faces[0]
    surface, closed = nurbs_of(written)
    side = -1.0 if written.Orientation == "Reversed" else 1.0
    low, high = surface.bounds.T

    def find(points: Array) -> Feet:
        at, known = nearest(surface, points, closed)
        if not own:
            known &= (((at > low) & (at < high)) | np.array(closed)).all(axis=1)
        feet, along_u, along_v = surface.derivatives(*at.T, order=1)
        normals = cross(along_u, along_v)
        length = norm(normals)
        normals *= (side / np.where(length > _SINGULAR, length, np.nan))[:, None]
        feet[~known] = np.nan
        return Feet(feet, normals, at, _none(points), face, written)

    return find


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


def _ask(points: Array, feet: Feet, rows: Array) -> None:
    """Project some rows by OpenCASCADE."""
    surface = feet.face.Surface
    feet.asked[rows] = True
    for row in rows.tolist():
        u, v = surface.parameter(App.Vector(*points[row]))
        feet.points[row], feet.parameters[row] = _vector(feet.face.valueAt(u, v)), (u, v)
        try:
            feet.normals[row] = _vector(feet.face.normalAt(u, v))
        except Part.OCCError:  # raised where the surface has no normal
            feet.normals[row] = np.nan


def _none(points: Array) -> Array:
    return np.zeros(len(points), dtype=np.bool_)


def _middle(face: Any) -> tuple[float, float]:
    first_u, last_u, first_v, last_v = face.ParameterRange
    return (first_u + last_u) / 2, (first_v + last_v) / 2


def _vector(vector: Any) -> Array:
    return np.array([vector.x, vector.y, vector.z])
