# SPDX-License-Identifier: LGPL-2.1-or-later
"""Variables: the Q-variables of the kinematic programs, with the values of a machine.

Input: a machine in mm and rad. Output: number, value and meaning of each variable that is set when the programs are
loaded, in mm and degrees; and the numbers of the programs' working variables. Both controllers use the same numbers.
Q1 to Q19 are reserved on the Turbo PMAC [Turbo PMAC User Manual, Reserved Variables, p. 261]; Q0 is an argument of its
ATAN2.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import NamedTuple

from pkm_post.model import Machine


class QVariable(NamedTuple):
    """A variable read by the programs.

    Attributes:
        name: name in the formulas.
        number: of the Q-variable.
        value: in mm or degrees.
        meaning: for the comment beside it.
    """

    name: str
    number: int
    value: float
    meaning: str


FIRST_NUMBER, LAST_NUMBER = 50, 511
"""First and last Q-variable of the programs; a Turbo PMAC with 16 coordinate systems has
Q0 to Q511 in each."""
_FIRST_STRUT, _PER_STRUT = 100, 20
_FIRST_OF_INVERSE, _FIRST_OF_FORWARD = 220, 300

COORDINATES = ("x", "y", "z")
AXES = ("x", "y", "z", "a", "b", "c")
STRUTS = range(1, 7)

_LEAST_PIVOT = 1e-9
"""Pivots of a regular system are near 1 in mm and degrees."""


def parameters(machine: Machine, tool_length: float, tolerance: float, most_steps: int) -> list[QVariable]:
    """The variables set when the programs are loaded, in the order of their numbers.

    Args:
        machine: geometry, screw and counts.
        tool_length: initial gauge length, mm.
        tolerance: strut error at which the forward program ends, mm.
        most_steps: largest number of steps of the forward program.
    """
    return [*_of_machine(machine, tool_length, tolerance, most_steps), *_of_struts(machine)]


def _of_machine(machine: Machine, tool_length: float, tolerance: float, most_steps: int) -> list[QVariable]:
    x, y, z = (float(value) for value in machine.home_tip)
    rows = (
        ("tool_length", tool_length, "gauge length of the tool in the spindle, mm"),
        ("work_x", 0.0, "origin of the work frame in {M}, mm"),
        ("work_y", 0.0, ""),
        ("work_z", 0.0, ""),
        ("work_c", 0.0, "rotation of the work frame about Z of {M}, degrees"),
        ("nose", machine.spindle_nose, "from the plane of the platform joints to the spindle nose, mm"),
        ("counts_per_mm", float(machine.controller["counts_per_mm"]), "counts of a motor per mm of its strut"),
        ("lead_per_degree", machine.screw_lead / 360.0, "travel of the nut per degree of twist, mm"),
        ("lead_per_radian", machine.screw_lead / math.tau, "the same per radian"),
        ("tolerance", tolerance, "strut error at which the forward program ends, mm"),
        ("most_steps", float(most_steps), "most steps of the forward program"),
        ("least_pivot", _LEAST_PIVOT, "pivot below which a pose counts as singular"),
        ("start_x", x, "tip in {M} where the forward program starts, tool upright, mm"),
        ("start_y", y, ""),
        ("start_z", z, ""),
    )
    return [QVariable(name, FIRST_NUMBER + row, value, text) for row, (name, value, text) in enumerate(rows)]


def _of_struts(machine: Machine) -> list[QVariable]:
    zero = machine.controller["zero_length"]
    found = []
    for strut in STRUTS:
        row = strut - 1
        points = (machine.base_joints[row], machine.platform_joints[row])
        axes = (machine.base_axes[row], machine.platform_axes[row])
        names = [f"{point}_{axis}" for point in ("base", "platform") for axis in COORDINATES]
        values = [float(value) for point in points for value in point]
        names += ["offset", "zero"]
        values += [float(machine.length_offset[row]), float(zero[row])]
        if machine.screw_lead != 0.0:
            names += [f"{joint}_axis_{axis}" for joint in ("base", "platform") for axis in COORDINATES]
            values += [float(value) for axis in axes for value in axis]
        first = _FIRST_STRUT + _PER_STRUT * row
        for place, (name, value) in enumerate(zip(names, values, strict=True)):
            found.append(QVariable(f"{name}{strut}", first + place, value, _MEANINGS.get(name, "").format(strut=strut)))
    return found


_MEANINGS = {
    "base_x": "strut {strut}: base joint in {{M}}, mm",
    "platform_x": "strut {strut}: platform joint in {{T}}, mm",
    "offset": "strut {strut}: joint distance less counted length, mm",
    "zero": "strut {strut}: counted length where its motor counts zero, mm",
    "base_axis_x": "strut {strut}: axis of the base joint that is fixed to the base",
    "platform_axis_x": "strut {strut}: axis of the platform joint that is fixed to the platform",
}

OUTCOMES = ("outcome", "steps")
"""Results of the forward program: 0 if a pose was found, else 1; and the number of steps."""


def work_numbers(names: Iterable[str], forward: bool) -> dict[str, int]:
    """Working Q-variables of a program, by name; the two programs share none.

    A query of axis positions may start the forward program while the inverse program runs.

    Args:
        names: in the order of their first assignment; repetitions are ignored.
        forward: whether it is the forward program, whose outcomes come first.

    Raises:
        ValueError: there are more names than variables.
    """
    first, last = (_FIRST_OF_FORWARD, LAST_NUMBER) if forward else (_FIRST_OF_INVERSE, _FIRST_OF_FORWARD - 1)
    numbers = {name: first + place for place, name in enumerate(dict.fromkeys([*OUTCOMES * forward, *names]))}
    if max(numbers.values()) > last:
        raise ValueError(f"names: expected at most {last - first + 1}, got {len(numbers)}")
    return numbers
