# SPDX-License-Identifier: LGPL-2.1-or-later
"""Surface Finish settings: the properties of the operation, and the inputs from them and the document.

Takes the operation and its job; returns faces in the frame of the job, the cutter and the settings of the passes, in
mm, mm/s and rad, or all their faults together. Documents store the names of the properties and of the choices: they are
a file format.

A machine limits the tilt of the tool from upright to the tilt it reaches everywhere around the faces. All directions
are tried at the corners and the centre of their box, against struts, joints and singular poses. The later check of the
whole path is the binding one.
"""

from __future__ import annotations

import enum
import math
from collections.abc import Sequence
from typing import Any

import FreeCAD as App
import numpy as np

from pkm_post.freecad_app.document_object import READ_ONLY, Row, add_missing
from pkm_post.freecad_app.job_settings import settings_of
from pkm_post.freecad_app.model_faces import NamedFace, model_faces
from pkm_post.freecad_app.tools import read_cutter, read_tools
from pkm_post.geometry import Array
from pkm_post.machine import machine_named, reach_margins
from pkm_post.model import Diagnostic, Diagnostics, Machine, Phrase, Place, errors
from pkm_post.posting import work_offset
from pkm_post.toolpath import (
    AxisRule,
    CutMode,
    Cutter,
    LeadMove,
    PassLines,
    PassOrder,
    Stepover,
    SurfaceOptions,
    SurfaceTolerances,
)

QT_TRANSLATE_NOOP = App.Qt.QT_TRANSLATE_NOOP

DISTANCE, SCALLOP = "Distance", "Scallop height"
_TILTS = np.radians(np.arange(0.0, 80.5, 0.5))
_DIRECTIONS = np.radians(np.arange(0.0, 360.0, 15.0))

Inputs = tuple[tuple[NamedFace, ...], Cutter, SurfaceOptions]
"""Faces, cutter and settings."""


def _choices(kind: type[enum.Enum]) -> list[str]:
    return [str(choice.value) for choice in kind]


_P, _S, _A, _L = "Pattern", "Stepover and Tolerances", "Tool Axis", "Approach and Leads"
_C, _R = "Check", "Result"
PROPERTIES: tuple[Row, ...] = (
    ("App::PropertyEnumeration", "Lines", _P,
     QT_TRANSLATE_NOOP("App::Property", "Lines that the passes follow"), _choices(PassLines)),
    ("App::PropertyEnumeration", "Order", _P,
     QT_TRANSLATE_NOOP("App::Property", "Order of the passes"), _choices(PassOrder)),
    ("App::PropertyVector", "PlaneNormal", _P,
     QT_TRANSLATE_NOOP("App::Property", "Normal of the parallel planes"), App.Vector(1, 0, 0)),
    ("App::PropertyBool", "Reversed", _P,
     QT_TRANSLATE_NOOP("App::Property", "Begin at the other side of the face"), False),
    ("App::PropertyEnumeration", "CutMode", _P,
     QT_TRANSLATE_NOOP("App::Property", "Where the material is; in a zigzag on its first pass"), _choices(CutMode)),
    ("App::PropertyBool", "FlipNormals", _P,
     QT_TRANSLATE_NOOP("App::Property", "The material is on the other side of the faces"), False),
    ("App::PropertyEnumeration", "StepoverMode", _S,
     QT_TRANSLATE_NOOP("App::Property", "Whether distance or scallop height sets the stepover"), [DISTANCE, SCALLOP]),
    ("App::PropertyLength", "Stepover", _S,
     QT_TRANSLATE_NOOP("App::Property", "Largest distance of passes along the surface"), 1.0),
    ("App::PropertyLength", "ScallopHeight", _S,
     QT_TRANSLATE_NOOP("App::Property", "Largest scallop height between passes"), 0.01),
    ("App::PropertyLength", "ChordTolerance", _S,
     QT_TRANSLATE_NOOP("App::Property", "Largest deviation of the cutter from the surface on straight moves"), 0.01),
    ("App::PropertyAngle", "AxisTolerance", _S,
     QT_TRANSLATE_NOOP("App::Property", "Largest deviation of the tool axis between two points"), 0.1),
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
     QT_TRANSLATE_NOOP("App::Property", "Form of lead-in and lead-out"), _choices(LeadMove)),
    ("App::PropertyLength", "LeadLength", _L,
     QT_TRANSLATE_NOOP("App::Property", "Length of a straight lead, radius of an arc"), 2.0),
    ("App::PropertyLength", "CheckSpacing", _C,
     QT_TRANSLATE_NOOP("App::Property", "Distance of the points of the model at which gouges and material left "
                       "are measured; 0 to measure nothing"), 0.0),
)  # fmt: skip
CHECK_SPACING = 1.0
"""mm, for new operations; gouges are searched at closer points where the cutter comes near. Operations without a
spacing, from older documents, are not measured."""

RESULTS: tuple[Row, ...] = (
    ("App::PropertyInteger", "PassCount", _R, QT_TRANSLATE_NOOP("App::Property", "Number of passes"), 0),
    ("App::PropertyInteger", "ClampedAxes", _R,
     QT_TRANSLATE_NOOP("App::Property", "Points at which the tool axis was moved into its cone"), 0),
    ("App::PropertyFloat", "MaximumGouge", _R,
     QT_TRANSLATE_NOOP("App::Property", "Deepest cut into the model that was found, mm; -1 if not measured"), -1.0),
    ("App::PropertyFloat", "UnseenGouge", _R,
     QT_TRANSLATE_NOOP("App::Property", "Largest possible further depth between the points, mm; -1 if not measured"),
     -1.0),
    ("App::PropertyVector", "GougePoint", _R, QT_TRANSLATE_NOOP("App::Property", "Where that is"), App.Vector()),
    ("App::PropertyFloat", "MaximumExcess", _R,
     QT_TRANSLATE_NOOP("App::Property", "Most material left found at points CheckSpacing apart, mm; more between them "
                       "may be missed; -1 if not measured"), -1.0),
    ("App::PropertyVector", "ExcessPoint", _R, QT_TRANSLATE_NOOP("App::Property", "Where that is"), App.Vector()),
    ("App::PropertyAngle", "UsedConeLimit", _R,
     QT_TRANSLATE_NOOP("App::Property", "Half angle of the cone that was used, limited by the machine"), 180.0),
)  # fmt: skip


def add_missing_properties(obj: Any) -> None:
    """Add the properties that the object lacks, for instance in a document of an older version."""
    add_missing(obj, PROPERTIES)
    add_missing(obj, RESULTS, READ_ONLY)


def read_inputs(obj: Any, job: Any, place: Place) -> tuple[Inputs | None, Diagnostics]:
    """Read faces, cutter and settings of an operation.

    Args:
        obj: the operation, with a tool controller.

    Returns:
        The inputs, or None; and all their faults.
    """
    chosen = [(thing, names) for thing, names in obj.Base or ()]
    faces, face_faults = model_faces(job.Model, chosen, place) if chosen else (None, ())
    cutter, tool_faults = read_cutter(obj.ToolController, place)
    diagnostics: list[Diagnostic] = [] if chosen else [Diagnostic("N308", place, Phrase("Base is empty"))]
    diagnostics += [*face_faults, *tool_faults]
    cone, cone_faults = _cone(obj, job, faces or (), place)
    settings, faults = _read_settings(obj, cone, place)
    diagnostics += [*cone_faults, *faults]
    if faces is None or cutter is None or settings is None or errors(diagnostics):
        return None, tuple(diagnostics)
    return (faces, cutter, settings), tuple(diagnostics)


def _cone(obj: Any, job: Any, faces: Sequence[NamedFace], place: Place) -> tuple[float, Diagnostics]:
    """Half angle of the cone of the tool axis in rad: that of the user or, if narrower, of the machine."""
    limit = math.radians(obj.ConeLimit.Value)
    if not obj.Machine or not faces:
        return limit, ()
    if not _is_upright(obj.ConeAxis):
        return limit, (
            Diagnostic("N309", place, Phrase("a machine limits the tilt from upright: ConeAxis is not (0, 0, 1)")),
        )
    box = box_of(faces, obj.ClearanceHeight.Value)
    tilt, faults = reachable_tilt(obj.Machine, job, obj.ToolController, box, place)
    return (limit if tilt is None else min(limit, tilt)), faults


def box_of(faces: Sequence[NamedFace], clearance: float) -> tuple[Array, Array]:
    """Lowest and highest corner of the region of the tip over faces, up to the clearance height, (3,) each, mm."""
    boxes = [named.face.BoundBox for named in faces]
    low = np.array([min(getattr(box, side) for box in boxes) for side in ("XMin", "YMin", "ZMin")])
    high = np.array([max(getattr(box, side) for box in boxes) for side in ("XMax", "YMax", "ZMax")])
    high[2] = max(high[2], clearance)
    return low, high


def reachable_tilt(
    name: str, job: Any, controller: Any, box: tuple[Array, Array], place: Place
) -> tuple[float | None, Diagnostics]:
    """The largest tilt from upright that the machine reaches at the part in every direction.

    Args:
        name: name of a machine included in PKM Post, or path of a machine file.
        job: the CAM job, with its work offset and its gauge lengths.
        controller: the tool controller, with a gauge length.
        box: lowest and highest corner of the region of the tip, (3,) each, mm.

    Returns:
        The angle in rad, or None; and the faults: M1xx of the machine file, J113, K108, N310.

    Raises:
        Refused: the arguments of the job are invalid, J117.
    """
    settings = settings_of(job)
    machine, machine_faults = machine_named(name)
    tools, tool_faults = read_tools([controller], settings.tool_lengths, place.file)
    if machine is None or not tools:
        return None, (*machine_faults, *tool_faults)
    offset, faults = work_offset(machine, settings.options)
    if offset is None:
        return None, faults
    tilt = _largest_tilt(machine, offset, tools[int(controller.ToolNumber)].length, *box)
    if tilt is None:
        return None, (Diagnostic("N310", place, Phrase("{} at {}", machine.name, settings.arguments.work_offset)),)
    return tilt, ()


def _largest_tilt(machine: Machine, machine_from_work: Array, length: float, low: Array, high: Array) -> float | None:
    """The last tilt before the first that is out of reach somewhere; None if upright is out of reach."""
    corners = np.array(np.meshgrid(*zip(low, high, strict=True))).reshape(3, -1).T
    points = np.vstack([(np.asarray(low) + high) / 2, corners])
    tilt, turn = (each.ravel() for each in np.meshgrid(_TILTS, _DIRECTIONS, indexing="ij"))
    lean = np.column_stack([np.sin(tilt) * np.cos(turn), np.sin(tilt) * np.sin(turn), np.cos(tilt)])
    tip = np.tile(points @ machine_from_work[:3, :3].T + machine_from_work[:3, 3], (len(lean), 1))
    axis = np.repeat(lean @ machine_from_work[:3, :3].T, len(points), axis=0)
    margins = reach_margins(machine, tip, axis, np.zeros(len(tip)), np.full(len(tip), length))
    worst = np.minimum.reduce([
        *(each.min(axis=1) for each in (margins.shortest, margins.longest, margins.base, margins.platform)),
        margins.singular,
    ])  # fmt: skip
    reached = (worst.reshape(len(_TILTS), -1) >= 0.0).all(axis=1)
    beyond = int(np.argmin(reached)) if not reached.all() else len(_TILTS)
    return float(_TILTS[beyond - 1]) if beyond else None


def _is_upright(cone_axis: Any) -> bool:
    """Whether the axis of a cone points straight up."""
    x, y, z = cone_axis
    return bool(z > 0.0 and math.hypot(x, y) <= 1e-9 * z)


def _read_settings(obj: Any, cone: float, place: Place) -> tuple[SurfaceOptions | None, Diagnostics]:
    """Read the settings from the properties of the operation and of its tool controller.

    Args:
        cone: half angle of the cone of the tool axis, rad.

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


def _settings(obj: Any, cone: float, feed: float, plunge: float) -> SurfaceOptions:
    by_distance = str(obj.StepoverMode) == DISTANCE
    lead, tilt = math.radians(obj.Lead.Value), math.radians(obj.Tilt.Value)
    return SurfaceOptions(
        safe_height=obj.SafeHeight.Value,
        clearance_height=obj.ClearanceHeight.Value,
        feed=feed,
        plunge_feed=plunge,
        lines=PassLines(obj.Lines),
        order=PassOrder(obj.Order),
        plane=tuple(obj.PlaneNormal),
        reversed=bool(obj.Reversed),
        stepover=Stepover(obj.Stepover.Value, None) if by_distance else Stepover(None, obj.ScallopHeight.Value),
        tolerances=SurfaceTolerances(obj.ChordTolerance.Value, math.radians(obj.AxisTolerance.Value)),
        rule=AxisRule(lead, tilt, tuple(obj.ConeAxis), cone),
        cut_mode=CutMode(obj.CutMode),
        clockwise=obj.ToolController.SpindleDir != "Reverse",
        lead_move=LeadMove(obj.LeadMove),
        lead_length=obj.LeadLength.Value,
        approach=obj.ApproachDistance.Value,
    )
