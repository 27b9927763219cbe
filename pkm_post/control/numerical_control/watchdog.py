# SPDX-License-Identifier: LGPL-2.1-or-later
"""Watchdog: a program counts down its own time and holds itself unless this computer renews the count.

Input: the lines of a program whose moves are no longer than ``plan.LONGEST_MOVE_MS``. Output: the same lines with those
of the watchdog, and the longest time from silence to standstill. The deceleration of a hold is an I-variable with a
documented unit on a Turbo PMAC; on a Power PMAC it is measured (``rehearsal``).
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from pkm_post.control.link.errors import NotReadyError
from pkm_post.control.link.program import PmacProgram
from pkm_post.control.link.queries import read_number
from pkm_post.control.link.session import Session
from pkm_post.control.link.status import AnySettings
from pkm_post.control.numerical_control.plan import LONGEST_MOVE_MS
from pkm_post.writing import PmacSettings, PowerPmacSettings

CREDIT_MS = 600
"""Time a program may run after a renewal: several readings over a serial line."""
_AHEAD_MS = 2 * LONGEST_MOVE_MS
"""Time beyond the credit: moves computed ahead, and moves covered by one watchdog line."""
_UNITS_PER_S = 1000 * 2**23
"""Isx95 counts 2^-23 ms per servo cycle; the cycle has I10 of these units, which are 100 % [TurboPMAC, I10, Isx95]."""
_INTERVAL, _MOVE = re.compile(r"PVT(\d+)", re.IGNORECASE), re.compile(r"[A-Z]\S+:\S+ .*")


@dataclass(frozen=True)
class Watchdog:
    """The watchdog of a program.

    Attributes:
        program: with the watchdog lines.
        variable: number of the P-variable that counts down.
        silence_s: longest time from silence to standstill, s, at an override of 100 %.
    """

    program: PmacProgram
    variable: int
    silence_s: float

    def renew(self, session: Session) -> None:
        """Let the program continue; retried if the link fails, since a repeated renewal is harmless.

        Raises:
            PmacError: the controller is unreachable, or refuses.
        """
        session.query(_credit(self.variable))


def watchdog_of(settings: AnySettings, program: PmacProgram, silence_s: float) -> Watchdog:
    """Insert a watchdog into a program; its P-variable has the number of the program.

    Args:
        program: as certified.
        silence_s: longest time from silence to standstill, s.
    """
    lines = with_watchdog(program.lines, program.number, settings)
    return Watchdog(PmacProgram(program.number, lines), program.number, silence_s)


def silence_s(session: Session, settings: PmacSettings) -> float:
    """Longest time from silence to standstill of a watched program on a Turbo PMAC, s, at an override of 100 %.

    Raises:
        NotReadyError: a hold on this controller would never finish.
    """
    name = f"I{50 + settings.coordinate_system}95"
    slew = abs(read_number(session, name))
    if slew == 0:
        raise NotReadyError(
            [f"{name} is 0: a hold would not stop the struts, so nothing stops them when the link fails"]
        )
    cycle = read_number(session, "I10")
    return (CREDIT_MS + _AHEAD_MS) / 1000 + cycle / slew * cycle / _UNITS_PER_S


def with_watchdog(lines: Sequence[str], variable: int, settings: AnySettings) -> tuple[str, ...]:
    """Insert the lines of a watchdog into a program.

    Args:
        lines: of a program whose moves are no longer than ``plan.LONGEST_MOVE_MS``.
        variable: number of the P-variable.
        settings: of the controller, with the coordinate system to hold.
    """
    guard = f"{'if' if isinstance(settings, PowerPmacSettings) else 'IF'}(P{variable}<0){_hold(settings)}"
    made = [_credit(variable)]
    for ms, group in _groups(lines):
        made += [f"P{variable}=P{variable}-{ms}", guard] if ms else []
        made += group
    return tuple(made)


def _hold(settings: AnySettings) -> str:
    """A hold as a statement: an on-line command, or a direct one [Power PMAC User's Manual, p. 689]."""
    system = settings.coordinate_system
    return f" hold{system}" if isinstance(settings, PowerPmacSettings) else f'COMMAND"&{system}H"'


def _credit(variable: int) -> str:
    return f"P{variable}={CREDIT_MS}"


def _groups(lines: Sequence[str]) -> Iterator[tuple[int, list[str]]]:
    """Groups of lines with their total ms, each within the longest single move."""
    interval, total, group = 0, 0, list[str]()
    for line in lines:
        stated = _INTERVAL.fullmatch(line)
        interval = int(stated[1]) if stated else interval
        ms = interval if _MOVE.fullmatch(line) else 0
        if ms and total + ms > LONGEST_MOVE_MS:
            yield total, group
            total, group = 0, []
        total += ms
        group.append(line)
    yield total, group
