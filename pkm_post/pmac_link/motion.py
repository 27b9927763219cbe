# SPDX-License-Identifier: LGPL-2.1-or-later
"""Motion: whether a machine moves, by its motors and not by the flag of its program alone.

A motor may move without a program: by a jog from elsewhere, while it looks for its home, when a PLC program drives it,
when it has lost its power. And a strut that turns round in the middle of a move stands for a moment. So the struts are
looked at twice.

Enters: a session. Leaves: a state in which only those struts stand that have stayed where they are.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from pkm_post.pmac_link.faults import LinkLostError
from pkm_post.pmac_link.session import Session
from pkm_post.pmac_link.status import MOTORS, AnySettings, MotorBits, Status, SystemBits, hexadecimal, read_status

LOOK_S = 0.1
"""Seconds between both looks."""
STAYED_MM = 0.01
"""A strut that stands does not move so far meanwhile: it is a hundred counts of a common encoder."""


def settled_status(session: Session, settings: AnySettings) -> Status:
    """The state after a second look: a strut stands that its controller wants to stand, and that has not moved."""
    before = read_status(session, settings)
    session.sleep(LOOK_S)
    status = read_status(session, settings)
    moved = np.abs([status.length - before.length, status.commanded - before.commanded]).max(axis=0) > STAYED_MM
    pairs = zip(before.motors, status.motors, moved, strict=True)
    return replace(status, motors=tuple(now.moving() if away else _both(then, now) for then, now, away in pairs))


def is_busy(session: Session) -> bool:
    """Whether a program runs or is held in the coordinate system that the port is for, or a motor is to move.

    No address of a coordinate system is sent: lines for a rotary buffer go to the one that was addressed last.

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
