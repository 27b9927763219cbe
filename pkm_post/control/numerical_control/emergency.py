# SPDX-License-Identifier: LGPL-2.1-or-later
"""Emergency: instructions for the operator, in order, when the link is lost while a program may be running.

Enters: the last state read. Leaves: lines of text. A computer without a link stops nothing.
"""

from __future__ import annotations

from pkm_post.control.link.status import Status

STEPS = (
    "THE LINK TO THE CONTROLLER IS LOST AND THE MACHINE MAY BE MOVING. This computer cannot stop it now.",
    "1. If anything is not as it should be, press the EMERGENCY STOP of the machine. Do not wait for this computer.",
    "2. Keep everybody away from the machine. The program goes on in the controller until it ends.",
    "3. If the machine has a feed hold of its own, press it, and look that all six struts stand.",
    "4. Then look at the cable, at the power of the controller, and at this computer; leave the machine as it is.",
    "5. When the controller answers again: status, then hold, then abort. Do not start, resume, jog or load before.",
    "6. If the power was off or the emergency stop was pressed: home the machine before anything else.",
    "7. Bring the tool free of the part by short jogs along its axis, then to the start, before a program runs again.",
)
"""In order of priority: people, machine, link, workpiece."""


ADVICE_S = 2.0
"""Seconds after a stop within which the machine must be seen at rest, or the operator is alerted."""
NOT_AT_REST = (
    "THE MACHINE IS NOT SEEN AT REST. This computer goes on trying to stop it; do not wait for that.",
    *STEPS[1:],
)
"""The same after a stop that was sent but not confirmed in time."""


def emergency_text(last: Status | None) -> tuple[str, ...]:
    """The instructions, or nothing if the last state read shows a machine at rest without a program.

    Args:
        last: None if no state was ever read.
    """
    if last is not None and not last.running and last.standing:
        return ()
    return STEPS
