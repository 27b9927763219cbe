# SPDX-License-Identifier: LGPL-2.1-or-later
"""Face surface: a Part face as a parametric surface for passes.

Takes a face, in the frame of its shape; returns functions of columns (u, v), or points and outward unit normals at
them, in mm. B-spline faces are evaluated from their poles, all points at once. For others OpenCASCADE evaluates point
by point, at some ten microseconds each; the test whether a point is on a trimmed face takes several times as long, so
it is only made near the borders.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from pkm_post.freecad_app.face_projection import nurbs_of
from pkm_post.freecad_app.frames import rows_of
from pkm_post.geometry import Array, cross, dot, norm
from pkm_post.toolpath import ParameterRange, Surface

_SAME = 1e-6
"""mm within which both ends of a range coincide: the surface is closed."""
_SINGULAR = 1e-9
"""mm^2: cross product of both derivatives below which the normal is undefined."""
_WHOLE = 1e-9
"""Missing share of the full parameter area up to which a face counts as untrimmed."""
_NEAR = 0.01
"""Distance from a border, as a share of the ranges, within which OpenCASCADE tests whether a point is on the face."""
_OFF = _NEAR / 8
"""Allowed deviation of a border polygon, as a share of the ranges."""
_PARTS = (4, 16, 64)
"""Pairs of segments of a polygon for each span of an edge: the first sufficient count is used."""
_AT_ONCE = 1 << 20
"""Pairs of a point and a segment compared at a time."""


Columns = tuple[Array, Array, Array, Array]
Evaluate = Callable[[Array, Array], Columns]


def face_surface(face: Any, flipped: bool = False) -> Surface:
    """The surface of a face, trimmed like the face.

    Args:
        face: a Part face. Normals point out of its solid.
        flipped: whether the material is on the other side, for a face without a solid.
    """
    first_u, last_u, first_v, last_v = face.ParameterRange
    u, v = np.linspace(first_u, last_u, 9), np.linspace(first_v, last_v, 9)
    closed_u = _coincide(face, np.full(9, first_u), v, np.full(9, last_u), v)
    closed_v = _coincide(face, u, np.full(9, first_v), u, np.full(9, last_v))
    by_poles = _from_poles(face)
    side = -1.0 if flipped else 1.0
    return Surface(
        _oriented(by_poles or _from_occ(face), side),
        _everywhere if is_untrimmed(face) else _trimmed(face),
        ParameterRange(first_u, last_u, closed_u),
        ParameterRange(first_v, last_v, closed_v),
        None if by_poles else _rows_from_occ(face.valueAt),
        None if by_poles else _rows_from_occ(face.normalAt, side),
    )


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
    return rows_of([face.valueAt(*pair) for pair in pairs]), rows_of([face.normalAt(*pair) for pair in pairs])


def _oriented(evaluate: Evaluate, side: float) -> Evaluate:
    """The same surface with its normals multiplied by 1 or -1."""

    def turned(u: Array, v: Array) -> Columns:
        point, normal, along_u, along_v = evaluate(u, v)
        return point, side * normal, along_u, along_v

    return turned


def _from_occ(face: Any) -> Evaluate:
    """Points, normals and derivatives from OpenCASCADE."""

    def evaluate(u: Array, v: Array) -> Columns:
        pairs = list(zip(u.tolist(), v.tolist(), strict=True))
        derivatives = [face.derivative1At(*pair) for pair in pairs]
        return (
            rows_of([face.valueAt(*pair) for pair in pairs]),
            rows_of([face.normalAt(*pair) for pair in pairs]),
            rows_of([by_u for by_u, _ in derivatives]),
            rows_of([by_v for _, by_v in derivatives]),
        )

    return evaluate


def _rows_from_occ(at: Callable[[float, float], Any], side: float = 1.0) -> Callable[[Array, Array], Array]:
    """Only points, or only normals, multiplied by 1 or -1, from OpenCASCADE."""
    return lambda u, v: side * rows_of([at(*pair) for pair in zip(u.tolist(), v.tolist(), strict=True)])


def _from_poles(face: Any) -> Evaluate | None:
    """The same for a B-spline face within one period of its surface; OpenCASCADE handles points without a normal."""
    if face.Surface.TypeId != "Part::GeomBSplineSurface":
        return None
    surface, _ = nurbs_of(face)
    (low_u, high_u), (low_v, high_v) = surface.bounds.tolist()
    first_u, last_u, first_v, last_v = face.ParameterRange
    if not (low_u <= first_u and last_u <= high_u and low_v <= first_v and last_v <= high_v):
        return None
    occ = _from_occ(face)
    _, normal, along_u, along_v = occ(np.array([(first_u + last_u) / 2]), np.array([(first_v + last_v) / 2]))
    side = -1.0 if dot(normal, cross(along_u, along_v))[0] < 0.0 else 1.0

    def evaluate(u: Array, v: Array) -> Columns:
        point, along_u, along_v = surface.derivatives(u, v, order=1)
        normal = side * cross(along_u, along_v)
        length = norm(normal)
        singular = np.flatnonzero(length <= _SINGULAR)
        normal = normal / np.where(length > _SINGULAR, length, 1.0)[:, None]
        normal[singular] = occ(u[singular], v[singular])[1]
        return point, normal, along_u, along_v

    return evaluate


def _coincide(face: Any, u: Array, v: Array, other_u: Array, other_v: Array) -> bool:
    """Whether two lines of the surface coincide."""
    ends = zip(u.tolist(), v.tolist(), other_u.tolist(), other_v.tolist(), strict=True)
    return all(face.valueAt(a, b).distanceToPoint(face.valueAt(c, d)) < _SAME for a, b, c, d in ends)


def _trimmed(face: Any) -> Callable[[Array, Array], Array]:
    """Which pairs (u, v) are on a trimmed face: by its borders as polygons and, near these, by OpenCASCADE."""
    first_u, last_u, first_v, last_v = face.ParameterRange
    first, width = np.array([first_u, first_v]), np.array([last_u - first_u, last_v - first_v])
    polygons = _borders(face, first, width)

    def inside(u: Array, v: Array) -> Array:
        if polygons is None:
            held, near = np.zeros(len(u), dtype=bool), np.arange(len(u))
        else:
            held, distance = _in_polygons((np.column_stack([u, v]) - first) / width, *polygons)
            near = np.flatnonzero(distance <= _NEAR)
        held[near] = [face.isPartOfDomain(*pair) for pair in zip(u[near].tolist(), v[near].tolist(), strict=True)]
        return held

    return inside


def _borders(face: Any, first: Array, width: Array) -> tuple[Array, Array] | None:
    """Ends of the segments of all borders, (S, 2) each in shares of the ranges; None if they are not closed there.

    A pole may have no line on the face, and the borders of an invalid face may enclose its outside.
    """
    if not face.isValid():
        return None
    starts, ends = [], []
    for wire in face.Wires:
        lines = []
        for edge in wire.OrderedEdges:
            line = _border_line(face, edge, first, width)
            if line is None or (lines and norm(line[:1] - lines[-1][-1:])[0] > _OFF):
                return None
            lines.append(line)
        points = np.vstack(lines)
        if norm(points[:1] - points[-1:])[0] > _OFF:
            return None
        starts.append(points)
        ends.append(np.roll(points, -1, axis=0))
    return np.vstack(starts), np.vstack(ends)


def _border_line(face: Any, edge: Any, first: Array, width: Array) -> Array | None:
    """An edge as a polygon in shares of the ranges, (S, 2), in its direction; None if none is close enough."""
    on_face = face.curveOnSurface(edge)
    if on_face is None:
        return None
    curve, begin, end = on_face
    knots = [knot for knot in curve.getKnots() if begin < knot < end] if hasattr(curve, "getKnots") else []
    spans = np.array([begin, *knots, end])
    for parts in _PARTS:
        share = np.linspace(0, len(spans) - 1, 2 * parts * (len(spans) - 1) + 1)
        values = [curve.value(place) for place in np.interp(share, np.arange(len(spans)), spans).tolist()]
        points = (np.array([(value.x, value.y) for value in values]) - first) / width
        if norm(points[1::2] - (points[:-2:2] + points[2::2]) / 2).max() <= _OFF:
            return points[::-1] if edge.Orientation == "Reversed" else points
    return None


def _in_polygons(points: Array, starts: Array, ends: Array) -> tuple[Array, Array]:
    """Which points are inside closed polygons by the even-odd rule, and their distances from the border, (N,) each."""
    inside, distance = np.zeros(len(points), dtype=bool), np.zeros(len(points))
    count = max(_AT_ONCE // len(starts), 1)
    along = ends - starts
    square = np.maximum(dot(along, along), np.finfo(float).tiny)
    for row in range(0, len(points), count):
        chunk = slice(row, row + count)
        u, v = (points[chunk, axis, None] - starts[:, axis] for axis in (0, 1))
        share = np.clip((u * along[:, 0] + v * along[:, 1]) / square, 0.0, 1.0)
        distance[chunk] = np.hypot(u - share * along[:, 0], v - share * along[:, 1]).min(axis=1)
        spans = (v >= 0.0) != (v >= along[:, 1])
        left = (u * along[:, 1] < v * along[:, 0]) == (along[:, 1] > 0.0)
        inside[chunk] = np.count_nonzero(spans & left, axis=1) % 2 == 1
    return inside, distance


def is_untrimmed(face: Any) -> bool:
    """Whether a face fills its full parameter range."""
    whole = face.Surface.toShape(*face.ParameterRange).Area
    return bool(abs(whole - face.Area) <= _WHOLE * whole)


def _everywhere(u: Array, _v: Array) -> Array:
    return np.ones(len(u), dtype=bool)
