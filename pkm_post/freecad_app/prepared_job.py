# SPDX-License-Identifier: LGPL-2.1-or-later
"""Prepared job: a CAM job with its machine, read for posting, checking and display.

Takes a job with its settings, and optionally a machine object, whose machine file and work offset then override
those of the settings. The document is not recomputed: document objects call this during a recompute.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from pkm_post.freecad_app.frames import matrix_of
from pkm_post.freecad_app.job import document_name, read_job
from pkm_post.freecad_app.job_settings import JobSettings
from pkm_post.freecad_app.job_setup import job_setup
from pkm_post.freecad_app.machine_object import machine_of
from pkm_post.machine import find_machine, machine_named
from pkm_post.model import Diagnostic, Machine, Place
from pkm_post.options import Options, Override, flag_of, said_by, shown
from pkm_post.posting import Prepared, work_offset

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
        said = (shown("work_offset", said_by(each)["work_offset"]) for each in (settings.options, options))
        yield Diagnostic("J125", place, str(Override(flag_of("work_offset"), *said)))
