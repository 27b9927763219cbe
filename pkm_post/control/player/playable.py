# SPDX-License-Identifier: LGPL-2.1-or-later
"""Playable: read a trajectory file to play on a machine, and find the row to start at.

Input: a file, a machine, a line. Output: the trajectory, its tolerances and a row; or the reasons against it.
"""

from __future__ import annotations

from pathlib import Path

from pkm_post.certificate import machine_fault, values_beyond_machine
from pkm_post.control.player.stop_events import TOLERANCES
from pkm_post.machine import find_collisions
from pkm_post.model import Diagnostic, Diagnostics, Machine, Place, Setup, Tolerances, Trajectory, errors, threads
from pkm_post.toolpath import (
    MachineOffsets,
    StartLine,
    lines_to_begin_at,
    not_repeated,
    row_of_line,
    with_machine_offsets,
)
from pkm_post.writing import manifest, trajectory_file


def read_playable(
    file: Path, machine: Machine, offsets: MachineOffsets | None = None
) -> tuple[Trajectory | None, Tolerances | None, Diagnostics]:
    """Read a trajectory and the tolerances it was made for, or the reasons against playing it.

    Args:
        file: a trajectory file.
        offsets: changes at the machine since the posting; none by default.
    """
    trajectory, faults = trajectory_file.read(file)
    if trajectory is None or errors(faults):
        return None, None, faults
    another, place = machine_fault(trajectory, machine, str(file)), Place(str(file))
    if another is not None:
        return None, None, (*faults, another)
    faults += manifest.check(file)[1]
    faults += tuple(Diagnostic("T107", at, found) for at, found in values_beyond_machine(trajectory, machine))
    if trajectory.tolerances is None:
        faults += (Diagnostic("T105", place, "none"),)
    faults += thread_faults(trajectory, file)
    if errors(faults):
        return None, None, faults
    moved, found = with_machine_offsets(trajectory, machine, offsets or MachineOffsets())
    return moved, trajectory.tolerances, (*faults, *found)


def collisions_at_offsets(
    trajectory: Trajectory, machine: Machine, offsets: MachineOffsets, setup: Setup
) -> Diagnostics:
    """Collisions of a whole trajectory, with these offsets; none without offsets: the posting has looked for them."""
    if offsets.is_empty or setup.is_empty:
        return ()
    return find_collisions(trajectory, machine, setup, trajectory.tolerances or TOLERANCES).faults


def thread_faults(trajectory: Trajectory, file: Path) -> Diagnostics:
    """C208 for a trajectory with threads: the player has no axis for the spindle."""
    found = threads(trajectory.events)
    return (Diagnostic("C208", Place(str(file)), f"{len(found)} of them"),) if found else ()


def first_row(
    trajectory: Trajectory, line: int, operation: str, file: Path, repeat_codes: bool = False
) -> tuple[int | None, Diagnostics]:
    """The row at which to start for a line of the source, with codes not repeated (K152); or None with the reason.

    Args:
        line: line, or number of the command, in the source.
        operation: its name; empty for the first one with such a line.
        file: of the trajectory, for the diagnostic.
        repeat_codes: whether earlier machine-specific M codes are repeated.
    """
    row = row_of_line(trajectory, StartLine(line, operation))
    if row is not None:
        return row, not_repeated(trajectory, row) if row and not repeat_codes else ()
    place = Place(str(file), operation, line)
    return None, (Diagnostic("C207", place, lines_to_begin_at(trajectory)),)
