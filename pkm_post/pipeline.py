# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pipeline: the one way through the house, from a program to files that a controller and a person can use.

This module alone knows the order of the steps. Either every file is written and certified, or none is there.
"""

from __future__ import annotations

import contextlib
import math
import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from pkm_post import outputs, planning, trajectory_file
from pkm_post.certificate import certify
from pkm_post.compensation import OffsetOptions, compensate
from pkm_post.controllers import TABLES, controller_of
from pkm_post.files import staged
from pkm_post.geometry.vectors import Array
from pkm_post.model import Diagnostic, Machine, Place, Program, Refused, Tool, Trajectory
from pkm_post.model.diagnostics import errors
from pkm_post.model.findings import Tolerances
from pkm_post.placement import place
from pkm_post.report import plots, summary
from pkm_post.spin import ZERO_TORSION, Policy, with_spin
from pkm_post.surface_speed import SurfaceSpeed, with_surface_speed

T = TypeVar("T")
Findings = tuple[Diagnostic, ...]
Log = Callable[[str], None]

SUFFIX = ".pmc"
"""How the name of a motion program ends."""
LINUXCNC = "linuxcnc"
"""The name in ``Options.also`` of a program for LinuxCNC's hexapod, which is no table of the motion."""


def quiet(line: str) -> None:
    """Log nothing."""


@dataclass(frozen=True)
class Options:
    """What a user may choose.

    Attributes:
        work_offset: name of a work offset in the machine file, or the (4, 4) pose of {C} in {M}.
        tip_tolerance: how far the tool tip may be from the programmed path, mm.
        axis_tolerance: how far the tool axis may be from the programmed one, rad.
        spin: how the platform turns about the tool axis.
        contours: how 2D cutter compensation (G41, G42, CUTCOM) is applied.
        actual_tools: by number, tools whose cutters are others than those the program was made for; a program with
            surface normals is compensated for them.
        surface_speed: how fast the cutting edge is to move over the work; None leaves the spindle as programmed.
        also: what is written beside the program: names of ``controllers.TABLES``, and ``LINUXCNC``.
    """

    work_offset: str | Array = "G54"
    tip_tolerance: float = 1e-3
    axis_tolerance: float = math.radians(1e-3)
    spin: Policy = ZERO_TORSION
    contours: OffsetOptions = OffsetOptions()
    actual_tools: Mapping[int, Tool] = field(default_factory=dict)
    surface_speed: SurfaceSpeed | None = None
    also: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        known = (*TABLES, LINUXCNC)
        if not set(self.also) <= set(known):
            raise ValueError(f"also: expected names out of {', '.join(known)}, got {', '.join(self.also)}")


@dataclass(frozen=True)
class Posted:
    """What was made.

    Attributes:
        program: the motion program, or the first of its parts.
        files: everything that was written, the program included.
        report: the content of the report file.
        diagnostics: warnings.
    """

    program: Path
    files: tuple[Path, ...]
    report: dict[str, Any]
    diagnostics: Findings


@dataclass
class _Run:
    """One run through the pipeline: says what it does, times it, and stops at errors."""

    log: Log
    warnings: list[Diagnostic] = field(default_factory=list)

    def accept(self, diagnostics: Findings) -> None:
        """Keep warnings, stop at errors."""
        if errors(diagnostics):
            raise Refused((*self.warnings, *diagnostics))
        self.warnings.extend(diagnostics)

    def value(self, result: tuple[T | None, Findings]) -> T:
        """The value of a step that may have found faults."""
        value, diagnostics = result
        self.accept(diagnostics)
        if value is None:
            raise ValueError("expected a value or an error, got neither")
        return value

    @contextlib.contextmanager
    def step(self, name: str) -> Iterator[list[str]]:
        """Log a step with its time and what it adds to the list."""
        told: list[str] = []
        begin = time.perf_counter()
        yield told
        self.log(f"{name:<22}{time.perf_counter() - begin:7.2f} s   {', '.join(told)}")


def post(
    program: Program | None,
    machine: Machine | None,
    program_path: Path,
    options: Options | None = None,
    log: Log = quiet,
    found: Findings = (),
) -> Posted:
    """Make a certified motion program, with its trajectory, set-up file and report beside it.

    Args:
        program: cutter locations in {C}; None if what it was to be read from has errors.
        machine: the machine to run it on; None if its file has errors.
        program_path: where the motion program goes; the other files take its stem.
        options: what the user chose.
        log: takes a line for each step.
        found: what was found in reading these; it is told with what is found here.

    Raises:
        Refused: something in the input, or the place to write to, does not allow it; nothing was written.
    """
    if program is None or machine is None or errors(found):
        raise Refused(found)
    run, options = _Run(log, list(found)), options or Options()
    try:
        with staged(program_path.parent) as folder:
            report = _post(run, program, machine, folder / program_path.name, options)
            names = sorted(path.name for path in folder.iterdir())
    except OSError as fault:
        raise Refused([*run.warnings, Diagnostic("F101", Place(str(program_path)), str(fault))]) from fault
    files = tuple(program_path.parent / name for name in names)
    return Posted(program_path, files, report, tuple(run.warnings))


def _post(run: _Run, program: Program, machine: Machine, path: Path, options: Options) -> dict[str, Any]:
    """The steps in their order, on one screen; files go to the folder of ``path``."""
    tolerances = Tolerances(options.tip_tolerance, options.axis_tolerance)
    controller = run.value(controller_of(machine))
    settings = run.value(controller.settings_of(machine))

    with run.step("trajectory") as told:
        placed = run.value(trajectory_of(program, machine, options))
        stored = path.with_suffix(".pkmt")
        trajectory_file.write(replace(placed, tolerances=tolerances), stored)
        trajectory = run.value(trajectory_file.read(stored))
        told.append(f"{len(trajectory)} segments")

    with run.step("reach and feed plan") as told:
        tool_path = planning.tool_path(trajectory, tolerances)
        schedule, faults = planning.plan_feed(tool_path, trajectory, machine)
        run.accept(faults)
        told.append(f"{schedule.rests_ms[-1] / 1000:.1f} s of motion")

    with run.step("interpolation") as told:
        motion = planning.interpolate(tool_path, schedule, trajectory.events, machine, tolerances)
        struts = planning.strut_motion(motion, machine)
        run.accept(controller.faults(struts, settings, path.name))
        told.append(f"{len(motion)} points")

    with run.step("motion program") as told:
        parts = controller.program_parts(struts, settings, summary.heading(trajectory))
        names = outputs.write_parts(path, parts)
        setup = controller.setup_text(settings, machine.name, machine.strut_stroke)
        if setup is not None:
            outputs.write_parts(path.with_name(path.stem + controller.SETUP_SUFFIX), (setup,))
        told.append(f"{sum(map(len, parts)) / 1e6:.1f} MB" + f" in {len(parts)} parts" * (len(parts) > 1))

    with run.step("certificate") as told:
        played = run.value(controller.read_parts(outputs.read_parts(path, names), settings))
        certificate = run.value(certify(played, path.name, trajectory, machine, motion, tolerances))
        told.append(f"{certificate.instants} poses by forward kinematics")

    with run.step("report") as told:
        report = summary.report(trajectory, machine, certificate, tolerances, played, motion)
        summary.write(report, path.with_name(f"{path.stem}-report.json"))
        picture = path.with_name(f"{path.stem}-report.png")
        run.accept(plots.draw(picture, trajectory, machine, motion, played, certificate, tolerances))
        told.extend(summary.verdict(certificate))

    for name in options.also:
        with run.step(f"also {name}") as told:
            if name == LINUXCNC:
                run.accept(outputs.write_for_linuxcnc(path, trajectory))
            else:
                # the last line of the heading speaks of the program
                found, faults = outputs.write_table(path, TABLES[name], played, summary.heading(trajectory)[:-1])
                run.accept(faults)
                told.append(found)
    return report


def trajectory_of(program: Program, machine: Machine, options: Options) -> tuple[Trajectory | None, Findings]:
    """The program compensated, on the machine, with its spin; or what stands against it."""
    offset, told = work_offset(machine, options)
    moved, faults = compensate(program, options.contours, options.actual_tools)
    told += faults
    if offset is None or moved is None:
        return None, told
    if options.surface_speed is not None:
        limits = machine.spindle_least_speed, machine.spindle_speed
        moved, faults = with_surface_speed(moved, options.surface_speed, limits)
        told += faults
        if moved is None:
            return None, told
    placed, faults = place(moved, machine, offset)
    told += faults
    if placed is None:
        return None, told
    turned, faults = with_spin(placed, machine, options.spin)
    return turned, told + faults


def work_offset(machine: Machine, options: Options) -> tuple[Array | None, Findings]:
    """The work offset that was chosen, (4, 4), or why there is none."""
    chosen = options.work_offset
    if not isinstance(chosen, str):
        return np.asarray(chosen, dtype=np.float64), ()
    if chosen not in machine.work_offsets:
        known = ", ".join(sorted(machine.work_offsets))
        return None, (Diagnostic("K108", Place(machine.name), f"{chosen}, the machine file has {known}"),)
    return machine.work_offsets[chosen], ()
