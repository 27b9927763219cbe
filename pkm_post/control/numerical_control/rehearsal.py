# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rehearsal: measure the time from silence to standstill of a watched program on a Power PMAC, without motion.

``Coord[].FeedHoldSlew`` sets the deceleration of a hold, but no available source gives its unit. So before the first
jog a program with a watchdog runs with the struts at rest; it is renewed once and then left alone until
``Coord[].FeedHold`` shows a time base of zero (1; 3 while slowing down) [Power PMAC User's Manual, p. 693]. That proves
on this controller everything a jog relies on: the program counts, a renewal gets through, it holds itself, and in what
time. It is repeated when the element changes.

Input: a machine at standstill. Output: a time, for this session.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from pkm_post.control.link import stopping
from pkm_post.control.link.errors import NotReadyError
from pkm_post.control.link.queries import read_number
from pkm_post.control.link.session import Session
from pkm_post.control.link.status import AnySettings, read_status
from pkm_post.control.numerical_control.execute import execute_watched, job_of
from pkm_post.control.numerical_control.plan import LONGEST_MOVE_MS
from pkm_post.control.numerical_control.watchdog import CREDIT_MS, Watchdog, silence_s
from pkm_post.model import Array, Machine, StrutMotion, read_only
from pkm_post.writing import PowerPmacSettings

_LONGEST_S = 30.0
"""Longest rehearsal; a slower hold is no protection."""
_MOVES = 80
"""Moves of its program, 10 s at 100 %: more than its count, plus half of any acceptable hold."""
_STOPPED = 1
_POLL_S = 0.02
_FULL_OVERRIDE = 100.0


@dataclass(frozen=True)
class Silence:
    """Result of a rehearsal.

    Attributes:
        seconds: longest time from silence to standstill, at an override of 100 %.
        slew: value of ``Coord[].FeedHoldSlew`` at that time; 0 on a Turbo PMAC, which is queried each time.
    """

    seconds: float
    slew: float = 0.0


def longest_silence(
    session: Session, machine: Machine, settings: AnySettings, number: int, known: Silence | None = None
) -> Silence:
    """Longest time from silence to standstill of a jog.

    Args:
        session: an open session; on a Power PMAC with ownership of the machine.
        machine: the machine, at standstill.
        number: of the program to use, and of its P-variable.
        known: earlier result of the same session.

    Raises:
        NotReadyError: a hold would not stop this machine, or as ``execute.execute``.
        PmacError: as ``execute.execute``.
    """
    if not isinstance(settings, PowerPmacSettings):
        return Silence(silence_s(session, settings))
    slew = read_number(session, f"Coord[{settings.coordinate_system}].FeedHoldSlew")
    if known is not None and known.slew == slew:
        return known
    return Silence(_rehearsed(session, machine, settings, number), slew)


def _rehearsed(session: Session, machine: Machine, settings: PowerPmacSettings, number: int) -> float:
    status = read_status(session, settings)
    settings = replace(settings, program=number)
    job = job_of(_standing(status.commanded, settings), settings, "rehearsal")
    _, watchdog = execute_watched(session, machine, settings, job, 0.0)
    found = _times(session, settings, watchdog)
    stopping.abort(session, settings, at_once=True)
    if found is None:
        raise NotReadyError(
            [
                f"a program that counts down P{number} and is not renewed did not hold itself within {_LONGEST_S:g} s:"
                " nothing would stop a jog when the link fails"
            ]
        )
    count, slowing = found
    share = status.override / _FULL_OVERRIDE
    # The count is in program time. Slowing down from a lower override takes at least that share.
    return count * share + slowing / share + LONGEST_MOVE_MS / 1000


def _times(session: Session, settings: PowerPmacSettings, watchdog: Watchdog) -> tuple[float, float] | None:
    """Seconds from the last renewal to deceleration, and from there to a time base of zero; None if not seen."""
    element, variable = f"Coord[{settings.coordinate_system}].FeedHold", f"P{watchdog.variable}"
    until, renewed, slows = session.now() + _LONGEST_S, None, None
    while session.now() < until:
        session.check_preemption()
        if renewed is None and read_number(session, variable) < CREDIT_MS:  # past the approach
            renewed = session.now()
            watchdog.renew(session)
        state = read_number(session, element)
        if state and slows is None:
            slows = session.now()
        if state == _STOPPED:
            ran_out = read_number(session, variable) < 0
            return (slows - renewed, session.now() - slows) if renewed and slows and ran_out else None
        session.sleep(_POLL_S)
    return None


def _standing(lengths: Array, settings: PowerPmacSettings) -> StrutMotion:
    """Struts at rest for the rehearsal, at lengths rounded as in a program."""
    printed = np.array([float(f"{length:.{settings.length_decimals}f}") for length in lengths])
    time_ms = LONGEST_MOVE_MS * np.arange(_MOVES + 1, dtype=np.int64)
    length = np.tile(printed, (len(time_ms), 1))
    return StrutMotion(read_only(time_ms), read_only(length), read_only(np.zeros_like(length)), ())
