# SPDX-License-Identifier: LGPL-2.1-or-later
"""Model faces: the faces that an operation of a CAM job may touch.

Takes the model of the job and a selection of faces, as FreeCAD links them; returns named Part faces, in the frame of
the job, or the faults of the selection. A job works on clones of its original objects, which may have other placements:
a face picked on the original stands for that of the clone.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import Part

from pkm_post.freecad_app.contact_faces import NamedFace
from pkm_post.model import Diagnostic, Place

Chosen = Iterable[tuple[Any, Sequence[str]]]


def model_faces(
    model: Any, chosen: Chosen, place: Place
) -> tuple[tuple[NamedFace, ...] | None, tuple[Diagnostic, ...]]:
    """The selected faces, or all of the model.

    Args:
        model: the group with the clones, the property ``Model`` of a job; None if it was deleted.
        chosen: pairs of an object and names of its elements; an empty name means all faces of the object.
        place: location stated in diagnostics.

    Returns:
        The faces, or None; and the faults: N115.
    """
    clones = [] if model is None else list(model.Group)
    picked = [(_clone(clones, thing), name.split(".")[-1]) for thing, names in chosen for name in names or ("",)]
    wanted = picked or [(clone, "") for clone in clones]
    faces, gone = [], []
    for thing, name in wanted:
        elements = [(f"Face{number}", face) for number, face in enumerate(Part.getShape(thing).Faces, start=1)]
        found = [NamedFace(f"{thing.Label}.{element}", face) for element, face in elements if name in ("", element)]
        faces += found
        gone += [] if found else [f"{thing.Label}.{name}" if name else f"{thing.Label} without faces"]
    if gone or not faces:
        return None, (Diagnostic("N115", place, ", ".join(gone) or "a job without a model"),)
    return tuple({face.name: face for face in faces}.values()), ()


def _clone(clones: Sequence[Any], thing: Any) -> Any:
    """The job's clone of an object; the object itself if there is none."""
    made = [clone for clone in clones if hasattr(clone, "PathResource") and thing in clone.Objects]
    return made[0] if made else thing
