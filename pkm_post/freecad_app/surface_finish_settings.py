# SPDX-License-Identifier: LGPL-2.1-or-later
"""Surface Finish settings: the properties of the operation, and their conversion to settings.

Takes a document object; returns ``surface_path.Settings`` in mm, mm/s and rad, or the faults of the values. Documents
store the names of the properties and of the choices: they are a file format.
"""

from __future__ import annotations

import enum
import math
from typing import Any

import FreeCAD as App

from pkm_post.freecad_app.object_properties import READ_ONLY, Row, add_missing
from pkm_post.model import Diagnostic, Place
from pkm_post.toolpath import AxisRule, CutMode, LeadMove, Lines, Order, Settings, Stepover, Tolerances

QT_TRANSLATE_NOOP = App.Qt.QT_TRANSLATE_NOOP

DISTANCE, SCALLOP = "Distance", "Scallop height"


def _choices(kind: type[enum.Enum]) -> list[str]:
    return [str(choice.value) for choice in kind]


_P, _S, _A, _L = "Pattern", "Stepover and Tolerances", "Tool Axis", "Approach and Leads"
_C, _R = "Check", "Result"
PROPERTIES: tuple[Row, ...] = (
    ("App::PropertyEnumeration", "Lines", _P,
     QT_TRANSLATE_NOOP("App::Property", "What the passes run along"), _choices(Lines)),
    ("App::PropertyEnumeration", "Order", _P,
     QT_TRANSLATE_NOOP("App::Property", "How passes follow each other"), _choices(Order)),
    ("App::PropertyVector", "PlaneNormal", _P,
     QT_TRANSLATE_NOOP("App::Property", "Normal of the parallel planes"), App.Vector(1, 0, 0)),
    ("App::PropertyBool", "Reversed", _P,
     QT_TRANSLATE_NOOP("App::Property", "Begin at the other side of the face"), False),
    ("App::PropertyEnumeration", "CutMode", _P,
     QT_TRANSLATE_NOOP("App::Property", "Where the material is; in a zigzag on its first pass"), _choices(CutMode)),
    ("App::PropertyBool", "FlipNormals", _P,
     QT_TRANSLATE_NOOP("App::Property", "The material is on the other side of the faces"), False),
    ("App::PropertyEnumeration", "StepoverMode", _S,
     QT_TRANSLATE_NOOP("App::Property", "What says how far passes are apart"), [DISTANCE, SCALLOP]),
    ("App::PropertyLength", "Stepover", _S,
     QT_TRANSLATE_NOOP("App::Property", "Largest distance of passes along the surface"), 1.0),
    ("App::PropertyLength", "ScallopHeight", _S,
     QT_TRANSLATE_NOOP("App::Property", "Largest height of what is left between passes"), 0.01),
    ("App::PropertyLength", "ChordTolerance", _S,
     QT_TRANSLATE_NOOP("App::Property", "How far straight moves may take the cutter off the surface"), 0.01),
    ("App::PropertyAngle", "AxisTolerance", _S,
     QT_TRANSLATE_NOOP("App::Property", "How far the tool axis may be off between two points"), 0.1),
    ("App::PropertyAngle", "Lead", _A,
     QT_TRANSLATE_NOOP("App::Property", "Lean from the normal forward, in the direction of feed"), 0.0),
    ("App::PropertyAngle", "Tilt", _A,
     QT_TRANSLATE_NOOP("App::Property", "Lean from the normal to the left of the direction of feed"), 0.0),
    ("App::PropertyVector", "ConeAxis", _A,
     QT_TRANSLATE_NOOP("App::Property", "Middle of the cone in which the tool axis stays"), App.Vector(0, 0, 1)),
    ("App::PropertyAngle", "ConeLimit", _A,
     QT_TRANSLATE_NOOP("App::Property", "Half angle of that cone; 180 degrees for no limit"), 180.0),
    ("App::PropertyString", "Machine", _A,
     QT_TRANSLATE_NOOP("App::Property", "Name or file of a machine whose reach limits the tilt from upright"), ""),
    ("App::PropertyLength", "ApproachDistance", _L,
     QT_TRANSLATE_NOOP("App::Property", "Where rapid motion ends, along the tool axis"), 2.0),
    ("App::PropertyEnumeration", "LeadMove", _L,
     QT_TRANSLATE_NOOP("App::Property", "How the cutter comes to the surface and leaves it"), _choices(LeadMove)),
    ("App::PropertyLength", "LeadLength", _L,
     QT_TRANSLATE_NOOP("App::Property", "Length of a straight lead, radius of an arc"), 2.0),
    ("App::PropertyLength", "CheckSpacing", _C,
     QT_TRANSLATE_NOOP("App::Property", "Distance of the points of the model at which gouges and material left "
                       "are measured; 0 to measure nothing"), 0.0),
)  # fmt: skip

RESULTS: tuple[Row, ...] = (
    ("App::PropertyInteger", "PassCount", _R, QT_TRANSLATE_NOOP("App::Property", "Number of passes"), 0),
    ("App::PropertyInteger", "ClampedAxes", _R,
     QT_TRANSLATE_NOOP("App::Property", "Points at which the tool axis was moved into its cone"), 0),
    ("App::PropertyFloat", "MaximumGouge", _R,
     QT_TRANSLATE_NOOP("App::Property", "Deepest cut into the model found at points CheckSpacing apart, mm; deeper "
                       "between them may be missed; -1 if not measured"), -1.0),
    ("App::PropertyVector", "GougePoint", _R, QT_TRANSLATE_NOOP("App::Property", "Where that is"), App.Vector()),
    ("App::PropertyFloat", "MaximumExcess", _R,
     QT_TRANSLATE_NOOP("App::Property", "Most material left found at points CheckSpacing apart, mm; more between them "
                       "may be missed; -1 if not measured"), -1.0),
    ("App::PropertyVector", "ExcessPoint", _R, QT_TRANSLATE_NOOP("App::Property", "Where that is"), App.Vector()),
    ("App::PropertyAngle", "UsedConeLimit", _R,
     QT_TRANSLATE_NOOP("App::Property", "Half angle of the cone, with what the machine allows"), 180.0),
)  # fmt: skip


def add_missing_properties(obj: Any) -> None:
    """Add the properties that the object lacks, for instance in a document of an older version."""
    add_missing(obj, PROPERTIES)
    add_missing(obj, RESULTS, READ_ONLY)


def read_settings(obj: Any, cone: float, place: Place) -> tuple[Settings | None, tuple[Diagnostic, ...]]:
    """Read the settings from the properties of the operation and of its tool controller.

    Args:
        obj: the operation.
        cone: half angle of the cone of the tool axis, rad.
        place: location stated in diagnostics.

    Returns:
        The settings, or None; and the faults: J105, N309.
    """
    controller = obj.ToolController
    feed, plunge = controller.HorizFeed.Value, controller.VertFeed.Value
    if not (feed > 0.0 and plunge > 0.0):
        return None, (Diagnostic("J105", place, f"{controller.Label}: {60 * feed:g} and {60 * plunge:g} mm/min"),)
    try:
        return _settings(obj, cone, feed, plunge), ()
    except ValueError as wrong:
        return None, (Diagnostic("N309", place, str(wrong)),)


def _settings(obj: Any, cone: float, feed: float, plunge: float) -> Settings:
    by_distance = str(obj.StepoverMode) == DISTANCE
    lead, tilt = math.radians(obj.Lead.Value), math.radians(obj.Tilt.Value)
    return Settings(
        safe_height=obj.SafeHeight.Value,
        clearance_height=obj.ClearanceHeight.Value,
        feed=feed,
        plunge_feed=plunge,
        lines=Lines(obj.Lines),
        order=Order(obj.Order),
        plane=tuple(obj.PlaneNormal),
        reversed=bool(obj.Reversed),
        stepover=Stepover(obj.Stepover.Value, None) if by_distance else Stepover(None, obj.ScallopHeight.Value),
        tolerances=Tolerances(obj.ChordTolerance.Value, math.radians(obj.AxisTolerance.Value)),
        rule=AxisRule(lead, tilt, tuple(obj.ConeAxis), cone),
        cut_mode=CutMode(obj.CutMode),
        clockwise=obj.ToolController.SpindleDir != "Reverse",
        lead_move=LeadMove(obj.LeadMove),
        lead_length=obj.LeadLength.Value,
        approach=obj.ApproachDistance.Value,
    )
