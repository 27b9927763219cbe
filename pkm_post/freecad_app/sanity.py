# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sanity: our checks in CAM's sanity report of a job, and its record of the last posted program.

CAM's report collects remarks by subject. The subject of output gets the findings of reach, part, stock, holder and
fixtures, for jobs with one of our post-processors and a machine; other jobs are unchanged.
"""

from __future__ import annotations

import functools
from collections.abc import Iterable
from datetime import datetime
from pathlib import Path
from types import ModuleType
from typing import Any

import FreeCAD

from pkm_post.freecad_app.arguments import GCODE, POST_PROCESSORS
from pkm_post.freecad_app.core_texts import fault_text
from pkm_post.model import Diagnostic, Refused, Severity

translate = FreeCAD.Qt.translate

_OPERATOR = "PKM Post"
_KINDS = {Severity.ERROR: "WARNING", Severity.WARNING: "CAUTION"}
"""CAM's kinds of remarks: a warning is the most serious one."""


def remember_output(job: Any, program: Path) -> None:
    """Store the last written program and its time in a job for CAM's sanity report, without touching the job.

    Args:
        program: the file.
    """
    was_touched = "Touched" in job.State
    job.LastPostProcessDate = datetime.now().isoformat(sep=" ", timespec="seconds")
    job.LastPostProcessOutput = str(program.absolute())
    if not was_touched:
        job.purgeTouched()


def add_checks(sanity: ModuleType) -> None:
    """Add our checks to the reports of CAM's module, once."""
    report = sanity.CAMSanity
    if hasattr(report._outputData, "__wrapped__"):
        return
    original = report._outputData

    @functools.wraps(original)
    def output_data(self: Any) -> dict[str, Any]:
        data: dict[str, Any] = original(self)
        if self.job.PostProcessor in POST_PROCESSORS and self.job.PostProcessor != GCODE:
            machine, findings = checked(self.job)
            data["machine"] = machine
            data["squawkData"] += [
                self.squawk(_OPERATOR, fault_text(each), squawkType=_KINDS[each.severity]) for each in findings
            ] or [self.squawk(_OPERATOR, translate("Sanity", "The machine can follow the job"), squawkType="NOTE")]
        return data

    report._outputData = output_data


def checked(job: Any) -> tuple[str, Iterable[Diagnostic]]:
    """The machine of a job and the findings of its checks, as in the post panel and Reach."""
    from pkm_post.freecad_app.job_settings import settings_of
    from pkm_post.freecad_app.post_outputs import study_of_job

    machine = ""
    try:
        settings = settings_of(job)
        machine = settings.machine
        return machine, study_of_job(job, settings)
    except Refused as refused:
        return machine, refused.diagnostics
