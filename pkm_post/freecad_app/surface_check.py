# SPDX-License-Identifier: LGPL-2.1-or-later
"""Surface check: excess material that a path leaves on the faces of a model, and gouges.

Takes a program, a cutter and faces; returns the deepest gouge and the largest excess, with their places, in mm. Faces
are sampled at points: between the points the values may be worse. Gouges are searched on all faces of the model, for
all moves including rapids, and with the flank of the cutter: their depth is the largest distance of a point inside the
cutter. Excess is measured along the normal, only on the faces to be covered.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from pkm_post.freecad_app.face_surface import face_surface
from pkm_post.geometry import Array, norm
from pkm_post.model import Program
from pkm_post.toolpath import Cutter, SweptVolume, stock_left

_FEWEST = 3
_SPREAD = (0.7548776662466927, 0.5698402909980532)
"""Shares of a cell from one point to the next, whose multiples fill a square evenly [Roberts2018]."""
_NEAR = 0.1
"""mm: points farther than this from the cutter are not gouged; their exact distance is irrelevant."""


@dataclass(frozen=True)
class Checked:
    """The worst effects of a path on a model.

    Attributes:
        gouge: depth of the deepest gouge, 0 for none.
        gouge_point: (3,) its place.
        excess: largest excess on the faces to be covered; ``reach`` where the cutter does not arrive at all.
        excess_point: (3,) its place.
    """

    gouge: float
    gouge_point: Array
    excess: float
    excess_point: Array


def check_faces(
    program: Program,
    cutter: Cutter,
    covered: Sequence[Any],
    others: Sequence[Any],
    flipped: bool,
    spacing: float,
    tolerance: float,
    reach: float,
    progress: Callable[[float], None],
) -> Checked:
    """Measure a path against faces.

    Args:
        program: all moves of the operation.
        cutter: the cutter.
        covered: the faces to be covered.
        others: the other faces of the model.
        flipped: whether the material of the covered faces is on the other side.
        spacing: largest distance of the points along u and v, mm.
        tolerance: of the measurement, mm.
        reach: larger excess than this is not measured, mm.
        progress: callback with the completed share; it may raise to stop the work.
    """
    samples = [_samples(face, flipped, spacing) for face in covered] + [
        _samples(face, False, spacing) for face in others
    ]
    point, normal = (np.vstack([sample[column] for sample in samples]) for column in (0, 1))
    ours = sum(len(sample[0]) for sample in samples[: len(covered)])
    depth = -_distances(program, cutter, point, tolerance, progress)
    left = stock_left(
        program.position, program.tool_axis, cutter, point[:ours], normal[:ours], tolerance=tolerance, reach=reach
    ).left
    deepest, highest = int(np.argmax(depth)), int(np.argmax(left))
    return Checked(max(0.0, float(depth[deepest])), point[deepest], min(reach, float(left[highest])), point[highest])


def _distances(
    program: Program, cutter: Cutter, points: Array, tolerance: float, progress: Callable[[float], None]
) -> Array:
    """Signed distances of points from the swept volume of the cutter, (N,), negative inside, infinite where far."""
    extent = float(norm(np.ptp(np.vstack([program.position, points]), axis=0)))
    sweep = SweptVolume.of(program.position, program.tool_axis, cutter, _NEAR, extent)
    return sweep.distances(points, tolerance, progress)[0]


def _samples(face: Any, flipped: bool, spacing: float) -> tuple[Array, Array]:
    """Points of a face and normals there: a grid, and in each of its cells a point not aligned with any other.

    A grid alone may coincide with the passes of the cutter, where there is no excess.
    """
    surface = face_surface(face, flipped)
    u, v = np.linspace(surface.u.first, surface.u.last, 33), np.linspace(surface.v.first, surface.v.last, 33)
    coarse = surface.at(*(each.ravel() for each in np.meshgrid(u, v, indexing="ij"))).point.reshape(33, 33, 3)
    counts = [
        max(math.ceil(float(np.max(norm(np.diff(coarse, axis=axis)))) * 32 / spacing) + 1, _FEWEST) for axis in (0, 1)
    ]
    spans = tuple(zip((surface.u, surface.v), counts, strict=True))
    grid = np.meshgrid(*(np.linspace(span.first, span.last, count) for span, count in spans), indexing="ij")
    within = [each[:-1, :-1].ravel() for each in grid]
    number = np.arange(1, len(within[0]) + 1)
    inner = [
        low + span.width / (count - 1) * np.mod(number * share, 1.0)
        for low, (span, count), share in zip(within, spans, _SPREAD, strict=True)
    ]
    u, v = (np.append(each.ravel(), more) for each, more in zip(grid, inner, strict=True))
    held = surface.contains(u, v)
    patch = surface.at(u[held], v[held])
    return patch.point, patch.normal
