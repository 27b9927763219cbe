# SPDX-License-Identifier: LGPL-2.1-or-later
"""Symmetry frames: the planes and axes that the symmetry panel offers, as tables."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import FreeCAD

from pkm_post.freecad_app.frames import axis_of, plane_of

QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP


@dataclass(frozen=True)
class Frame:
    """The reference of a mirror or a rotation.

    Attributes:
        direction: property with the normal or the axis.
        link: property with the picked element.
        read: returns point and direction of the picked element.
        label: of the choice.
        choices: texts and directions.
        hint: pickable elements.
    """

    direction: str
    link: str
    read: Callable[[Any], Any]
    label: str
    choices: tuple[tuple[str, tuple[float, float, float]], ...]
    hint: str


PLANE = Frame(
    "Normal",
    "Plane",
    plane_of,
    QT_TRANSLATE_NOOP("SymmetryPanel", "Plane"),
    (
        (QT_TRANSLATE_NOOP("SymmetryPanel", "XY"), (0.0, 0.0, 1.0)),
        (QT_TRANSLATE_NOOP("SymmetryPanel", "XZ"), (0.0, 1.0, 0.0)),
        (QT_TRANSLATE_NOOP("SymmetryPanel", "YZ"), (1.0, 0.0, 0.0)),
    ),
    QT_TRANSLATE_NOOP("SymmetryPanel", "Pick a flat face or a datum plane"),
)
AXIS = Frame(
    "Axis",
    "Line",
    axis_of,
    QT_TRANSLATE_NOOP("SymmetryPanel", "Axis"),
    (
        (QT_TRANSLATE_NOOP("SymmetryPanel", "X"), (1.0, 0.0, 0.0)),
        (QT_TRANSLATE_NOOP("SymmetryPanel", "Y"), (0.0, 1.0, 0.0)),
        (QT_TRANSLATE_NOOP("SymmetryPanel", "Z"), (0.0, 0.0, 1.0)),
    ),
    QT_TRANSLATE_NOOP("SymmetryPanel", "Pick an edge, a round face or a datum line"),
)
