# SPDX-License-Identifier: LGPL-2.1-or-later
"""Homing: triggered here, carried out by the machine, monitored here.

Only the machine builder knows the order in which the struts may search for home, and how far each may travel with
the platform attached. Homing is therefore a program in the controller, usually a PLC program. This module sends the
line that the builder specifies, in one of the forms below, then watches the home-complete bits of all six struts, with
a deadline.

Input: the line, states of the controller and the time in s. Output: the progress of the homing.
"""

from __future__ import annotations

import enum
import re
from dataclasses import dataclass

from pkm_post.control.link.errors import NotReadyError
from pkm_post.control.link.ownership import owned
from pkm_post.control.link.session import Session
from pkm_post.control.link.status import MOTORS, AnySettings, Status, settled_status
from pkm_post.control.link.tool_pose import UNKNOWN_POSE, pose_from_home
from pkm_post.model import Machine, Phrase
from pkm_post.toolpath import ToolPose

_FORMS = {
    "ENABLE PLC n": re.compile(r"ENA(?:BLE)? ?PLC ?\d{1,2}", re.IGNORECASE),
    "Pn=value or Mn=value": re.compile(r"[PM]\d{1,4}=-?\d+(?:\.\d+)?", re.IGNORECASE),
    "&nBnR": re.compile(r"&\d{1,2} ?B\d{1,5} ?R", re.IGNORECASE),
    "#nHM": re.compile(r"#[1-6](?:HM|HOME)(?: ?#[1-6](?:HM|HOME))*", re.IGNORECASE),
}
"""Permitted triggers: a PLC program, a variable polled by one, a motion program, motors."""
_WITHOUT_PLC = ("&nBnR", "#nHM")
HOMING_S = 600.0
"""Seconds within which all struts must find their homes."""
_NOTHING_S = 5.0
"""Seconds for the state to reflect the homing, and of rest after which one without a PLC program does not go on."""
_QUIET_S = 2.0
"""Seconds of rest that count as the end: a PLC program may pause between struts."""
_STOPS_IT = ("amplifier_fault", "fatal_following_error")


class HomingPhase(enum.Enum):
    """Phase of a homing."""

    SEARCHING = "the struts look for their homes"
    DONE = "all struts have found their homes"
    NOTHING = "the controller shows no homing"
    FAILED = "the homing has failed"
    LATE = "the homing takes too long"


@dataclass(frozen=True)
class Homing:
    """Observed state of a homing.

    Attributes:
        missing: struts that are not homed yet, from 1.
        words: faults in plain text.
    """

    phase: HomingPhase
    missing: tuple[int, ...]
    words: tuple[str, ...]

    def __str__(self) -> str:
        struts = f"; no home yet: strut {', '.join(map(str, self.missing))}" if self.missing else ""
        return "\n".join([self.phase.value + struts, *self.words])


def check_trigger(trigger: str) -> None:
    """Check that a line has a form that may start a homing.

    Raises:
        ValueError: it has another form.
    """
    if not any(form.fullmatch(trigger) for form in _FORMS.values()):
        raise ValueError(Phrase("a homing starts with one of {}, not with {!r}", ", ".join(_FORMS), trigger))


def start_homing(session: Session, settings: AnySettings, trigger: str) -> HomingWatch:
    """Send the line that starts the homing of the machine.

    Raises:
        ValueError: the line has another form.
        NotReadyError: a program runs, a strut moves, or a motor has a fault; nothing was sent.
        OutcomeUnknownError: the controller may or may not have executed it; the machine may move.
        NotOwnerError: another client owns the machine; nothing was sent.
    """
    check_trigger(trigger)
    with owned(session, "home"):
        _check_rest(settled_status(session, settings))
        session.command(trigger)
    return HomingWatch(session.now(), by_plc=not any(_FORMS[form].fullmatch(trigger) for form in _WITHOUT_PLC))


def _check_rest(status: Status) -> None:
    reasons = [*_faults(status)]
    if status.running:
        reasons.append("a program runs, or is held")
    if not status.standing:
        reasons.append("a strut moves")
    if reasons:
        raise NotReadyError(reasons)


def missing_homes(status: Status) -> tuple[int, ...]:
    """The struts that are not homed, from 1."""
    return tuple(motor for motor, homed in zip(MOTORS, status.homed, strict=True) if not homed)


def standing_pose(session: Session, settings: AnySettings, machine: Machine, tool_length: float) -> ToolPose:
    """The commanded pose of a homed machine at standstill.

    Raises:
        NotReadyError: a strut is not homed or moves, a program runs, or the pose is unknown.
    """
    status = settled_status(session, settings)
    reasons = [f"strut {strut}: not homed" for strut in missing_homes(status)]
    reasons += ["a program runs, or is held"] if status.running else []
    reasons += [] if status.standing else ["a strut moves"]
    if reasons:
        raise NotReadyError(reasons)
    pose = pose_from_home(machine, status.commanded, tool_length)
    if pose is None:
        raise NotReadyError([UNKNOWN_POSE])
    return pose


class HomingWatch:
    """Monitors a homing."""

    def __init__(self, began: float, seconds: float = HOMING_S, by_plc: bool = True) -> None:
        """Start monitoring.

        Args:
            began: time of the trigger, s.
            seconds: timeout.
            by_plc: whether a PLC program may start the next motion after any pause.
        """
        self._began, self._until, self._by_plc = began, began + seconds, by_plc
        self._seen, self._moved_at = False, began
        self._quiet_since: float | None = None

    def see(self, status: Status, now: float) -> Homing:
        """Evaluate a state read at time ``now``."""
        missing = missing_homes(status)
        searching = any(motor.has("homing") for motor in status.motors)
        busy = searching or not status.standing or status.running
        self._seen, self._moved_at = self._seen or busy or bool(missing), now if busy else self._moved_at
        self._quiet_since = None if busy or missing else now if self._quiet_since is None else self._quiet_since
        return Homing(self._phase(status, now), missing, status.fault_texts())

    def _phase(self, status: Status, now: float) -> HomingPhase:
        has_stopped = not self._by_plc and bool(missing_homes(status)) and now - self._moved_at >= _NOTHING_S
        if any(_faults(status)) or has_stopped:
            return HomingPhase.FAILED
        if self._seen and self._quiet_since is not None and now - self._quiet_since >= _QUIET_S:
            return HomingPhase.DONE
        if not self._seen and now - self._began >= _NOTHING_S:
            return HomingPhase.NOTHING
        return HomingPhase.LATE if now >= self._until else HomingPhase.SEARCHING


def _faults(status: Status) -> tuple[str, ...]:
    """Faults that end a homing; limits are excluded, as homes may be there."""
    return tuple(
        f"strut {number}: {motor.FAULT_TEXTS[name]}"
        for number, motor in zip(MOTORS, status.motors, strict=True)
        for name in _STOPS_IT
        if motor.has(name)
    )
