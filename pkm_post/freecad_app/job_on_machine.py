# SPDX-License-Identifier: LGPL-2.1-or-later
"""Job on a machine: a CAM job with its machine, and as a trajectory in the machine frame {M}, to be looked at there.

A job enters, with the arguments of its post-processor, and a machine object if there is one: its machine file and its
work offset go before those of the arguments then. The document is not recomputed: document objects ask for this while
it is.
"""

from __future__ import annotations

import argparse
from dataclasses import dataclass, replace
from typing import Any

from pkm_post import pipeline
from pkm_post.freecad_app.arguments import own_arguments
from pkm_post.freecad_app.frames import apply, matrix_of
from pkm_post.freecad_app.job import read_job
from pkm_post.freecad_app.job_to_post import at_fixture
from pkm_post.freecad_app.machine_object import machine_of
from pkm_post.freecad_app.part_mesh import part_mesh
from pkm_post.kinematics import Part
from pkm_post.machine_file import machine_named
from pkm_post.model import Diagnostic, Machine, Program, Refused, Trajectory
from pkm_post.model.certificate import Tolerances
from pkm_post.model.diagnostics import errors
from pkm_post.options import options_from, tool_lengths_from


@dataclass(frozen=True)
class JobAndMachine:
    """A job before it is placed.

    Attributes:
        program: of the job, in {C}.
        machine: that it runs on.
        options: that it is placed by.
        diagnostics: warnings.
    """

    program: Program
    machine: Machine
    options: pipeline.Options
    diagnostics: tuple[Diagnostic, ...]


@dataclass(frozen=True)
class JobOnMachine:
    """A job where it is driven. Warnings are told when it is posted.

    Attributes:
        trajectory: of the job, in {M}, with its spin.
        machine: that it runs on.
        part: the model of the job in {M}; None if it has no faces.
        tolerances: for rounded corners.
    """

    trajectory: Trajectory
    machine: Machine
    part: Part | None
    tolerances: Tolerances


def job_and_machine(job: Any, chosen: argparse.Namespace, machine_object: Any = None) -> JobAndMachine:
    """Read a job and its machine; what is wrong with either is told together.

    Args:
        job: the CAM job, recomputed.
        chosen: its arguments.
        machine_object: what ``create_machine`` made; without one the arguments say it all.

    Raises:
        Refused: the job cannot be read, or there is no such machine.
    """
    options = at_fixture(options_from(chosen), job)
    found: tuple[Diagnostic, ...] = ()
    if machine_object is None:
        machine, found = machine_named(chosen.machine)
    else:
        machine = machine_of(machine_object)
        options = replace(options, work_offset=matrix_of(machine_object.Frame.inverse()))
    program, told = read_job(job, tool_lengths_from(chosen))
    found += told
    if machine is None or program is None or errors(found):
        raise Refused(found)
    return JobAndMachine(program, machine, options, found)


def job_on_machine(job: Any, machine_object: Any = None) -> JobOnMachine:
    """Put a job on its machine.

    Args:
        job: the CAM job, recomputed.
        machine_object: what ``create_machine`` made; without one the arguments of the job say it all.

    Raises:
        Refused: the job cannot be read or placed.
    """
    read = job_and_machine(job, own_arguments(job), machine_object)
    trajectory, told = pipeline.trajectory_of(read.program, read.machine, read.options)
    if trajectory is None:
        raise Refused((*read.diagnostics, *told))
    triangles = part_mesh(job)
    corners = apply(trajectory.machine_from_work, triangles.reshape(-1, 3)).reshape(-1, 3, 3)
    tolerances = Tolerances(read.options.tip_tolerance, read.options.axis_tolerance)
    return JobOnMachine(trajectory, read.machine, Part.of(corners) if len(corners) else None, tolerances)
