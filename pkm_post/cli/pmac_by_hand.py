# SPDX-License-Identifier: LGPL-2.1-or-later
"""By hand: common parts of the actions that move the machine by hand.

A plan is printed, executed and awaited, and the position reached is printed. If the command ends while the machine
moves, it holds the machine.
"""

from __future__ import annotations

import argparse
import sys
from typing import TYPE_CHECKING

from pkm_post.cli.pmac_stop import held_at_the_end

if TYPE_CHECKING:
    from pkm_post.cli.pmac_actions import Target
    from pkm_post.control import Array, NumericalControl, Plan, Session, Status
    from pkm_post.model import Diagnostic

_SLOWEST_OVERRIDE = 0.05
"""A move may take as long as at this override, which an operator may set meanwhile."""
_START_S = 30.0
"""Added to that: the approach, and the machine's own codes."""
_HELD = "it is held, by somebody or, a jog, because this computer came too late to renew it; resume or abort it"


def control_of(session: Session, target: Target, namespace: argparse.Namespace) -> NumericalControl:
    """Numerical control of a machine with the given tool.

    Raises:
        NotReadyError: the program number for moves by hand is that of the jobs.
    """
    from pkm_post.control import NotReadyError, NumericalControl

    if namespace.number == target.settings.program:
        raise NotReadyError([f"program {namespace.number} is that of the jobs: choose another --number"])
    length = target.machine.rest_tool_length if namespace.tool_length is None else namespace.tool_length
    return NumericalControl(session, target.machine, target.settings, length, namespace.number)


def carry_out(
    session: Session,
    target: Target,
    namespace: argparse.Namespace,
    control: NumericalControl,
    plan: Plan | None,
    told: tuple[Diagnostic, ...],
    near: float | None = None,
) -> int:
    """Print a plan, execute it, and print the position reached; ``near`` is as for ``execute``."""
    from pkm_post.control import off_target, pose_text
    from pkm_post.options import START_TOLERANCE_MM

    for diagnostic in told:
        print(diagnostic, file=sys.stderr)
    if plan is None:
        return 1
    print(f"to {pose_text(plan.end)}; {plan.seconds:.1f} s")
    if namespace.check:
        return 0
    with held_at_the_end(session, target.settings):
        control.execute(plan, START_TOLERANCE_MM if near is None else near)
        if control.silence_s is not None:
            print(f"it rests within {control.silence_s:.1f} s if this computer falls silent, at 100 %", flush=True)
        status = wait_for_end(control, plan.seconds)
    if ended_elsewhere(status, plan.lengths):
        return 1
    print(f"arrived; no strut is off by more than {off_target(status, plan.lengths):.4f} mm")
    return 0


def wait_for_end(control: NumericalControl, seconds: float) -> Status:
    """State after a move that takes this many seconds at 100 %."""
    return control.wait_for_rest(_START_S + seconds / _SLOWEST_OVERRIDE)


def ended_elsewhere(status: Status, lengths: Array) -> bool:
    """Whether a move ended away from its target lengths, which is printed."""
    from pkm_post.control import off_target
    from pkm_post.options import START_TOLERANCE_MM

    words = [_HELD] if status.held else list(status.words())
    if not words and off_target(status, lengths) > START_TOLERANCE_MM:
        words = [f"it ended {off_target(status, lengths):.3f} mm of a strut from where it leads to"]
    print(*words, sep="\n", end="\n" if words else "", file=sys.stderr)
    return bool(words)
