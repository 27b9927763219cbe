# SPDX-License-Identifier: LGPL-2.1-or-later
"""Symmetry properties: the editable and read-only properties of mirrored and rotated operations.

Their names, types and units are a file format: they can be extended, not changed.
"""

from __future__ import annotations

import FreeCAD as App

from pkm_post.freecad_app.derived_operation import BASE_AND_ACTIVE
from pkm_post.freecad_app.material_side import SIDES
from pkm_post.freecad_app.object_properties import Row

QT_TRANSLATE_NOOP = App.Qt.QT_TRANSLATE_NOOP

_LINK = "App::PropertyLinkSubGlobal"
_S = "Symmetry"
_SIDE: Row = (
    "App::PropertyEnumeration",
    "MaterialSide",
    _S,
    QT_TRANSLATE_NOOP(
        "App::Property", "Where the material is, seen along the way of the original, should the original not tell"
    ),
    list(SIDES),
)
MIRROR: tuple[Row, ...] = (
    *BASE_AND_ACTIVE,
    ("App::PropertyVectorDistance", "Point", _S,
     QT_TRANSLATE_NOOP("App::Property", "A point of the plane of the mirror"), App.Vector()),
    ("App::PropertyVector", "Normal", _S,
     QT_TRANSLATE_NOOP("App::Property", "Normal of the plane of the mirror"), App.Vector(1, 0, 0)),
    (_LINK, "Plane", _S,
     QT_TRANSLATE_NOOP("App::Property", "A flat face or datum plane that gives point and normal"), None),
    ("App::PropertyBool", "KeepClimb", _S,
     QT_TRANSLATE_NOOP("App::Property", "Run each pass the other way, so that climb milling stays so"), False),
    _SIDE,
)  # fmt: skip
ROTATION: tuple[Row, ...] = (
    *BASE_AND_ACTIVE,
    ("App::PropertyVectorDistance", "Point", _S,
     QT_TRANSLATE_NOOP("App::Property", "A point of the axis"), App.Vector()),
    ("App::PropertyVector", "Axis", _S,
     QT_TRANSLATE_NOOP("App::Property", "Direction of the axis"), App.Vector(0, 0, 1)),
    (_LINK, "Line", _S,
     QT_TRANSLATE_NOOP("App::Property", "An edge, round face or datum line that gives point and direction"), None),
    ("App::PropertyAngle", "Angle", _S,
     QT_TRANSLATE_NOOP("App::Property", "Angle of the turn, right-handed about the axis"), 180.0),
    ("App::PropertyInteger", "Copies", _S,
     QT_TRANSLATE_NOOP("App::Property", "Number of copies, each turned by Angle against the one before"), 1),
    ("App::PropertyFloatList", "Angles", _S,
     QT_TRANSLATE_NOOP("App::Property", "Angles of the copies in degrees, instead of the two"), []),
    _SIDE,
)  # fmt: skip

_G = "Report"
_COMMON: tuple[Row, ...] = (
    ("App::PropertyString", "CutOfBase", _G,
     QT_TRANSLATE_NOOP("App::Property", "How the original cuts: Climb, Conventional, Both or Unknown"), "Unknown"),
    ("App::PropertyString", "CutOfCopies", _G, QT_TRANSLATE_NOOP("App::Property", "How the copies cut"), "Unknown"),
    ("App::PropertyInteger", "Joints", _G,
     QT_TRANSLATE_NOOP("App::Property", "Number of places where the original and its copies meet"), 0),
    ("App::PropertyLength", "JointDistance", _G,
     QT_TRANSLATE_NOOP("App::Property", "Largest distance of the tips where they meet"), 0.0),
    ("App::PropertyAngle", "JointTurn", _G,
     QT_TRANSLATE_NOOP("App::Property", "Largest angle of the tool axes where they meet"), 0.0),
)  # fmt: skip
MIRROR_RESULTS: tuple[Row, ...] = (
    *_COMMON,
    ("App::PropertyInteger", "ReversedPasses", _G,
     QT_TRANSLATE_NOOP("App::Property", "Number of passes that are run the other way"), 0),
    ("App::PropertyInteger", "SwappedArcs", _G,
     QT_TRANSLATE_NOOP("App::Property", "Number of arcs that turn the other way, G2 for G3 or G3 for G2"), 0),
    ("App::PropertyLength", "GapToBase", _G,
     QT_TRANSLATE_NOOP("App::Property", "Distance between the cuts of the original and of the copy"), 0.0),
    ("App::PropertyLength", "OverlapWithBase", _G,
     QT_TRANSLATE_NOOP("App::Property", "Width in which the original and the copy both cut"), 0.0),
)  # fmt: skip
ROTATION_RESULTS: tuple[Row, ...] = (
    *_COMMON,
    ("App::PropertyAngle", "Covered", _G,
     QT_TRANSLATE_NOOP("App::Property", "Angle in which the original and its copies cut"), 0.0),
    ("App::PropertyAngle", "Overlap", _G,
     QT_TRANSLATE_NOOP("App::Property", "Angle in which two of them or more cut"), 0.0),
    ("App::PropertyAngle", "Gap", _G,
     QT_TRANSLATE_NOOP("App::Property", "Widest angle in which none of them cuts"), 0.0),
    ("App::PropertyBool", "Tiles", _G,
     QT_TRANSLATE_NOOP("App::Property", "Whether they lie all round, none of them on another"), False),
)  # fmt: skip
