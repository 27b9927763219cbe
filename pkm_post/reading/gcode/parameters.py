# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parameters: the memory of a running program, as defined by RS274NGC.

Input: numbers or names of parameters and the values assigned to them. Output: their values, in the unit the program
uses. ``#1`` to ``#30`` are local to the called subprogram, ``#31`` and up are global, and all of them start at 0;
``#<name>`` is local and ``#<_name>`` global, and both are undefined until assigned. Parameters that only the control
knows are refused.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Set
from dataclasses import dataclass
from typing import ClassVar, Protocol, Self

HIGHEST = 5601
"""The last numbered parameter."""

ARGUMENTS = 30
"""Number of local numbered parameters; the arguments of a call initialise them."""

_WHOLE = 1e-4
"""Tolerance for accepting a value as an integer."""

_OF_THE_MACHINE: tuple[tuple[int, int, str], ...] = (
    (5061, 5070, "what was probed"),
    (5161, 5169, "the reference point of G28"),
    (5181, 5189, "the reference point of G30"),
    (5210, 5219, "the shift of G92"),
    (5220, 5220, "the number of the work offset in force"),
    (5221, 5390, "a work offset"),
    (5399, 5399, "the input read by M66"),
    (5400, 5413, "the tool in the spindle"),
    (5420, 5428, "the current position"),
    (5599, 5601, "a setting of the control"),
)
"""First and last number, and their content in the control."""

# fmt: off
_NAMES_OF_THE_MACHINE = frozenset((
    "_vmajor", "_vminor", "_line", "_motion_mode", "_plane", "_ccomp", "_metric", "_imperial", "_absolute",
    "_incremental", "_inverse_time", "_units_per_minute", "_units_per_rev", "_coord_system", "_tool_offset",
    "_retract_r_plane", "_retract_old_z", "_spindle_rpm_mode", "_spindle_css_mode", "_ijk_absolute_mode",
    "_lathe_diameter_mode", "_lathe_radius_mode", "_spindle_on", "_spindle_cw", "_mist", "_flood",
    "_speed_override", "_feed_override", "_adaptive_feed", "_feed_hold", "_feed", "_rpm", "_x", "_y", "_z", "_a",
    "_b", "_c", "_u", "_v", "_w", "_abs_x", "_abs_y", "_abs_z", "_abs_a", "_abs_b", "_abs_c", "_current_tool",
    "_current_pocket", "_selected_tool", "_selected_pocket", "_task", "_remap_level",
))
# fmt: on
"""Names that the control reserves for its own state."""

_SETTINGS_OF_THE_MACHINE = ("_hal[", "_ini[")
"""Beginnings of the names of pins and of entries of the configuration."""

_OF_A_CALL = ("_value", "_value_returned", "_call_level")
"""Names set by subprogram calls only, not by assignment."""

_POSITION = (5420, 5421, 5422)
"""X, Y and Z of the current position in the work frame of the program."""

Name = int | str
"""What follows ``#``: a number, or a name in lower case without blanks."""


class ExecutionFault(Exception):  # noqa: N818 - it is no error of the program
    """The program cannot continue. Raised during execution and reported as a diagnostic of the current block.

    Attributes:
        code: key into the table of diagnostics.
        found: the finding.
        column: place in the block, from 1; 0 for the whole block.
    """

    def __init__(self, code: str, found: str, column: int = 0) -> None:
        super().__init__(code, found, column)
        self.code, self.found, self.column = code, found, column

    def at(self, column: int) -> Self:
        """The fault with a column, unless it has one."""
        self.column = self.column or column
        return self


class SystemVariables(Protocol):
    """Position and modal state that a running program can read, in its own units."""

    def coordinate(self, axis: int, number: int) -> float:
        """A coordinate of the tool in the work frame of the program, for the parameter of that number."""

    def machine_coordinate(self, axis: int, number: int) -> float:
        """A coordinate of the tool from the zero of the machine."""

    def code(self, number: int) -> float:
        """The active code or word of a variable from #4001 to #4130."""


@dataclass
class _Level:
    """Call frame of a subprogram: its names, and the caller's values of #1 to #30."""

    named: dict[str, float]
    saved: list[float] | None


class Parameters:
    """All parameters of a running program."""

    functions: ClassVar[Mapping[str, Callable[..., float]]] = {}
    """Functions and operators that differ from RS274NGC."""
    needs_brackets: ClassVar[bool] = False
    """Whether operands of AND, OR and XOR that are computed by other operators are refused without brackets."""

    def __init__(self) -> None:
        self.where: Callable[[], SystemVariables] | None = None
        self._numbered = [0.0] * (HIGHEST + 1)
        self._global: dict[str, float] = dict.fromkeys(_OF_A_CALL, 0.0)
        self._levels = [_Level({}, None)]

    @property
    def depth(self) -> int:
        """Call depth; 0 in the main program."""
        return len(self._levels) - 1

    def memory(self, names: Set[Name] | None) -> tuple[object, ...]:
        """The values of some parameters at all levels, of all if None, but those of the position and the codes."""
        if names is None:
            return self._numbered, self._global, self._levels
        numbered = [self._numbered[name] for name in names if isinstance(name, int) and name <= HIGHEST]
        named = [{name: value for name, value in each.items() if name in names} for each in self._scopes()]
        return numbered, named, [level.saved for level in self._levels]

    def value(self, name: Name) -> float:
        """The value of a parameter.

        Raises:
            ExecutionFault: it is undefined, or reserved for the control.
        """
        if isinstance(name, int):
            if name in _POSITION and self.where is not None:
                return self.where().coordinate(_POSITION.index(name), name)
            return self._numbered[_numbered(name)]
        _refuse_names_of_the_machine(name)
        value = self._named(name).get(name)
        if value is None:
            raise ExecutionFault("G301", f"#<{name}>")
        return value

    def assign(self, name: Name, value: float) -> None:
        """Assign a value to a parameter.

        Raises:
            ExecutionFault: it is reserved for the control.
        """
        if isinstance(name, int):
            self._numbered[_numbered(name)] = value
            return
        _refuse_names_of_the_machine(name)
        if name in _OF_A_CALL:
            raise ExecutionFault("G303", f"#<{name}>: set by calls alone")
        self._named(name)[name] = value

    def exists(self, name: Name) -> bool:
        """Whether a parameter can be read.

        Raises:
            ExecutionFault: only the control knows it, or the number does not exist.
        """
        if isinstance(name, int) and not 1 <= name <= HIGHEST:
            raise ExecutionFault("G302", f"#{name}")
        if isinstance(name, str) and name.startswith(_SETTINGS_OF_THE_MACHINE):
            raise ExecutionFault("G303", f"#<{name}>")
        return isinstance(name, int) or name in _NAMES_OF_THE_MACHINE or name in self._named(name)

    def enter(self, arguments: list[float] | None) -> None:
        """Enter a subprogram.

        Args:
            arguments: values of #1 and up; None if the subprogram shares #1 to #30 with its caller, as after M98.
        """
        saved = None
        if arguments is not None:
            saved = self._numbered[1 : ARGUMENTS + 1]
            self._numbered[1 : ARGUMENTS + 1] = [*arguments, *[0.0] * (ARGUMENTS - len(arguments))]
        self._levels.append(_Level({}, saved))
        self._global.update(_value=0.0, _value_returned=0.0, _call_level=float(self.depth))

    def leave(self, returned: float | None) -> None:
        """Leave a subprogram with its return value, None if there is none."""
        saved = self._levels.pop().saved
        if saved is not None:
            self._numbered[1 : ARGUMENTS + 1] = saved
        self._global.update(
            _value=0.0 if returned is None else returned,
            _value_returned=float(returned is not None),
            _call_level=float(self.depth),
        )

    def _scopes(self) -> Iterator[dict[str, float]]:
        yield self._global
        yield from (level.named for level in self._levels)

    def _named(self, name: str) -> dict[str, float]:
        return self._global if name.startswith("_") else self._levels[-1].named


def whole_number(value: float) -> int | None:
    """The integer a value represents, None if it represents none."""
    if value != value:  # a vacant variable
        return None
    number = round(value)
    return number if abs(value - number) < _WHOLE else None


def in_range(value: float) -> int:
    """Convert a value to a parameter number.

    Raises:
        ExecutionFault: the value is not a whole number, or below 0.
    """
    number = whole_number(value)
    if number is None or number < 0:
        raise ExecutionFault("G302", f"#{value:.10g}")
    return number


def _numbered(number: int) -> int:
    if not 1 <= number <= HIGHEST:
        raise ExecutionFault("G302", f"#{number}")
    if number > _OF_THE_MACHINE[0][0] - 1:
        for first, last, what in _OF_THE_MACHINE:
            if first <= number <= last:
                raise ExecutionFault("G303", f"#{number}: {what}")
    return number


def _refuse_names_of_the_machine(name: str) -> None:
    if name in _NAMES_OF_THE_MACHINE or name.startswith(_SETTINGS_OF_THE_MACHINE):
        raise ExecutionFault("G303", f"#<{name}>")
