# SPDX-License-Identifier: LGPL-2.1-or-later
"""Macro variables: the memory of custom macro B on Fanuc controls.

Input: numbers of variables and values. Output: values, in the unit of the program; NaN is a vacant variable, which
counts as 0 in arithmetic and drops its word. #0 is always vacant, #1 to #33 belong to a level of
macro calls and initially vacant, #100 to #199 and #500 to #999 are common to all levels [Fanuc, custom macro,
variables]. The initial values of #500 to #999 are unknown: reading one before it is assigned is a fault.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Set
from typing import ClassVar

from pkm_post.reading.gcode.expressions import FUNCTIONS, arc_tangent
from pkm_post.reading.gcode.parameters import ExecutionFault, Name, Parameters

LOCAL = 33
"""Number of local variables."""
_VACANT = math.nan
_CLEARED = range(100, 200)
"""Common variables that are vacant when the control is switched on."""
_KEPT = range(500, 1000)
"""Common variables that keep their values from other programs."""
_ALARM = 3000
_PANEL = (3003, 3004)
"""Switches of single block and feed hold: they do not affect the motion."""
_CODES = range(4001, 4131)
_BLOCK_END, _IN_MACHINE, _CURRENT = range(5001, 5004), range(5021, 5024), range(5041, 5044)
_FULL_TURN = 360.0


def _whole(value: float) -> int:
    if value != round(value):
        raise ExecutionFault("G305", f"{value:.10g} bit by bit")
    return round(value)


def _unrounded(value: float) -> float:
    if value != round(value):
        raise ExecutionFault("G305", f"round of {value:.10g} in an argument of a macro")
    return value


def _remainder(left: float, right: float) -> float:
    if left != round(left) or right != round(right):
        raise ExecutionFault("G305", f"{left:.10g} mod {right:.10g}")
    if right == 0:
        raise ExecutionFault("G304", f"{left:.10g} mod {right:.10g}")
    return math.fmod(left, right)


def _positive(degrees: float) -> float:
    return degrees + _FULL_TURN if degrees < 0 else degrees


class MacroVariables(Parameters):
    """All variables of a running program."""

    functions: ClassVar[Mapping[str, Callable[..., float]]] = {
        "fix": math.trunc,
        "round in a word": lambda value: value,
        "round in an argument": _unrounded,
        "mod": _remainder,
        "fup": lambda value: math.copysign(math.ceil(abs(value)), value),
        "and": lambda left, right: _whole(left) & _whole(right),
        "or": lambda left, right: _whole(left) | _whole(right),
        "xor": lambda left, right: _whole(left) ^ _whole(right),
        "atan": lambda y, x: _positive(arc_tangent(y, x)),
        "asin": lambda value: _positive(FUNCTIONS["asin"](value)),
    }
    """FIX truncates and FUP rounds away from 0; AND, OR and XOR are bitwise, which is the same for conditions; ATAN
    and ASIN are from 0 to 360 degrees [Fanuc, custom macro, arithmetic; parameter 6004#0 at 0]."""

    needs_brackets: ClassVar[bool] = True
    """AND binds as ``*`` and OR and XOR as ``+`` [Fanuc, custom macro, priority of operations], which few expect."""

    def __init__(self) -> None:
        super().__init__()
        self._common: dict[int, float] = {}
        self._local: list[list[float]] = [[_VACANT] * LOCAL]
        self._calls: list[bool] = []
        """For each call, whether it started its own level."""

    @property
    def depth(self) -> int:
        """Call depth; 0 in the main program."""
        return len(self._calls)

    def memory(self, names: Set[Name] | None) -> tuple[object, ...]:
        """The values of some variables at all levels, of all if None, but those of the position and the codes."""
        if names is None:
            return self._common, self._local, self._calls
        common = {name: value for name, value in self._common.items() if name in names}
        own = [name - 1 for name in names if isinstance(name, int) and 1 <= name <= LOCAL]
        return common, [[level[index] for index in own] for level in self._local], self._calls

    def value(self, name: Name) -> float:
        """The value of a variable, NaN for a vacant one.

        Raises:
            ExecutionFault: the value is unknown.
        """
        if isinstance(name, str):
            raise ExecutionFault("G302", f"#<{name}>")
        if name <= LOCAL:
            return self._local[-1][name - 1] if name else _VACANT
        if name in self._common or name in _CLEARED:
            return self._common.get(name, _VACANT)
        if name in _KEPT:
            raise ExecutionFault("G301", f"#{name}")
        return self._of_the_control(name)

    def _of_the_control(self, number: int) -> float:
        if self.where is not None:
            for places in (_BLOCK_END, _CURRENT):
                if number in places:
                    return self.where().coordinate(number - places.start, number)
            if number in _IN_MACHINE:
                return self.where().machine_coordinate(number - _IN_MACHINE.start, number)
            if number in _CODES:
                return self.where().code(number)
        raise ExecutionFault("G303", f"#{number}")

    def assign(self, name: Name, value: float) -> None:
        """Assign a value to a variable; NaN makes it vacant.

        Raises:
            ExecutionFault: the variable is not writable, or raises an alarm.
        """
        if isinstance(name, str):
            raise ExecutionFault("G302", f"#<{name}>")
        if 1 <= name <= LOCAL:
            self._local[-1][name - 1] = value
        elif name in _CLEARED or name in _KEPT:
            self._common[name] = value
        elif name == _ALARM:
            raise ExecutionFault("G319", f"#{_ALARM}={value:g}")
        elif name not in _PANEL:
            raise ExecutionFault("G303", f"#{name}, assigned")

    def exists(self, name: Name) -> bool:
        """Whether a variable has a value."""
        return self.value(name) == self.value(name)

    def enter(self, arguments: list[float] | None) -> None:
        """Enter a program.

        Args:
            arguments: values of #1 and up, NaN where vacant; None if it shares them with its caller, as after M98.
                Assignments change them: a further pass of the call has the values that this one leaves.
        """
        self._calls.append(arguments is not None)
        if arguments is not None:
            arguments.extend([_VACANT] * (LOCAL - len(arguments)))
            self._local.append(arguments)

    def leave(self, returned: float | None) -> None:
        """Leave a program; macros return nothing."""
        if self._calls.pop():
            self._local.pop()
