# SPDX-License-Identifier: LGPL-2.1-or-later
"""Power elements: the data structure of a Power PMAC, as far as it is simulated.

``Motor[1].MaxPos`` and ``Coord[1].FeedTime`` replace I-variables. The elements that the simulator uses are converted
I-variables; status elements are read from motors and coordinate systems. Motor units are counts, times are in ms
[PowerPMAC, Saved Data Structure Elements].

Input: names and values. Output: values, or a refusal of unknown elements.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass

from pkm_post.control.simulator.controller import Controller
from pkm_post.control.simulator.errors import DATA, CommandError
from pkm_post.control.simulator.programs import LETTERS
from pkm_post.control.simulator.variables import ELEMENT, SIMULATED_MOTORS, SYSTEMS

_ROLLOVER = re.compile(r"posrollover\[([0-9]|1[0-9]|2[0-9]|3[01])\]")
_FACTOR = re.compile(r"coordsf\[([0-9]|[12][0-9]|3[01])\]")
_SLEW = 2.0**23
"""Isx94 and Isx95 count 2^-23 ms per servo cycle; no available manual gives the unit of the elements."""
_FACTORY_SLEW = 1e-4
"""As in the saved set-up of a controller [PowerPMACProjects]: in ms per servo cycle, 2 s for 100 %."""
_LEAST_LIMIT = 1e-6
"""counts: used for a soft limit at 0, which means none for an I-variable."""

Conversion = Callable[[float], float]


@dataclass(frozen=True)
class Converted:
    """An element backed by an I-variable.

    Attributes:
        which: last two digits of the I-variable.
        of_variable: converts a value of the variable to one of the element.
        to_variable: the reverse; None for a value not simulated.
    """

    which: int
    of_variable: Conversion = lambda value: value
    to_variable: Callable[[float], float | None] = lambda value: value


def _times(factor: float) -> tuple[Conversion, Conversion]:
    return lambda value: value / factor, lambda value: value * factor


def _inverse_of_positive(value: float) -> float | None:
    return 1 / value if value > 0 else None


def _inverse_of_negative(value: float) -> float | None:
    """Ramp from a negative number, whose inverse is an acceleration; positive numbers, times, are not simulated."""
    return -1 / value if value < 0 else None


def _only_zero(value: float) -> float | None:
    return 0.0 if value == 0 else None


_MOTOR: dict[str, Converted] = {
    "servoctrl": Converted(0),
    "fatalfelimit": Converted(11, *_times(16)),
    "warnfelimit": Converted(12, *_times(16)),
    "maxspeed": Converted(16),
    "invamax": Converted(17, lambda value: 1 / value if value else 0.0, _inverse_of_positive),
    "abortta": Converted(15, lambda value: -1 / value if value else 0.0, _inverse_of_negative),
    "jogta": Converted(19, lambda value: -1 / value if value else 0.0, _inverse_of_negative),
    "jogspeed": Converted(22),
    "homevel": Converted(23),
    "homeoffset": Converted(26, *_times(16)),
    "inposband": Converted(28, *_times(16)),
}
_COORD: dict[str, Converted] = {
    "feedtime": Converted(90),
    "noblend": Converted(92),
    "segmovetime": Converted(13, to_variable=_only_zero),
    "ta": Converted(87),
    "ts": Converted(88),
    "timebaseslew": Converted(94, *_times(_SLEW)),
    "feedholdslew": Converted(95, *_times(_SLEW)),
}


class PowerElements:
    """The data structure of one controller.

    Attributes:
        time_bases: addresses in ``Coord[].pDesTimeBase`` other than the default, by number.
    """

    def __init__(self, controller: Controller) -> None:
        self._controller = controller
        self.time_bases: dict[int, str] = {}
        for system in range(1, SYSTEMS + 1):
            for which in (94, 95):
                controller.variables.write("I", _number("coord", system, which), _FACTORY_SLEW * _SLEW)
        self._limits = {(motor, name): 0.0 for motor in range(1, SIMULATED_MOTORS + 1) for name in ("maxpos", "minpos")}

    def read(self, name: str) -> float:
        """The value of an element.

        Raises:
            CommandError: the element does not exist.
        """
        kind, index, element = _split(name)
        if kind == "sys":
            return {"maxcoords": float(SYSTEMS), "maxmotors": SIMULATED_MOTORS + 1.0}[element]
        if _ROLLOVER.fullmatch(element) and kind == "coord":
            return 0.0
        if (factor := _FACTOR.fullmatch(element)) and kind == "motor":
            return self._factor(index, int(factor[1]))
        if (index, element) in self._limits and kind == "motor":
            return self._limits[index, element]
        table = _MOTOR if kind == "motor" else _COORD
        if element in table:
            entry = table[element]
            return entry.of_variable(self._controller.variables.read("I", _number(kind, index, entry.which)))
        return self._status(kind, index, element)

    def write(self, name: str, value: float) -> None:
        """Set an element.

        Raises:
            CommandError: the element is a status or does not exist, or its value is not simulated.
        """
        kind, index, element = _split(name)
        if _ROLLOVER.fullmatch(element) and kind == "coord" and value == 0:
            return
        if (index, element) in self._limits and kind == "motor":
            self._limits[index, element] = value
            self._set_limits(index)
            return
        entry = {"motor": _MOTOR, "coord": _COORD}.get(kind, {}).get(element)
        converted = entry.to_variable(value) if entry else None
        if entry is None or converted is None:
            raise CommandError(DATA)
        self._controller.variables.write("I", _number(kind, index, entry.which), converted)

    def _factor(self, motor: int, axis: int) -> float:
        """The scale factor of a motor's linear axis definition for an axis, by its place among all letters."""
        system = self._controller.system_of(motor)
        definition = system.axes.definitions[motor] if system else None
        is_of_it = definition is not None and LETTERS.find(definition.letter) == axis
        return definition.scale if definition and is_of_it else 0.0

    def _set_limits(self, motor: int) -> None:
        """Soft limits act while the higher one is above the lower one [PowerPMAC, Overtravel Limits]."""
        high, low = self._limits[motor, "maxpos"], self._limits[motor, "minpos"]
        for which, value in ((13, high), (14, low)):
            heeded = (value or _LEAST_LIMIT) if high > low else 0.0
            self._controller.variables.write("I", 100 * motor + which, heeded)

    def _status(self, kind: str, index: int, element: str) -> float:
        motors = self._controller.motors
        if kind == "motor":
            columns = {
                "homecomplete": motors.homed, "closedloop": motors.closed, "ampena": motors.enabled,
                "despos": motors.commanded, "actpos": motors.actual,
            }  # fmt: skip
            if element in columns:
                return float(columns[element][index - 1])
            raise CommandError(DATA)
        system = self._controller.systems[index - 1]
        indices = system.axes.indices()
        states = {
            "progrunning": system.running, "progactive": system.running or not system.interpreter.ended(),
            "feedhold": (1 if system.override == 0 else 3) if system.holding else 2 * system.resumes,
            "errorstatus": 16 if system.runtime_error else 0,
            "csolve": bool(indices), "homecomplete": bool(indices) and bool(motors.homed[indices].all()),
        }  # fmt: skip
        if element not in states:
            raise CommandError(DATA)
        return float(states[element])


def _split(name: str) -> tuple[str, int, str]:
    match = re.fullmatch(ELEMENT, name, re.IGNORECASE)
    if match is None:
        raise CommandError(DATA)
    kind, index = (match["kind"] or "sys").lower(), int(match["index"] or 0)
    element = name.split(".", 1)[1].lower()
    most = {"sys": 0, "motor": SIMULATED_MOTORS, "coord": SYSTEMS}[kind]
    if not min(most, 1) <= index <= most or (kind == "sys" and element not in ("maxcoords", "maxmotors")):
        raise CommandError(DATA)
    return kind, index, element


def _number(kind: str, index: int, which: int) -> int:
    return 100 * (index if kind == "motor" else 50 + index) + which
