# SPDX-License-Identifier: LGPL-2.1-or-later
"""Symmetry report: cut direction and coverage of copies, and their fit at joints.

Takes programs or document objects; sets the read-only properties of a symmetric operation, and returns the totals of
all copies of one operation in a job. Units: mm, rad; properties in mm and degrees.

Copies mill climb or conventional depending on the side of the material, and on the sense of the
spindle. An operation's properties state both: CAM defines climb milling for a spindle that turns clockwise (M3), the
material is then to the right of the path; Surface Finish follows its spindle. Sides are +1 (right), -1 (left) or 0
(unknown).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from Path.Base.Util import toolControllerForOp
from PathScripts import PathUtils

from pkm_post.freecad_app.document import members
from pkm_post.freecad_app.document_checks import is_pkm_object
from pkm_post.freecad_app.document_object import program_of
from pkm_post.freecad_app.tools import SPINDLE_SENSES
from pkm_post.geometry import Array
from pkm_post.model import Kind, Program
from pkm_post.toolpath import (
    AngularCoverage,
    Seam,
    coverage,
    cut_lengths,
    mirror_gap,
    pass_rows,
    seam,
    seams,
    sector,
    transform,
)

NOT_STATED, LEFT, RIGHT = "Not stated", "Left", "Right"
SIDES = {NOT_STATED: 0, LEFT: -1, RIGHT: 1}
"""Choices of the property ``MaterialSide``."""

_CUT_MODES = {"Climb": 1, "Conventional": -1}
_PROFILE = {("Outside", "CW"): 1, ("Outside", "CCW"): -1, ("Inside", "CCW"): 1, ("Inside", "CW"): -1}
"""Side of the contour and direction of CAM's profile operation; CAM reverses holes by itself."""
_ORDERS = ("Order", "CutPattern", "OffsetPattern", "ClearingPattern")
_ONE_WAY = ("One way", "Spiral", "Offset")
"""Pass patterns that keep the material on one side throughout."""


def is_symmetric(obj: Any) -> bool:
    """Whether an object is a mirrored or rotated operation."""
    return hasattr(getattr(obj, "Proxy", None), "matrices")


def material_side_of(obj: Any) -> int:
    """The side on which an operation has the material, according to its properties.

    Args:
        obj: an operation; a mirrored or rotated one takes the side of its base, and so does a dress-up.
    """
    if is_symmetric(obj):
        return base_material_side(obj) * obj.Proxy.side_factor(obj)
    if hasattr(obj, "CutMode"):
        orders = [getattr(obj, name) for name in _ORDERS if hasattr(obj, name)]
        side = _CUT_MODES.get(obj.CutMode, 0) if all(order in _ONE_WAY for order in orders) else 0
        return -side if is_pkm_object(obj) and spindle_sense_of(obj) < 0 else side
    if hasattr(obj, "Side") and hasattr(obj, "Direction"):
        return _PROFILE.get((str(obj.Side), str(obj.Direction)), 0)
    base = getattr(obj, "Base", None)
    return material_side_of(base) if hasattr(base, "Path") else 0


def base_material_side(obj: Any) -> int:
    """The side on which the base of a mirrored or rotated operation has the material."""
    stated = SIDES[obj.MaterialSide]
    return stated if stated or obj.Base is None else material_side_of(obj.Base)


def spindle_sense_of(obj: Any) -> int:
    """+1 if the tool controller of an operation turns the spindle clockwise (M3), -1 counterclockwise, 0 if stopped."""
    return SPINDLE_SENSES.get(getattr(toolControllerForOp(obj), "SpindleDir", ""), 0)


_PARALLEL = 1e-6
"""Sine of the angle between planes below which they do not intersect."""


@dataclass(frozen=True)
class Family:
    """An operation and all its copies in the job, at any depth.

    Attributes:
        label: name of the operation.
        members: number of instances.
        coverage: covered angle about their axis, rad; None without an axis, or without a cut.
    """

    label: str
    members: int
    coverage: AngularCoverage | None
    joints: tuple[Seam, ...]


def write_report(obj: Any, base: Program, copies: Sequence[Program], result: Program) -> None:
    """Write the read-only properties of a symmetric operation.

    Args:
        base: the program of the operation's base.
        result: the program of the operation.
    """
    sense, side = spindle_sense_of(obj), base_material_side(obj)
    obj.CutOfBase = cut_lengths(base, side, sense).direction.value
    obj.CutOfCopies = cut_lengths(result, side * obj.Proxy.side_factor(obj), sense).direction.value
    is_mirror = hasattr(obj, "Normal")
    joints = _report_mirror(obj, base, copies[0]) if is_mirror else _report_rotation(obj, [base, *copies])
    obj.Joints = len(joints)
    obj.JointDistance = max((each.distance for each in joints), default=0.0)
    obj.JointTurn = math.degrees(max((each.turn for each in joints), default=0.0))


def _report_mirror(obj: Any, base: Program, copy: Program) -> tuple[Seam, ...]:
    obj.GapToBase, obj.OverlapWithBase = mirror_gap(base, obj.Point, obj.Normal)
    obj.ReversedPasses = len(pass_rows(copy)) if obj.KeepClimb else 0
    obj.SwappedArcs = _swapped_arcs(base, copy, bool(obj.KeepClimb))
    return (seam(base, copy),) if len(pass_rows(base)) else ()


def _swapped_arcs(base: Program, copy: Program, reversed_pass: bool) -> int:
    """Number of arcs with reversed sense about their coordinate; reversing the pass as well restores the sense."""
    arc = base.kind == Kind.ARC
    senses = []
    for axis in (base.arc_axis[arc], copy.arc_axis[arc]):
        along = np.argmax(np.abs(axis), axis=1)
        senses.append(axis[np.arange(len(axis)), along] > 0)
    return int(np.sum((senses[0] != senses[1]) != reversed_pass))


def _report_rotation(obj: Any, programs: list[Program]) -> tuple[Seam, ...]:
    total, joints = _coverage(programs, np.array(obj.Point), np.array(obj.Axis))
    angles = (total.covered, total.overlap, total.gap) if total else (0.0, 0.0, 2 * math.pi)
    obj.Covered, obj.Overlap, obj.Gap = (math.degrees(angle) for angle in angles)
    obj.Tiles = total is not None and total.tiles
    return joints


def _coverage(programs: list[Program], point: Array, axis: Array) -> tuple[AngularCoverage | None, tuple[Seam, ...]]:
    """Coverage of programs about an axis, and their joints; nothing if one of them has no cut."""
    sectors = [found for program in programs if (found := sector(program, point, axis))]
    if not programs or len(sectors) < len(programs):
        return None, ()
    return coverage(sectors), seams(programs, sectors)


def family_of(obj: Any) -> Family:
    """The operation and all its active copies in the job as one family.

    Args:
        obj: a symmetric operation, or one that has copies.

    Raises:
        Refused: the commands of the original cannot be read.
    """
    root, job = _root(obj), PathUtils.findParentJob(obj)
    operations = [root] if job is None else members(job.Operations)
    others = [each for each in operations if _root(each) == root and each != root and _is_valid(each)]
    programs = [program for each in (root, *others) for program in _images(each)]
    axis = _axis(others)
    total, joints = _coverage(programs, *axis) if axis else (None, ())
    return Family(root.Label, len(programs), total, joints)


def _root(obj: Any) -> Any:
    """The operation at the root of a chain of copies; a copy without a base is its own root."""
    while is_symmetric(obj) and obj.Base is not None:
        obj = obj.Base
    return obj


def _is_valid(obj: Any) -> bool:
    """Whether a copy and all copies below it exist and are active."""
    while is_symmetric(obj) and obj.Base is not None:
        if not obj.Active or not obj.isValid():
            return False
        obj = obj.Base
    return not is_symmetric(obj)


def _images(obj: Any) -> list[Program]:
    """The original, or each image of it that a copy contains; before passes are reversed."""
    if not is_symmetric(obj):
        return [program_of(obj)]
    if obj.Base is None:
        return []
    images = [transform(program, matrix)[0] for matrix in obj.Proxy.matrices(obj) for program in _images(obj.Base)]
    return [program for program in images if program is not None]


def _axis(copies: list[Any]) -> tuple[Array, Array] | None:
    """A point and the direction of the axis: that of a rotation, or the intersection line of two mirror planes."""
    rotations = [each for each in copies if hasattr(each, "Axis")]
    if rotations:
        return np.array(rotations[0].Point), np.array(rotations[0].Axis)
    planes = [(np.array(each.Point), np.array(each.Normal.normalize())) for each in copies]
    for number, (point, normal) in enumerate(planes):
        for other_point, other in planes[number + 1 :]:
            along = np.cross(normal, other)
            if np.linalg.norm(along) > _PARALLEL:
                sides = np.array([normal @ point, other @ other_point, 0.0])
                return np.linalg.solve(np.array([normal, other, along]), sides), along
    return None
