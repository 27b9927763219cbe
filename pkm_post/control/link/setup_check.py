# SPDX-License-Identifier: LGPL-2.1-or-later
"""Set-up check: compare a controller with the set-up that programs of the machine rely on.

A Turbo PMAC reports an axis definition as ``10000A-500``. A Power PMAC puts the coordinate system in front,
``&1#1->10000A-500`` [gpascii; dls_powerpmacanalyse]; whether answers of ``echo 7`` have it is unknown, so both are
read. A motor with a linear axis definition has no kinematics, so only the definitions are compared [PowerPMAC, Axis
Definition Statements]. Soft limits of a Power PMAC act while ``MaxPos`` is above ``MinPos`` [PowerPMAC, Overtravel
Limits].

Input: a session, settings, the stroke in mm. Output: every difference as text.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from decimal import Decimal

import numpy as np

from pkm_post.control.link.errors import NotReadyError
from pkm_post.control.link.queries import is_definition, query_line, read_number
from pkm_post.control.link.session import Session
from pkm_post.control.link.status import MOTORS, AnySettings
from pkm_post.writing import PmacSettings, PowerPmacSettings

_UNSIGNED = r"(?:\d+(?:\.\d*)?|\.\d+)(?:E[-+]?\d+)?"
"""Digits belong to one part of it only: a long answer of nothing else is refused in time in proportion to it."""
_DEFINITION = re.compile(
    rf"(?:(?:&(?P<system>\d+))?#(?P<motor>\d+)->)?(?P<scale>[-+]?{_UNSIGNED})?(?P<letter>[A-Z]+)(?P<offset>[-+]{_UNSIGNED})?"
)
_ROTARY = "ABC"
_BEYOND = 0.001
"""mm: a limit this far beyond the stroke, or a motor unit if that is less, is one of rounding."""
_HOLDS = "more than 0, or a hold does not stop the struts"

_Expected = Mapping[str, tuple[float, str]]
"""Values by name of a variable or an element, each with its reason."""


def check_setup(session: Session, settings: AnySettings, stroke: tuple[float, float]) -> None:
    """Compare the controller with the set-up that programs of this machine rely on.

    Args:
        stroke: shortest and longest strut length, mm.

    Raises:
        NotReadyError: lists all differences.
    """
    reasons = list(_axis_faults(session, settings))
    system = settings.coordinate_system
    if isinstance(settings, PowerPmacSettings):
        reasons += _value_faults(session, _expected_elements(settings))
        reasons += _number_faults(session, "Sys.MaxCoords", system + 1, f"more than {system}")
        for motor in MOTORS:
            reasons += _number_faults(
                session, f"Motor[{motor}].ServoCtrl", 1, f"1 or more (strut {motor} is activated)"
            )
        reasons += _number_faults(session, f"Coord[{system}].FeedHoldSlew", 1e-99, _HOLDS)
        reasons += _source_faults(session, f"Coord[{system}]")
        reasons += _element_limit_faults(session, settings, stroke)
    else:
        reasons += _value_faults(session, _expected_variables(settings))
        reasons += _number_faults(session, "I68", system - 1, f"{system - 1} or more")
        reasons += _number_faults(session, f"I{50 + system}95", 1, _HOLDS)
        reasons += _value_faults(session, _time_base(settings), "${:X}")
        reasons += _variable_limit_faults(session, settings, stroke)
    if reasons:
        raise NotReadyError(reasons)


def _axis_faults(session: Session, settings: AnySettings) -> Iterator[str]:
    """Compare ``#n->`` with the axis definitions of the set-up file; an axis of the spindle has no offset."""
    axes = [
        (motor, settings.counts_per_mm, letter, zero)
        for motor, letter, zero in zip(MOTORS, settings.letters, settings.zero_length, strict=True)
    ]
    if (spindle := settings.spindle_axis) is not None:
        axes.append((spindle.motor, spindle.counts_per_turn, spindle.letter, 0.0))
    for motor, counts, letter, zero in axes:
        scale, zero_length = (Decimal(repr(float(number))) for number in (counts, zero))
        wanted = (scale, letter, -(scale * zero_length))
        answer = query_line(session, f"&{settings.coordinate_system}#{motor}->").replace(" ", "").upper()
        found = _DEFINITION.fullmatch(answer)
        got = found and (Decimal(found["scale"] or 1), found["letter"], Decimal(found["offset"] or 0))
        own = (str(settings.coordinate_system), str(motor))
        is_own = found and all(shown in (None, mine) for shown, mine in zip(found.group(1, 2), own, strict=True))
        if not is_definition(got, wanted) or not is_own:
            stated = f"{wanted[0].normalize():f}{letter}{wanted[2].normalize():+f}"
            yield f"#{motor}->: expected {stated}, the controller has {answer or 'nothing'}"


def _expected_variables(settings: PmacSettings) -> _Expected:
    base = f"I{50 + settings.coordinate_system}"
    expected = {
        f"{base}90": (1000, "speeds are in mm/s"),
        f"{base}50": (0, "no kinematics in the controller"),
        f"{base}92": (0, "moves follow one another without a stop"),
    }
    for motor, letter in zip(MOTORS, settings.letters, strict=True):
        if letter in _ROTARY:
            expected[f"I{motor}27"] = (0, "no rollover of a strut")
    if (spindle := settings.spindle_axis) is not None:
        expected |= {f"I{spindle.motor}{end}": (0, "no soft limit of the spindle") for end in (13, 14)}
        if spindle.letter in _ROTARY:
            expected[f"I{spindle.motor}27"] = (0, "no rollover of the spindle")
    return expected


def _expected_elements(settings: PowerPmacSettings) -> _Expected:
    system = f"Coord[{settings.coordinate_system}]"
    expected = {
        f"{system}.FeedTime": (1000, "speeds are in mm/s"),
        f"{system}.SegMoveTime": (0, "each interval is one cubic"),
        f"{system}.NoBlend": (0, "moves follow one another without a stop"),
        f"{system}.Csolve": (1, "the axis definitions can be solved"),
    }
    for letter in settings.letters:
        if letter in _ROTARY:
            expected[f"{system}.PosRollover[{_ROTARY.index(letter)}]"] = (0, "no rollover of a strut")
    return expected


def _time_base(settings: PmacSettings) -> _Expected:
    """Another time base than that of ``%`` is not limited to 100 %, and at rest it looks like a hold."""
    return {f"I{50 + settings.coordinate_system}93": (settings.time_base, "the time base is the override")}


def _source_faults(session: Session, system: str) -> Iterator[str]:
    """As ``_time_base``; an element that points to a register is shown with its name or, perhaps, its address."""
    own, pointer = f"{system}.DesTimeBase.a", f"{system}.pDesTimeBase"
    got = query_line(session, pointer).removeprefix(f"{pointer}=")
    if got.lower() != own.lower() and got != query_line(session, own).removeprefix(f"{own}="):
        yield f"{pointer}: expected {own} (the time base is the override), the controller has {got}"


def _value_faults(session: Session, expected: _Expected, form: str = "{:g}") -> Iterator[str]:
    for name, (value, why) in expected.items():
        got = read_number(session, name)
        if got != value:
            number = int(got) if "X" in form else got
            yield f"{name}: expected {form.format(value)} ({why}), the controller has {form.format(number)}"


def _number_faults(session: Session, name: str, least: float, words: str) -> Iterator[str]:
    got = read_number(session, name)
    if got < least:
        yield f"{name}: expected {words}, the controller has {got:g}"


def _counts(settings: AnySettings, stroke: tuple[float, float]) -> Iterator[tuple[int, float, float]]:
    """Yield each motor with its lowest and highest position within the stroke, in counts."""
    for motor, zero in zip(MOTORS, settings.zero_length, strict=True):
        low, high = sorted(settings.counts_per_mm * (length - zero) for length in stroke)
        yield motor, low, high


def _variable_limit_faults(session: Session, settings: PmacSettings, stroke: tuple[float, float]) -> Iterator[str]:
    """The soft limits must be enabled and within the stroke."""
    for motor, low, high in _counts(settings, stroke):
        for name, (least, most) in {f"I{motor}13": (-np.inf, high), f"I{motor}14": (low, np.inf)}.items():
            got = read_number(session, name)
            if got == 0 or not least - 1 <= got <= most + 1:
                within = f"{most:.0f} or less" if np.isfinite(most) else f"{least:.0f} or more"
                yield f"{name}: expected {within} and not 0, which is no limit; the controller has {got:g}"


def _element_limit_faults(session: Session, settings: PowerPmacSettings, stroke: tuple[float, float]) -> Iterator[str]:
    """The soft limits must be enabled and within the stroke."""
    beyond = min(1.0, _BEYOND * abs(settings.counts_per_mm))  # a motor unit can be a millimetre or a metre
    for motor, low, high in _counts(settings, stroke):
        least, most = (read_number(session, f"Motor[{motor}].{name}") for name in ("MinPos", "MaxPos"))
        if not low - beyond <= least < most <= high + beyond:
            yield (
                f"Motor[{motor}].MinPos and MaxPos: expected limits from {low:.10g} to {high:.10g},"
                f" the controller has {least:g} and {most:g}"
            )
