# SPDX-License-Identifier: LGPL-2.1-or-later
"""Surface Finish choice: lead and cone limit of a new operation, so that its tool fits its faces right away.

Takes the operation with its faces and its tool controller; sets ``Lead`` and ``ConeLimit``, which the user can change.
On concave faces, the bottom of a flat or bull-nose mill would cut behind its contact point: a disc of radius e with a
lead stays clear of a concave curvature k if sin(lead) >= k e, since its heel then rises as fast as the surface. On
steep faces, the axis stays in a cone around upright that the machine of the job reaches all over the part, or a usual
one if that is unknown.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from pkm_post.freecad_app.document import document_name
from pkm_post.freecad_app.face_surface import face_surface
from pkm_post.freecad_app.job_settings import settings_of
from pkm_post.freecad_app.model_faces import model_faces
from pkm_post.freecad_app.surface_finish_settings import box_of, reachable_tilt
from pkm_post.freecad_app.tools import read_cutter
from pkm_post.geometry import Array, norm
from pkm_post.model import Place, Refused

_SAMPLES = 13
"""Points of a face along u and along v."""
_SPARE = 3.0
"""degrees of lead beyond the need of concave faces."""
_STEEPEST_LEAD = 45.0
_USUAL_CONE = 30.0
"""degrees: half angle of the cone without a known machine."""
_FLAT = 1e-6
"""1/mm and rad: curvature and turn of normals of a plane."""


def choose_lead_and_cone(obj: Any, job: Any) -> None:
    """Set the lead and the cone limit of an operation with faces and a tool; otherwise leave them unchanged."""
    place = Place(document_name(obj.Document), obj.Label)
    if not obj.Base or obj.ToolController is None:
        return
    faces, _ = model_faces(job.Model, [(thing, names) for thing, names in obj.Base], place)
    cutter, _ = read_cutter(obj.ToolController, place)
    if faces is None or cutter is None:
        return  # the operation itself reports it
    samples = [_samples(named.face, bool(obj.FlipNormals)) for named in faces]
    steepest = max(float(np.degrees(np.arccos(np.clip(normal[:, 2], -1.0, 1.0)).max())) for _, normal in samples)
    lead = max(_lead(*sample, max(cutter.radial_offset, 0.0)) for sample in samples)
    obj.Lead = lead
    if steepest + lead > _USUAL_CONE:
        obj.ConeLimit = _cone(obj, job, box_of(faces, obj.ClearanceHeight.Value), place)


def _samples(face: Any, flipped: bool) -> tuple[Array, Array]:
    """Points and outward normals of a face."""
    surface = face_surface(face, flipped)
    spans = (np.linspace(span.first, span.last, _SAMPLES) for span in (surface.u, surface.v))
    u, v = (each.ravel() for each in np.meshgrid(*spans, indexing="ij"))
    held = surface.contains(u, v)
    samples = surface.at(u[held], v[held]) if held.any() else surface.at(u, v)
    regular = np.isfinite(samples.normal).all(axis=1)
    return samples.point[regular], samples.normal[regular]


def _lead(point: Array, normal: Array, flat: float) -> float:
    """Lead in whole degrees over one face; 0 for a ball or over a plane.

    Args:
        point: (N, 3) samples, mm.
        normal: (N, 3) outward unit normals there.
        flat: radius of the flat bottom of the cutter, mm.
    """
    way = point[None] - point[:, None]
    distance = norm(way)
    near = (distance > 0.0) & (distance <= max(2.0 * flat, float(distance.max()) / _SAMPLES))
    above = np.einsum("nmi,ni->nm", way, normal)
    hollow = float(np.max(2.0 * above[near] / distance[near] ** 2, initial=0.0))
    turns = float(np.max(norm(normal - normal[0]), initial=0.0))
    if flat == 0.0 or (hollow <= _FLAT and turns <= _FLAT):
        return 0.0
    needed = math.degrees(math.asin(min(hollow * flat, 1.0)))
    return float(min(math.ceil(needed + _SPARE), _STEEPEST_LEAD))


def _cone(obj: Any, job: Any, box: tuple[Array, Array], place: Place) -> float:
    """Half angle in whole degrees that the machine of the job reaches at the part; the usual one if it is unknown."""
    try:
        tilt, _ = reachable_tilt(settings_of(job).machine, job, obj.ToolController, box, place)
    except Refused:
        tilt = None
    found = 0.0 if tilt is None else math.floor(math.degrees(tilt))
    return float(found or _USUAL_CONE)
