# SPDX-License-Identifier: LGPL-2.1-or-later
"""Playable: a trajectory file that can be played on a machine, and where in it to begin.

Enters: a file, a machine, a line. Leaves: the trajectory, its tolerances and a row; or what is against it.
"""

from __future__ import annotations

import math
from pathlib import Path

from pkm_post.certificate import machine_fault, values_beyond_machine
from pkm_post.model import Diagnostic, Machine, Place, Tolerances, Trajectory, errors
from pkm_post.toolpath import StartLine, row_of_line
from pkm_post.writing import trajectory_file

Findings = tuple[Diagnostic, ...]


def read_playable(file: Path, machine: Machine) -> tuple[Trajectory | None, Tolerances | None, Findings]:
    """A trajectory and the tolerances it was made for, or what is against playing it.

    Args:
        file: a trajectory file.
        machine: the machine to play it on.
    """
    trajectory, faults = trajectory_file.read(file)
    if trajectory is None or errors(faults):
        return None, None, faults
    another, place = machine_fault(trajectory, machine, str(file)), Place(str(file))
    if another is not None:
        return None, None, (*faults, another)
    faults += tuple(Diagnostic("T107", at, found) for at, found in values_beyond_machine(trajectory, machine))
    if trajectory.tolerances is None:
        faults += (Diagnostic("T105", place, "none"),)
    if math.isfinite(machine.strut_jerk) or math.isfinite(machine.tip_jerk):
        limits = f"struts {machine.strut_jerk:g} mm/s^3, tip {machine.tip_jerk:g} mm/s^3"
        faults += (Diagnostic("C206", Place(machine.name), limits),)
    return (None, None, faults) if errors(faults) else (trajectory, trajectory.tolerances, faults)


def first_row(trajectory: Trajectory, line: int, operation: str, file: Path) -> tuple[int | None, Findings]:
    """The row to begin with for a line of the source, or that there is none.

    Args:
        trajectory: the program.
        line: line, or number of the command, in the source.
        operation: its name; empty for the first one with such a line.
        file: of the trajectory, for the diagnostic.
    """
    row = row_of_line(trajectory, StartLine(line, operation))
    if row is not None:
        return row, ()
    place = Place(str(file), operation, line)
    return None, (Diagnostic("C207", place, f"operations {', '.join(trajectory.operations) or 'without a name'}"),)
