# SPDX-License-Identifier: LGPL-2.1-or-later
"""The stages of posting, one function each, on the types of ``pkm_post.model``."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from pkm_post.api.inputs import NO_LENGTHS, Source, is_path, sound_lengths, sound_value, typed
from pkm_post.machine import ReachReport, check_reach, placed_workpiece
from pkm_post.model import Certificate, Diagnostic, Machine, Place, Program, Refused, Trajectory
from pkm_post.options import Options
from pkm_post.planning import Plan
from pkm_post.planning import plan as planned
from pkm_post.posting import (
    Log,
    Posted,
    Progress,
    effective_setup,
    no_log,
    no_progress,
    post_file,
    trajectory_of,
    verify,
    write_program,
)
from pkm_post.reading import AS_WRITTEN, ReadingOptions
from pkm_post.system import memory_guard, result_files, staged, write_fault
from pkm_post.toolpath import compensate as compensated
from pkm_post.writing import GcodeDialect, trajectory_file
from pkm_post.writing import write as gcode_text


@typed
def compensate(program: Program, options: Options | None = None) -> Program:
    """Compensate the cutter: contours under G41, G42 or CUTCOM, and points with surface normals.

    Args:
        program: as read.
        options: ``contours`` and ``actual_tools``.

    Returns:
        The program of tool tips; one without compensation is returned unchanged.

    Raises:
        Refused: a contour cannot be offset, or a tool is unknown.

    Example:
        >>> program = pkm.read("contour.ngc", tool_lengths={1: 120.0}, arguments="--tool 1=10,0")
        >>> program = pkm.compensate(program)
        >>> program.position[1:3, 1]  # the contour is at y = 0, the tool has a diameter of 10 mm
        array([5., 5.])
    """
    chosen = options or Options()
    return sound_value(*compensated(program, chosen.contours, chosen.actual_tools))


@typed
def place(program: Program, machine: Machine, options: Options | None = None) -> Trajectory:
    """Place a program on a machine: compensation, surface speed, work offset, approach and spin.

    Args:
        program: as read, or already compensated.
        machine: the machine.
        options: work offset, compensation, surface speed, spin and tolerances.

    Returns:
        The trajectory in the machine frame.

    Raises:
        Refused: the work offset is unknown, or the program cannot be compensated or placed.

    Example:
        >>> trajectory = pkm.place(pkm.read("part.ngc", tool_lengths={1: 120.0}), pkm.read_machine())
        >>> trajectory.tip[-1]
        array([ 20.,   0., 210.])
    """
    chosen = options or Options()
    return replace(sound_value(*trajectory_of(program, machine, chosen)), tolerances=chosen.tolerances)


@typed
def reach(trajectory: Trajectory, machine: Machine, options: Options | None = None) -> ReachReport:
    """Check that a machine can follow a trajectory everywhere, not only at sampled poses.

    Args:
        trajectory: in the machine frame.
        machine: the machine.
        options: ``mesh_files`` and ``setup``, which describe the part to keep clear of.

    Returns:
        The least margin of each check and where it is; ``faults()`` lists the violations.

    Raises:
        Refused: a mesh file has errors.

    Example:
        >>> trajectory = pkm.place(pkm.read("part.ngc", tool_lengths={1: 120.0}), pkm.read_machine())
        >>> pkm.reach(trajectory, pkm.read_machine()).faults()
        ()
    """
    setup = sound_value(*effective_setup(options or Options(), None))
    return check_reach(trajectory, machine, placed_workpiece(setup, trajectory))


@typed
def plan(trajectory: Trajectory, machine: Machine, options: Options | None = None) -> Plan:
    """Plan the motion: rounded corners, feed, and knots at whole milliseconds.

    Args:
        trajectory: in the machine frame.
        machine: its limits bound speeds and accelerations.
        options: the tolerances.

    Returns:
        Tool poses and strut lengths, with their rates.

    Raises:
        Refused: a pose is out of reach.

    Example:
        >>> trajectory = pkm.place(pkm.read("part.ngc", tool_lengths={1: 120.0}), pkm.read_machine())
        >>> pkm.plan(trajectory, pkm.read_machine()).struts.length.shape[1]
        6
    """
    return sound_value(*planned(trajectory, machine, (options or Options()).tolerances))


@typed
def write(
    what: Program | Trajectory | Plan,
    file: str | Path,
    machine: Machine | None = None,
    trajectory: Trajectory | None = None,
    form: GcodeDialect = GcodeDialect.VECTOR,
) -> tuple[Path, ...]:
    """Write a program as G-code, a trajectory as a trajectory file, or a plan as a motion program.

    A motion program comes with its set-up file and its trajectory file. It is not certified: ``certify`` does that,
    and ``post`` writes certified programs only.

    Args:
        what: a program, a trajectory or a plan.
        file: path of the result; the suffixes are .ngc, .pkmt and .pmc by custom.
        machine: required for a plan; its file names the controller.
        trajectory: required for a plan.
        form: notation of the tool axis in G-code.

    Returns:
        The files written; they appear together or not at all.

    Raises:
        Refused: G-code in this dialect or the controller cannot express it, or the folder is not writable.
        ValueError: a plan without its machine or its trajectory, or with the name of a trajectory file.

    Example:
        >>> [path.name for path in pkm.write(pkm.read("part.ngc", tool_lengths={1: 120.0}), "copy.ngc")]
        ['copy.ngc']
    """
    path = Path(file)
    try:
        with staged(path.parent) as folder:
            target = folder / path.name
            if isinstance(what, Program):
                target.write_text(sound_value(*gcode_text(what, form)), encoding="ascii", newline="\n")
            elif isinstance(what, Trajectory):
                trajectory_file.write(what, target)
            elif machine is None or trajectory is None:
                raise ValueError("expected the machine and the trajectory of the plan, got None")
            elif path.suffix.lower() == result_files.TRAJECTORY:
                raise ValueError(
                    f"file: expected a motion program, whose trajectory file goes beside it, got {path.name}"
                )
            else:
                sound_value(*write_program(target, trajectory, what, machine))
            names = sorted(each.name for each in folder.iterdir())
    except OSError as fault:
        raise Refused([write_fault(path, fault)]) from fault
    return tuple(path.with_name(name) for name in names)


@typed
def certify(program: str | Path, machine: Machine, trajectory: str | Path | None = None) -> Certificate:
    """Read a motion program back and check it against its trajectory file and the limits of its machine.

    Args:
        program: the motion program, or the first of its parts.
        machine: the machine it was made for.
        trajectory: the trajectory file; by default the one beside the program.

    Returns:
        The certificate, which holds.

    Raises:
        Refused: the certificate does not hold, or a file cannot be read.

    Example:
        >>> program, machine = pkm.read("part.ngc", tool_lengths={1: 120.0}), pkm.read_machine()
        >>> trajectory = pkm.place(program, machine)
        >>> files = pkm.write(pkm.plan(trajectory, machine), "part.pmc", machine, trajectory)
        >>> pkm.certify("part.pmc", machine).holds
        True
    """
    path = Path(program)
    beside = path.parent / f"{path.stem}{result_files.TRAJECTORY}"
    verified = verify(path, Path(trajectory) if trajectory else beside, machine)
    return sound_value(verified.certificate, verified.diagnostics)


@typed
def post(
    source: Source,
    machine: str | Path | None = None,
    out: str | Path = ".",
    *,
    options: Options | None = None,
    tool_lengths: Mapping[int, float] = NO_LENGTHS,
    reading: ReadingOptions = AS_WRITTEN,
    arguments: str = "",
    job_name: str | None = None,
    log: Log = no_log,
    progress: Progress = no_progress,
) -> tuple[Posted, ...]:
    """Post a CAM job, a FreeCAD document, G-code or CL data to certified motion programs.

    A job is posted with its stored arguments; those given here override them, which J125 reports.

    Args:
        source: a CAM job, or the path of a FreeCAD document (needs FreeCAD) or of a part program.
        machine: name of a machine that comes with PKM Post, or path of a machine file; None for that of the job.
        out: folder for the results.
        options: override all settings of the job that ``Options`` covers.
        tool_lengths: gauge lengths by tool number, mm.
        reading: facts that a part program does not state itself.
        arguments: options as on the command line; not together with ``options``.
        job_name: name or label of one job of a document to post; None for all.
        log: callback for a line per step.
        progress: callback, a few times a second; an exception from it aborts the run.

    Returns:
        The posted programs, one per job.

    Raises:
        Refused: the input or the folder has errors, a document is to be posted outside FreeCAD (F143), or memory runs
            out (F130). Jobs of a document that are already posted remain; otherwise nothing is written.
        ValueError: the suffix of the file is unknown, a tool length is not above 0, both options and arguments are
            given, ``job_name`` without a document, or ``reading`` without a part program.

    Example:
        >>> (posted,) = pkm.post("part.ngc", tool_lengths={1: 120.0}, out="results")
        >>> posted.program.name, posted.report["certificate"]["holds"]
        ('part.pmc', True)
    """
    common: dict[str, Any] = {
        "options": options, "tool_lengths": sound_lengths(tool_lengths), "arguments": arguments, "log": log,
        "progress": progress,
    }  # fmt: skip
    with memory_guard(str(source) if is_path(source) else source.Label):
        _require_use(source, job_name, reading)
        if is_path(source) and Path(source).suffix.lower() != ".fcstd":
            return (post_file(Path(source), machine, out, reading=reading, **common),)
        if is_path(source) and "FreeCAD" not in sys.modules and find_spec("FreeCAD") is None:
            raise Refused([Diagnostic("F143", Place(str(source)), "this Python has none")])
        from pkm_post.freecad_app import post_job as jobs

        if is_path(source):
            return jobs.post_document(Path(source), machine, out, job_name=job_name, **common)
        return (jobs.post_job(source, machine, out, **common),)


def _require_use(source: Source, job_name: str | None, reading: ReadingOptions) -> None:
    """Check that a part program is given no job, and a CAM job or a document no facts of part programs."""
    document = is_path(source) and Path(source).suffix.lower() == ".fcstd"
    if job_name is not None and not document:
        raise ValueError(f"job_name: expected None except for a FreeCAD document, got {job_name!r}")
    if reading != AS_WRITTEN and (document or not is_path(source)):
        raise ValueError("reading: expected none except for a part program")
