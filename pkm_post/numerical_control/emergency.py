# SPDX-License-Identifier: LGPL-2.1-or-later
"""Emergency: what a person must do, and in which order, when the link is lost while a program may be running.

Enters: the state that was seen last. Leaves: lines for people. A computer that is cut off stops nothing.
"""

from __future__ import annotations

from pkm_post.pmac_link.status import Status

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
"""In this order: people first, then the machine, then the link, then the part."""


ADVICE_S = 2.0
"""Seconds after a stop in which the machine has to be seen at rest, or people are called."""
NOT_AT_REST = (
    "THE MACHINE IS NOT SEEN AT REST. This computer goes on trying to stop it; do not wait for that.",
    *STEPS[1:],
)
"""The same where a stop was sent and rest was not confirmed in time."""


def emergency_text(last: Status | None) -> tuple[str, ...]:
    """What to do, or nothing when the state that was seen last shows a machine at rest without program.

    Args:
        last: None when nothing was ever seen.
    """
    if last is not None and not last.running and last.standing:
        return ()
    return STEPS
