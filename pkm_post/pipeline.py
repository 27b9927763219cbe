# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pipeline: the one way through the house, from a program to files that a controller and a person can use.

This module alone knows the order of the steps. Either every file is written and certified, or none is there.
"""

from __future__ import annotations

import contextlib
import math
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from pkm_post import planning, trajectory_file
from pkm_post.certificate import certify
from pkm_post.controllers import pmac
from pkm_post.files import staged
from pkm_post.geometry.vectors import Array
from pkm_post.model import Diagnostic, Machine, Place, Program, Refused
from pkm_post.model.diagnostics import errors
from pkm_post.model.findings import Tolerances
from pkm_post.placement import place
from pkm_post.report import plots, summary
from pkm_post.spin import ZERO_TORSION, Policy, with_spin

T = TypeVar("T")
Findings = tuple[Diagnostic, ...]
Log = Callable[[str], None]

SUFFIX = ".pmc"
"""How the name of a motion program ends."""


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
    """

    work_offset: str | Array = "G54"
    tip_tolerance: float = 1e-3
    axis_tolerance: float = math.radians(1e-3)
    spin: Policy = ZERO_TORSION


@dataclass(frozen=True)
class Posted:
    """What was made.

    Attributes:
        program: the motion program.
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
    settings = run.value(pmac.settings_of(machine))

    with run.step("trajectory") as told:
        placed = run.value(place(program, machine, run.value(work_offset(machine, options))))
        placed = run.value(with_spin(placed, machine, options.spin))
        stored = path.with_suffix(".pkmt")
        trajectory_file.write(placed, stored)
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
        run.accept(
            pmac.event_faults(struts, settings.codes, path.name) + pmac.memory_faults(struts, settings, path.name)
        )
        told.append(f"{len(motion)} points")

    with run.step("motion program") as told:
        text = pmac.program_text(struts, settings, summary.heading(trajectory))
        path.write_text(text, encoding="ascii", newline="\n")
        setup = path.with_name(f"{path.stem}-setup.pmc")
        setup.write_text(pmac.setup_text(settings, machine.name, machine.strut_stroke), encoding="ascii", newline="\n")
        told.append(f"{len(text) / 1e6:.1f} MB")

    with run.step("certificate") as told:
        played = run.value(pmac.read_program(path.read_text(encoding="ascii"), settings, path.name))
        certificate = run.value(certify(played, path.name, trajectory, machine, motion, tolerances))
        told.append(f"{certificate.instants} poses by forward kinematics")

    with run.step("report") as told:
        report = summary.report(trajectory, machine, certificate, tolerances, played)
        summary.write(report, path.with_name(f"{path.stem}-report.json"))
        picture = path.with_name(f"{path.stem}-report.png")
        run.accept(plots.draw(picture, trajectory, machine, motion, played, certificate, tolerances))
        told.extend(summary.verdict(certificate))
    return report


def work_offset(machine: Machine, options: Options) -> tuple[Array | None, Findings]:
    """The work offset that was chosen, (4, 4), or why there is none."""
    chosen = options.work_offset
    if not isinstance(chosen, str):
        return np.asarray(chosen, dtype=np.float64), ()
    if chosen not in machine.work_offsets:
        known = ", ".join(sorted(machine.work_offsets))
        return None, (Diagnostic("K108", Place(machine.name), f"{chosen}, the machine file has {known}"),)
    return machine.work_offsets[chosen], ()
