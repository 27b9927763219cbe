# SPDX-License-Identifier: LGPL-2.1-or-later
"""Stopping: a hold or an abort, resent until the machine is at rest, with instructions for the operator meanwhile.

A stop never gives up. It climbs a ladder: a hold slows the program down along its path; an abort stops each strut on
its own ramp; a control character aborts everything in the controller and does not need an intact line; the last rung
cuts motor power. Each rung has a timeout. A bad link does not stop the climb, except to the last rung: struts without
power may sink, so power is cut only while they are seen to move after everything else was sent.

A computer without a link stops nothing: then, and after a stop not confirmed in time, the operator gets instructions.

Input: a session, settings. Output: the state of a machine at rest. Only another waiting stop ends it earlier.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator
from dataclasses import dataclass

from pkm_post.control.link.errors import CancelledError, NoAccessError, PmacError
from pkm_post.control.link.owner_record import Owner, exchange_hold, exchange_owner, read_record
from pkm_post.control.link.session import Session, free_memory
from pkm_post.control.link.status import AnySettings, Status, read_status, settled_status
from pkm_post.writing import PowerPmacSettings

SHOWN_S = 0.5
"""Seconds for the state to reflect a stop, before it is resent."""
POLL_S = 0.02
NEXT_SEGMENT_S = 1.0
"""Seconds within which a stream or a play with a working link starts its next motion."""
_UNKNOWN_OWNER = Owner(0, 0, 0, 0, 0)
_log = logging.getLogger(__name__)

EMERGENCY_STEPS = (
    "THE LINK TO THE CONTROLLER IS LOST AND THE MACHINE MAY BE MOVING. This computer cannot stop it now.",
    "1. If anything looks wrong, press the EMERGENCY STOP of the machine. Do not wait for this computer.",
    "2. Keep everybody away from the machine. The program continues in the controller until it ends.",
    "3. If the machine has a feed hold of its own, press it, and make sure that all six struts are at rest.",
    "4. Then check the cable, the power of the controller, and this computer; leave the machine as it is.",
    "5. When the controller answers again: status, then hold, then abort; only then start, resume, jog or load.",
    "6. If the power was off or the emergency stop was pressed: home the machine before anything else.",
    "7. Move the tool clear of the part by short jogs along its axis, then to the start, before a program runs again.",
)
"""In order of priority: people, machine, link, workpiece."""
REST_DEADLINE_S = 2.0
"""Seconds after a stop within which the machine must be seen at rest, or the operator is alerted."""
NOT_AT_REST = (
    "THE MACHINE IS NOT SEEN AT REST. This computer keeps trying to stop it; do not wait for that.",
    *EMERGENCY_STEPS[1:],
)
"""Advice after a stop that was sent but not confirmed in time."""


@dataclass(frozen=True)
class Rung:
    """One rung of the ladder.

    Attributes:
        name: in plain text.
        is_obeyed: whether a state shows that the controller obeys.
        unseen_s: seconds of resending until a state shows that.
        rest_s: seconds from then for the struts to come to rest.
        blindly: whether to send it even if the machine is not known to move.
    """

    name: str
    send: Callable[[Session, AnySettings], object]
    is_obeyed: Callable[[Status], bool]
    unseen_s: float
    rest_s: float
    blindly: bool = True


def _command(text: str) -> Callable[[Session, AnySettings], object]:
    return lambda session, settings: session.command(f"&{settings.coordinate_system}{text}")


def _control(code: int) -> Callable[[Session, AnySettings], object]:
    return lambda session, settings: session.interrupt(code)


def _kill_motors(session: Session, settings: AnySettings) -> None:
    """``#1k`` is refused while a program moves the motor, ``#*k`` is not [Power PMAC User's Manual, p. 697]."""
    session.command("#*k")


def _is_held(status: Status) -> bool:
    return status.held


def _is_held_or_ended(status: Status) -> bool:
    """Held means a time base of 0: during deceleration, reversing struts are at rest for a moment."""
    return not status.running or (status.held and (status.override == 0 or not status.may_slow))


def _is_ended(status: Status) -> bool:
    return not status.running


def _never(status: Status) -> bool:
    return False


HOLD = Rung("hold", _command("H"), _is_held, unseen_s=1.0, rest_s=5.0)
ABORT = Rung("abort", _command("A"), _is_ended, unseen_s=1.0, rest_s=2.0)
ABORT_ALL = Rung("abort of everything (^A)", _control(0x01), _is_ended, unseen_s=1.0, rest_s=2.0)
KILL_ALL = Rung("power off all motors (^K)", _control(0x0B), _never, unseen_s=1.0, rest_s=0.0, blindly=False)
KILL_MOTORS = Rung("power off all motors", _kill_motors, _never, unseen_s=1.0, rest_s=0.0, blindly=False)
"""^A and ^K are control characters of a Turbo PMAC [TurboPMAC, <CTRL-A>, <CTRL-K>]; gpascii accepts none."""

TURBO_LADDER = (HOLD, ABORT, ABORT_ALL, KILL_ALL)
POWER_LADDER = (HOLD, ABORT, KILL_MOTORS)


def hold(session: Session, settings: AnySettings) -> Status:
    """Slow the program down to rest on its path; if the machine does not obey, the higher rungs stop it.

    Raises:
        CancelledError: another stop is waiting.
        NoAccessError: the controller's computer denies this user access.
    """
    return _climb(session, settings, _ladder(settings), _is_held_or_ended)


def abort(session: Session, settings: AnySettings, at_once: bool = False) -> Status:
    """End a program: with a hold first, so that the struts stay on the path, then an abort.

    Args:
        at_once: skip the hold: each strut stops on its own ramp, off the path.

    Raises:
        CancelledError: another stop is waiting; the abort was sent.
        NoAccessError: the controller's computer denies this user access.
    """
    _, *rungs = _ladder(settings)
    seen: Status | None = None
    if not at_once:
        try:
            with session.short_timeouts():
                seen = _try(session, settings, HOLD, _is_held_or_ended)
        except CancelledError:
            _log.warning("aborted without coming to rest before: another stop waits")
    was_held = seen is not None and seen.held  # then it is this abort that ends the program, and its owner sees that
    return _climb(session, settings, tuple(rungs), _is_ended, may_go_on=not was_held)


def _ladder(settings: AnySettings) -> tuple[Rung, ...]:
    return POWER_LADDER if isinstance(settings, PowerPmacSettings) else TURBO_LADDER


def _climb(
    session: Session,
    settings: AnySettings,
    rungs: tuple[Rung, ...],
    is_stopped: Callable[[Status], bool],
    may_go_on: bool = True,
) -> Status:
    """Climb until a state shows the machine at rest; at the top, repeat the upper two rungs."""
    seen: Status | None = None
    with session.short_timeouts():
        for rung in _endless(rungs):
            if not rung.blindly and (seen is None or seen.standing):
                continue
            seen = _try(session, settings, rung, is_stopped)
            rests = seen is not None and _rests(seen, is_stopped)
            ends = is_stopped is _is_ended
            if seen is not None and rests and may_go_on and _is_continued(session, settings, seen, ends):
                seen = _try(session, settings, rungs[0], is_stopped)
            if seen is not None and _rests(seen, is_stopped):
                return seen
            _log.warning("the machine is not seen at rest after: %s", rung.name)
    raise AssertionError("the ladder has no end")


def _is_continued(session: Session, settings: AnySettings, status: Status, ends: bool) -> bool:
    """Whether another client's stream or play starts its next motion: between them the machine is at rest anyway.

    Between two motions a play sees neither a hold nor an abort, and plans, or waits for people, as long as needed; so
    the stop is also written to the record of its owner.
    """
    other = None if status.held else _other_owner(session)
    if other is None:
        return False
    until, is_written = session.now() + NEXT_SEGMENT_S, other.action != "play"
    order = exchange_owner(other.owner, 0) if ends else exchange_hold(other, True)
    while session.now() < until:
        if not is_written and _write_to_record(session, order):
            until, is_written = session.now() + NEXT_SEGMENT_S, True  # until it sees that
            if not ends:
                _log.warning("the play of another client is held where it rests: resume continues it")
        seen = _read(session, settings)
        if seen is not None and seen.running:
            return True
        session.check_preemption()
        session.sleep(POLL_S)
    return False


def _other_owner(session: Session) -> Owner | None:
    """Another client that streams or plays, or may do so as its record cannot be read; None if there is none."""
    if session.keeper is not None:
        return None
    try:
        record = read_record(session)
    except (CancelledError, NoAccessError):
        raise
    except PmacError as fault:
        _log.warning("whether a program runs in pieces is unknown: %s", fault)
        return _UNKNOWN_OWNER
    return record if record.owner and record.action in ("stream", "play") else None


def _write_to_record(session: Session, order: str) -> bool:
    """Change the record of a play, unless it loads: the assignment might become a line of its program."""
    try:
        if session.has_handshake and free_memory(session) < 0:
            return False
        session.query(order)
    except (CancelledError, NoAccessError):
        raise
    except PmacError as fault:
        _log.warning("the stop of another client's play could not be written to its record: %s", fault)
        return False
    return True


def _endless(rungs: tuple[Rung, ...]) -> Iterator[Rung]:
    yield from rungs
    while True:
        yield from rungs[-2:]


def _rests(status: Status, is_stopped: Callable[[Status], bool]) -> bool:
    """Whether the machine is at rest; motors without power follow no program, whatever its state."""
    return status.standing and (is_stopped(status) or not status.powered)


def _try(session: Session, settings: AnySettings, rung: Rung, is_stopped: Callable[[Status], bool]) -> Status | None:
    """Send one rung until obeyed, and wait for rest; return the last state read, or None."""
    until, is_obeyed, seen, first = session.now() + rung.unseen_s, False, None, None
    while session.now() < until:
        is_taken = _send(session, settings, rung)
        again = session.now() + SHOWN_S
        while session.now() < (until if is_obeyed else min(again, until)):
            seen = _read(session, settings)
            if seen is not None and _rests(seen, is_stopped) and not seen.running:
                seen = _read(session, settings, seen)  # a homing or a jog may only begin, or reverse
            if seen is not None and _rests(seen, is_stopped):
                return seen
            first = first or seen
            if first and seen and not is_obeyed and (rung.is_obeyed(seen) or (is_taken and _slows(rung, first, seen))):
                is_obeyed, until = True, session.now() + rung.rest_s
            session.check_preemption()
            session.sleep(POLL_S)
    return seen


def _slows(rung: Rung, first: Status, now: Status) -> bool:
    """Whether a hold shows by its override, which falls: a Turbo PMAC has no bit for it."""
    return rung is HOLD and now.override < first.override


def _send(session: Session, settings: AnySettings, rung: Rung) -> bool:
    """Send a rung; return whether it was acknowledged; the state will show whether it is obeyed."""
    try:
        rung.send(session, settings)
        return True
    except (CancelledError, NoAccessError):
        raise
    except PmacError as fault:
        _log.warning("%s: %s", rung.name, fault)
        return False


def _read(session: Session, settings: AnySettings, first: Status | None = None) -> Status | None:
    """The state, or after a first reading the settled one; None if it cannot be read."""
    try:
        return settled_status(session, settings, first) if first else read_status(session, settings)
    except (CancelledError, NoAccessError):
        raise
    except PmacError:
        return None


def emergency_text(last: Status | None) -> tuple[str, ...]:
    """The instructions, or nothing if the last state read shows a machine at rest without a program.

    Args:
        last: None if no state was read.
    """
    if last is not None and not last.running and last.standing:
        return ()
    return EMERGENCY_STEPS
