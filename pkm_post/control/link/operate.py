# SPDX-License-Identifier: LGPL-2.1-or-later
"""Operate: run and resume a program, and set its override. Each command is sent once; then the state is read.

Hold and abort are in ``stopping``. ``Q`` is not offered: it would end a program at a knot where the struts are moving.
The controller's state shows a command with a short delay, so each command is watched until it shows.

Enters: a session, settings, a program. Leaves: the resulting state.
"""

from __future__ import annotations

from collections.abc import Callable

from pkm_post.control.link.download import listing_of
from pkm_post.control.link.faults import NotReadyError, OutcomeUnknownError, PmacError
from pkm_post.control.link.listing import Program
from pkm_post.control.link.motion import settled_status
from pkm_post.control.link.ownership import RESUMED_BY_ALL, owned
from pkm_post.control.link.ready import check_start
from pkm_post.control.link.session import Session
from pkm_post.control.link.status import Array, Status, read_status
from pkm_post.model import Machine
from pkm_post.options import START_TOLERANCE_MM
from pkm_post.writing import PmacSettings

OVERRIDE_S = 5.0
"""Seconds for the time base to reach an override."""
SHOWN_S = 0.5
"""Seconds for the state to show that a start was accepted."""
_OVERRIDE_REACHED = 0.1
"""%"""
_POLL_S = 0.02


def run(
    session: Session,
    settings: PmacSettings,
    program: Program,
    first: Array,
    near: float = START_TOLERANCE_MM,
    machine: Machine | None = None,
) -> Status:
    """Start a program from its beginning.

    Args:
        session: an open session.
        settings: of the machine's controller.
        program: what the controller must hold; its listing is verified again.
        first: (6,) strut lengths of its first point, mm.
        near: largest distance of each strut from it, mm.
        machine: its geometry, to compare the tool pose as well.

    Raises:
        NotReadyError: the controller's program differs, or the machine is not ready.
        OutcomeUnknownError: the link failed at the start, and the state does not show a running program.
        CancelledError: a stop came first; nothing was started.
        NotOwnerError: another client owns the machine; nothing was started.
    """
    with owned(session, "run"):
        there = listing_of(session, program)
        if not there.same:
            raise NotReadyError([f"program {program.number} in the controller is another one: {there.difference}"])
        check_start(settled_status(session, settings), first, near, machine)
        return _go(session, settings, f"B{program.number}R", lambda status: status.running)


def resume(session: Session, settings: PmacSettings) -> Status:
    """Resume a held program.

    Raises:
        NotReadyError: no program is held, or there is a fault.
        OutcomeUnknownError: the link failed, and the state does not show that the program has resumed.
        CancelledError: a stop came first; the program is still held.
        NotOwnerError: the program belongs to another client; it is still held.
    """
    with owned(session, "resume", beside=RESUMED_BY_ALL):
        return _resume(session, settings)


def _resume(session: Session, settings: PmacSettings) -> Status:
    status = read_status(session, settings)
    reasons = list(status.words())
    if not status.held:
        reasons.append("no program is held; after a stop (M0, M1) continue it, else start it from its beginning")
    if reasons:
        raise NotReadyError(reasons)
    return _go(session, settings, "R", lambda status: status.running and not status.held)


def override(
    session: Session, settings: PmacSettings, percent: float, meanwhile: Callable[[], None] = lambda: None
) -> Status:
    """Set the override of the time base and verify that it takes effect.

    Args:
        session: an open session.
        settings: of the machine's controller.
        percent: above 0 and up to 100: programs are planned to the limits of the machine at 100 %.
        meanwhile: called after each reading.

    Raises:
        ValueError: the percentage is out of range; use a hold to stop.
        NotReadyError: a program is held; its time base is at 0.
        PmacError: the time base does not reach it.
        CancelledError: a stop came first.
        NotOwnerError: another client owns the machine.
    """
    if not 0 < percent <= 100:
        raise ValueError(f"percent: expected above 0 and up to 100, got {percent:g}")
    with owned(session, "override", beside=RESUMED_BY_ALL):
        return _override(session, settings, percent, meanwhile)


def _override(session: Session, settings: PmacSettings, percent: float, meanwhile: Callable[[], None]) -> Status:
    if read_status(session, settings).held:
        raise NotReadyError(["a program is held: resume it, or abort it, before the override is changed"])
    session.order(f"&{settings.coordinate_system}%{percent:.2f}")

    def is_reached(status: Status) -> bool:
        return abs(status.override - percent) <= _OVERRIDE_REACHED

    status = _watched(session, settings, is_reached, OVERRIDE_S, session.is_waited_for, meanwhile)
    if is_reached(status):
        return status
    session.give_way()
    taken_from = f"I{50 + settings.coordinate_system}93"
    raise PmacError(
        f"the time base stays at {status.override:g} % after %{percent:g}: {taken_from} may take it from elsewhere"
    )


def _go(session: Session, settings: PmacSettings, order: str, goes: Callable[[Status], bool]) -> Status:
    """Send a command that moves the machine, once, unless a stop waits; if its answer is lost, the state decides."""
    session.give_way()
    try:
        session.order(f"&{settings.coordinate_system}{order}")
    except OutcomeUnknownError:
        status = _watched(session, settings, goes, SHOWN_S)
        if not goes(status):
            raise
        return status
    return _watched(session, settings, goes, SHOWN_S)


def _watched(
    session: Session,
    settings: PmacSettings,
    holds: Callable[[Status], bool],
    seconds: float,
    is_over: Callable[[], bool] = lambda: False,
    meanwhile: Callable[[], None] = lambda: None,
) -> Status:
    """Poll until the state satisfies ``holds``; return the last state on timeout, or when ``is_over``."""
    until = session.now() + seconds
    while True:
        status = read_status(session, settings)
        if holds(status) or session.now() >= until or is_over():
            return status
        meanwhile()
        session.sleep(_POLL_S)
