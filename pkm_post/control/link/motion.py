# SPDX-License-Identifier: LGPL-2.1-or-later
"""Motion: whether a machine moves, judged by its motors and not by the flag of its program alone.

A motor may move without a program: when another client jogs it, during homing, under a PLC program, or after losing
power. And a strut that reverses in the middle of a move stands for a moment. So the struts are read twice.

Enters: a session. Leaves: a state in which only struts that have not moved count as standing.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from pkm_post.control.link.faults import LinkLostError
from pkm_post.control.link.session import Session
from pkm_post.control.link.status import MOTORS, AnySettings, MotorBits, Status, SystemBits, hexadecimal, read_status

LOOK_S = 0.1
"""Seconds between the two readings."""
STAYED_MM = 0.01
"""A standing strut moves less than this between the readings: a hundred counts of a common encoder."""


def settled_status(session: Session, settings: AnySettings) -> Status:
    """The state after a second reading: a strut stands if both readings command it to stand and it has not moved."""
    before = read_status(session, settings)
    session.sleep(LOOK_S)
    status = read_status(session, settings)
    moved = np.abs([status.length - before.length, status.commanded - before.commanded]).max(axis=0) > STAYED_MM
    pairs = zip(before.motors, status.motors, moved, strict=True)
    return replace(status, motors=tuple(now.moving() if away else _both(then, now) for then, now, away in pairs))


def is_busy(session: Session) -> bool:
    """Whether a program runs or is held in the port's coordinate system, or a motor is commanded to move.

    It sends no coordinate system address: lines for a rotary buffer go to the last one addressed.

    Raises:
        LinkLostError: the answer makes no sense.
    """
    told = session.ask(" ".join(f"#{motor}?" for motor in MOTORS) + " ??")
    try:
        *motors, system = told
        bits = [MotorBits(hexadecimal(line, MotorBits.DIGITS)) for line in motors]
        runs = SystemBits(hexadecimal(system, SystemBits.DIGITS)).has("running")
    except ValueError as fault:
        raise LinkLostError(f"state: {fault}") from None
    return runs or not all(motor.has("standing") for motor in bits)


def _both(before: MotorBits, now: MotorBits) -> MotorBits:
    return now if before.has("standing") else now.moving()
