# SPDX-License-Identifier: LGPL-2.1-or-later
"""Job set-up: a CAM job on its machine, for posting, checks and display.

Takes a job with its settings, and optionally a machine object, whose machine file and work offset then override those
of the settings. Returns the job before it is placed, with part, stock and tool shanks in the work frame {C}, or its
trajectory in the machine frame {M}, or the study of its reach. Lengths are in mm. The document is not recomputed, since
document objects prepare and place jobs during a recompute.

A job has no data on clamps. The end of the cutting edges is known for tool bits with a CuttingEdgeHeight and a
ShankDiameter, such as end mills. The box that CAM puts around the model of a new job counts as assumed: the user did
not choose it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from Path.Base.Util import toolControllerForOp
from Path.Main.Stock import StockType

from pkm_post.freecad_app.arguments import POST_PROCESSORS, replace_arguments
from pkm_post.freecad_app.document import document_name, members
from pkm_post.freecad_app.document_checks import require_computed
from pkm_post.freecad_app.document_object import print_diagnostics
from pkm_post.freecad_app.fixtures import ONE_PLACE, at_fixtures, fixture_places
from pkm_post.freecad_app.frames import matrix_of, placement_of
from pkm_post.freecad_app.job import is_active, read_job
from pkm_post.freecad_app.job_settings import JobSettings, settings_of
from pkm_post.freecad_app.job_study import JobStudy, study_of
from pkm_post.freecad_app.machine_object import machine_of
from pkm_post.freecad_app.mesh import mesh_of
from pkm_post.freecad_app.tools import bit_of
from pkm_post.geometry import Array
from pkm_post.machine import CollisionMesh, find_machine, machine_named, placed_workpiece
from pkm_post.model import (
    Diagnostic,
    Diagnostics,
    Machine,
    Mesh,
    Place,
    Refused,
    Setup,
    Tolerances,
    Trajectory,
    errors,
    required,
)
from pkm_post.options import Options, Override, argument_values, flag_of, format_value
from pkm_post.posting import (
    FoundPlace,
    Prepared,
    Progress,
    StiffnessStudy,
    Study,
    effective_setup,
    find_place,
    stiffness_study,
    study,
    work_offset,
    work_offset_text,
)
from pkm_post.reading import core_of, shank_of

_SAME_PLACE = 1e-6
"""mm, and for directions: FreeCAD rounds stored placements."""


@dataclass(frozen=True)
class PlacedJob:
    """A job on its machine. Only its warnings about replaced settings are shown; posting reports the others.

    Attributes:
        trajectory: of the job, in {M}, with its spin.
        setup: part, stock, fixtures and shanks, in {C}.
        tolerances: for rounded corners.
    """

    trajectory: Trajectory
    machine: Machine
    setup: Setup
    tolerances: Tolerances

    @property
    def part(self) -> CollisionMesh | None:
        """The model of the job in {M}; None if it has no faces."""
        return placed_workpiece(self.setup, self.trajectory)

    def study(self) -> JobStudy:
        """All checks of the job, shared by all displays."""
        return study_of(self.trajectory, self.machine, self.setup, self.tolerances)


def prepared_job(job: Any, settings: JobSettings, machine_object: Any = None) -> Prepared:
    """Read a job and its machine; the faults of both are collected together.

    Args:
        job: the CAM job, recomputed.
        machine_object: from ``create_machine``; without one the settings define the machine.

    Raises:
        Refused: the file of the machine object has faults.
    """
    options = settings.options
    if machine_object is None:
        machine, diagnostics = machine_named(settings.machine)
    else:
        machine = machine_of(machine_object)
        options = replace(options, work_offset=matrix_of(machine_object.Frame.inverse()))
        diagnostics = tuple(_machine_differences(job, settings, machine_object, machine, options))
    places, unplaced = places_of(job, settings, machine, options)
    is_axis = machine is not None and machine.spindle_axis is not None
    program, job_diagnostics = read_job(job, settings.tool_lengths, settings.selection, places, is_axis)
    options = replace(options, setup=setup_of(job, places))
    return Prepared(program, machine, options, (*diagnostics, *settings.found, *unplaced, *job_diagnostics), places)


def places_of(
    job: Any, settings: JobSettings, machine: Machine | None, options: Options
) -> tuple[dict[str, Array], Diagnostics]:
    """The pose in {C} of each fixture of a job, (4, 4) by name, as from ``fixture_places``; empty without a machine."""
    if machine is None:
        return {}, ()
    place = Place(document_name(job.Document), job.Label)
    return fixture_places(settings.selection.fixtures_of(job), machine, options, dict(settings.arguments.origin), place)


def _machine_differences(
    job: Any, settings: JobSettings, machine_object: Any, machine: Machine, options: Options
) -> Iterator[Diagnostic]:
    """Yield J125 if the machine object differs in machine or placement from those the job is posted for."""
    place = Place(document_name(job.Document), machine_object.Label)
    if find_machine(machine_object.MachineFile) != find_machine(settings.machine):
        machines = Override(flag_of("machine"), settings.machine, machine_object.MachineFile)
        yield Diagnostic("J125", place, str(machines))
    offset, _ = work_offset(machine, settings.options)
    if offset is not None and not np.allclose(offset, options.work_offset, rtol=0.0, atol=_SAME_PLACE):
        values = (
            format_value("work_offset", argument_values(each)["work_offset"]) for each in (settings.options, options)
        )
        yield Diagnostic("J125", place, str(Override(flag_of("work_offset"), *values)))


def setup_of(job: Any, places: Mapping[str, Array] = ONE_PLACE) -> Setup:
    """The set-up of a recomputed job, with a part and a stock at each of several fixtures."""
    bits = [(number, bit_of(each)) for number, each in _bits(job).items()]
    shanks = {number: shank for number, bit in bits if (shank := shank_of(bit)) is not None}
    cores = {number: core for number, bit in bits if (core := core_of(bit)) is not None}
    stock = _mesh([job.Stock] if job.Stock else [], StockType.FromStock(job.Stock) == StockType.FromBase)
    part = at_fixtures(_mesh(members(job.Model)), places)
    return Setup(part, at_fixtures(stock, places), shanks=shanks, cores=cores)


def _bits(job: Any) -> dict[int, Any]:
    """The tool bits by number. Of several with one number, that of active operations counts."""
    used = [toolControllerForOp(each) for each in members(job.Operations) if is_active(each)]
    in_use_last = sorted(members(job.Tools), key=used.__contains__)
    return {int(each.ToolNumber): each.Tool for each in in_use_last}


def _mesh(items: Iterable[Any], assumed: bool = False) -> Mesh | None:
    """The meshes of some objects as one; None if they have no faces."""
    shaped = [item for item in items if hasattr(item, "Shape")]
    triangles = np.concatenate([np.empty((0, 3, 3)), *(mesh_of(item.Shape) for item in shaped)])
    return Mesh(", ".join(item.Label for item in shaped), triangles, assumed) if len(triangles) else None


def placed_job(job: Any, machine_object: Any = None) -> PlacedJob:
    """Put a job on its machine.

    Args:
        job: the CAM job, recomputed.
        machine_object: from ``create_machine``; without one the arguments of the job define the machine.

    Raises:
        Refused: the job cannot be read or placed.
    """
    prepared = prepared_job(job, settings_of(job), machine_object)
    # J125: the display differs from the job's settings, or from the posted program
    print_diagnostics(each for each in prepared.found if each.code == "J125")
    trajectory, _ = prepared.placed()
    program, machine = prepared.sound
    setup, faults = effective_setup(prepared.options, program)
    if errors(faults):
        raise Refused((*prepared.found, *faults))
    return PlacedJob(trajectory, machine, setup, prepared.options.tolerances)


def study_job(job: Any, free: str = "") -> Study:
    """Check a job on its machine, with its arguments, and its model as the part.

    Args:
        job: the CAM job, a document object; its document is recomputed.
        free: letters of x, y, z, a, b and c in which the part may be moved; empty to leave it in place.

    Raises:
        Refused: the job cannot be read or placed. A job out of reach is reported in the study instead.
    """
    require_computed(job.Document)
    prepared = prepared_job(job, settings_of(job))
    result, faults = study(*prepared.sound, prepared.options, free)
    return required(result, (*prepared.found, *faults))


def stiffness_of(job: Any, machine_object: Any = None) -> StiffnessStudy:
    """Stiffness of the tool tip along a job, and over the table.

    Args:
        job: the CAM job, recomputed.
        machine_object: from ``create_machine``; without one the arguments of the job define the machine.

    Raises:
        Refused: the job cannot be read or placed, or the machine file states no stiffness.
    """
    placed = placed_job(job, machine_object)
    return required(*stiffness_study(placed.trajectory, placed.machine))


def set_best_work_offset(job: Any, free: str = "xyzc") -> Study:
    """Set the argument ``--work-offset`` of a job to the offset with the largest margin on its machine.

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
    _require_post_processor(job)
    result = study_job(job, free)
    if result.place is not None:
        set_place(job, result.place)
    return result


def place_search(job: Any, machine_object: Any = None) -> Callable[[Progress], FoundPlace]:
    """Read a job; return the search for a place at which the machine can follow it, which may run in any thread.

    The search takes a progress callback; an exception from it ends the search.

    Args:
        job: the CAM job, recomputed.
        machine_object: from ``create_machine``; without one the arguments of the job define the machine.

    Raises:
        Refused: the job cannot be read or placed; also raised by the search.
    """
    prepared = prepared_job(job, settings_of(job), machine_object)
    program, machine = prepared.sound

    def search(progress: Progress) -> FoundPlace:
        found, faults = find_place(program, machine, prepared.options, progress=progress)
        return required(found, (*prepared.found, *faults))

    return search


def set_place(job: Any, found: FoundPlace, machine_object: Any = None) -> None:
    """Set the arguments of a job, and the work offset of a machine without a job, to a found place.

    Args:
        job: the CAM job, for a post-processor of PKM Post.
        found: the place.
        machine_object: from ``create_machine``, used for the search.

    Raises:
        ValueError: ``--work-offset`` cannot express the orientation of the part, or the job has another post-processor.
    """
    _require_post_processor(job)
    offset = found.reach.trajectory.machine_from_work
    flag, equals, text = work_offset_text(offset).partition("=")
    if not equals:
        raise ValueError(f"expected a work offset that is rotated only about z, got {flag}")
    chosen: dict[str, str | list[str] | None] = {flag: text}
    chosen |= {flag_of("spin"): found.options.spin.rule.value} if found.spins else {}
    chosen |= {flag_of("origin"): _origins(job, machine_object)}  # the search moved all fixtures together
    if machine_object is not None and machine_object.Job is None:
        document_from_work = matrix_of(machine_object.Frame) @ matrix_of(machine_object.WorkOffset)
        machine_object.WorkOffset = placement_of(offset @ document_from_work)
    job.PostProcessorArgs = replace_arguments(job.PostProcessorArgs, chosen)


def _origins(job: Any, machine_object: Any) -> list[str]:
    """The poses in {C} of the fixtures after the first one, as values of ``--origin``."""
    settings = settings_of(job)
    machine = machine_named(settings.machine)[0] if machine_object is None else machine_of(machine_object)
    options = settings.options
    if machine_object is not None:
        options = replace(options, work_offset=matrix_of(machine_object.Frame.inverse()))
    places, _ = places_of(job, settings, machine, options)
    found = {name: work_offset_text(pose).partition("=") for name, pose in list(places.items())[1:]}
    if not all(equals for _, equals, _ in found.values()):
        raise ValueError("expected fixtures that are rotated against each other only about z")
    return [f"{name}={text}" for name, (_, _, text) in found.items()]


def _require_post_processor(job: Any) -> None:
    if job.PostProcessor not in POST_PROCESSORS:
        known = ", ".join(POST_PROCESSORS)
        raise ValueError(f"expected a job for {known}, got one for {job.PostProcessor or 'none'}")
