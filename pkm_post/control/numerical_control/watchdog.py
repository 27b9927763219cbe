# SPDX-License-Identifier: LGPL-2.1-or-later
"""Watchdog: lets the controller hold a program by itself when the computer that started it falls silent.

Ahead of its moves, the program decrements a variable of the controller by their duration in milliseconds and holds its
coordinate system when the variable falls below zero. The client that monitors the machine resets the variable several
times a second. A computer switched off, a killed process, a frozen window and a cut cable have the same effect: no
reset arrives. The controller itself performs the hold, so the struts stay on the certified path.

Enters: the lines of a certified program. Leaves: the same lines interleaved with those of the watchdog.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from pkm_post.control.link.faults import NotReadyError
from pkm_post.control.link.listing import Program
from pkm_post.control.link.ready import number_of
from pkm_post.control.link.session import Session
from pkm_post.planning import LONGEST_MS
from pkm_post.writing import PmacSettings

CREDIT_MS = 600
"""Time a program may run after a renewal: several readings over a serial line."""
_AHEAD_MS = 2 * LONGEST_MS
"""Moves beyond the credit: those the controller computes ahead, and those that one watchdog line covers."""
_FULL_SLEW = 1644.0
"""Isx95 at which a hold takes one second [TurboPMAC, Isx95]."""
_INTERVAL, _MOVE = re.compile(r"PVT(\d+)"), re.compile(r"[A-Z]\S+:\S+ .*")


@dataclass(frozen=True)
class Watchdog:
    """The watchdog of a program.

    Attributes:
        program: with the watchdog lines.
        variable: number of the P-variable that counts down.
        silence_s: longest time from silence to standstill, s, at an override of 100 %.
    """

    program: Program
    variable: int
    silence_s: float

    def renew(self, session: Session) -> None:
        """Let the program continue; retried when the link fails, as a repeated renewal does no harm.

        Raises:
            PmacError: the controller is unreachable, or refuses.
        """
        session.ask(_credit(self.variable))


def watchdog_of(session: Session, settings: PmacSettings, program: Program) -> Watchdog:
    """Insert a watchdog into a program; its P-variable has the number of the program.

    Args:
        session: an open session.
        settings: of the controller.
        program: as it was certified.

    Raises:
        NotReadyError: a hold would never finish on this controller.
    """
    name = f"I{50 + settings.coordinate_system}95"
    slew = abs(number_of(session, name))
    if slew == 0:
        raise NotReadyError([f"{name} is 0: a hold would not stop the struts, so nothing would when the link fails"])
    lines = watched(program.lines, program.number, settings.coordinate_system)
    silence = (CREDIT_MS + _AHEAD_MS) / 1000 + _FULL_SLEW / slew
    return Watchdog(Program(program.number, lines), program.number, silence)


def watched(lines: Sequence[str], variable: int, coordinate_system: int) -> tuple[str, ...]:
    """Insert the lines of a watchdog into those of a program.

    Args:
        lines: of a program whose moves are no longer than ``feed.knots.LONGEST_MS``.
        variable: number of the P-variable.
        coordinate_system: to hold.
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
    """Groups of lines with their total ms, none longer than the longest single move may be."""
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
