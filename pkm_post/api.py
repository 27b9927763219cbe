# SPDX-License-Identifier: LGPL-2.1-or-later
"""The public API, for macros and scripts: each stage of posting as one function on the types of ``pkm_post.model``.

``import pkm_post as pkm`` gives all names of this module. Lengths are in mm, angles in rad, speeds in mm/s; options as
text are in the units of the command line. An error in the input raises ``Refused`` with all diagnostics, and a warning
is issued as ``DiagnosticWarning``. docs/api.md shows every function with an example.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, TypeVar

from pkm_post.machine import ReachReport, check_reach, machine_named, placed_workpiece
from pkm_post.machine import find_machine as machine_path
from pkm_post.model import Certificate, Diagnostic, Machine, Program, Refused, Trajectory, errors
from pkm_post.model import EventKind as EventKind
from pkm_post.model import Tool as Tool
from pkm_post.options import Options, options_from, parse_text
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
    prepared_file,
    trajectory_of,
    verify,
    write_program,
)
from pkm_post.reading import AS_WRITTEN, ReadingOptions
from pkm_post.system import memory_guard, staged, write_fault
from pkm_post.toolpath import Cutter as Cutter
from pkm_post.toolpath import compensate as compensated
from pkm_post.toolpath import tip_from_contact as tip_from_contact
from pkm_post.writing import GcodeDialect, trajectory_file
from pkm_post.writing import write as gcode_text

Source = Any
"""Path of a part program, or a CAM job (a document object)."""
_EXAMPLE = "example_6tps"
_NO_LENGTHS: Mapping[int, float] = {}
_DEFAULT = "--work-offset G54"
Value = TypeVar("Value")


class DiagnosticWarning(UserWarning):
    """A diagnostic that does not stop the work."""


def read(
    source: Source,
    tool_lengths: Mapping[int, float] = _NO_LENGTHS,
    reading: ReadingOptions = AS_WRITTEN,
    arguments: str = "",
) -> Program:
    """Read a part program or a CAM job.

    Args:
        source: path of G-code or CL data, or a CAM job.
        tool_lengths: gauge lengths by tool number, mm; they override those of the source.
        reading: what a part program does not state itself, such as its unit.
        arguments: options as on the command line.

    Returns:
        The program: tool tips and tool axes in the work frame, events by row.

    Raises:
        Refused: the source has errors.

    Example:
        >>> program = pkm.read("part.ngc", tool_lengths={1: 120.0})
        >>> len(program), sorted(program.tools)
        (5, [1])
    """
    if _is_path(source):
        prepared = prepared_file(Path(source), None, None, tool_lengths, reading, arguments)
    else:
        from pkm_post.freecad_app import post_job

        prepared = post_job.prepared(source, tool_lengths, arguments)
    return _value(prepared.program, prepared.found)


def read_machine(name: str | Path = _EXAMPLE) -> Machine:
    """Read a machine file.

    Args:
        name: name of a machine that comes with PKM Post, or path of a machine file.

    Raises:
        Refused: there is none, or it has errors.

    Example:
        >>> pkm.read_machine("example_6tps").strut_stroke
        (750.0, 1250.0)
    """
    return _value(*machine_named(str(name)))


def find_machine(name: str) -> Path:
    """The file of a machine, to copy and change.

    Args:
        name: name of a machine that comes with PKM Post, or path of a machine file.

    Raises:
        Refused: there is none.

    Example:
        >>> pkm.find_machine("example_6tps").name
        'example_6tps.toml'
    """
    path = machine_path(name)
    if path is None:
        raise Refused(machine_named(name)[1])
    return path


def read_options(arguments: str) -> Options:
    """Options from text as on the command line.

    Raises:
        ValueError: an option or its value is not known.

    Example:
        >>> pkm.read_options("--work-offset=0,0,150 --tip-tolerance 0.002").tip_tolerance
        0.002
    """
    return options_from(parse_text(f"{_DEFAULT} {arguments}"))


def compensate(program: Program, options: Options | None = None) -> Program:
    """Compensate the cutter: contours under G41, G42 or CUTCOM, and points with surface normals.

    Args:
        program: as read.
        options: ``contours`` and ``actual_tools``.

    Returns:
        The program of tool tips; one without compensation is returned as it is.

    Raises:
        Refused: a contour cannot be offset, or a tool is unknown.

    Example:
        >>> program = pkm.read("contour.ngc", tool_lengths={1: 120.0}, arguments="--tool 1=10,0")
        >>> program = pkm.compensate(program)
        >>> program.position[1:3, 1]  # the contour is at y = 0, the tool has a diameter of 10 mm
        array([5., 5.])
    """
    chosen = options or Options()
    return _value(*compensated(program, chosen.contours, chosen.actual_tools))


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
    return replace(_value(*trajectory_of(program, machine, chosen)), tolerances=chosen.tolerances)


def reach(trajectory: Trajectory, machine: Machine, options: Options | None = None) -> ReachReport:
    """Check whether a machine can follow a trajectory, everywhere and not only at sampled poses.

    Args:
        trajectory: in the machine frame.
        machine: the machine.
        options: ``mesh_files`` and ``setup``: the part to keep clear of.

    Returns:
        The least margin of each check and where it is; ``faults()`` lists the violations.

    Raises:
        Refused: a mesh file has errors.

    Example:
        >>> trajectory = pkm.place(pkm.read("part.ngc", tool_lengths={1: 120.0}), pkm.read_machine())
        >>> pkm.reach(trajectory, pkm.read_machine()).faults()
        ()
    """
    setup = _value(*effective_setup(options or Options(), None))
    return check_reach(trajectory, machine, placed_workpiece(setup, trajectory))


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
    return _value(*planned(trajectory, machine, (options or Options()).tolerances))


def write(
    what: Program | Trajectory | Plan,
    file: str | Path,
    machine: Machine | None = None,
    trajectory: Trajectory | None = None,
    form: GcodeDialect = GcodeDialect.VECTOR,
) -> tuple[Path, ...]:
    """Write a program as G-code, a trajectory as a trajectory file, or a plan as a motion program.

    A motion program gets its set-up file and its trajectory file beside it. It is not certified: ``certify`` does that,
    and ``post`` writes certified programs only.

    Args:
        what: a program, a trajectory or a plan.
        file: path of the result; the suffixes are .ngc, .pkmt and .pmc by custom.
        machine: of a plan; its file says for which controller.
        trajectory: of a plan.
        form: how G-code says the tool axis.

    Returns:
        The files written; they appear together or not at all.

    Raises:
        Refused: G-code of this form or the controller cannot express it, or the folder cannot be written.
        ValueError: a plan needs its machine and its trajectory.

    Example:
        >>> [path.name for path in pkm.write(pkm.read("part.ngc", tool_lengths={1: 120.0}), "copy.ngc")]
        ['copy.ngc']
    """
    path = Path(file)
    try:
        with staged(path.parent) as folder:
            target = folder / path.name
            if isinstance(what, Program):
                target.write_text(_value(*gcode_text(what, form)), encoding="ascii", newline="\n")
            elif isinstance(what, Trajectory):
                trajectory_file.write(what, target)
            elif machine is None or trajectory is None:
                raise ValueError("expected the machine and the trajectory of the plan, got None")
            else:
                _value(*write_program(target, trajectory, what, machine))
            names = sorted(each.name for each in folder.iterdir())
    except OSError as fault:
        raise Refused([write_fault(path, fault)]) from fault
    return tuple(path.with_name(name) for name in names)


def certify(program: str | Path, machine: Machine, trajectory: str | Path | None = None) -> Certificate:
    """Read a motion program back and compare it with its trajectory file and with the limits of its machine.

    Args:
        program: the motion program, or the first of its parts.
        machine: the machine it was made for.
        trajectory: the trajectory file; by default the one beside the program.

    Returns:
        The certificate; it holds.

    Raises:
        Refused: it does not hold, or a file cannot be read.

    Example:
        >>> program, machine = pkm.read("part.ngc", tool_lengths={1: 120.0}), pkm.read_machine()
        >>> trajectory = pkm.place(program, machine)
        >>> files = pkm.write(pkm.plan(trajectory, machine), "part.pmc", machine, trajectory)
        >>> pkm.certify("part.pmc", machine).holds
        True
    """
    path = Path(program)
    verified = verify(path, Path(trajectory) if trajectory else path.with_suffix(".pkmt"), machine)
    return _value(verified.certificate, verified.diagnostics)


def post(
    source: Source,
    machine: str | Path | None = None,
    out: str | Path = ".",
    *,
    options: Options | None = None,
    tool_lengths: Mapping[int, float] = _NO_LENGTHS,
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
        options: replace all settings of the job that ``Options`` holds.
        tool_lengths: gauge lengths by tool number, mm.
        reading: what a part program does not state itself.
        arguments: options as on the command line; not together with ``options``.
        job_name: the only job of a document to post.
        log: callback, receives a line for each step.
        progress: callback at the start of each step; an exception from it aborts the run.

    Returns:
        What was posted: one, or one for each job of a document.

    Raises:
        Refused: the input or the folder has errors, or memory runs out (F130). If a document has several jobs, those
            already posted remain; otherwise nothing was written.
        ValueError: the suffix of the file is not known, or both options and arguments are given.

    Example:
        >>> (posted,) = pkm.post("part.ngc", tool_lengths={1: 120.0}, out="results")
        >>> posted.program.name, posted.report["certificate"]["holds"]
        ('part.pmc', True)
    """
    common: dict[str, Any] = {
        "options": options, "tool_lengths": tool_lengths, "log": log, "progress": progress, "arguments": arguments,
    }  # fmt: skip
    with memory_guard(str(source) if _is_path(source) else source.Label):
        if _is_path(source) and Path(source).suffix.lower() != ".fcstd":
            return (post_file(Path(source), machine, out, reading=reading, **common),)
        from pkm_post.freecad_app import post_job as jobs

        if _is_path(source):
            return jobs.post_document(Path(source), machine, out, job_name=job_name, **common)
        return (jobs.post_job(source, machine, out, **common),)


def jobs(document: Any) -> list[Any]:
    """The CAM jobs of a FreeCAD document.

    Raises:
        Refused: there is none, J102.

    Example:
        >>> [job.Label for job in pkm.jobs(FreeCAD.ActiveDocument)]  # in FreeCAD
        ['Job']
    """
    from pkm_post.freecad_app.post_job import find_jobs

    return find_jobs(document)


def job(document: Any, name: str | None = None) -> Any:
    """The CAM job of a document with a name or label; without a name its only job.

    Raises:
        Refused: there is none, or more than one, J102.

    Example:
        >>> pkm.job(FreeCAD.ActiveDocument).Label  # in FreeCAD
        'Job'
    """
    from pkm_post.freecad_app.post_job import find_job

    return find_job(document, name)


def mirror(
    operation: Any,
    normal: Sequence[float],
    point: Sequence[float] = (0.0, 0.0, 0.0),
    label: str | None = None,
    keep_climb: bool = False,
) -> Any:
    """Add a mirrored copy of an operation to its job.

    Args:
        operation: of a CAM job.
        normal: (3,) normal of the mirror plane.
        point: (3,) a point of the plane, mm.
        label: displayed name.
        keep_climb: whether each pass is reversed, so that the copy climb mills as the original does.

    Raises:
        ValueError: the operation is in no job.

    Example:
        >>> operation = pkm.job(FreeCAD.ActiveDocument).Operations.Group[0]  # in FreeCAD
        >>> pkm.mirror(operation, normal=(1, 0, 0), label="Quadrant 2").Label
        'Quadrant 2'
    """
    from pkm_post.freecad_app.symmetry import create_mirror

    return create_mirror(operation, normal, point, label, keep_climb)


def rotate(
    operation: Any,
    axis: Sequence[float],
    angle: float,
    point: Sequence[float] = (0.0, 0.0, 0.0),
    label: str | None = None,
) -> Any:
    """Add a rotated copy of an operation to its job.

    Args:
        operation: of a CAM job.
        axis: (3,) direction of the axis.
        angle: rad, right-handed about the axis.
        point: (3,) a point of the axis, mm.
        label: displayed name.

    Raises:
        ValueError: the operation is in no job.

    Example:
        >>> operation = pkm.job(FreeCAD.ActiveDocument).Operations.Group[0]  # in FreeCAD
        >>> pkm.rotate(operation, axis=(0, 0, 1), angle=math.pi, label="Quadrant 3").Label
        'Quadrant 3'
    """
    from pkm_post.freecad_app.symmetry import create_rotation

    return create_rotation(operation, axis, angle, point, label)


def symmetry(operation: Any) -> Any:
    """What an operation and its mirrored and rotated copies cover together, and where they meet.

    Args:
        operation: one that has copies, or a copy.

    Returns:
        Number of members, covered angle about the common axis (rad), and joints.

    Raises:
        Refused: the commands of the original cannot be read.

    Example:
        >>> pkm.symmetry(pkm.job(FreeCAD.ActiveDocument).Operations.Group[0]).members  # in FreeCAD
        3
    """
    from pkm_post.freecad_app.symmetry_report import family_of

    return family_of(operation)


def set_gauge_length(controller: Any, length: float) -> None:
    """Set the gauge length of a tool controller, from the spindle nose to the tool tip.

    Args:
        controller: a tool controller of a CAM job.
        length: mm.

    Example:
        >>> pkm.set_gauge_length(pkm.job(FreeCAD.ActiveDocument).Tools.Group[0], 120.0)  # in FreeCAD
    """
    from pkm_post.freecad_app.tools import set_gauge_length as set_length

    set_length(controller, length)


def surface_points(face: Any, u: Any, v: Any) -> tuple[Any, Any]:
    """Points of a face and their outward unit normals.

    Args:
        face: a face of a shape.
        u: (N,) first parameters.
        v: (N,) second parameters.

    Returns:
        (N, 3) points, mm, and (N, 3) normals.

    Example:
        >>> point, normal = pkm.surface_points(Part.makeSphere(10).Faces[0], [0.0], [0.0])  # in FreeCAD
        >>> point.shape, normal.shape
        ((1, 3), (1, 3))
    """
    from pkm_post.freecad_app.face_surface import surface_points as points_of

    return points_of(face, u, v)


def add_machine(document: Any, machine: str = "", job: Any = None, label: str = "") -> Any:
    """Add a machine to a FreeCAD document, at its home pose.

    Args:
        document: gets the object.
        machine: name or path of a machine file; empty for that of the job, or the example.
        job: CAM job that supplies the work offset.
        label: displayed name; empty for that of the machine.

    Raises:
        Refused: the machine does not exist, or its file has faults; nothing was added.

    Example:
        >>> pkm.add_machine(FreeCAD.ActiveDocument, "example_6tps").Label  # in FreeCAD
        'Machine Example 6-TPS'
    """
    from pkm_post.freecad_app.machine_object import create_machine

    return create_machine(document, machine, job, label)


def _is_path(source: Source) -> bool:
    return isinstance(source, str | Path)


def _value(value: Value | None, diagnostics: Iterable[Diagnostic]) -> Value:
    """The value; warnings are issued.

    Raises:
        Refused: there is none, or there are errors.
    """
    listed = tuple(diagnostics)
    if value is None or errors(listed):
        raise Refused(listed)
    for diagnostic in listed:
        warnings.warn(str(diagnostic), DiagnosticWarning, stacklevel=3)
    return value
