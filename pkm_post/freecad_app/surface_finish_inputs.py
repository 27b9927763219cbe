# SPDX-License-Identifier: LGPL-2.1-or-later
"""Surface Finish inputs: reads the inputs of the operation from the document and reports all their faults together.

Takes the operation and its job; returns faces in the frame of the job, the cutter and the settings, in mm and rad.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from pkm_post.freecad_app.contact_faces import NamedFace
from pkm_post.freecad_app.machine_tilt import machine_tilt, upright
from pkm_post.freecad_app.model_faces import model_faces
from pkm_post.freecad_app.surface_finish_settings import read_settings
from pkm_post.freecad_app.tool_cutter import read_cutter
from pkm_post.model import Diagnostic, Place, errors
from pkm_post.toolpath import Cutter, Settings

Inputs = tuple[tuple[NamedFace, ...], Cutter, Settings]
"""Faces, cutter and settings."""


def read_inputs(obj: Any, job: Any, place: Place) -> tuple[Inputs | None, tuple[Diagnostic, ...]]:
    """Read faces, cutter and settings of an operation.

    Args:
        obj: the operation, with a tool controller.
        job: its job.
        place: location stated in diagnostics.

    Returns:
        The inputs, or None; and all their faults.
    """
    chosen = [(thing, names) for thing, names in obj.Base or ()]
    faces, face_faults = model_faces(job.Model, chosen, place) if chosen else (None, ())
    cutter, tool_faults = read_cutter(obj.ToolController, place)
    found: list[Diagnostic] = [] if chosen else [Diagnostic("N308", place, "Base is empty")]
    found += [*face_faults, *tool_faults]
    cone, cone_faults = _cone(obj, job, faces or (), place)
    settings, faults = read_settings(obj, cone, place)
    found += [*cone_faults, *faults]
    if faces is None or cutter is None or settings is None or errors(found):
        return None, tuple(found)
    return (faces, cutter, settings), tuple(found)


def _cone(obj: Any, job: Any, faces: Sequence[NamedFace], place: Place) -> tuple[float, tuple[Diagnostic, ...]]:
    """Half angle of the cone of the tool axis in rad: the user's, or the machine's where that is narrower."""
    limit = math.radians(obj.ConeLimit.Value)
    if not obj.Machine or not faces:
        return limit, ()
    if not upright(obj.ConeAxis):
        return limit, (Diagnostic("N309", place, "a machine limits the tilt from upright: ConeAxis is not (0, 0, 1)"),)
    boxes = [named.face.BoundBox for named in faces]
    low = np.array([min(getattr(box, side) for box in boxes) for side in ("XMin", "YMin", "ZMin")])
    high = np.array([max(getattr(box, side) for box in boxes) for side in ("XMax", "YMax", "ZMax")])
    high[2] = max(high[2], obj.ClearanceHeight.Value)
    tilt, faults = machine_tilt(obj.Machine, job, obj.ToolController, (low, high), place)
    return (limit if tilt is None else min(limit, tilt)), faults
