# SPDX-License-Identifier: LGPL-2.1-or-later
"""Power set-up: compare a Power PMAC with the set-up that programs of the machine rely on.

A motor with a linear axis definition has no kinematics, so only the definitions are compared [PowerPMAC, Axis
Definition Statements]. They are reported with the coordinate system in front, ``&1#1->10000A-500`` [gpascii;
dls_powerpmacanalyse]; whether answers of ``echo 7`` have it is unknown, so both are read. Soft limits act while
``MaxPos`` is above ``MinPos`` [PowerPMAC, Overtravel Limits].

Input: a session, settings, the stroke in mm. Output: every difference as text.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from decimal import Decimal

from pkm_post.control.link.queries import is_definition, query_line, read_number
from pkm_post.control.link.session import Session
from pkm_post.control.link.status import MOTORS
from pkm_post.writing import PowerPmacSettings

_UNSIGNED = r"(?:\d+\.?\d*|\.\d+)(?:E[-+]?\d+)?"
_DEFINITION = re.compile(
    rf"(?:(?:&(?P<system>\d+))?#(?P<motor>\d+)->)?(?P<scale>[-+]?{_UNSIGNED})?(?P<letter>[A-Z]+)(?P<offset>[-+]{_UNSIGNED})?"
)
_ROTARY = "ABC"
_BEYOND = 0.001
"""mm: a limit this far beyond the stroke, or a motor unit if that is less, is one of rounding."""


def setup_faults(session: Session, settings: PowerPmacSettings, stroke: tuple[float, float]) -> Iterator[str]:
    """Every difference between the controller and the set-up of the machine, as text.

    Args:
        session: an open session.
        settings: of the machine's controller.
        stroke: shortest and longest strut length, mm.
    """
    yield from _axis_faults(session, settings)
    yield from _element_faults(session, settings)
    yield from _limit_faults(session, settings, stroke)


def _axis_faults(session: Session, settings: PowerPmacSettings) -> Iterator[str]:
    scale = Decimal(repr(settings.counts_per_mm))
    for motor, letter, zero in zip(MOTORS, settings.letters, settings.zero_length, strict=True):
        wanted = (scale, letter, -scale * Decimal(repr(float(zero))))
        answer = query_line(session, f"&{settings.coordinate_system}#{motor}->").replace(" ", "").upper()
        found = _DEFINITION.fullmatch(answer)
        got = found and (Decimal(found["scale"] or 1), found["letter"], Decimal(found["offset"] or 0))
        own = (str(settings.coordinate_system), str(motor))
        is_own = found and all(shown in (None, mine) for shown, mine in zip(found.group(1, 2), own, strict=True))
        if not is_definition(got, wanted) or not is_own:
            stated = f"{wanted[0].normalize():f}{letter}{wanted[2].normalize():+f}"
            yield f"#{motor}->: expected {stated}, the controller has {answer or 'nothing'}"


def _element_faults(session: Session, settings: PowerPmacSettings) -> Iterator[str]:
    system = f"Coord[{settings.coordinate_system}]"
    expected = {
        f"{system}.FeedTime": (1000, "speeds are in mm/s"),
        f"{system}.SegMoveTime": (0, "each interval is one cubic"),
        f"{system}.Csolve": (1, "the axis definitions can be solved"),
    }
    for motor, letter in zip(MOTORS, settings.letters, strict=True):
        expected[f"Motor[{motor}].ServoCtrl"] = (1, f"strut {motor} is activated")
        if letter in _ROTARY:
            expected[f"{system}.PosRollover[{_ROTARY.index(letter)}]"] = (0, "no rollover of a strut")
    for name, (value, why) in expected.items():
        got = read_number(session, name)
        if got != value:
            yield f"{name}: expected {value} ({why}), the controller has {got:g}"
    served = read_number(session, "Sys.MaxCoords")
    if served <= settings.coordinate_system:
        yield f"Sys.MaxCoords: expected more than {settings.coordinate_system}, the controller has {served:g}"


def _limit_faults(session: Session, settings: PowerPmacSettings, stroke: tuple[float, float]) -> Iterator[str]:
    """The soft limits must be enabled and within the stroke."""
    beyond = min(1.0, _BEYOND * abs(settings.counts_per_mm))  # a motor unit can be a millimetre or a metre
    for motor, zero in zip(MOTORS, settings.zero_length, strict=True):
        low, high = sorted(settings.counts_per_mm * (length - zero) for length in stroke)
        least, most = (read_number(session, f"Motor[{motor}].{name}") for name in ("MinPos", "MaxPos"))
        if not low - beyond <= least < most <= high + beyond:
            yield (
                f"Motor[{motor}].MinPos and MaxPos: expected limits from {low:.10g} to {high:.10g},"
                f" the controller has {least:g} and {most:g}"
            )
