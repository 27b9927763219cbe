# SPDX-License-Identifier: LGPL-2.1-or-later
"""Job set-up: part, stock and tool shanks of a CAM job, for posting and for checks.

Takes a job; returns a set-up, in mm, in the work frame {C} of the job. A job has no data on clamps. The end of the
cutting edges is known for tool bits with a CuttingEdgeHeight and a ShankDiameter, as end mills have.
The box that CAM puts around the model of a new job counts as assumed: the user did not choose it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from typing import Any

import FreeCAD as App
import numpy as np
from Path.Main.Stock import StockType

from pkm_post.freecad_app.arguments import POST_PROCESSORS, rewritten
from pkm_post.freecad_app.document import document_name
from pkm_post.freecad_app.frames import matrix_of
from pkm_post.freecad_app.job import read_job
from pkm_post.freecad_app.job_settings import JobSettings, settings_of
from pkm_post.freecad_app.machine_object import machine_of
from pkm_post.freecad_app.mesh import mesh_of
from pkm_post.freecad_app.tools import millimetres
from pkm_post.machine import CollisionMesh, find_machine, machine_named, placed_workpiece
from pkm_post.model import Diagnostic, Machine, Mesh, Place, Refused, Setup, Shank, Tolerances, Trajectory
from pkm_post.options import Options, Override, argument_values, flag_of, format_value
from pkm_post.posting import Prepared, Study, known_setup, study, told_offset, work_offset


def job_setup(job: Any) -> Setup:
    """The set-up of a recomputed job."""
    shanks = dict(_shanks(job.Tools.Group))
    stock = _mesh([job.Stock] if job.Stock else [], StockType.FromStock(job.Stock) == StockType.FromBase)
    return Setup(part=_mesh(job.Model.Group), stock=stock, shanks=shanks)


def _mesh(items: Iterable[Any], assumed: bool = False) -> Mesh | None:
    """The meshes of some objects as one; None if they have no faces."""
    shaped = [item for item in items if hasattr(item, "Shape")]
    triangles = np.concatenate([np.empty((0, 3, 3)), *(mesh_of(item.Shape) for item in shaped)])
    return Mesh(", ".join(item.Label for item in shaped), triangles, assumed) if len(triangles) else None


def _shanks(controllers: Iterable[Any]) -> Iterator[tuple[int, Shank]]:
    for controller in controllers:
        start, diameter = (millimetres(controller.Tool, name) for name in ("CuttingEdgeHeight", "ShankDiameter"))
        if start > 0 and diameter > 0:
            yield int(controller.ToolNumber), Shank(start, diameter)


_SAME_PLACE = 1e-6
"""mm and directions: FreeCAD rounds placements when it stores them."""


def prepared_job(job: Any, settings: JobSettings, machine_object: Any = None) -> Prepared:
    """Read a job and its machine; the faults of both are collected together.

    Args:
        job: the CAM job, recomputed.
        settings: the settings of the job.
        machine_object: from ``create_machine``; without one the settings define the machine.

    Raises:
        Refused: the file of the machine object has faults.
    """
    options = replace(settings.options, setup=job_setup(job))
    if machine_object is None:
        machine, found = machine_named(settings.machine)
    else:
        machine = machine_of(machine_object)
        options = replace(options, work_offset=matrix_of(machine_object.Frame.inverse()))
        found = tuple(_elsewhere(job, settings, machine_object, machine, options))
    program, told = read_job(job, settings.tool_lengths, settings.selection)
    return Prepared(program, machine, options, (*found, *settings.found, *told))


def _elsewhere(
    job: Any, settings: JobSettings, machine_object: Any, machine: Machine, options: Options
) -> Iterator[Diagnostic]:
    """Yield J125 where the machine object has another machine or placement than the job is posted for."""
    place = Place(document_name(job.Document), machine_object.Label)
    if find_machine(machine_object.MachineFile) != find_machine(settings.machine):
        told = Override(flag_of("machine"), settings.machine, machine_object.MachineFile)
        yield Diagnostic("J125", place, str(told))
    offset, _ = work_offset(machine, settings.options)
    if offset is not None and not np.allclose(offset, options.work_offset, atol=_SAME_PLACE):
        values = (
            format_value("work_offset", argument_values(each)["work_offset"]) for each in (settings.options, options)
        )
        yield Diagnostic("J125", place, str(Override(flag_of("work_offset"), *values)))


@dataclass(frozen=True)
class JobOnMachine:
    """A job on its machine. Of its warnings only replaced settings are shown; posting reports the others.

    Attributes:
        trajectory: of the job, in {M}, with its spin.
        machine: the machine it runs on.
        part: the model of the job in {M}; None if it has no faces.
        tolerances: for rounded corners.
    """

    trajectory: Trajectory
    machine: Machine
    part: CollisionMesh | None
    tolerances: Tolerances


def job_on_machine(job: Any, machine_object: Any = None) -> JobOnMachine:
    """Put a job on its machine.

    Args:
        job: the CAM job, recomputed.
        machine_object: from ``create_machine``; without one the arguments of the job define the machine.

    Raises:
        Refused: the job cannot be read or placed.
    """
    read = prepared_job(job, settings_of(job), machine_object)
    for each in read.found:
        if each.code == "J125":  # the display differs from the job's settings, or from what is posted
            App.Console.PrintWarning(f"{each}\n")
    trajectory, _ = read.placed()
    program, machine = read.sound
    setup, _ = known_setup(read.options, program)
    return JobOnMachine(trajectory, machine, placed_workpiece(setup, trajectory), read.options.tolerances)


def study_job(job: Any, free: str = "") -> Study:
    """Check a job on its machine, as its arguments define it, with its model as the part.

    Args:
        job: the CAM job, a document object; its document is recomputed.
        free: letters of ``position.FREEDOMS`` in which the part may be moved; empty to leave it in place.

    Raises:
        Refused: the job cannot be read or placed. A job out of reach is reported in the study instead.
    """
    job.Document.recompute()
    read = prepared_job(job, settings_of(job))
    found, told = study(*read.sound, read.options, free)
    if found is None:
        raise Refused((*read.found, *told))
    return found


def place_job(job: Any, free: str = "xyzc") -> Study:
    """Give a job the work offset with the largest margin on its machine.

    Args:
        job: the CAM job, for a post-processor of PKM Post.
        free: letters of x, y, z and c in which the part may be moved.

    Raises:
        ValueError: ``--work-offset`` cannot express a freedom or the orientation of the part, or the job has another
            post-processor.
        Refused: as ``study_job``.
    """
    if set(free) - set("xyzc"):
        raise ValueError(f"free: expected letters of 'xyzc', got {free!r}")
    if job.PostProcessor not in POST_PROCESSORS:
        known = ", ".join(POST_PROCESSORS)
        raise ValueError(f"expected a job for {known}, got one for {job.PostProcessor or 'none'}")
    found = study_job(job, free)
    flag, equals, offset = told_offset(found.machine_from_work).partition("=")
    if not equals:
        raise ValueError(f"expected a work offset that is turned about z alone, got {flag}")
    job.PostProcessorArgs = rewritten(job.PostProcessorArgs, {flag: offset})
    return found
