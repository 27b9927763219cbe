# SPDX-License-Identifier: LGPL-2.1-or-later
"""Post outputs: the texts and files of the post-processors for a CAM job.

Takes a job, its settings and the path to which CAM will write; returns the text for that path, and the diagnostics.
Binary files are written to the same folder, except for the dialog of FreeCAD newer than 1.1, which saves texts later
and elsewhere. All faults are reported together, and then nothing is written.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path as FilePath
from typing import Any, TypeVar

import FreeCAD as App

from pkm_post.freecad_app.arguments import GCODE, LINUXCNC, PMAC, TRAJECTORY
from pkm_post.freecad_app.document_checks import require_computed
from pkm_post.freecad_app.job import read_job
from pkm_post.freecad_app.job_settings import JobSettings
from pkm_post.freecad_app.job_setup import prepared_job
from pkm_post.freecad_app.job_study import JobStudy, study_of
from pkm_post.freecad_app.post_job import post_to
from pkm_post.freecad_app.progress import Progress
from pkm_post.model import Diagnostic, Diagnostics, Phrase, Place, Refused, Trajectory, errors
from pkm_post.posting import Posted, effective_setup, step_names
from pkm_post.system import require_usable, result_files, staged, write_fault
from pkm_post.writing import GcodeDialect, manifest, outputs, trajectory_file, write

T = TypeVar("T")
Written = tuple[str, Diagnostics]
"""The text for CAM, and warnings."""
_EXTRA_STEPS = 2
"""Reading before the steps of the pipeline, and the end, which is reported, too."""
_NO_PARENTHESES = str.maketrans("()", "[]")
"""G-code comments cannot be nested."""


def _motion_program(job: Any, settings: JobSettings, path: FilePath) -> Written:
    """The motion program, or the first of its parts; all other files are written to the same folder.

    CAM accepts several texts, but inserts a number into every name after the first: a part would get a name that
    no reader of the program expects. The other parts are therefore not passed to CAM.
    """
    posted = _posted(job, settings, path)
    if len(posted.parts) > 1:
        names = ", ".join(part.name for part in posted.parts)
        App.Console.PrintMessage(f"the program has {len(posted.parts)} parts, to be run in this order: {names}\n")
    return posted.program.read_text(encoding="ascii"), posted.diagnostics


def _program_alone(job: Any, settings: JobSettings, path: FilePath) -> Written:
    """The motion program without its other files, for a dialog that saves texts wherever the user likes."""
    with tempfile.TemporaryDirectory() as folder:
        posted = _posted(job, settings, FilePath(folder) / path.name)
        names = ", ".join(file.name for file in posted.files if file != posted.program)
        if len(posted.parts) > 1:
            raise Refused(
                [*posted.diagnostics, Diagnostic("F111", Place(path.name), Phrase("it needs {} beside it", names))]
            )
        found = Diagnostic("F112", Place(path.name), Phrase("without {}", names))
        return posted.program.read_text(encoding="ascii"), (*posted.diagnostics, found)


def _posted(job: Any, settings: JobSettings, path: FilePath) -> Posted:
    """The results of posting, with progress in the status bar."""
    steps = len(step_names(settings.options)) + _EXTRA_STEPS
    with Progress(App.Qt.translate("Progress", "Post"), steps) as bar:
        return post_to(path, job, settings, print, lambda step, share: bar.step())


def _trajectory(job: Any, settings: JobSettings, path: FilePath) -> Written:
    """A short text about the trajectory, which is written to the same folder: CAM cannot write bytes."""
    trajectory, found = _reachable(job, settings)
    target = path.with_suffix(result_files.TRAJECTORY)
    earlier = manifest.listed(target.parent, target.stem)
    try:
        require_usable(target.name)
        with staged(target.parent, manifest.manifest_name(target.stem)) as folder:
            stored = folder / target.name
            trajectory_file.write(replace(trajectory, tolerances=settings.options.tolerances), stored)
            _require(trajectory_file.read(stored), found)
            manifest.write(folder, target.stem)
    except OSError as fault:
        raise Refused([*found, write_fault(target, fault)]) from fault
    written = (path.name, target.name, manifest.manifest_name(target.stem))
    found = (*found, *outputs.left_over(path, written, earlier))
    lines = (
        f"trajectory: {target.name}",
        f"machine: {FilePath(settings.machine).name}",
        f"segments: {len(trajectory)}",
        "reach checked, motion not planned, not certified",
    )
    return "".join(f"({ascii(line)[1:-1].translate(_NO_PARENTHESES)})\n" for line in lines), found


def _linuxcnc(job: Any, settings: JobSettings, path: FilePath) -> Written:
    """G-code for LinuxCNC's hexapod."""
    trajectory, found = _reachable(job, settings)
    return _require(outputs.linuxcnc_text(trajectory, settings.options.tip_tolerance), found)


def _gcode(job: Any, settings: JobSettings, path: FilePath) -> Written:
    """The program of the job as G-code."""
    require_computed(job.Document)
    if len(settings.selection.fixtures_of(job)) > 1:  # only the machine knows their poses
        prepared = prepared_job(job, settings)
        program, diagnostics = prepared.program, prepared.found
    else:
        program, diagnostics = read_job(job, settings.tool_lengths, settings.selection)
        diagnostics = (*settings.found, *diagnostics)
    program, found = _require((program, diagnostics))
    return _require(write(program, GcodeDialect(settings.arguments.form), inch=settings.arguments.inch), found)


def _trajectory_alone(job: Any, settings: JobSettings, path: FilePath) -> Written:
    """Refuse: the dialog would save the text, but the trajectory it names is a binary file."""
    found = f"it needs {path.with_suffix(result_files.TRAJECTORY).name} beside it"
    raise Refused([Diagnostic("F111", Place(path.name), found)])


Output = Callable[[Any, JobSettings, FilePath], Written]
"""Takes the job, its settings and the path of the text."""
_OUTPUTS: dict[str, Output] = {
    PMAC: _motion_program,
    TRAJECTORY: _trajectory,
    LINUXCNC: _linuxcnc,
    GCODE: _gcode,
}
"""Output function by post-processor."""
_IN_THE_DIALOG: dict[str, Output] = {PMAC: _program_alone, TRAJECTORY: _trajectory_alone}
"""Variants for saving only texts, after posting, in a folder unknown at that time."""


def output_of(post_processor: str, for_dialog: bool = False) -> Output:
    """Output function of a post-processor.

    Args:
        for_dialog: whether the dialog of FreeCAD newer than 1.1 saves the text, and no other file is written.
    """
    return _IN_THE_DIALOG.get(post_processor, _OUTPUTS[post_processor]) if for_dialog else _OUTPUTS[post_processor]


def _reachable(job: Any, settings: JobSettings) -> tuple[Trajectory, Diagnostics]:
    """The trajectory of a job, verified to be reachable for its machine, and the warnings."""
    trajectory, study, found = _studied(job, settings)
    return _require((trajectory, study.findings), found)


def study_of_job(job: Any, settings: JobSettings) -> Diagnostics:
    """All findings of the checks of a job, including errors of its path.

    Raises:
        Refused: the job has no path to check.
    """
    _, study, found = _studied(job, settings)
    return (*found, *study.findings)


def _studied(job: Any, settings: JobSettings) -> tuple[Trajectory, JobStudy, Diagnostics]:
    """The trajectory of a job, the study of it, and the warnings before."""
    require_computed(job.Document)
    prepared = prepared_job(job, settings)
    trajectory, found = _require(prepared.placed())
    program, machine = prepared.sound
    setup, found = _require(effective_setup(prepared.options, program), found)
    return trajectory, study_of(trajectory, machine, setup, prepared.options.tolerances), found


def _require(result: tuple[T | None, Diagnostics], found: Diagnostics = ()) -> tuple[T, Diagnostics]:
    """The value of a step, and all findings so far.

    Raises:
        Refused: there is no value, or an error.
    """
    value, diagnostics = result
    if value is None or errors(diagnostics):
        raise Refused((*found, *diagnostics))
    return value, (*found, *diagnostics)
