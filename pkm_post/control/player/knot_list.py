# SPDX-License-Identifier: LGPL-2.1-or-later
"""Knot list: the points of a motion as a linked list in P-variables of the controller, and the program that runs it.

A rotary buffer cannot replace the stop at its end by more motion once it is sent. So the points are stored in
P-variables, each with the variable of the next point, and a resident program goes from point to point:

    P(a) variable of the next point, 0 at the end     P(a+1) interval, ms
    P(a+2..7) strut lengths, mm                       P(a+8..13) strut speeds, mm/s

The program reads P(a) when it computes the move after that point. So one assignment to P(a) replaces the continuation,
completely or not at all: until then the list ends in a stop. Diamond Light Source feeds trajectories to Turbo PMACs in
a similar way, with a resident program and two buffers of points [EPICSpmac, trajectory scan].

Input: points in mm, mm/s and whole ms. Output: lines for the controller, and points parsed from lines.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from pkm_post.control.link.program import PmacProgram
from pkm_post.control.link.status import AnySettings
from pkm_post.model import StrutMotion
from pkm_post.writing import PowerPmacSettings

POINT_VARIABLES = 14
FIRST_VARIABLE, LAST_VARIABLE = 1000, 8186
"""The variables after them record the owner of the machine (``ownership``)."""
_HEAD_VARIABLES = 2
_LEAST_POINTS = 32
"""Points of two short pieces with their stops."""
_LINE = 200
"""Characters of a line: several assignments in one exchange."""
_ASSIGNMENT = re.compile(r"P(\d+)=(-?\d+(?:\.\d+)?)")


@dataclass(frozen=True)
class Layout:
    """The variables of the list.

    Attributes:
        first: number of its first P-variable: the next point to go to.
        last: number of the last usable one.
    """

    first: int = FIRST_VARIABLE
    last: int = LAST_VARIABLE

    def __post_init__(self) -> None:
        if len(self.points()) < _LEAST_POINTS:
            raise ValueError(f"first: expected room for {_LEAST_POINTS} points up to P{self.last}, got {self.first}")

    @property
    def next(self) -> int:
        """The variable of the next point to go to."""
        return self.first

    @property
    def current(self) -> int:
        """The variable of the point whose move was computed last."""
        return self.first + 1

    def points(self) -> range:
        """The first variables of all points."""
        begin = self.first + _HEAD_VARIABLES
        return range(begin, self.last + 2 - POINT_VARIABLES, POINT_VARIABLES)


def resident_program(layout: Layout, settings: AnySettings, number: int) -> PmacProgram:
    """The program that runs the list: one PVT move for each point, to its end.

    A Power PMAC uses braces for the loop, and the same variables [PowerPMAC, Script Language].
    """
    current = f"P{layout.current}"
    axes = " ".join(
        f"{letter}(P({current}+{2 + strut})):(P({current}+{8 + strut}))"
        for strut, letter in enumerate(settings.letters)
    )
    is_power = isinstance(settings, PowerPmacSettings)
    absolute, interval, dwell = ("abs", "pvt", "dwell0") if is_power else ("ABS", "PVT", "DWELL0")
    lines = (
        absolute,
        f"while(P{layout.next}>0) {{" if is_power else f"WHILE(P{layout.next}>0)",
        f"{current}=P{layout.next}",
        f"{interval}(P({current}+1))",
        axes,
        f"P{layout.next}=P({current})",
        "}" if is_power else "ENDWHILE",
        dwell,
    )
    return PmacProgram(number, lines)


def point_assignments(motion: StrutMotion, places: Sequence[int], settings: AnySettings) -> list[str]:
    """Assignments for the points of a motion after its first, with the last one as the end of the list.

    Args:
        motion: M points.
        places: (M - 1,) the first variable of each point but the first.
        settings: state the decimals.
    """
    found = []
    following = [*places[1:], 0]
    intervals = (motion.time_ms[1:] - motion.time_ms[:-1]).tolist()
    lengths, speeds = motion.length[1:].tolist(), motion.speed[1:].tolist()
    for place, after, ms, length, speed in zip(places, following, intervals, lengths, speeds, strict=True):
        found += [f"P{place}={after}", f"P{place + 1}={ms}"]
        found += [f"P{place + 2 + n}={_number(value, settings.length_decimals)}" for n, value in enumerate(length)]
        found += [f"P{place + 8 + n}={_number(value, settings.speed_decimals)}" for n, value in enumerate(speed)]
    return found


def _number(value: float, decimals: int) -> str:
    return f"{round(value, decimals) + 0.0:.{decimals}f}"


def assignment_lines(assignments: Iterable[str]) -> Iterator[str]:
    """Lines with as many assignments as fit."""
    line = ""
    for one in assignments:
        if line and len(line) + 1 + len(one) > _LINE:
            yield line
            line = ""
        line = f"{line} {one}" if line else one
    if line:
        yield line


def read_assignments(lines: Iterable[str]) -> dict[int, str]:
    """The values that lines assign to P-variables, as written.

    Raises:
        ValueError: a line is not a list of assignments.
    """
    found: dict[int, str] = {}
    for line in lines:
        for one in line.split():
            match = _ASSIGNMENT.fullmatch(one)
            if match is None:
                raise ValueError(f"line: expected assignments to P-variables, got {one!r}")
            found[int(match[1])] = match[2]
    return found
