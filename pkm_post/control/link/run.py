# SPDX-License-Identifier: LGPL-2.1-or-later
"""Run: start and resume a program, watch its override. Each command is sent once, then the state is read.

Hold and abort are in ``stopping``. ``Q`` is not offered: it would end a program at a knot where the struts are moving.
The controller's state reflects a command with a short delay, so it is polled. Preconditions in controller and machine
are queried, never assumed.

Input: a session, settings, a program, strut lengths in mm. Output: the resulting state, or ``NotReadyError`` with every
reason.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from pkm_post.control.link import stopping
from pkm_post.control.link.download import verify_listing
from pkm_post.control.link.errors import NotReadyError, OutcomeUnknownError, OverrideError, PmacError
from pkm_post.control.link.owner_record import RESUMED_BY_ALL, release_hold
from pkm_post.control.link.ownership import owned
from pkm_post.control.link.program import PmacProgram
from pkm_post.control.link.session import Session
from pkm_post.control.link.status import MOTORS, AnySettings, Status, read_status, settled_status
from pkm_post.control.link.tool_pose import start_faults
from pkm_post.model import Array, Machine
from pkm_post.options import OVERRIDE_PERCENT, START_TOLERANCE_MM
from pkm_post.writing import PowerPmacSettings

LOWEST_OVERRIDE, HIGHEST_OVERRIDE = OVERRIDE_PERCENT


def check_start(
    status: Status, first: Array, start_tolerance: float = START_TOLERANCE_MM, machine: Machine | None = None
) -> None:
    """Check that a program may start: struts homed, in closed loop, without faults, at rest near its first point.

    Args:
        first: (6,) strut lengths of the first point, mm.
        start_tolerance: largest distance of each strut from it, mm.
        machine: its geometry, to compare the tool pose as well.

    Raises:
        NotReadyError: lists every reason.
    """
    reasons = [*_motor_faults(status), *status.fault_texts()]
    if status.running:
        reasons.append("a program runs, or is held")
    if not status.override <= HIGHEST_OVERRIDE:
        reasons.append(f"the override is {status.override:g} %: the program was planned to the limits at 100 %")
    away = np.abs(status.length - first)
    reasons += [
        f"strut {motor}: {status.length[motor - 1]:.3f} mm long, {distance:.3f} mm from the first point of the program"
        for motor, distance in zip(MOTORS, away, strict=True)
        if not distance <= start_tolerance
    ]
    if machine is not None and all(status.homed):
        reasons += start_faults(machine, status.length, first, start_tolerance)
    if reasons:
        raise NotReadyError(tuple(dict.fromkeys(reasons)))


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
            if name in bits.BIT_NUMBERS and not bits.has(name):
                yield f"strut {motor}: {otherwise}"


OVERRIDE_S = 5.0
"""Seconds for the time base to reach an override."""
SHOWN_S = 0.5
"""Seconds for the state to reflect a start."""
_OVERRIDE_REACHED = 0.1
"""%"""
_POLL_S = 0.02


def start_program(
    session: Session,
    settings: AnySettings,
    program: PmacProgram,
    first: Array,
    start_tolerance: float = START_TOLERANCE_MM,
    machine: Machine | None = None,
) -> Status:
    """Start a program from its beginning.

    Args:
        program: the program in the controller; its listing is verified again.
        first: (6,) strut lengths of its first point, mm.
        start_tolerance: largest distance of each strut from it, mm.
        machine: its geometry, to compare the tool pose as well.

    Raises:
        NotReadyError: the controller's program differs, or the machine is not ready.
        OutcomeUnknownError: the link failed at the start, and no program is seen running.
        CancelledError: a stop came first; nothing was started.
        NotOwnerError: another client owns the machine; nothing was started.
    """
    with owned(session, "run"):
        there = verify_listing(session, program)
        if not there.same:
            raise NotReadyError([f"program {program.number} in the controller is a different one: {there.difference}"])
        check_start(settled_status(session, settings), first, start_tolerance, machine)
        return _start_motion(session, settings, f"B{program.number}R", lambda status: status.running)


def resume_program(session: Session, settings: AnySettings) -> Status:
    """Resume a held program, or a play that was held between two motions.

    Raises:
        NotReadyError: no program is held, or there is a fault.
        OutcomeUnknownError: the link failed, and the program is not seen to resume.
        CancelledError: a stop came first; the program is still held.
        NotOwnerError: another client owns the program; it is still held.
    """
    with owned(session, "resume", concurrent=RESUMED_BY_ALL):
        return _resume(session, settings)


def _resume(session: Session, settings: AnySettings) -> Status:
    status = read_status(session, settings)
    reasons = list(status.fault_texts())
    is_released = not reasons and release_hold(session)
    if not (status.held or is_released):
        advice = "after a stop (M0, M1) continue it, otherwise start it from its beginning"
        reasons.append(f"no program is held; {'it runs already' if status.running else advice}")
    if reasons:
        raise NotReadyError(reasons)
    if not status.held:
        return status  # its play starts the next motion
    return _start_motion(session, settings, "R", lambda status: status.running and not status.held)


def set_feed_override(
    session: Session, settings: AnySettings, percent: float, meanwhile: Callable[[], None] = lambda: None
) -> Status:
    """Set the override of the time base and verify that it takes effect.

    Args:
        percent: from 0.01 to 100: programs are planned to the limits of the machine at 100 %.
        meanwhile: called after each reading.

    Raises:
        ValueError: the percentage is out of range; to stop, use a hold.
        NotReadyError: a program is held; its time base is at 0.
        PmacError: the time base does not reach it.
        CancelledError: a stop came first.
        NotOwnerError: another client owns the machine.
    """
    if not LOWEST_OVERRIDE <= percent <= HIGHEST_OVERRIDE:
        raise ValueError(f"percent: expected {LOWEST_OVERRIDE:g} to {HIGHEST_OVERRIDE:g}, got {percent:g}")
    with owned(session, "override", concurrent=RESUMED_BY_ALL):
        return _override(session, settings, percent, meanwhile)


def _override(session: Session, settings: AnySettings, percent: float, meanwhile: Callable[[], None]) -> Status:
    if read_status(session, settings).held:
        raise NotReadyError(["a program is held: resume it, or abort it, before the override is changed"])
    session.command(f"&{settings.coordinate_system}%{percent:.2f}")

    def is_reached(status: Status) -> bool:
        return abs(status.override - percent) <= min(_OVERRIDE_REACHED, percent / 2)  # 0 is none

    status = _wait_until(session, settings, is_reached, OVERRIDE_S, session.stop_pending, meanwhile)
    if is_reached(status):
        return status
    session.check_preemption()
    system = settings.coordinate_system
    is_power = isinstance(settings, PowerPmacSettings)
    slew = f"Coord[{system}].TimeBaseSlew" if is_power else f"I{50 + system}94"
    raise PmacError(
        f"the time base stays at {status.override:g} % after %{percent:g}:"
        f" {slew} may be too low, or the time base may have another source"
    )


def check_override(session: Session, settings: AnySettings, status: Status, where: str = "") -> None:
    """Hold a running program on its path at an override for which no motion is certified.

    Args:
        where: the place, as text.

    Raises:
        OverrideError: the override is above 100 %, set from elsewhere.
    """
    if not status.running or status.held or status.override <= HIGHEST_OVERRIDE:
        return
    held = stopping.hold(session, settings).held
    at = f"{status.override:g} % {where}".rstrip()
    limit = f"the motion is certified for at most {HIGHEST_OVERRIDE:g} %"
    raise OverrideError(f"the override is {at}, set from elsewhere: {limit}", held)


def watch_program(session: Session, settings: AnySettings) -> Status:
    """Poll until no program runs and the struts are at rest; a held program is waited for.

    Raises:
        OverrideError: as ``check_override``.
    """
    while True:
        status = read_status(session, settings)
        if status.standing and not status.running:
            return status
        check_override(session, settings, status)
        session.sleep(_POLL_S)


def watch_resumed(session: Session, settings: AnySettings, status: Status) -> Status:
    """Poll until the time base is steady after a resume: a held one does not show the override that it returns to.

    Raises:
        OverrideError: as ``check_override``.
    """
    until = session.now() + OVERRIDE_S
    while status.running and not status.held and session.now() < until:
        check_override(session, settings, status)
        session.sleep(_POLL_S)
        before, status = status, read_status(session, settings)
        if status.override == before.override:
            break
    return status


def _start_motion(session: Session, settings: AnySettings, order: str, goes: Callable[[Status], bool]) -> Status:
    """Send a motion command once, unless a stop is waiting; if its answer is lost, the state decides."""
    session.check_preemption()
    try:
        session.command(f"&{settings.coordinate_system}{order}")
    except OutcomeUnknownError:
        status = _wait_until(session, settings, goes, SHOWN_S)
        if not goes(status):
            raise
        return status
    return _wait_until(session, settings, goes, SHOWN_S)


def _wait_until(
    session: Session,
    settings: AnySettings,
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
