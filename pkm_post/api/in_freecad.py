# SPDX-License-Identifier: LGPL-2.1-or-later
"""In FreeCAD: jobs, symmetric copies and machines of a document, for macros. FreeCAD is imported at the first call."""

from __future__ import annotations

import argparse
import math
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from pkm_post.options import tool_length


def _require(name: str, value: Any, attribute: str, expected: str) -> None:
    """Check that an object of FreeCAD is of the expected kind, before anything is added or changed.

    Raises:
        TypeError: it lacks the attribute of its kind.
    """
    if not hasattr(value, attribute):
        raise TypeError(f"{name}: expected {expected}, got {type(value).__name__}")


def _require_operation(operation: Any) -> None:
    _require("operation", operation, "Path", "an operation of a CAM job")
    if hasattr(operation, "PostProcessor"):
        raise TypeError("operation: expected an operation of a CAM job, got the job itself")


def _vector(name: str, value: Iterable[float], least: float = 0.0) -> tuple[float, ...]:
    """Three finite numbers of a length above the least.

    Raises:
        ValueError: they are not.
    """
    numbers = tuple(map(float, value))
    if len(numbers) != 3 or not least < math.hypot(*numbers) < math.inf:
        raise ValueError(f"{name}: expected three numbers{', not all zero' if least == 0 else ''}, got {numbers}")
    return numbers


def jobs(document: Any) -> list[Any]:
    """The CAM jobs of a FreeCAD document.

    Raises:
        Refused: the document has no job, J102.

    Example:
        >>> [job.Label for job in pkm.jobs(FreeCAD.ActiveDocument)]  # in FreeCAD
        ['Job']
    """
    _require("document", document, "addObject", "a FreeCAD document")
    from pkm_post.freecad_app.post_job import find_jobs

    return find_jobs(document)


def job(document: Any, name: str | None = None) -> Any:
    """Find a CAM job of a document by name or label; without a name, its only job.

    Raises:
        Refused: no job matches, or more than one, J102.

    Example:
        >>> pkm.job(FreeCAD.ActiveDocument).Label  # in FreeCAD
        'Job'
    """
    _require("document", document, "addObject", "a FreeCAD document")
    from pkm_post.freecad_app.post_job import find_job

    return find_job(document, name)


def mirror(
    operation: Any,
    normal: Iterable[float],
    point: Iterable[float] = (0.0, 0.0, 0.0),
    label: str | None = None,
    keep_climb: bool = False,
) -> Any:
    """Add a mirrored copy of an operation to its job.

    Args:
        operation: of a CAM job.
        normal: (3,) normal of the mirror plane.
        point: (3,) a point of the plane, mm.
        label: displayed name.
        keep_climb: reverse each pass, so that the copy climb mills as the original does.

    Raises:
        ValueError: the operation is in no job, or a number is not finite or a direction zero; nothing is added.

    Example:
        >>> operation = pkm.job(FreeCAD.ActiveDocument).Operations.Group[0]  # in FreeCAD
        >>> pkm.mirror(operation, normal=(1, 0, 0), label="Quadrant 2").Label
        'Quadrant 2'
    """
    _require_operation(operation)
    plane = _vector("normal", normal), _vector("point", point, -1.0)
    from pkm_post.freecad_app.symmetry import create_mirror

    return create_mirror(operation, *plane, None if label is None else str(label), bool(keep_climb))


def rotate(
    operation: Any,
    axis: Iterable[float],
    angle: float,
    point: Iterable[float] = (0.0, 0.0, 0.0),
    label: str | None = None,
) -> Any:
    """Add a rotated copy of an operation to its job.

    Args:
        operation: of a CAM job.
        axis: (3,) direction of the axis.
        angle: rad, right-handed about the axis.
        point: (3,) a point of the axis, mm.
        label: displayed name.

    Raises:
        ValueError: the operation is in no job, or a number is not finite or a direction zero; nothing is added.

    Example:
        >>> operation = pkm.job(FreeCAD.ActiveDocument).Operations.Group[0]  # in FreeCAD
        >>> pkm.rotate(operation, axis=(0, 0, 1), angle=math.pi, label="Quadrant 3").Label
        'Quadrant 3'
    """
    _require_operation(operation)
    direction, centre = _vector("axis", axis), _vector("point", point, -1.0)
    if not math.isfinite(angle):
        raise ValueError(f"angle: expected a number in rad, got {angle}")
    from pkm_post.freecad_app.symmetry import create_rotation

    return create_rotation(operation, direction, angle, centre, None if label is None else str(label))


def symmetry(operation: Any) -> Any:
    """Joint coverage of an operation and its mirrored and rotated copies.

    Args:
        operation: an operation with copies, or a copy.

    Returns:
        Number of members, covered angle about the common axis (rad), and joints.

    Raises:
        Refused: the commands of the original cannot be read.

    Example:
        >>> pkm.symmetry(pkm.job(FreeCAD.ActiveDocument).Operations.Group[0]).members  # in FreeCAD
        3
    """
    _require_operation(operation)
    from pkm_post.freecad_app.symmetry_report import family_of

    return family_of(operation)


def set_gauge_length(controller: Any, length: float) -> None:
    """Set the gauge length of a tool controller, from the spindle nose to the tool tip.

    Args:
        controller: a tool controller of a CAM job.
        length: mm.

    Raises:
        ValueError: the length is not a number above 0.

    Example:
        >>> pkm.set_gauge_length(pkm.job(FreeCAD.ActiveDocument).Tools.Group[0], 120.0)  # in FreeCAD
    """
    _require("controller", controller, "ToolNumber", "a tool controller of a CAM job")
    try:
        checked = tool_length(str(float(length)))
    except (ValueError, argparse.ArgumentTypeError) as fault:
        raise ValueError(f"length: {fault}") from None
    from pkm_post.freecad_app.tools import set_gauge_length as set_length

    set_length(controller, checked)


def surface_points(face: Any, u: Any, v: Any) -> tuple[Any, Any]:
    """Points of a face and their outward unit normals.

    Args:
        face: a face of a shape.
        u: (N,) first parameters.
        v: (N,) second parameters.

    Returns:
        (N, 3) points, mm, and (N, 3) normals.

    Example:
        >>> point, normal = pkm.surface_points(Part.makeSphere(10).Faces[0], [0.0], [0.0])  # in FreeCAD
        >>> point.shape, normal.shape
        ((1, 3), (1, 3))
    """
    _require("face", face, "valueAt", "a face of a shape")
    from pkm_post.freecad_app.face_surface import surface_points as points_of

    return points_of(face, u, v)


def add_machine(document: Any, machine: str | Path = "", job: Any = None, label: str = "") -> Any:
    """Add a machine to a FreeCAD document, at its home pose.

    Args:
        document: gets the object.
        machine: name or path of a machine file; empty for that of the job, else the example.
        job: CAM job that supplies the work offset.
        label: displayed name; empty for that of the machine.

    Raises:
        Refused: the machine does not exist, or its file has errors; nothing is added.

    Example:
        >>> pkm.add_machine(FreeCAD.ActiveDocument, "example_6tps").Label  # in FreeCAD
        'Machine Example 6-TPS'
    """
    _require("document", document, "addObject", "a FreeCAD document")
    if job is not None:
        _require("job", job, "PostProcessor", "a CAM job")
    from pkm_post.freecad_app.machine_object import create_machine

    return create_machine(document, str(machine), job, str(label))
