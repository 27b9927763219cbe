# SPDX-License-Identifier: LGPL-2.1-or-later
"""Settings: how one machine's controller is wired and spoken to, as far as it is the same for the whole family.

Enters: the ``[controller]`` table of the machine file. Leaves: checked settings that the writer, the reader and the
set-up file share as data. Units: mm, mm/s, ms, encoder counts.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields
from typing import Any, ClassVar, Self, TypeVar

from pkm_post.controllers.pvt.codes import DEFAULT_CODES, check_codes
from pkm_post.model import Diagnostic, Machine, Place

Rule = tuple[str, Callable[[Any], bool]]


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
        approach_ramp_ms: how long the approach takes to reach its speed, and to stop.
        line_limit: longest line the controller takes, in characters.
        codes: text of each event, by the names of ``codes.MEANINGS``.
    """

    KIND: ClassVar[str]
    """Value of ``controller.kind`` in the machine file."""
    RULES: ClassVar[Mapping[str, Rule]]
    """For each entry what is expected of it."""
    WITHOUT_MEANING: ClassVar[tuple[str, ...]] = ()
    """Entries of a machine file that other controllers have and this one does not."""

    counts_per_mm: float
    zero_length: tuple[float, ...]
    approach_speed: float
    letters: tuple[str, ...] = ("A", "B", "C", "U", "V", "W")
    coordinate_system: int = 1
    program: int = 10
    length_decimals: int = 6
    speed_decimals: int = 4
    approach_ramp_ms: int = 500
    line_limit: int = 159
    codes: Mapping[str, str] = field(default_factory=lambda: dict(DEFAULT_CODES))

    def __post_init__(self) -> None:
        for name, (expected, holds) in self.RULES.items():
            value = getattr(self, name)
            if not holds(value):
                raise ValueError(f"controller.{name}: expected {expected}, got {value!r}")
        check_codes(self.codes)

    @classmethod
    def of(cls, controller: Mapping[str, Any]) -> Self:
        """Settings from the ``[controller]`` table of a machine file; codes it leaves out have their default text.

        Raises:
            ValueError: an entry is missing, unknown or has a wrong value.
        """
        entries = {name: value for name, value in controller.items() if name not in cls.WITHOUT_MEANING}
        kind = entries.pop("kind", None)
        if kind != cls.KIND:
            raise ValueError(f"controller.kind: expected {cls.KIND!r}, got {kind!r}")
        unknown = sorted(set(entries) - {item.name for item in fields(cls)})
        missing = sorted({"counts_per_mm", "zero_length", "approach_speed"} - set(entries))
        if unknown or missing:
            raise ValueError(f"controller: expected the entries of Settings, got unknown {unknown}, missing {missing}")
        for name in ("letters", "zero_length"):
            if isinstance(entries.get(name), list):
                entries[name] = tuple(entries[name])
        return cls(**entries | {"codes": DEFAULT_CODES | dict(entries.get("codes", {}))})


AnySettings = TypeVar("AnySettings", bound=Settings)


def settings_of(form: type[AnySettings], machine: Machine) -> tuple[AnySettings | None, tuple[Diagnostic, ...]]:
    """Settings of a machine's controller; whether its codes can be told apart its file's reader does not know."""
    try:
        return form.of(machine.controller), ()
    except ValueError as fault:
        return None, (Diagnostic("M104", Place(machine.name), f"controller: {fault}"),)


def whole(least: int, most: int) -> Rule:
    """The rule of an entry that counts."""

    def holds(value: Any) -> bool:
        return isinstance(value, int) and not isinstance(value, bool) and least <= value <= most

    return f"a whole number from {least} to {most}", holds


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def _are_letters(value: Any) -> bool:
    return isinstance(value, tuple) and len(value) == 6 and set(value) < set("ABCUVWXYZ") and len(set(value)) == 6


COMMON_RULES: dict[str, Rule] = {
    "counts_per_mm": ("a number other than zero", lambda value: _is_number(value) and value != 0),
    "zero_length": (
        "six lengths in mm",
        lambda value: isinstance(value, tuple) and len(value) == 6 and all(map(_is_number, value)),
    ),
    "approach_speed": ("a speed above zero in mm/s", lambda value: _is_number(value) and value > 0),
    "letters": ("six different letters of ABCUVWXYZ", _are_letters),
    "coordinate_system": whole(1, 16),
    "program": whole(1, 999),  # from 1000 on live the subprograms of the codes G, M, T, D
    "length_decimals": whole(1, 9),
    "speed_decimals": whole(1, 9),
    "approach_ramp_ms": whole(1, 10_000),
    "line_limit": whole(40, 1 << 16),
}
