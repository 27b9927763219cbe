# SPDX-License-Identifier: LGPL-2.1-or-later
"""Spindle axis: the entries of a spindle that the controller can move as an axis, and their checks.

Input: the entries in mm and rad, by name; None for omitted ones, malformed ones are absent. Output: the axis, in
turns, mm and s; and checks for ``consistency``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from pkm_post.model import SpindleAxis

Values = dict[str, Any]

_OF_THE_AXIS = tuple(
    f"spindle.axis.{key}" for key in ("motor", "letter", "counts_per_turn", "speed", "acceleration", "lead_tolerance")
)
_TOGETHER = (*_OF_THE_AXIS, "controller.codes.spindle_axis", "controller.codes.spindle_speed")
"""Entries to state all together or not at all."""


def spindle_axis(values: Values) -> SpindleAxis | None:
    """The spindle as an axis, or None if the file states none."""
    motor, letter, counts, speed, acceleration, tolerance = (values[entry] for entry in _OF_THE_AXIS)
    return None if motor is None else SpindleAxis(motor, letter, counts, speed / 60.0, acceleration, tolerance)


def _incomplete(values: Values) -> Iterator[tuple[str, str]]:
    if any(values.get(entry) is not None for entry in _TOGETHER):
        for entry in _TOGETHER:
            if entry in values and values[entry] is None:
                yield entry, "needed with the other entries of a spindle that is an axis"


def _axis_of_a_strut(values: Values) -> Iterator[tuple[str, str]]:
    letter = values["spindle.axis.letter"]
    if letter in values["controller.letters"]:
        yield "spindle.axis.letter", f"{letter} is the axis of a strut"


def _other_controller(values: Values) -> Iterator[tuple[str, str]]:
    if values["controller.kind"] != "turbo_pmac":
        yield "spindle.axis.motor", "only programs of a turbo_pmac have a spindle that is an axis"


def _faster_than_the_spindle(values: Values) -> Iterator[tuple[str, str]]:
    as_axis, most = values["spindle.axis.speed"], values["spindle.speed"]
    if as_axis > most:
        yield "spindle.axis.speed", f"{as_axis:g} is above the highest speed of the spindle, {most:g}"


AXIS_CHECKS: tuple[tuple[tuple[str, ...], Callable[[Values], Iterator[tuple[str, str]]]], ...] = (
    ((), _incomplete),
    (("spindle.axis.letter", "controller.letters"), _axis_of_a_strut),
    (("spindle.axis.motor", "controller.kind"), _other_controller),
    (("spindle.axis.speed", "spindle.speed"), _faster_than_the_spindle),
)
"""Each check with its required entries."""
