# SPDX-License-Identifier: LGPL-2.1-or-later
"""Model faces: the faces of an operation, and the face and normal at each point of a path.

Takes the model of a job and a selection of faces, as FreeCAD links them; returns named Part faces, in the frame of the
job, or the faults of the selection. A job works on clones of its original objects, which may have other placements: a
face picked on the original means that of the clone.

For points near the faces it returns columns: for each point a normal, its face, and a second face where the choice is
ambiguous. Nothing is guessed: a point beyond the tolerance is on no face, and one within it of two faces with different
normals is on both. mm, in the frame of the shapes.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import FreeCAD as App
import numpy as np
import Part

from pkm_post.freecad_app.face_projection import project
from pkm_post.freecad_app.progress import Progress
from pkm_post.geometry import Array, dot
from pkm_post.model import Diagnostic, Diagnostics, Place

_SAME_NORMAL = np.cos(1e-3)
"""Cosine of the angle up to which two faces count as one smooth surface: 0.06 degrees."""
_BOX_MARGIN = 1e-4
"""Enlargement of a face's bounding box beyond the tolerance, mm."""
_BATCH = 5000
"""Points projected between two progress steps."""


Chosen = Iterable[tuple[Any, Sequence[str]]]


@dataclass(frozen=True)
class NamedFace:
    """A face with its displayed name, object and element, as in ``Box.Face6``."""

    name: str
    face: Any


def model_faces(model: Any, chosen: Chosen, place: Place) -> tuple[tuple[NamedFace, ...] | None, Diagnostics]:
    """The selected faces, or all of the model.

    Args:
        model: the group with the clones, the property ``Model`` of a job; None if it was deleted.
        chosen: pairs of an object and names of its elements; an empty name means all faces of the object.

    Returns:
        The faces, or None; and the faults: N115.
    """
    clones = [] if model is None else list(model.Group)
    picked = [(_clone(clones, thing), name.split(".")[-1]) for thing, names in chosen for name in names or ("",)]
    wanted = picked or [(clone, "") for clone in clones]
    faces, missing = [], []
    for thing, name in wanted:
        elements = [(f"Face{number}", face) for number, face in enumerate(Part.getShape(thing).Faces, start=1)]
        found = [NamedFace(f"{thing.Label}.{element}", face) for element, face in elements if name in ("", element)]
        faces += found
        missing += [] if found else [f"{thing.Label}.{name}" if name else f"{thing.Label} without faces"]
    if missing or not faces:
        return None, (Diagnostic("N115", place, ", ".join(missing) or "a job without a model"),)
    return tuple({face.name: face for face in faces}.values()), ()


def _clone(clones: Sequence[Any], thing: Any) -> Any:
    matching = [clone for clone in clones if hasattr(clone, "PathResource") and thing in clone.Objects]
    return matching[0] if matching else thing


@dataclass(frozen=True)
class FaceContacts:
    """Columns of N points.

    Attributes:
        normal: (N, 3) unit normal of the nearest face, out of the material; NaN where none is within the tolerance.
        face: (N,) index of that face, -1 for none.
        other: (N,) index of another face within the tolerance whose normal differs, -1 for none.
    """

    normal: Array
    face: Array
    other: Array


def find_contacts(faces: Sequence[NamedFace], points: Array, tolerance: float, text: str) -> FaceContacts:
    """Find the faces on which points lie.

    Args:
        faces: the faces.
        points: (N, 3).
        tolerance: largest distance of a point from its face, mm.
        text: label of the progress bar.

    Raises:
        Stopped: the user cancelled.
    """
    contacts = FaceContacts(np.full(points.shape, np.nan), np.full(len(points), -1), np.full(len(points), -1))
    nearest = np.full(len(points), np.inf)
    parts = [(index, rows) for index, named in enumerate(faces) for rows in _nearby_rows(named.face, points, tolerance)]
    with Progress(text, len(parts)) as progress:
        for index, rows in parts:
            distance, normal = _on_face(faces[index].face, points[rows], tolerance)
            on = distance <= tolerance
            rows, distance, normal = rows[on], distance[on], normal[on]
            differs = dot(contacts.normal[rows], normal) < _SAME_NORMAL  # false before the first
            nearer = distance < nearest[rows]
            contacts.other[rows[differs]] = np.where(nearer, contacts.face[rows], index)[differs]
            chosen = rows[nearer]
            nearest[chosen], contacts.normal[chosen], contacts.face[chosen] = distance[nearer], normal[nearer], index
            progress.step()
    return contacts


def nearest_face(faces: Sequence[NamedFace], point: Array) -> tuple[str, float]:
    """Name of the face nearest to a point (3,), edges included, and its distance in mm."""
    vertex = Part.Vertex(App.Vector(*point.tolist()))
    return min(((named.name, named.face.distToShape(vertex)[0]) for named in faces), key=lambda pair: pair[1])


def _nearby_rows(face: Any, points: Array, tolerance: float) -> Iterator[Array]:
    """Yield the rows of the points in the bounding box of a face, in batches.

    ``face.BoundBox`` is that of the display triangles, which miss bulges of the face.
    """
    with_triangles, with_tolerance = False, False
    box = face.optimalBoundingBox(with_triangles, with_tolerance)
    tolerance += _BOX_MARGIN
    low, high = np.array([box.XMin, box.YMin, box.ZMin]), np.array([box.XMax, box.YMax, box.ZMax])
    rows = np.flatnonzero(np.all((points >= low - tolerance) & (points <= high + tolerance), axis=1))
    yield from (rows[first : first + _BATCH] for first in range(0, len(rows), _BATCH))


def _on_face(face: Any, points: Array, tolerance: float) -> tuple[Array, Array]:
    """Distances of points from a face, (n,), and the surface normals at their feet, (n, 3)."""
    _, normals, signed, on_face = project(face, points)
    distance = np.where(np.isfinite(normals).all(axis=1), np.abs(signed), np.inf)
    for row in np.flatnonzero((distance <= tolerance) & ~on_face).tolist():  # beyond an edge, but maybe close enough
        distance[row] = face.distToShape(Part.Vertex(App.Vector(*points[row].tolist())))[0]
    return distance, normals
