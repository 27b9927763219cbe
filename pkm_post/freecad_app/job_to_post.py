# SPDX-License-Identifier: LGPL-2.1-or-later
"""Job to post: all that is read of a CAM job and its machine before it is posted.

A job enters, the name of a machine and options; what leaves needs no document any more, so that a window can go on
while it is posted.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from pathlib import Path as FilePath
from typing import Any

from pkm_post import pipeline
from pkm_post.freecad_app.job import read_job
from pkm_post.machine_file import machine_named
from pkm_post.model import Diagnostic, Machine, Program
from pkm_post.options import FIXTURE_OF_THE_JOB


@dataclasses.dataclass(frozen=True)
class ReadJob:
    """A job that was read with its machine: what is still to be done needs no document and can be done in any thread.

    Attributes:
        program: of the job; None if it has errors.
        machine: that it runs on; None if its file has errors.
        options: with the fixture of the job for the work offset if none was chosen.
        found: in reading both.
    """

    program: Program | None
    machine: Machine | None
    options: pipeline.Options
    found: tuple[Diagnostic, ...]

    def post(
        self,
        program_path: FilePath,
        log: pipeline.Log = pipeline.quiet,
        progress: pipeline.Progress = pipeline.unwatched,
    ) -> pipeline.Posted:
        """Post it to a motion program of this name; the other files take its stem.

        Raises:
            Refused: as ``post_job``.
        """
        return pipeline.post(self.program, self.machine, program_path, self.options, log, self.found, progress)


def read_for_post(
    job: Any, machine: str | FilePath, options: pipeline.Options | None, tool_lengths: Mapping[int, float]
) -> ReadJob:
    """Bring a job up to date and read it with its machine; as ``post_job``."""
    job.Document.recompute()
    model, machine_faults = machine_named(machine)
    program, job_faults = read_job(job, tool_lengths)
    return ReadJob(program, model, at_fixture(options, job), (*machine_faults, *job_faults))


def at_fixture(options: pipeline.Options | None, job: Any) -> pipeline.Options:
    """The options, with the fixture of the job for the work offset if none was chosen."""
    options = options or pipeline.Options(work_offset=FIXTURE_OF_THE_JOB)
    if isinstance(options.work_offset, str) and options.work_offset == FIXTURE_OF_THE_JOB:
        return dataclasses.replace(options, work_offset=job.Fixtures[0] if job.Fixtures else "G54")
    return options
