# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cartesian guard: ends a program of tip and axis before its first move if the controller is set up differently.

The guard checks the switch of the kinematics (Isx50; on a Power PMAC the axis definitions and the segment time), the
gauge length in Q50 and the work frame in Q51 to Q54. A Turbo PMAC then names the mismatch; a Power PMAC, whose syntax
of ``send`` no available source documents, writes its number to Q66. An allowance permits changes at the machine without
posting again: the program runs within it, and its certificate holds at every corner of it. ``RETURN`` outside of a
subroutine ends a program, and the next ``R`` starts it from the beginning [Turbo PMAC Software Reference, RETURN; Power
PMAC User's Manual, p. 692].

Shifting the work frame by d is equivalent to shifting the base joints by -d, a longer tool to a longer spindle nose: so
each corner is a machine. The vector of a strut is affine in these four values, so its length is convex: longest at a
corner, but it may be shortest between them, by at most half the sum of the squared ranges through the distance of its
joints. Corners keep that distance from the shortest length. Fixtures stay with the base: at each corner a box holds all
their places.
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
"""Tolerance of the variables without an allowance: half a micrometre, and 10 um at a distance of 57 m."""
_NO_STRUT = 1e-3
"""mm: joints this near leave no stroke at the corners of an allowance."""
ALLOWED_DECIMALS = 3
"""Decimals of an allowance in mm; a guard has no more."""


@dataclass(frozen=True)
class Allowance:
    """Permitted deviations, to either side, of values at the machine from those of the program.

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
        """The allowed values of the variables, for the heading of a program."""
        origin = f"Q51 to Q53 up to {self.origin:g} from zero" if self.origin else "Q51 to Q53 zero"
        length = f"Q50={tool_length:g}" + (f" up to {self.tool_length:g} more or less" if self.tool_length else "")
        return f"{length}, {origin}, Q54 zero" if self.origin else f"{length} and Q51 to Q54 zero"

    def corners(self, machine: Machine) -> Iterator[tuple[str, Machine]]:
        """Yield each corner of the allowance as text, with the equivalent machine, whose struts stay longer."""
        low, high = machine.strut_stroke
        nearest = max(low + float(machine.length_offset.min()), _NO_STRUT)
        stroke = low + (3 * self.origin**2 + self.tool_length**2) / (2 * nearest), high
        fixtures = tuple(
            replace(box, lowest=box.lowest - self.origin, highest=box.highest + self.origin) for box in machine.fixtures
        )
        shifts = (-self.origin, self.origin) if self.origin else (0.0,)
        lengths = (-self.tool_length, self.tool_length) if self.tool_length else (0.0,)
        for *shift, longer in product(shifts, shifts, shifts, lengths):
            if any(shift) or longer:
                words = f"work frame at {', '.join(f'{value:+g}' for value in shift)}, tool {longer:+g} mm"
                base = machine.base_joints - np.array(shift)
                nose = machine.spindle_nose + longer
                moved = replace(machine, base_joints=base, spindle_nose=nose, fixtures=fixtures)
                yield words, replace(moved, strut_stroke=stroke)


@dataclass(frozen=True)
class Setting:
    """State of the controller for which the certificate of a program of tip and axis holds.

    Attributes:
        tool_length: gauge length, mm.
        allowance: of the gauge length and the work frame.
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
    """The lines of the guard, which precede the rest of the program."""
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
"""The mismatch by the value of Q66, from 1."""
_LINEAR, _REASON = "Q65", "Q66"


def _power_lines(system: int, setting: Setting) -> Iterator[str]:
    """The guard of a Power PMAC; motors with kinematics have no scale factors of linear axis definitions.

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


_TOOL = re.compile(r"Q50<(-?\d+\.\d{4}) (?:OR|\|\|) Q50>(\d+\.\d{4})")
_ORIGIN = re.compile(r"abs\(Q51\)>(\d+\.\d{4})", re.IGNORECASE)
_SEGMENT = re.compile(r"SegMoveTime!=(\d+)")


def stated_allowance(text: str) -> Allowance:
    """The allowance that a guard states; zero without a guard."""
    tool, origin = _TOOL.search(text), _ORIGIN.search(text)
    half = (float(tool[2]) - float(tool[1])) / 2 if tool else 0.0
    return Allowance(_allowed(half), _allowed(float(origin[1]) if origin else 0.0))


def stated_segment_time(text: str) -> int:
    """The segment time that a guard states, ms."""
    found = _SEGMENT.search(text)
    return int(found[1]) if found else 0


def _allowed(beside: float) -> float:
    return round(beside, ALLOWED_DECIMALS) if beside > 1.5 * _SAME_MM else 0.0


def guarded(text: str, opening: str, lines: tuple[str, ...]) -> str:
    """Insert the guard after the opening of the program buffer.

    Raises:
        ValueError: the program does not have exactly one opening.
    """
    if text.count(opening) != 1:
        raise ValueError(f"text: expected {opening!r} once, got it {text.count(opening)} times")
    return text.replace(opening, opening + "".join(f"{line}\n" for line in lines))


def unguarded(text: str, opening: str, lines: tuple[str, ...]) -> str:
    """Remove the guard from a program.

    Raises:
        ValueError: the guard is missing, or not in front of everything else.
    """
    expected = opening + "".join(f"{line}\n" for line in lines)
    if text.count(expected) != 1:
        raise ValueError(f"text: expected the guard once, got it {text.count(expected)} times")
    return text.replace(expected, opening)
