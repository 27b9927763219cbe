# SPDX-License-Identifier: LGPL-2.1-or-later
"""Face trim: which points of a surface lie within the edges of a face.

Takes feet on the surface of a Part face, with their parameters; returns whether they are on the face.
"""

from __future__ import annotations

from typing import Any

import FreeCAD as App
import numpy as np
import Part

from pkm_post.freecad_app.face_feet import Feet
from pkm_post.geometry import Array, within

_CHORDS = 32
"""Number of chords that approximate an edge in the parameter plane."""

_SHARE = 1e-3
"""Share of its greatest length that a derivative counts as having at least."""

_SHORT = 1e-9
"""Smallest length of a derivative by which parameters are divided, mm."""

_EDGE = 1e-3
"""A foot this close to the edge of a face, in mm, counts as on the face."""


def on_face(feet: Feet) -> Array:
    """Whether the feet are on the face, or within a micron of its edge: (N,) bool.

    The edges of the face are polylines in the parameter plane. OpenCASCADE decides where a foot is near one of them:
    about 12 us each, and more for faces with many edges.

    Args:
        feet: result of the function that ``finder`` returns.
    """
    at = feet.parameters.copy()
    for row in np.flatnonzero(np.isnan(at).any(axis=1)).tolist():
        at[row] = feet.written.Surface.parameter(App.Vector(*feet.points[row]))
    inside = np.zeros(len(at), dtype=np.bool_)
    for face, rows in ((feet.written, ~feet.asked), (feet.face, feet.asked)):
        if rows.any():
            inside[rows] = _in_domain(face, at[rows])
    return inside


def _in_domain(face: Any, at: Array) -> Array:
    """Whether parameters (N, 2) are on the face, or almost."""
    first_u, _, first_v, _ = face.ParameterRange
    surface = face.Surface
    u, v = at.T
    u = first_u + np.mod(u - first_u, surface.UPeriod()) if surface.isUPeriodic() else u
    v = first_v + np.mod(v - first_v, surface.VPeriod()) if surface.isVPeriodic() else v
    inside, doubt = within(np.column_stack([u, v]), *_edges(face))
    for row in np.flatnonzero(doubt).tolist():
        inside[row] = face.isPartOfDomain(*at[row].tolist()) or _beside_edge(face, *at[row].tolist())
    return inside


def _edges(face: Any) -> tuple[Array, Array]:
    """The edges of a face as segments in the parameter plane (S, 4), and the uncertain distance around them (S,)."""
    segments, sags = [], []
    for edge in (edge for wire in face.Wires for edge in wire.OrderedEdges):
        curve, first, last = face.curveOnSurface(edge)
        count = 1 if isinstance(curve, Part.Geom2d.Line2d) else _CHORDS
        values = [curve.value(share) for share in np.linspace(first, last, 2 * count + 1).tolist()]
        points = np.array([(value.x, value.y) for value in values])
        ends, middles = points[::2], points[1::2]
        sags.append(np.linalg.norm(middles - (ends[:-1] + ends[1:]) / 2, axis=1))
        segments.append(np.hstack([ends[:-1], ends[1:]]))
    lines = np.vstack(segments)
    return lines, 2 * np.concatenate(sags) + _micron(face, lines[:, :2])


def _micron(face: Any, at: Array) -> Array:
    """Upper bound of two microns in parameters, at each of some places on the face."""
    lengths = np.array([[way.Length for way in face.derivative1At(u, v)] for u, v in at.tolist()])
    # At a pole one derivative is 0: the other one, and the places beside it, are used instead.
    least: Array = np.maximum(lengths, _SHARE * lengths.max(axis=0)).min(axis=1)
    return 2 * _EDGE / least


def _beside_edge(face: Any, u: float, v: float) -> bool:
    along_u, along_v = (max(derivative.Length, _SHORT) for derivative in face.derivative1At(u, v))
    steps = ((_EDGE / along_u, 0.0), (-_EDGE / along_u, 0.0), (0.0, _EDGE / along_v), (0.0, -_EDGE / along_v))
    return any(face.isPartOfDomain(u + du, v + dv) for du, dv in steps)
