# SPDX-License-Identifier: LGPL-2.1-or-later
"""Watchdog: a program that the controller holds by itself when the computer that started it falls silent.

The program counts a variable of the controller down by the milliseconds of its next moves, in front of these moves, and
holds its coordinate system when the variable falls below zero. Whoever watches the machine sets the variable up again,
several times a second. A computer that is switched off, a process that is killed, a window that hangs and a cable that
is cut all look alike to it: nothing comes. The hold is the controller's own, so the struts stay on the certified path.

Enters: the lines of a certified program. Leaves: the same lines with those of the watchdog between them.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from pkm_post.controllers.pmac import Settings
from pkm_post.feed.knots import LONGEST_MS
from pkm_post.pmac_link.faults import NotReadyError
from pkm_post.pmac_link.listing import Program
from pkm_post.pmac_link.ready import number_of
from pkm_post.pmac_link.session import Session

CREDIT_MS = 600
"""For how long a program may go on after it was renewed: several readings over a serial line."""
_AHEAD_MS = 2 * LONGEST_MS
"""The moves that a controller computes ahead, and those that a line of the watchdog stands for, are let go already."""
_FULL_SLEW = 1644.0
"""Isx95 with which a hold takes a second [TurboPMAC, Isx95]."""
_INTERVAL, _MOVE = re.compile(r"PVT(\d+)"), re.compile(r"[A-Z]\S+:\S+ .*")


@dataclass(frozen=True)
class Watchdog:
    """The watchdog of a program.

    Attributes:
        program: with its lines.
        variable: number of the variable P that counts down.
        silence_s: after how many seconds of silence the struts stand, at most, at an override of 100 %.
    """

    program: Program
    variable: int
    silence_s: float

    def renew(self, session: Session) -> None:
        """Let the program go on; asked again when the link fails, for it may arrive twice.

        Raises:
            PmacError: the controller cannot be reached, or refuses it.
        """
        session.ask(_credit(self.variable))


def watchdog_of(session: Session, settings: Settings, program: Program) -> Watchdog:
    """Put a watchdog into a program; its variable P has the number of the program.

    Args:
        session: an open session.
        settings: of the controller.
        program: as it was certified.

    Raises:
        NotReadyError: a hold would never come to its end on this controller.
    """
    name = f"I{50 + settings.coordinate_system}95"
    slew = abs(number_of(session, name))
    if slew == 0:
        raise NotReadyError([f"{name} is 0: a hold would not stop the struts, so nothing would when the link fails"])
    lines = watched(program.lines, program.number, settings.coordinate_system)
    silence = (CREDIT_MS + _AHEAD_MS) / 1000 + _FULL_SLEW / slew
    return Watchdog(Program(program.number, lines), program.number, silence)


def watched(lines: Sequence[str], variable: int, coordinate_system: int) -> tuple[str, ...]:
    """The lines of a program with those of a watchdog.

    Args:
        lines: of a program whose moves take no longer than ``feed.knots.LONGEST_MS``.
        variable: number of the variable P.
        coordinate_system: that is held.
    """
    guard = f'IF(P{variable}<0)COMMAND"&{coordinate_system}H"'
    made = [_credit(variable)]
    for ms, group in _groups(lines):
        made += [f"P{variable}=P{variable}-{ms}", guard] if ms else []
        made += group
    return tuple(made)


def _credit(variable: int) -> str:
    return f"P{variable}={CREDIT_MS}"


def _groups(lines: Sequence[str]) -> Iterator[tuple[int, list[str]]]:
    """The lines in groups whose moves take no longer than the longest single one may, with the ms they take."""
    interval, total, group = 0, 0, list[str]()
    for line in lines:
        stated = _INTERVAL.fullmatch(line)
        interval = int(stated[1]) if stated else interval
        ms = interval if _MOVE.fullmatch(line) else 0
        if ms and total + ms > LONGEST_MS:
            yield total, group
            total, group = 0, []
        total += ms
        group.append(line)
    yield total, group
