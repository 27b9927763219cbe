# SPDX-License-Identifier: LGPL-2.1-or-later
"""Settings: wiring and communication of one machine's controller, as far as common to the family.

Input: the ``[controller]`` table of a machine, whose entries the reader of machine files has checked one by one.
Output: settings that the writer, the reader and the set-up file share as data. The checks here are those that the
reader of machine files cannot make: the kind of controller, distinguishable codes, and a program number chosen at run
time. The axis definitions of set-up files, which make axis values true strut lengths, are also here:

    counts = counts_per_mm * (strut length - zero_length)

These are exact decimals: binary rounding would add spurious digits. Units: mm, mm/s, ms, encoder counts.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import MISSING, dataclass, fields
from decimal import Decimal
from typing import Any, ClassVar, Self, TypeVar

from pkm_post.model import Diagnostic, Diagnostics, Machine, Place, SpindleAxis
from pkm_post.writing.controllers.pvt.codes import check_codes
from pkm_post.writing.controllers.pvt.decimals import exact, plain

APPROACH_RAMP_MS = 500
"""Duration of acceleration and of deceleration of the approach."""
_LAST_PROGRAM = 999
"""Programs from 1000 on are the subprograms of the codes G, M, T, D."""


@dataclass(frozen=True, kw_only=True)
class PvtSettings:
    """Settings of the controller of one machine; strut i is motor i and the axis of letter i.

    Attributes:
        counts_per_mm: encoder counts per mm of strut length; negative if the count falls as the strut extends.
        zero_length: length of each strut in mm at motor position zero.
        approach_speed: root of the sum of the squares of the six strut speeds on the approach to the first knot, mm/s.
        letters: axis letter of each strut.
        coordinate_system: number of the coordinate system of the six motors.
        program: number of the motion program.
        length_decimals: digits after the point of a length in mm.
        speed_decimals: digits after the point of a speed in mm/s.
        line_limit: longest line that the controller accepts, in characters.
        codes: text of each event, by the names of ``codes.EVENT_CODES``.
        spindle_axis: the spindle as an axis; None if it cannot be one.

    Raises:
        ValueError: the codes are not distinguishable, or the program number is not valid.
    """

    KIND: ClassVar[str]
    """Value of ``controller.kind`` in the machine file."""

    counts_per_mm: float
    zero_length: tuple[float, ...]
    approach_speed: float
    letters: tuple[str, ...]
    coordinate_system: int
    program: int
    length_decimals: int
    speed_decimals: int
    line_limit: int
    codes: Mapping[str, str]
    spindle_axis: SpindleAxis | None = None

    def __post_init__(self) -> None:
        # manual moves and single blocks run under a program number chosen at run time
        if not 1 <= self.program <= _LAST_PROGRAM:
            raise ValueError(f"program: expected a whole number from 1 to {_LAST_PROGRAM}, got {self.program}")
        check_codes(self.codes, self.all_letters, self.coordinate_system)

    @property
    def all_letters(self) -> tuple[str, ...]:
        """Letters of all axes that a program moves: the struts, and a spindle that can be an axis."""
        return self.letters if self.spindle_axis is None else (*self.letters, self.spindle_axis.letter)

    @classmethod
    def of(cls, controller: Mapping[str, Any]) -> Self:
        """Settings from ``Machine.controller``; entries without meaning for this controller are ignored.

        Raises:
            ValueError: the table is of another kind of controller, or its codes are not distinguishable.
        """
        kind = controller.get("kind")
        if kind != cls.KIND:
            raise ValueError(f"kind: expected {cls.KIND}, got {kind!r}")
        needed = [item.name for item in fields(cls) if item.default is MISSING or item.name in controller]
        return cls(**{name: controller[name] for name in needed})


AnySettings = TypeVar("AnySettings", bound=PvtSettings)


def settings_of(form: type[AnySettings], machine: Machine) -> tuple[AnySettings | None, Diagnostics]:
    """Settings, of a class for this kind of controller, of a machine's controller, or None with diagnostics."""
    try:
        return form.of(machine.controller), ()
    except ValueError as fault:
        return None, (Diagnostic("M104", Place(machine.name), f"controller.{fault}"),)


ROTARY_LETTERS = "ABC"
"""Axes that controllers of the family treat as rotary."""


def check_stroke(stroke: tuple[float, float]) -> None:
    """Check that the stroke is two increasing lengths.

    Raises:
        ValueError: otherwise.
    """
    shortest, longest = stroke
    if not (math.isfinite(shortest) and math.isfinite(longest) and shortest < longest):
        raise ValueError(f"stroke: expected two finite lengths, the shorter first, got {stroke}")


def axis_definitions(settings: PvtSettings) -> list[str]:
    """The axis definition of each motor: ``#motor->SCALE LETTER OFFSET``, without the spaces."""
    scale = exact(settings.counts_per_mm)
    offsets = [-scale * exact(length) for length in settings.zero_length]
    return [
        f"#{motor}->{plain(scale)}{letter}{'' if offset < 0 else '+'}{plain(offset)}"
        for motor, (letter, offset) in enumerate(zip(settings.letters, offsets, strict=True), start=1)
    ]


def stroke_counts(settings: PvtSettings, stroke: tuple[float, float]) -> list[tuple[Decimal, Decimal]]:
    """The lowest and highest count of each strut."""
    scale = exact(settings.counts_per_mm)
    ends = [[scale * (exact(length) - exact(zero)) for length in stroke] for zero in settings.zero_length]
    return [(min(counts), max(counts)) for counts in ends]
