# SPDX-License-Identifier: LGPL-2.1-or-later
"""Homing: triggered here, done by the machine, watched here.

In which order struts may look for their homes, and how far each may go with the platform on it, the builder of the
machine knows. So homing is a program of the controller, mostly a PLC, and nothing here knows how to do it. What is sent
is the line that the builder says starts it, when it has one of the forms below. Then the home-complete bits of all six
struts are watched, with a deadline.

Enters: the line, states of the controller and the time in s. Leaves: how far it is.
"""

from __future__ import annotations

import enum
import re
from dataclasses import dataclass

from pkm_post.controllers.pmac import Settings
from pkm_post.pmac_link.faults import NotReadyError
from pkm_post.pmac_link.motion import settled_status
from pkm_post.pmac_link.ownership import owned
from pkm_post.pmac_link.session import Session
from pkm_post.pmac_link.status import MOTORS, Status

_FORMS = {
    "ENABLE PLC n": re.compile(r"ENA(?:BLE)? ?PLC ?\d{1,2}", re.IGNORECASE),
    "Pn=value or Mn=value": re.compile(r"[PM]\d{1,4}=-?\d+(?:\.\d+)?", re.IGNORECASE),
    "&nBnR": re.compile(r"&\d{1,2} ?B\d{1,5} ?R", re.IGNORECASE),
    "#nHM": re.compile(r"#[1-6](?:HM|HOME)(?: #[1-6](?:HM|HOME))*", re.IGNORECASE),
}
"""What may start the homing of a machine: a PLC program, a variable that one waits for, a motion program, motors."""
HOMING_S = 600.0
"""Seconds in which all struts have to find their homes."""
_NOTHING_S = 5.0
"""Seconds in which something has to be seen of it."""
_QUIET_S = 2.0
"""Seconds for which all has to be at rest: a PLC may make pauses between the struts."""
_STOPS_IT = ("amplifier_fault", "fatal_following_error")


class Phase(enum.Enum):
    """How far a homing is."""

    SEARCHING = "the struts look for their homes"
    DONE = "all struts have found their homes"
    NOTHING = "the controller shows no homing"
    FAILED = "the homing has failed"
    LATE = "the homing takes too long"


@dataclass(frozen=True)
class Homing:
    """What is seen of a homing.

    Attributes:
        phase: how far it is.
        missing: struts that have no home yet, from 1.
        words: what is wrong, in words.
    """

    phase: Phase
    missing: tuple[int, ...]
    words: tuple[str, ...]

    def __str__(self) -> str:
        struts = f"; no home yet: strut {', '.join(map(str, self.missing))}" if self.missing else ""
        return "\n".join([self.phase.value + struts, *self.words])


def check_trigger(trigger: str) -> None:
    """Check that a line may be one that starts a homing.

    Raises:
        ValueError: it has none of the forms.
    """
    if not any(form.fullmatch(trigger) for form in _FORMS.values()):
        raise ValueError(f"trigger: expected {' or '.join(_FORMS)}, got {trigger!r}")


def start_homing(session: Session, settings: Settings, trigger: str) -> HomingWatch:
    """Send the line that starts the homing of the machine.

    Raises:
        ValueError: the line has none of the forms.
        NotReadyError: a program runs, a strut moves, or a motor has a fault; nothing was sent.
        OutcomeUnknownError: nobody knows whether it was carried out; the machine may move.
        NotOwnerError: another client has the machine; nothing was sent.
    """
    check_trigger(trigger)
    with owned(session, "home"):
        _check_rest(settled_status(session, settings))
        session.order(trigger)
    return HomingWatch(session.now())


def _check_rest(status: Status) -> None:
    reasons = [*_faults(status)]
    if status.running:
        reasons.append("a program runs, or is held")
    if not status.standing:
        reasons.append("a strut moves")
    if reasons:
        raise NotReadyError(reasons)


def missing_homes(status: Status) -> tuple[int, ...]:
    """The struts without home, from 1."""
    return tuple(motor for motor, homed in zip(MOTORS, status.homed, strict=True) if not homed)


class HomingWatch:
    """Looks on."""

    def __init__(self, began: float, seconds: float = HOMING_S) -> None:
        """Begin to watch.

        Args:
            began: the time when it was triggered, s.
            seconds: how long it may take.
        """
        self._began, self._until = began, began + seconds
        self._seen = False
        self._quiet_since: float | None = None

    def see(self, status: Status, now: float) -> Homing:
        """What a state at a time means."""
        missing = missing_homes(status)
        searching = any(motor.has("homing") for motor in status.motors)
        busy = searching or not status.standing or status.running
        self._seen = self._seen or busy or bool(missing)
        self._quiet_since = None if busy or missing else now if self._quiet_since is None else self._quiet_since
        return Homing(self._phase(status, busy, now), missing, status.words())

    def _phase(self, status: Status, busy: bool, now: float) -> Phase:
        if any(_faults(status)):
            return Phase.FAILED
        if self._seen and self._quiet_since is not None and now - self._quiet_since >= _QUIET_S:
            return Phase.DONE
        if not self._seen and now - self._began >= _NOTHING_S:
            return Phase.NOTHING
        return Phase.LATE if now >= self._until else Phase.SEARCHING


def _faults(status: Status) -> tuple[str, ...]:
    """Faults that no homing goes on with; limits are not among them, for homes may be there."""
    return tuple(
        f"strut {number}: {motor.TOLD[name]}"
        for number, motor in zip(MOTORS, status.motors, strict=True)
        for name in _STOPS_IT
        if motor.has(name)
    )
