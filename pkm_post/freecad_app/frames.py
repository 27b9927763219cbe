# SPDX-License-Identifier: LGPL-2.1-or-later
"""Frames: FreeCAD placements and vectors as arrays, and the plane or axis of a picked element.

An element is picked by a link as stored in properties: an object with the names of its elements. Its plane or axis is a
point in mm and a direction, in document coordinates. Planes come from flat faces and datum planes, axes from straight
or round edges, faces of revolution, and datum lines.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import FreeCAD as App
import numpy as np
import Part

from pkm_post.geometry import Array


def matrix_of(placement: Any) -> Array:
    """The (4, 4) matrix of a placement."""
    return np.array(placement.Matrix.A).reshape(4, 4)


def placement_of(matrix: Array) -> Any:
    """The placement of a rigid (4, 4) matrix."""
    return App.Placement(App.Matrix(*(float(value) for value in np.asarray(matrix).ravel())))


def rows_of(vectors: Sequence[Any]) -> Array:
    """FreeCAD vectors as the rows of an array (N, 3)."""
    return np.array([(vector.x, vector.y, vector.z) for vector in vectors], dtype=np.float64).reshape(-1, 3)


def vectors_of(points: Array) -> list[Any]:
    """The rows of an array (N, 3) as FreeCAD vectors."""
    return [App.Vector(*point) for point in points.tolist()]


def apply(matrix: Array, points: Array) -> Array:
    """Transform points (N, 3) to the other frame."""
    moved: Array = points @ matrix[:3, :3].T + matrix[:3, 3]
    return moved


Link = tuple[Any, list[str]]
Placed = tuple[App.Vector, App.Vector]
"""A point of a plane or an axis, and its normal or direction."""


def plane_of(link: Link) -> Placed:
    """The plane of a flat face or a datum plane.

    Args:
        link: the object and the name of its face; no name for an object with a single face.

    Raises:
        ValueError: the face is not flat or does not exist.
    """
    shape = _element(link, lambda whole: whole.Faces)
    plane = shape.findPlane() if shape is not None and shape.ShapeType == "Face" else None
    if plane is None:
        raise ValueError(f"Plane: expected a flat face or a datum plane, got {_name(link)}")
    return plane.Position, plane.Axis


def axis_of(link: Link) -> Placed:
    """The axis of an edge, a face of revolution or a datum line.

    Args:
        link: the object and the name of its edge or face; no name for an object with a single edge.

    Raises:
        ValueError: the picked element has no axis.
    """
    shape = _element(link, lambda whole: whole.Edges)
    form = {"Edge": "Curve", "Face": "Surface"}.get("" if shape is None else shape.ShapeType, "")
    known = _FORMS.get(getattr(shape, form).TypeId) if form else None
    if known is None:
        raise ValueError(f"Line: expected a straight or round edge, a round face or a datum line, got {_name(link)}")
    point, direction = known
    return getattr(getattr(shape, form), point), getattr(getattr(shape, form), direction)


_FORMS = {
    "Part::GeomLine": ("Location", "Direction"),
    "Part::GeomCircle": ("Center", "Axis"),
    "Part::GeomEllipse": ("Center", "Axis"),
    "Part::GeomCylinder": ("Center", "Axis"),
    "Part::GeomCone": ("Apex", "Axis"),
    "Part::GeomToroid": ("Center", "Axis"),
    "Part::GeomSurfaceOfRevolution": ("Location", "Direction"),
}
"""For each curve and surface with an axis, the attributes with its point and direction."""


def _element(link: Link, parts: Callable[[Any], list[Any]]) -> Any:
    """The element that a link names, or the single element of an object, in document coordinates; None if none."""
    obj, names = link
    name = next(iter(names), "")
    shape = Part.getShape(obj, name, needSubElement=True)
    if shape.isNull():
        return None
    if shape.ShapeType not in ("Face", "Edge"):
        found = parts(shape)
        if len(found) != 1:
            return None
        (shape,) = found
    # A shape has the placement of its object; the object may be in a part with another placement.
    shape = shape.copy()
    shape.Placement = obj.getGlobalPlacement() * obj.Placement.inverse() * shape.Placement
    return shape


def _name(link: Link) -> str:
    obj, names = link
    return " ".join([obj.Label, *names]).strip()
