# SPDX-License-Identifier: LGPL-2.1-or-later
"""When people are shown what to do, and in which order."""

import dataclasses

from pkm_post.control.link.status_bits import MotorBits, SystemBits
from pkm_post.control.link.stopping import EMERGENCY_STEPS, emergency_text

RUNNING = SystemBits(1 << 48)


def test_a_machine_at_rest_is_no_emergency(station):
    at_rest = station.control.poll().status
    assert emergency_text(at_rest) == ()
    assert emergency_text(dataclasses.replace(at_rest, system=RUNNING)) == EMERGENCY_STEPS
    moves = (MotorBits(at_rest.motors[0].value & ~(1 << 37)), *at_rest.motors[1:])
    assert emergency_text(dataclasses.replace(at_rest, motors=moves)) == EMERGENCY_STEPS


def test_a_machine_that_was_never_seen_may_move():
    assert emergency_text(None) == EMERGENCY_STEPS


def test_people_come_first_and_orders_only_when_the_controller_answers():
    first = [
        next(row for row, line in enumerate(EMERGENCY_STEPS) if word in line)
        for word in ("EMERGENCY STOP", "everybody")
    ]
    answers = next(row for row, line in enumerate(EMERGENCY_STEPS) if "answers again" in line)
    assert first == [1, 2] and answers > 2
    assert "hold" in EMERGENCY_STEPS[answers] and EMERGENCY_STEPS[answers].index("hold") < EMERGENCY_STEPS[
        answers
    ].index("abort")
