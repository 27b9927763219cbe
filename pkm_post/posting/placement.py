# SPDX-License-Identifier: LGPL-2.1-or-later
"""Placement: a program as a trajectory on its machine, with its set-up of part, stock and fixtures, and its checks.

Input: a program in {C}, a machine and the options. Output: the compensated trajectory on the machine, in {M}, with its
spin; the effective set-up, where files named by the user override those of the job; the margins and findings of the
trajectory; or diagnostics.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from pkm_post.geometry import Array
from pkm_post.machine import ReachReport, check_reach, find_collisions, placed_workpiece, with_spin
from pkm_post.model import Diagnostic, Diagnostics, Machine, Mesh, Phrase, Place, Program, Setup, Tolerances, Trajectory
from pkm_post.options import NO_MESH, Options
from pkm_post.posting.run import CollisionSearch
from pkm_post.toolpath import compensate, place, with_copies

if TYPE_CHECKING:
    from concurrent.futures import Executor


def trajectory_of(
    program: Program, machine: Machine, options: Options, executor: Executor | None = None
) -> tuple[Trajectory | None, Diagnostics]:
    """Compensate a program and place it with its copies and spin on the machine; or None with diagnostics.

    An executor, if given, distributes the search for the spin.
    """
    offset, diagnostics = work_offset(machine, options)
    moved, faults = compensate(program, options.contours, options.actual_tools)
    diagnostics += faults
    if offset is None or moved is None:
        return None, diagnostics
    moved, faults = with_copies(moved, options.copies)
    diagnostics += faults
    if moved is None:
        return None, diagnostics
    if options.surface_speed is not None:
        from pkm_post.toolpath import with_surface_speed

        limits = machine.spindle_least_speed, machine.spindle_speed
        moved, faults = with_surface_speed(moved, options.surface_speed, limits)
        diagnostics += faults
        if moved is None:
            return None, diagnostics
    placed, faults = place(moved, machine, offset, options.setup.shanks)
    diagnostics += faults
    if placed is None:
        return None, diagnostics
    turned, faults = with_spin(placed, machine, options.spin, executor)
    diagnostics += faults
    if turned is None or options.from_line is None:
        return turned, diagnostics
    from pkm_post.toolpath import started_at_line

    begun, faults = started_at_line(turned, options.from_line, machine)
    return begun, diagnostics + faults


def work_offset(machine: Machine, options: Options) -> tuple[Array | None, Diagnostics]:
    """The chosen work offset, (4, 4), or None with diagnostics."""
    chosen = options.work_offset
    if not isinstance(chosen, str):
        return np.asarray(chosen, dtype=np.float64), ()
    if chosen not in machine.work_offsets:
        known = ", ".join(sorted(machine.work_offsets))
        return None, (Diagnostic("K108", Place(machine.name), Phrase("{}, the machine file has {}", chosen, known)),)
    return machine.work_offsets[chosen], ()


def effective_setup(options: Options, program: Program | None) -> tuple[Setup, Diagnostics]:
    """The set-up of a program, and diagnostics of its files.

    Args:
        options: the files, and the set-up of the job.
        program: has the tools with unknown corners, which a trajectory file does not store; None if it has errors.
    """
    files, diagnostics = options.mesh_files, list[Diagnostic]()

    def read(file: str | None, otherwise: Mesh | None = None) -> Mesh | None:
        if file is None or file == NO_MESH:
            return otherwise if file is None else None
        from pkm_post.reading import read_mesh

        mesh, faults = read_mesh(file)
        diagnostics.extend(faults)
        return mesh

    fixtures = tuple(mesh for mesh in map(read, files.fixtures) if mesh is not None)
    tools = program.tools.values() if program is not None else ()
    known = options.setup
    setup = replace(
        known,
        part=read(files.part, known.part),
        stock=read(files.stock, known.stock),
        fixtures=(*known.fixtures, *fixtures),
        unknown_corners=frozenset(tool.number for tool in tools if not tool.corner_known),
    )
    return setup, tuple(diagnostics)


def check_path_of(
    trajectory: Trajectory,
    machine: Machine,
    setup: Setup,
    tolerances: Tolerances,
    search: CollisionSearch = find_collisions,
) -> tuple[ReachReport, Diagnostics]:
    """Run all checks of a trajectory on its machine.

    Args:
        trajectory: in {M}, at least one segment.
        setup: part, stock and fixtures, and the shanks of the tools.
        tolerances: allowed deviation of the tool from the trajectory.
        search: ``find_collisions``, or a function that has its result.

    Returns:
        The margins along the path, and all findings: of reach, and of collisions without a margin.
    """
    checked = check_reach(trajectory, machine, placed_workpiece(setup, trajectory))
    collisions = search(trajectory, machine, setup, tolerances)
    others = (fault for fault in collisions.faults if fault.code not in _IN_REACH)
    return checked, (*checked.faults(), *others)


_IN_REACH = ("K117", "K121")
"""Diagnostics that the margins of reach cover, too."""


def turn_about_z(machine_from_work: Array) -> float:
    """Turn of the x axis of a work offset about z, degrees; NaN if it turns about another axis."""
    if not np.allclose(machine_from_work[2, :3], [0.0, 0.0, 1.0]):
        return np.nan
    return float(np.degrees(np.arctan2(machine_from_work[1, 0], machine_from_work[0, 0])))
