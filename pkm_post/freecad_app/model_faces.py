# SPDX-License-Identifier: LGPL-2.1-or-later
"""Model faces: the faces that an operation of a CAM job may touch.

The model of the job and a choice of faces, as FreeCAD links them, enter; named Part faces leave, in the frame of the
job, or what is wrong with the choice. A job works on clones of the objects it was made for, which may stand elsewhere:
who has picked a face of the original means that of the clone.
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
    """The faces chosen, or all of the model.

    Args:
        model: the group with the clones, the property ``Model`` of a job; None if it is gone.
        chosen: pairs of an object and names of its elements; an empty name is for all faces of the object.
        place: what diagnostics name.

    Returns:
        The faces, or None; and what is wrong: N115.
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
    """The clone that the job has made of an object; the object itself if there is none."""
    made = [clone for clone in clones if hasattr(clone, "PathResource") and thing in clone.Objects]
    return made[0] if made else thing
