# SPDX-License-Identifier: LGPL-2.1-or-later
"""Status: positions, following errors and status bits of the six motors, queried in one line.

A Power PMAC shows by elements of its data structure whether a program runs.

A motor may move without a program: when another client jogs it, during homing, under a PLC program, or after losing
power. And a strut that reverses within a move is at rest for a moment. So ``settled_status`` reads twice.

Input: a session, the settings of its controller. Output: lengths in mm, bits and their meanings.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from pkm_post.control.link.errors import LinkLostError
from pkm_post.control.link.queries import parse_bits, parse_number
from pkm_post.control.link.session import Session
from pkm_post.control.link.status_bits import FIRST_ELEMENT_BIT, MotorBits, PowerMotorBits, PowerSystemBits, SystemBits
from pkm_post.model import Array
from pkm_post.writing import PmacSettings, PowerPmacSettings

AnySettings = PmacSettings | PowerPmacSettings

MOTORS = range(1, 7)
SETTLING_S = 0.1
"""Seconds between the two readings."""
REST_TOLERANCE_MM = 0.01
"""A strut at rest moves less than this between readings: a hundred counts of a common encoder."""


@dataclass(frozen=True)
class Status:
    """The state of the six struts and of their coordinate system.

    Attributes:
        motors: bits of each strut.
        system: bits of the coordinate system.
        override: time base in %; 0 while held.
        length: (6,) strut lengths, mm.
        following_error: (6,) commanded minus actual length, mm.
        may_slow: whether a hold may still slow down. A Turbo PMAC shows that by its override alone, a Power PMAC by
            ``Coord[].FeedHold``: 1 at a time base of zero, 3 before, 2 when resumed [Power PMAC User's Manual, p. 693].
    """

    motors: tuple[MotorBits, ...]
    system: SystemBits
    override: float
    length: Array
    following_error: Array
    may_slow: bool = True

    @property
    def commanded(self) -> Array:
        """(6,) commanded strut lengths, mm."""
        return self.length + self.following_error

    @property
    def homed(self) -> tuple[bool, ...]:
        """For each strut whether it is homed."""
        return tuple(motor.has("homed") for motor in self.motors)

    @property
    def running(self) -> bool:
        """Whether a program runs, or is held; a Turbo PMAC shows a hold in the last moves by its motors alone.

        Its Running Program falls when these are computed, Move Timer Active when they are over [TurboPMAC, ?, ??].
        """
        is_held_at_the_end = self.override == 0 and any(motor.has("in_timed_move") for motor in self.motors)
        return self.system.has("running") or is_held_at_the_end

    @property
    def held(self) -> bool:
        """Whether a program is in a feed hold; a Power PMAC shows that while it still slows down."""
        return self.running and (self.system.held or self.override == 0)

    @property
    def standing(self) -> bool:
        """Whether no strut is commanded to move."""
        return all(motor.has("standing") for motor in self.motors)

    @property
    def powered(self) -> bool:
        """Whether any amplifier is enabled."""
        return any(motor.has("amplifier_enabled") for motor in self.motors)

    def fault_texts(self) -> tuple[str, ...]:
        """Faults in plain text, strut by strut."""
        own = [
            f"strut {number}: {word}"
            for number, motor in zip(MOTORS, self.motors, strict=True)
            for word in motor.fault_texts()
        ]
        return (*own, *self.system.fault_texts())


_RUNS = ("ProgRunning", "FeedHold", "ProgActive")
_ELEMENTS = (*_RUNS, "ErrorStatus")
_TIME_STANDS, _TIME_RISES = 1, 2


def read_status(session: Session, settings: AnySettings) -> Status:
    """Query everything in one line, so that it is consistent.

    Raises:
        LinkLostError: the answer is invalid.
    """
    query = _power_query(settings) if isinstance(settings, PowerPmacSettings) else _turbo_query(settings)
    answer = session.query(query)
    try:
        if isinstance(settings, PowerPmacSettings):
            return _power_status(answer, settings)
        return _turbo_status(answer, settings)
    except ValueError as fault:
        raise LinkLostError(f"{query!r}: {fault}") from None


def _turbo_query(settings: PmacSettings) -> str:
    system = f"&{settings.coordinate_system}"
    return " ".join(f"#{motor}? #{motor}P #{motor}F" for motor in MOTORS) + f" {system}?? {system}%"


def _turbo_status(answer: tuple[str, ...], settings: PmacSettings) -> Status:
    if len(answer) != 20:
        raise ValueError(f"expected 20 lines, got {len(answer)}")
    motors = tuple(map(MotorBits.read, answer[0:18:3]))
    system = SystemBits(parse_bits(answer[18], SystemBits.DIGITS))
    return Status(motors, system, _parse_override(answer[19]), *_lengths_and_errors(answer, settings))


def _power_query(settings: PowerPmacSettings) -> str:
    """``%`` is last, since a value after it sets the override [Power PMAC User's Manual, p. 695]."""
    system = settings.coordinate_system
    return " ".join(
        [
            *(f"#{motor}? #{motor}p #{motor}f" for motor in MOTORS),
            f"&{system}?",
            *(f"Coord[{system}].{name}" for name in _ELEMENTS),
            f"&{system}%",
        ]
    )


def _power_status(answer: tuple[str, ...], settings: PowerPmacSettings) -> Status:
    """Parse the lines of the answer; a ``ValueError`` if they are invalid."""
    expected = 3 * len(MOTORS) + 2 + len(_ELEMENTS)
    if len(answer) != expected:
        raise ValueError(f"expected {expected} lines, got {len(answer)}")
    motors = tuple(map(PowerMotorBits.read, answer[0:18:3]))
    bits = parse_bits(answer[18], PowerSystemBits.DIGITS)
    running, hold, active, error_status = map(parse_number, answer[19:-1])
    states = _runs(running, hold, active), hold not in (0, _TIME_RISES), error_status
    for place, is_set in enumerate(states, start=FIRST_ELEMENT_BIT):
        bits |= bool(is_set) << place
    length, error = _lengths_and_errors(answer, settings)
    system = PowerSystemBits(bits)
    return Status(motors, system, _parse_override(answer[-1]), length, error, may_slow=hold != _TIME_STANDS)


def _runs(running: float, hold: float, active: float) -> bool:
    """Whether a program runs or is held; no available text says whether a held one is Running, but it is Active."""
    return bool(running or (active and hold))


def _lengths_and_errors(answer: tuple[str, ...], settings: AnySettings) -> tuple[Array, Array]:
    """Lengths and following errors of the struts, (6,) each in mm.

    Args:
        answer: three lines for each strut, bits and the counts of position and following error; further lines are
            ignored.

    Raises:
        ValueError: a count is not a number.
    """
    counts = np.array([[parse_number(line) for line in answer[column : 3 * len(MOTORS) : 3]] for column in (1, 2)])
    position, error = counts / settings.counts_per_mm
    return position + np.array(settings.zero_length), error


def _parse_override(text: str) -> float:
    """The override of an answer, %; a ``ValueError`` if it is no number, or below 0."""
    value = parse_number(text)
    if value < 0:
        raise ValueError(f"expected an override of 0 or more, got {text!r}")
    return value


def settled_status(session: Session, settings: AnySettings, first: Status | None = None) -> Status:
    """The state after a second reading: a strut is at rest if commanded so in both, and it has not moved."""
    before = first or read_status(session, settings)
    session.sleep(SETTLING_S)
    status = read_status(session, settings)
    moved = np.abs([status.length - before.length, status.commanded - before.commanded]).max(axis=0) > REST_TOLERANCE_MM
    pairs = zip(before.motors, status.motors, moved, strict=True)
    rests = (now if then.has("standing") and not away else now.moving() for then, now, away in pairs)
    return replace(status, motors=tuple(rests))


def is_busy(session: Session) -> bool:
    """Whether a program runs or is held, or a motor is commanded to move; on a Turbo PMAC in the port's own system.

    It sends no coordinate system address: lines for a rotary buffer go to the last one addressed.

    Raises:
        LinkLostError: the answer is invalid.
    """
    kind: type[MotorBits] = MotorBits if session.has_handshake else PowerMotorBits
    motors = " ".join(f"#{motor}?" for motor in MOTORS)
    answer = session.query(f"{motors} ??" if session.has_handshake else motors)
    try:
        bits = list(map(kind.read, answer[: len(MOTORS)]))
        if session.has_handshake:
            (system,) = answer[len(MOTORS) :]
            runs = SystemBits(parse_bits(system, SystemBits.DIGITS)).has("running")
        else:
            runs = _runs_in_power_pmac(session)
    except ValueError as fault:
        raise LinkLostError(f"state: {fault}") from None
    return runs or any(motor.has("in_timed_move") or not motor.has("standing") for motor in bits)


_SYSTEMS_AT_ONCE = 4


def _runs_in_power_pmac(session: Session) -> bool:
    """Whether a program runs, or is held, in any coordinate system of a Power PMAC.

    Raises:
        ValueError: the answer is invalid.
    """
    (line,) = session.query("Sys.MaxCoords")
    most = int(parse_number(line))
    for first in range(1, most, _SYSTEMS_AT_ONCE):
        systems = range(first, min(first + _SYSTEMS_AT_ONCE, most))
        answer = session.query(" ".join(f"Coord[{system}].{name}" for system in systems for name in _RUNS))
        states = np.reshape(list(map(parse_number, answer)), (len(systems), len(_RUNS)))
        if any(_runs(*row) for row in states.tolist()):
            return True
    return False
