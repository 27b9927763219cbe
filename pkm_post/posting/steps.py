# SPDX-License-Identifier: LGPL-2.1-or-later
"""Steps: the order of the steps from a program to files, and the steps themselves.

Input: a program and a machine. Output: the files, all of them or none. A step takes the results of earlier steps and
the context that all steps share.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

from pkm_post.certificate import certify
from pkm_post.geometry import Array
from pkm_post.machine import Collisions, find_collisions, setup_names
from pkm_post.model import (
    Certificate,
    Coverage,
    Diagnostic,
    Diagnostics,
    FeedStudy,
    Machine,
    Motion,
    Phrase,
    Place,
    Program,
    Refused,
    Setup,
    StrutMotion,
    Trajectory,
    errors,
    threads,
)
from pkm_post.options import CARTESIAN, LINUXCNC, PICTURE, Options
from pkm_post.planning import FeedPlan, Plan, interpolate, plan_feed, slow_corners
from pkm_post.posting.placement import effective_setup, trajectory_of, turn_about_z
from pkm_post.posting.run import CollisionSearch, Log, PostContext, Posted, Progress, Run, no_log, no_progress
from pkm_post.report import Results, summary, write_page
from pkm_post.system import in_background, memory_guard, require_usable, result_files, staged, write_fault
from pkm_post.toolpath import with_optional_stops
from pkm_post.writing import TABLES, controller_settings, manifest, outputs, program_files, read_texts, trajectory_file

SUFFIX = result_files.PROGRAM
"""Suffix of a motion program."""
_TRAJECTORY, _FEED_PLAN, _INTERPOLATION = "trajectory", "reach and feed plan", "interpolation"
_COLLISIONS = "collisions"
_PROGRAM, _CERTIFICATE, _REPORT = "motion program", "certificate", "report"
_SHARES = {
    _TRAJECTORY: 0.1, _FEED_PLAN: 1.0, _COLLISIONS: 1.0, _INTERPOLATION: 1.5, _PROGRAM: 0.1, _CERTIFICATE: 1.0,
    _REPORT: 1.0,
}  # fmt: skip
"""The steps in order, with their approximate relative durations."""
_SHORT = 10_000
"""Segments of a trajectory whose file is read in a few milliseconds."""
_TURNED = 1e-6
"""degrees: a smaller turn of a work offset is rounding, and not shown."""
_SHARE_OF_ANOTHER = 0.2
"""Relative duration of an additional output."""


def post(
    program: Program | None,
    machine: Machine | None,
    program_path: Path,
    options: Options | None = None,
    log: Log = no_log,
    found: Diagnostics = (),
    progress: Progress = no_progress,
    search: CollisionSearch = find_collisions,
) -> Posted:
    """Make a certified motion program, with its trajectory, set-up file and report beside it.

    Args:
        program: cutter locations in {C}; None if its source has errors.
        machine: the machine to run it on; None if its file has errors.
        program_path: path of the motion program; the other files take its stem.
        log: receives a line for each step.
        found: diagnostics from reading these; returned with those found here.
        progress: called a few times a second; an exception from it aborts the run, and nothing is written.
        search: finds the collisions with part, stock and fixtures, or returns those known for the same inputs.

    Raises:
        Refused: the input has an error, or the folder is not writable; nothing is written.
    """
    options = options or Options()
    setup, faults = effective_setup(options, program)
    found = (*found, *faults)
    if program is None or machine is None or errors(found):
        raise Refused(found)
    program = with_optional_stops(program, options.optional_stops or machine.optional_stops)
    run = Run(log, progress, _shares(options), list(found))
    try:
        require_usable(program_path.name)
        results = staged(program_path.parent, manifest.manifest_name(program_path.stem))
        with memory_guard(str(program_path)), results as folder:
            settings = run.value(controller_settings(machine))
            context = PostContext(folder / program_path.name, machine, *settings, options, search)
            parts, report = _all_steps(run, context, program, setup)
            with run.goes_on():
                manifest.write(folder, program_path.stem, {context.trajectory.name: context.trajectory_hash})
            run.end()
            posted = _posted(run, program_path, sorted(os.listdir(folder)), parts, report)
    except OSError as fault:
        if fault is run.raised_outside:
            raise
        raise Refused([*run.warnings, write_fault(program_path, fault)]) from fault
    gone = [path for path in posted.files if not path.is_file()]
    run.accept(tuple(Diagnostic("F142", Place(str(path)), Phrase("it was written")) for path in gone))
    return posted


def _posted(run: Run, program_path: Path, names: list[str], parts: list[str], report: dict[str, Any]) -> Posted:
    """The result, made before the files appear, so that nothing can fail afterwards."""
    earlier = manifest.listed(program_path.parent, program_path.stem)
    run.accept(outputs.left_over(program_path, names, earlier))
    files, programs = (tuple(program_path.parent / name for name in each) for each in (names, parts))
    return Posted(program_path, files, report, tuple(run.warnings), programs)


def step_names(options: Options | None = None) -> tuple[str, ...]:
    """The steps of a run with these options, in order."""
    return tuple(_shares(options or Options()))


def _shares(options: Options) -> dict[str, float]:
    return _SHARES | {_another(name): _SHARE_OF_ANOTHER for name in options.also}


def _another(name: str) -> str:
    return f"also {name}"


def _all_steps(run: Run, context: PostContext, program: Program, setup: Setup) -> tuple[list[str], dict[str, Any]]:
    """Run the steps in order; return the names of the parts of the program, and the content of the report."""
    trajectory = _stored_trajectory(run, context, program)
    motion, feed, names, covered = _written_program(run, context, trajectory, setup)
    played, certificate, files = _certificate(run, context, trajectory, motion, covered)
    results = Results(
        trajectory, context.machine, motion, played, certificate, context.tolerances, feed, program.reading, files,
        setup, _work_offset(context), context.options.report_unit, context.options.report_date,
    )  # fmt: skip
    report = _report(run, context, results)
    for name in context.options.also:
        _write_another(run, context, name, results)
    return names, report


def _stored_trajectory(run: Run, context: PostContext, program: Program) -> Trajectory:
    """The trajectory as read back from its file: the plan is made from the stored data."""
    with run.step(_TRAJECTORY) as notes:
        trajectory = run.value(trajectory_file.read(_store(run, context, program)))
        run.accept(_outputs_without_threads(trajectory, context.options))
        notes.append(f"{len(trajectory)} segments")
        turn = turn_about_z(trajectory.machine_from_work)
        if abs(turn) > _TURNED:  # as in 0,0,250,5 with a decimal comma
            notes.append(f"work offset turned by {turn:.6g} degrees about z")
    return trajectory


def _outputs_without_threads(trajectory: Trajectory, options: Options) -> Diagnostics:
    """K157 for outputs whose format has no spindle as an axis."""
    others = [f"--also {name}" for name in options.also if name != PICTURE]
    if not others or not (found := threads(trajectory.events)):
        return ()
    return (Diagnostic("K157", trajectory.place(found[0].first), f"with {', '.join(others)}"),)


def _store(run: Run, context: PostContext, program: Program) -> Path:
    """Place a program and write its trajectory; return the path of the file."""
    placed = run.value(trajectory_of(program, context.machine, context.options))
    trajectory_file.write_in_private(replace(placed, tolerances=context.tolerances), context.trajectory)
    return context.trajectory


def _written_program(
    run: Run, context: PostContext, trajectory: Trajectory, setup: Setup
) -> tuple[Motion, FeedStudy, list[str], tuple[Coverage, ...]]:
    """Plan and write the program: its motion and feed, the names of its parts, and the coverage.

    Schedule and struts are freed before the program is read back: a long one needs the memory.
    """
    plan, covered = _planned(run, context, trajectory, setup)
    return plan.motion, plan.feed, _motion_program(run, context, trajectory, plan.struts), covered


def _planned(run: Run, context: PostContext, trajectory: Trajectory, setup: Setup) -> tuple[Plan, tuple[Coverage, ...]]:
    """Tool poses and strut lengths by time, and the coverage."""
    with (
        in_background(
            lambda: context.search(trajectory, context.machine, setup, context.tolerances), not setup.is_empty
        ) as found,
        in_background(lambda: context.trajectory_hash, len(trajectory) > _SHORT) as fingerprint,
    ):
        feed_plan = _feed_plan(run, context, trajectory)
        covered = _collisions(run, found, setup)
        fingerprint()  # cached in the context
    return _interpolation(run, context, feed_plan), covered


def _feed_plan(run: Run, context: PostContext, trajectory: Trajectory) -> FeedPlan:
    """The path with rounded corners, and its schedule."""
    with run.step(_FEED_PLAN) as notes:
        feed_plan, faults = plan_feed(trajectory, context.machine, context.tolerances)
        if errors(faults):
            from pkm_post.posting.machine_check import home_faults

            # if home itself is out of reach, moving the part does not help
            faults = (*home_faults(context.machine, context.machine.name), *faults)
        feed_plan = run.value((feed_plan, faults))
        notes.append(f"{feed_plan.schedule.rests_ms[-1] / 1000:.1f} s of motion")
    return feed_plan


def _collisions(run: Run, found: Callable[[], Collisions], setup: Setup) -> tuple[Coverage, ...]:
    """Wait for the collisions with part, stock and fixtures; return the coverage for the certificate."""
    with run.step(_COLLISIONS) as notes:
        collisions = found()
        run.accept(collisions.faults)
        notes.extend(setup_names(setup) or ["part and stock are not known"])
    return collisions.coverage


def _interpolation(run: Run, context: PostContext, feed_plan: FeedPlan) -> Plan:
    """Tool poses and strut lengths by time, valid for the controller."""
    with run.step(_INTERPOLATION) as notes:
        plan = interpolate(feed_plan)
        run.accept(slow_corners(feed_plan, plan.feed))
        run.accept(context.controller.faults(plan.struts, context.settings, context.path.name))
        notes.append(f"{len(plan.motion)} points")
    return plan


def _motion_program(run: Run, context: PostContext, trajectory: Trajectory, struts: StrutMotion) -> list[str]:
    """Write the program and the set-up it relies on; return the names of its parts."""
    with run.step(_PROGRAM) as notes:
        names = _write_parts(context, trajectory, struts)
        size = sum(context.path.with_name(name).stat().st_size for name in names)
        notes.append(f"{size / 1e6:.1f} MB" + f" in {len(names)} parts" * (len(names) > 1))
    return names


def _write_parts(context: PostContext, trajectory: Trajectory, struts: StrutMotion) -> list[str]:
    controller, settings, machine = context.controller, context.settings, context.machine
    records = program_files.source_hash_lines(context.trajectory_hash, machine.fingerprint)
    heading = [*summary.heading(trajectory), *records]
    parts = tuple(map(program_files.with_own_hash, controller.program_parts(struts, settings, heading)))
    names = outputs.write_parts(context.path, parts)
    setup = controller.setup_text(settings, machine.name, machine.strut_stroke)
    if setup is not None:
        outputs.write_parts(context.sibling(controller.SETUP_SUFFIX), (setup,))
    return names


def write_program(
    path: Path, trajectory: Trajectory, plan: Plan, machine: Machine
) -> tuple[list[str] | None, Diagnostics]:
    """Write a trajectory and its plan: trajectory file, motion program and its set-up file.

    Args:
        path: of the program; the other files take its stem.
        plan: strut motion by time.
        machine: its file names the controller.

    Returns:
        The names of the parts of the program, or None if the controller cannot take it; and the diagnostics.
    """
    found, faults = controller_settings(machine)
    if found is None:
        return None, faults
    context = PostContext(path, machine, *found, Options())
    faults = (*faults, *context.controller.faults(plan.struts, context.settings, path.name))
    if errors(faults):
        return None, faults
    trajectory_file.write(trajectory, context.trajectory)
    return _write_parts(context, trajectory, plan.struts), faults


def _work_offset(context: PostContext) -> tuple[str, Array]:
    """Name of the work offset, and the (4, 4) pose of {C} in {M}; a trajectory exists, so a name is valid."""
    offset = context.options.work_offset
    return (offset, context.machine.work_offsets[offset]) if isinstance(offset, str) else ("as given", offset)


def _certificate(
    run: Run, context: PostContext, trajectory: Trajectory, motion: Motion, covered: tuple[Coverage, ...]
) -> tuple[StrutMotion, Certificate, dict[str, Any]]:
    """The program read back from its text, its certificate, and the hashes of both files for the report."""
    with run.step(_CERTIFICATE) as notes:
        played, digests = _read_back(run, context)
        measured = certify(played, context.path.name, trajectory, context.machine, motion, context.tolerances, covered)
        certificate = run.value(measured)
        notes.append(f"{certificate.instants} instants")
        files = summary.hashes(digests, context.trajectory_hash)
    return played, certificate, files


def _read_back(run: Run, context: PostContext) -> tuple[StrutMotion, list[str]]:
    """The motion of the program and the hashes of its parts; the texts are freed before it is measured."""
    texts = run.value(read_texts(context.path, context.controller))
    played = run.value(context.controller.read_parts(texts, context.settings))
    return played, [program_files.program_hash(text) for _, text in texts]


def _report(run: Run, context: PostContext, results: Results) -> dict[str, Any]:
    with run.step(_REPORT) as notes:
        report = summary.report(results)
        summary.write(report, context.sibling(result_files.REPORT))
        write_page(context.sibling(result_files.PAGE), report, results)
        notes.extend(summary.verdict(results.certificate))
    run.print([*results.reading, *report["certificate"]["meaning"]])
    return report


def _write_another(run: Run, context: PostContext, name: str, results: Results) -> None:
    trajectory = results.trajectory
    with run.step(_another(name)) as notes:
        if name == LINUXCNC:
            run.accept(outputs.write_for_linuxcnc(context.path, trajectory, context.tolerances.tip))
            return
        if name == PICTURE:
            from pkm_post.report import draw_report

            run.accept(draw_report(context.sibling(result_files.PICTURE), results))
            return
        if name == CARTESIAN:
            from pkm_post.posting.cartesian_form import write_cartesian

            file = context.sibling(result_files.SIDE_OUTPUTS[CARTESIAN])
            off = write_cartesian(file, results.struts, context.trajectory, context.machine)
            notes.append(f"struts at most {off:.1e} mm from those of the program at its points")
            return
        note, faults = outputs.write_table(context.path, TABLES[name], results.struts, summary.origin(trajectory))
        run.accept(faults)
        notes.append(note)
