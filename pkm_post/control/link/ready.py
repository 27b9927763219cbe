# SPDX-License-Identifier: LGPL-2.1-or-later
"""Ready: check the preconditions of a program in controller and machine; they are queried, never assumed.

Enters: a session, the settings of the machine file, the stroke in mm, strut lengths in mm. Leaves: nothing, or
``NotReadyError`` with every reason.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from decimal import Decimal

import numpy as np

from pkm_post.control.link.faults import LinkLostError, NotReadyError, PmacError
from pkm_post.control.link.session import Session
from pkm_post.control.link.start_pose import start_faults
from pkm_post.control.link.status import MOTORS, Array, Status
from pkm_post.model import Machine
from pkm_post.options import START_TOLERANCE_MM
from pkm_post.writing import PmacSettings

_UNSIGNED = r"(?:\d+\.?\d*|\.\d+)"
_DEFINITION = re.compile(rf"([-+]?{_UNSIGNED})?([A-Z])([-+]{_UNSIGNED})?")
_REAL = r"[-+]?\d+(?:\.\d*)?"
_ROTARY = "ABC"


def check_setup(session: Session, settings: PmacSettings, stroke: tuple[float, float]) -> None:
    """Compare the controller with the setup that programs of this machine rely on.

    Args:
        session: an open session.
        settings: of the machine's controller.
        stroke: shortest and longest strut length, mm.

    Raises:
        NotReadyError: lists all differences.
    """
    reasons = [
        *_axis_faults(session, settings),
        *_variable_faults(session, settings),
        *_limit_faults(session, settings, stroke),
    ]
    if reasons:
        raise NotReadyError(reasons)


def check_start(status: Status, first: Array, near: float = START_TOLERANCE_MM, machine: Machine | None = None) -> None:
    """Check that a program may start: struts homed, in closed loop, without faults, standing near its first point.

    Args:
        status: of the struts.
        first: (6,) strut lengths of the first point, mm.
        near: largest distance of each strut from it, mm.
        machine: its geometry, to compare the tool pose as well.

    Raises:
        NotReadyError: lists every reason.
    """
    reasons = [*_motor_faults(status), *status.words()]
    if status.running:
        reasons.append("a program runs, or is held")
    if status.override > 100:
        reasons.append(f"the override is {status.override:g} %: the program was planned to the limits at 100 %")
    away = np.abs(status.length - first)
    reasons += [
        f"strut {motor}: {status.length[motor - 1]:.3f} mm long, {distance:.3f} mm from the first point of the program"
        for motor, distance in zip(MOTORS, away, strict=True)
        if not distance <= near
    ]
    if machine is not None and all(status.homed):
        reasons += start_faults(machine, status.length, first, near)
    if reasons:
        raise NotReadyError(tuple(dict.fromkeys(reasons)))


def number_of(session: Session, name: str) -> float:
    """The value of a variable of the controller.

    Raises:
        LinkLostError: the answer is not a number.
    """
    told = _one(session, name)
    if not re.fullmatch(_REAL, told):
        raise LinkLostError(f"{name}: expected a number, got {told!r}")
    return float(told)


def _motor_faults(status: Status) -> Iterator[str]:
    expected = {
        "homed": "not homed",
        "activated": "not activated",
        "amplifier_enabled": "its amplifier is off",
        "assigned": "belongs to no coordinate system",
        "standing": "moves",
    }
    for motor, bits in zip(MOTORS, status.motors, strict=True):
        for name, otherwise in expected.items():
            if not bits.has(name):
                yield f"strut {motor}: {otherwise}"


def _axis_faults(session: Session, settings: PmacSettings) -> Iterator[str]:
    """Compare ``#n->`` with the axis definitions of the setup file."""
    scale = Decimal(repr(float(settings.counts_per_mm)))
    for motor, letter, zero in zip(MOTORS, settings.letters, settings.zero_length, strict=True):
        wanted = (scale, letter, -scale * Decimal(repr(float(zero))))
        told = _one(session, f"&{settings.coordinate_system}#{motor}->").replace(" ", "")
        found = _DEFINITION.fullmatch(told.removeprefix(f"#{motor}->").upper())
        got = found and (Decimal(found[1] or 1), found[2], Decimal(found[3] or 0))
        if got != wanted:
            stated = f"{wanted[0].normalize():f}{letter}{wanted[2].normalize():+f}"
            yield f"#{motor}->: expected {stated}, the controller has {told or 'nothing'}"


def _variable_faults(session: Session, settings: PmacSettings) -> Iterator[str]:
    base = f"I{50 + settings.coordinate_system}"
    expected = {f"{base}90": (1000, "speeds are in mm/s"), f"{base}50": (0, "no kinematics in the controller")}
    for motor, letter in zip(MOTORS, settings.letters, strict=True):
        if letter in _ROTARY:
            expected[f"I{motor}27"] = (0, "no rollover of a strut")
    for name, (value, why) in expected.items():
        got = number_of(session, name)
        if got != value:
            yield f"{name}: expected {value} ({why}), the controller has {got:g}"
    served = number_of(session, "I68")
    if served < settings.coordinate_system - 1:
        yield f"I68: expected {settings.coordinate_system - 1} or more, the controller has {served:g}"


def _limit_faults(session: Session, settings: PmacSettings, stroke: tuple[float, float]) -> Iterator[str]:
    """The soft limits must be enabled and within the stroke."""
    for motor, zero in zip(MOTORS, settings.zero_length, strict=True):
        low, high = sorted(settings.counts_per_mm * (length - zero) for length in stroke)
        for name, (least, most) in {f"I{motor}13": (-np.inf, high), f"I{motor}14": (low, np.inf)}.items():
            got = number_of(session, name)
            if got == 0 or not least - 1 <= got <= most + 1:
                within = f"{most:.0f} or less" if np.isfinite(most) else f"{least:.0f} or more"
                yield f"{name}: expected {within} and not 0, which is no limit; the controller has {got:g}"


def _one(session: Session, query: str) -> str:
    told = session.ask(query)
    if len(told) != 1:
        raise PmacError(f"{query}: expected one line, got {len(told)}")
    return told[0].strip()
