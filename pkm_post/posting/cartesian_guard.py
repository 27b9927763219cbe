# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cartesian guard: a program of tip and axis ends before its first move on a controller that is set up otherwise.

The guard looks at the switch of the kinematics (Isx50), the gauge length in Q50 and the work frame in Q51 to Q54. What
may be changed at the machine without posting again is an allowance: up to that far from what the program was made for
it runs, and its certificate holds at every corner of the allowance. ``RETURN`` outside of a subroutine ends a program,
and the next ``R`` begins at its beginning [Turbo PMAC Software Reference, RETURN].

A work frame that is shifted by d is the same as base joints that are shifted by -d, and a tool that is longer the same
as a longer spindle nose: so the corners are machines.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from pkm_post.model import Machine
from pkm_post.writing import PmacSettings

_SAME_MM, _SAME_DEG = 0.0005, 0.00001
"""Half a micrometre, and 10 um at a distance of 57 m: what the variables may be off where nothing is allowed."""


@dataclass(frozen=True)
class Allowance:
    """How far values at the machine may be from those that a program was made for, to either side.

    Attributes:
        tool_length: of the gauge length, mm.
        origin: of the origin of the work frame along X, Y and Z each, mm.
    """

    tool_length: float = 0.0
    origin: float = 0.0

    def __post_init__(self) -> None:
        if not (self.tool_length >= 0 and self.origin >= 0):
            raise ValueError(f"expected 0 mm or more, got {self.tool_length:g} and {self.origin:g}")

    def words(self, tool_length: float) -> str:
        """What the variables may be, for the heading of a program."""
        origin = f"Q51 to Q53 up to {self.origin:g} from zero" if self.origin else "Q51 to Q53 zero"
        length = f"Q50={tool_length:g}" + (f" up to {self.tool_length:g} more or less" if self.tool_length else "")
        return f"{length}, {origin}, Q54 zero" if self.origin else f"{length} and Q51 to Q54 zero"

    def corners(self, machine: Machine) -> Iterator[tuple[str, Machine]]:
        """Each corner of the allowance in words, and the machine that moves as the controller then does."""
        shifts = (-self.origin, self.origin) if self.origin else (0.0,)
        lengths = (-self.tool_length, self.tool_length) if self.tool_length else (0.0,)
        for *shift, longer in product(shifts, shifts, shifts, lengths):
            if any(shift) or longer:
                words = f"work frame at {', '.join(f'{value:+g}' for value in shift)}, tool {longer:+g} mm"
                base = machine.base_joints - np.array(shift)
                yield words, replace(machine, base_joints=base, spindle_nose=machine.spindle_nose + longer)


def guard_lines(settings: PmacSettings, tool_length: float, allowance: Allowance) -> tuple[str, ...]:
    """The lines of the guard, in front of everything else in the program."""
    length, origin = max(allowance.tool_length, _SAME_MM), max(allowance.origin, _SAME_MM)
    switch = f"I{50 + settings.coordinate_system}50"
    beside = " OR ".join(f"ABS(Q{number})>{origin:.4f}" for number in (51, 52, 53))
    checks = (
        (f"{switch}!=1", f"KINEMATICS ARE OFF: {switch}"),
        (f"Q50<{tool_length - length:.4f} OR Q50>{tool_length + length:.4f}", "ANOTHER TOOL LENGTH: Q50"),
        (beside, "ANOTHER WORK FRAME: Q51 TO Q53"),
        (f"ABS(Q54)>{_SAME_DEG:.5f}", "ANOTHER WORK FRAME: Q54"),
    )
    return tuple(
        line for condition, words in checks for line in (f"IF ({condition})", f'SEND"{words}"', "RETURN", "ENDIF")
    )


def guarded(text: str, opening: str, lines: tuple[str, ...]) -> str:
    """A program with its guard behind the opening of its buffer.

    Raises:
        ValueError: the program does not have the opening once.
    """
    if text.count(opening) != 1:
        raise ValueError(f"text: expected {opening!r} once, got it {text.count(opening)} times")
    return text.replace(opening, opening + "".join(f"{line}\n" for line in lines))


def unguarded(text: str, opening: str, lines: tuple[str, ...]) -> str:
    """A program that was read, without its guard.

    Raises:
        ValueError: the guard is not there, or not in front of everything else.
    """
    expected = opening + "".join(f"{line}\n" for line in lines)
    if text.count(expected) != 1:
        raise ValueError(f"text: expected the guard once, got it {text.count(expected)} times")
    return text.replace(expected, opening)
