# SPDX-License-Identifier: LGPL-2.1-or-later
"""Variables: R parameters of the program, and variables of DEF and PROC, local to a program or subprogram.

Input: names, indices and values. Output: values. Variables of DEF start as 0 or an empty text; an R parameter
without a value is a fault, since a control keeps that of the previous program [SiemensNC, arithmetic parameters].
"""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import dataclass, field

from pkm_post.reading.gcode.expressions import rounded
from pkm_post.reading.gcode.parameters import Name
from pkm_post.reading.siemens.diagnostics import BlockFault

Value = float | str
Index = tuple[int, ...]

R_PARAMETERS = 1000
"""Most R parameters of a channel; a larger number is a typing error."""
_MOST_ELEMENTS = 100_000
TYPES = ("REAL", "INT", "BOOL", "CHAR", "STRING")


@dataclass
class _Variable:
    """A variable of DEF or PROC.

    Attributes:
        kind: one of ``TYPES``.
        size: dimensions of an array; none for a single value.
        start: value of every element before it is assigned.
        values: assigned elements.
    """

    kind: str
    size: Index
    start: Value
    values: dict[Index, Value] = field(default_factory=dict)


class Variables:
    """The variables of a running program; each level of subprograms has its own, R parameters belong to all."""

    def __init__(self) -> None:
        self._r: dict[int, float] = {}
        self._levels: list[dict[str, _Variable]] = [{}]

    def memory(self, names: Collection[Name] | None) -> tuple[object, ...]:
        """The values of some variables, of R parameters as "R1"; all for None."""
        if names is None:
            return self._r, self._levels
        levels = [{name: level[name] for name in level.keys() & names} for level in self._levels]
        return {number: value for number, value in self._r.items() if f"R{number}" in names}, levels

    def enter(self) -> None:
        """Begin a subprogram."""
        self._levels.append({})

    def leave(self) -> None:
        """End a subprogram."""
        self._levels.pop()

    def define(self, name: str, kind: str, size: Index = (), start: Value | None = None) -> None:
        """Define a variable.

        Raises:
            BlockFault: it is too large, or its initial value has the wrong type.
        """
        if math.prod(size) > _MOST_ELEMENTS:
            raise BlockFault("G606", f"{name} with more than {_MOST_ELEMENTS} elements")
        first = ("" if kind in ("STRING", "CHAR") else 0.0) if start is None else _typed(kind, start, name)
        self._levels[-1][name] = _Variable(kind, size, first)

    def value(self, name: str, index: Index) -> Value:
        """The value of a variable.

        Raises:
            BlockFault: it does not exist or has none.
        """
        if name == "R":
            if index[0] not in self._r:
                raise BlockFault("G301", f"R{index[0]}")
            return self._r[index[0]]
        variable = self._checked(name, index)
        return variable.values.get(index, variable.start)

    def assign(self, name: str, index: Index, value: Value) -> None:
        """Give a variable a value.

        Raises:
            BlockFault: it does not exist, or the value has the wrong type.
        """
        if name == "R":
            if index[0] >= R_PARAMETERS:
                raise BlockFault("G302", f"R{index[0]}")
            if isinstance(value, str):
                raise BlockFault("G606", f'R{index[0]}="{value}"')
            self._r[index[0]] = value
            return
        variable = self._checked(name, index)
        variable.values[index] = _typed(variable.kind, value, name)

    def _checked(self, name: str, index: Index) -> _Variable:
        variable = self._find(name)
        if variable is None:
            raise BlockFault("G603", name)
        inside = len(index) == len(variable.size) and all(
            place < most for place, most in zip(index, variable.size, strict=True)
        )
        if not inside:
            raise BlockFault("G606", f"{name}[{', '.join(map(str, index))}] of [{', '.join(map(str, variable.size))}]")
        return variable

    def _find(self, name: str) -> _Variable | None:
        """A local variable, or else one of the main program, visible to subprograms [SiemensNC, program-global]."""
        return self._levels[-1].get(name) or self._levels[0].get(name)


def _typed(kind: str, value: Value, name: str) -> Value:
    """Convert a value to the type of a variable."""
    if isinstance(value, str) is not (kind in ("STRING", "CHAR")):
        raise BlockFault("G606", f"{name}={value!r} of type {kind}")
    if isinstance(value, str) or kind == "REAL":
        return value
    return float(value != 0) if kind == "BOOL" else rounded(value) + 0.0
