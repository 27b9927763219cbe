# SPDX-License-Identifier: LGPL-2.1-or-later
"""Face surface: a Part face as the parametric surface on which passes are laid out.

Takes a face, in the frame of its shape; returns functions of columns (u, v), in mm. B-spline faces are evaluated from
their poles, all points at once. For others OpenCASCADE evaluates point by point, at some ten microseconds each;
testing whether a point lies on a trimmed face takes as long again.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from pkm_post.freecad_app.face_projection import nurbs_of
from pkm_post.geometry import Array, cross, dot, norm
from pkm_post.toolpath import ParameterRange, Surface

_SAME = 1e-6
"""mm within which both ends of a range coincide: the surface is closed."""
_SINGULAR = 1e-9
"""mm^2: cross product of both derivatives below which the normal is undefined."""
_WHOLE = 1e-9
"""Missing share of the area of its full parameter range up to which a face still counts as untrimmed."""


Columns = tuple[Array, Array, Array, Array]
Evaluate = Callable[[Array, Array], Columns]


def face_surface(face: Any, flipped: bool = False) -> Surface:
    """The surface of a face, trimmed like the face.

    Args:
        face: a Part face. Normals point out of its solid.
        flipped: whether the material is on the other side, which is possible for a face without a solid.
    """
    first_u, last_u, first_v, last_v = face.ParameterRange

    def inside(u: Array, v: Array) -> Array:
        return np.array([face.isPartOfDomain(*pair) for pair in zip(u.tolist(), v.tolist(), strict=True)], dtype=bool)

    u, v = np.linspace(first_u, last_u, 9), np.linspace(first_v, last_v, 9)
    closed_u = _coincide(face, np.full(9, first_u), v, np.full(9, last_u), v)
    closed_v = _coincide(face, u, np.full(9, first_v), u, np.full(9, last_v))
    return Surface(
        _turned(_by_poles(face) or _by_asking(face), -1.0 if flipped else 1.0),
        _everywhere if _untrimmed(face) else inside,
        ParameterRange(first_u, last_u, closed_u),
        ParameterRange(first_v, last_v, closed_v),
    )


def _turned(evaluate: Evaluate, side: float) -> Evaluate:
    """The same surface with its normals multiplied by 1 or -1."""

    def turned(u: Array, v: Array) -> Columns:
        point, normal, along_u, along_v = evaluate(u, v)
        return point, side * normal, along_u, along_v

    return turned


def _by_asking(face: Any) -> Evaluate:
    """Points, normals and derivatives from OpenCASCADE."""

    def evaluate(u: Array, v: Array) -> Columns:
        pairs = list(zip(u.tolist(), v.tolist(), strict=True))
        derivatives = [face.derivative1At(*pair) for pair in pairs]
        return (
            _rows([face.valueAt(*pair) for pair in pairs]),
            _rows([face.normalAt(*pair) for pair in pairs]),
            _rows([by_u for by_u, _ in derivatives]),
            _rows([by_v for _, by_v in derivatives]),
        )

    return evaluate


def _by_poles(face: Any) -> Evaluate | None:
    """The same for a B-spline face within one period of its surface; OpenCASCADE handles points without a normal."""
    if face.Surface.TypeId != "Part::GeomBSplineSurface":
        return None
    surface, _ = nurbs_of(face)
    (low_u, high_u), (low_v, high_v) = surface.bounds.tolist()
    first_u, last_u, first_v, last_v = face.ParameterRange
    if not (low_u <= first_u and last_u <= high_u and low_v <= first_v and last_v <= high_v):
        return None
    ask = _by_asking(face)
    _, normal, along_u, along_v = ask(np.array([(first_u + last_u) / 2]), np.array([(first_v + last_v) / 2]))
    side = -1.0 if dot(normal, cross(along_u, along_v))[0] < 0.0 else 1.0

    def evaluate(u: Array, v: Array) -> Columns:
        point, along_u, along_v = surface.derivatives(u, v, order=1)
        normal = side * cross(along_u, along_v)
        length = norm(normal)
        lost = np.flatnonzero(length <= _SINGULAR)
        normal = normal / np.where(length > _SINGULAR, length, 1.0)[:, None]
        normal[lost] = ask(u[lost], v[lost])[1]
        return point, normal, along_u, along_v

    return evaluate


def _coincide(face: Any, u: Array, v: Array, other_u: Array, other_v: Array) -> bool:
    """Whether two lines of the surface coincide."""
    ends = zip(u.tolist(), v.tolist(), other_u.tolist(), other_v.tolist(), strict=True)
    return all(face.valueAt(a, b).distanceToPoint(face.valueAt(c, d)) < _SAME for a, b, c, d in ends)


def _untrimmed(face: Any) -> bool:
    """Whether a face fills its full parameter range."""
    whole = face.Surface.toShape(*face.ParameterRange).Area
    return bool(abs(whole - face.Area) <= _WHOLE * whole)


def _everywhere(u: Array, _v: Array) -> Array:
    return np.ones(len(u), dtype=bool)


def _rows(vectors: list[Any]) -> Array:
    """FreeCAD vectors as the rows of an array (N, 3)."""
    return np.array([(vector.x, vector.y, vector.z) for vector in vectors], dtype=np.float64).reshape(-1, 3)
