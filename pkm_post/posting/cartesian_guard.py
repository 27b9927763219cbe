# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cartesian guard: a program of tip and axis ends before its first move on a controller that is set up otherwise.

The guard looks at the switch of the kinematics (Isx50; of a Power PMAC the axis definitions, and the segment time), the
gauge length in Q50 and the work frame in Q51 to Q54. A Turbo PMAC then says what is otherwise; a Power PMAC, whose form
of ``send`` is in no source that was at hand, writes a number to Q66. What may be changed at the machine without posting
again is an allowance: up to that far from what the program was made for it runs, and its certificate holds at every
corner of the allowance. ``RETURN`` outside of a subroutine ends a program, and the next ``R`` begins at its beginning
[Turbo PMAC Software Reference, RETURN; Power PMAC User's Manual, p. 692].

A work frame that is shifted by d is the same as base joints that are shifted by -d, and a tool that is longer the same
as a longer spindle nose: so the corners are machines.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from pkm_post.model import Machine
from pkm_post.writing import PmacSettings, PowerPmacSettings

_SAME_MM, _SAME_DEG = 0.0005, 0.00001
"""Half a micrometre, and 10 um at a distance of 57 m: what the variables may be off where nothing is allowed."""


ALLOWED_DECIMALS = 3
"""Of an allowance in mm: a guard has no more digits."""


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
        for value in (self.tool_length, self.origin):
            if value != round(value, ALLOWED_DECIMALS):
                raise ValueError(f"expected at most {ALLOWED_DECIMALS} decimals, got {value:g} mm")

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


@dataclass(frozen=True)
class Setting:
    """What a program of tip and axis finds at the controller where its certificate counts.

    Attributes:
        tool_length: gauge length, mm.
        allowance: how far it and the work frame may be changed.
        segment_time: of a Power PMAC, ms; 0 without segmentation.
    """

    tool_length: float
    allowance: Allowance
    segment_time: int = 0

    @property
    def lengths(self) -> tuple[str, str]:
        """Least and greatest value of Q50."""
        beside = max(self.allowance.tool_length, _SAME_MM)
        return f"{self.tool_length - beside:.4f}", f"{self.tool_length + beside:.4f}"

    @property
    def origin(self) -> str:
        """Greatest distance of Q51 to Q53 from zero."""
        return f"{max(self.allowance.origin, _SAME_MM):.4f}"


def guard_lines(settings: PmacSettings | PowerPmacSettings, setting: Setting) -> tuple[str, ...]:
    """The lines of the guard, in front of everything else in the program."""
    if isinstance(settings, PowerPmacSettings):
        return tuple(_power_lines(settings.coordinate_system, setting))
    return tuple(_turbo_lines(settings.coordinate_system, setting))


def _turbo_lines(system: int, setting: Setting) -> Iterator[str]:
    switch, (shortest, longest) = f"I{50 + system}50", setting.lengths
    beside = " OR ".join(f"ABS(Q{number})>{setting.origin}" for number in (51, 52, 53))
    checks = (
        (f"{switch}!=1", f"KINEMATICS ARE OFF: {switch}"),
        (f"Q50<{shortest} OR Q50>{longest}", "ANOTHER TOOL LENGTH: Q50"),
        (beside, "ANOTHER WORK FRAME: Q51 TO Q53"),
        (f"ABS(Q54)>{_SAME_DEG:.5f}", "ANOTHER WORK FRAME: Q54"),
    )
    for condition, words in checks:
        yield from (f"IF ({condition})", f'SEND"{words}"', "RETURN", "ENDIF")


POWER_REASONS = ("the axes are motors, so the kinematics are off", "SegMoveTime", "Q50", "Q51 to Q53", "Q54")
"""What is otherwise, by the value of Q66 from 1 on."""
_LINEAR, _REASON = "Q65", "Q66"


def _power_lines(system: int, setting: Setting) -> Iterator[str]:
    """Its scale factors are those of linear axis definitions, which a motor of the kinematics does not have.

    [Power PMAC User's Manual, p. 505: CoordSf[0] to [2] are A B C, [6] to [8] X Y Z; p. 692: return ends a program]
    """
    yield from (f"{_REASON}=0", f"{_LINEAR}=0")
    for motor in range(1, 7):
        for axes in ((0, 1, 2), (6, 7, 8)):
            factors = "+".join(f"abs(Motor[{motor}].CoordSf[{axis}])" for axis in axes)
            yield f"{_LINEAR}={_LINEAR}+{factors}"
    shortest, longest = setting.lengths
    checks = (
        f"{_LINEAR}>0",
        f"Coord[{system}].SegMoveTime!={setting.segment_time}",
        f"Q50<{shortest} || Q50>{longest}",
        " || ".join(f"abs(Q{number})>{setting.origin}" for number in (51, 52, 53)),
        f"abs(Q54)>{_SAME_DEG:.5f}",
    )
    for reason, condition in enumerate(checks, start=1):
        yield from (f"if ({condition}) {{", f"{_REASON}={reason}", "return", "}")


_TOOL = re.compile(r"Q50<(\d+\.\d{4}) (?:OR|\|\|) Q50>(\d+\.\d{4})")
_ORIGIN = re.compile(r"abs\(Q51\)>(\d+\.\d{4})", re.IGNORECASE)
_SEGMENT = re.compile(r"SegMoveTime!=(\d+)")


def stated_allowance(text: str) -> Allowance:
    """The allowance by the numbers of a guard; none where the text has no guard."""
    tool, origin = _TOOL.search(text), _ORIGIN.search(text)
    half = (float(tool[2]) - float(tool[1])) / 2 if tool else 0.0
    return Allowance(_allowed(half), _allowed(float(origin[1]) if origin else 0.0))


def stated_segment_time(text: str) -> int:
    """The segment time by the numbers of a guard, ms."""
    found = _SEGMENT.search(text)
    return int(found[1]) if found else 0


def _allowed(beside: float) -> float:
    return round(beside, ALLOWED_DECIMALS) if beside > 1.5 * _SAME_MM else 0.0


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
