# SPDX-License-Identifier: LGPL-2.1-or-later
"""Job on a machine: a CAM job as a trajectory in the machine frame {M}, for display.

Takes a job and optionally a machine object. The document is not recomputed: document objects call this during a
recompute.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import FreeCAD as App

from pkm_post.freecad_app.job_settings import settings_of
from pkm_post.freecad_app.prepared_job import prepared_job
from pkm_post.machine import Part, placed_part
from pkm_post.model import Machine, Tolerances, Trajectory
from pkm_post.posting import known_setup


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
    part: Part | None
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
    return JobOnMachine(trajectory, machine, placed_part(setup, trajectory), read.options.tolerances)
