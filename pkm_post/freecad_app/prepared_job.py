# SPDX-License-Identifier: LGPL-2.1-or-later
"""Prepared job: a CAM job with its machine, read for posting, for checks and to be looked at.

A job enters, with its settings, and a machine object if there is one: its machine file and its work offset go before
those of the settings then. The document is not recomputed: document objects ask for this while it is.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from pkm_post import pipeline
from pkm_post.freecad_app.frames import matrix_of
from pkm_post.freecad_app.job import read_job
from pkm_post.freecad_app.job_settings import JobSettings
from pkm_post.freecad_app.machine_object import machine_of
from pkm_post.machine_file import machine_named


def prepared_job(job: Any, settings: JobSettings, machine_object: Any = None) -> pipeline.Prepared:
    """Read a job and its machine; what is wrong with either is found together.

    Args:
        job: the CAM job, recomputed.
        settings: what it is posted with.
        machine_object: what ``create_machine`` made; without one the settings say it all.

    Raises:
        Refused: the file of the machine object has faults.
    """
    options = settings.options
    if machine_object is None:
        machine, found = machine_named(settings.machine)
    else:
        machine, found = machine_of(machine_object), ()
        options = replace(options, work_offset=matrix_of(machine_object.Frame.inverse()))
    program, told = read_job(job, settings.tool_lengths, settings.selection)
    return pipeline.Prepared(program, machine, options, (*found, *settings.found, *told))
