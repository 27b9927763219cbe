# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reach of a job: whether the machine of a CAM job can follow it, and the work offset with the largest margin.

Takes a job, with the arguments of its post-processor; returns a study. Placing the job sets its argument
``--work-offset``, which posting reads.
"""

from __future__ import annotations

from typing import Any

from pkm_post.freecad_app.arguments import POST_PROCESSORS, rewritten
from pkm_post.freecad_app.job_settings import settings_of
from pkm_post.freecad_app.prepared_job import prepared_job
from pkm_post.model import Refused
from pkm_post.posting import Study, study, told_offset


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
