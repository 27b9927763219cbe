# SPDX-License-Identifier: LGPL-2.1-or-later
"""Settings: how one machine's controller is wired and spoken to, as far as it is the same for the whole family.

Enters: the ``[controller]`` table of a machine, whose entries the reader of machine files has checked one by one.
Leaves: settings that the writer, the reader and the set-up file share as data. Checked here is what the reader of
machine files does not know: which kind of controller is spoken to, whether the codes can be told apart, and the number
of a program that no file states. Units: mm, mm/s, ms, encoder counts.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any, ClassVar, Self, TypeVar

from pkm_post.controllers.pvt.codes import check_codes
from pkm_post.model import Diagnostic, Machine, Place

APPROACH_RAMP_MS = 500
"""How long the approach takes to reach its speed, and to stop."""
_LAST_PROGRAM = 999
"""From 1000 on live the subprograms of the codes G, M, T, D."""


@dataclass(frozen=True, kw_only=True)
class Settings:
    """Settings of the controller of one machine; strut i is motor i is the axis of letter i.

    Attributes:
        counts_per_mm: encoder counts per mm of strut length; negative when the count falls as the strut grows.
        zero_length: for each strut its length in mm at motor position zero.
        approach_speed: root of the sum of the squares of the six strut speeds on the way to the first knot, mm/s.
        letters: for each strut its axis letter.
        coordinate_system: number of the coordinate system the six motors belong to.
        program: number of the motion program.
        length_decimals: digits after the point of a length in mm.
        speed_decimals: digits after the point of a speed in mm/s.
        line_limit: longest line the controller takes, in characters.
        codes: text of each event, by the names of ``codes.MEANINGS``.

    Raises:
        ValueError: the codes cannot be told apart, or the program has a number that is none for a program.
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

    def __post_init__(self) -> None:
        # moves by hand and single blocks run under a number that is chosen when the machine is operated
        if not 1 <= self.program <= _LAST_PROGRAM:
            raise ValueError(f"program: expected a whole number from 1 to {_LAST_PROGRAM}, got {self.program}")
        check_codes(self.codes, self.letters)

    @classmethod
    def of(cls, controller: Mapping[str, Any]) -> Self:
        """Settings from ``Machine.controller``; entries that have no meaning for this controller are left out.

        Raises:
            ValueError: the table is of another kind of controller, or its codes cannot be told apart.
        """
        kind = controller.get("kind")
        if kind != cls.KIND:
            raise ValueError(f"kind: expected {cls.KIND}, got {kind!r}")
        return cls(**{item.name: controller[item.name] for item in fields(cls)})


AnySettings = TypeVar("AnySettings", bound=Settings)


def settings_of(form: type[AnySettings], machine: Machine) -> tuple[AnySettings | None, tuple[Diagnostic, ...]]:
    """Settings of a machine's controller, or why there are none.

    Args:
        form: the settings that this kind of controller has.
        machine: as the reader of machine files made it.
    """
    try:
        return form.of(machine.controller), ()
    except ValueError as fault:
        return None, (Diagnostic("M104", Place(machine.name), f"controller.{fault}"),)
