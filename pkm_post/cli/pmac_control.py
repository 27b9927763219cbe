# SPDX-License-Identifier: LGPL-2.1-or-later
"""PMAC manual control: the actions home, jog, mdi, step, continue, override of the command ``pmac``.

Each prints its plan first; a plan that fails the checks is not sent. If the command ends while the machine moves, it
holds the machine.
"""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from pkm_post.cli.pmac_by_hand import carry_out, control_of
from pkm_post.cli.pmac_stop import held_at_the_end

if TYPE_CHECKING:
    from pkm_post.cli.pmac_actions import JobTarget, Target
    from pkm_post.control import Jog, Session

    Action = Callable[[Session, Any, argparse.Namespace], int]

_WATCH_S = 0.2
_THERE_MM = 1e-3
"""mm of a strut; closer to the start of a program no approach is planned."""


def home(session: Session, target: Target, namespace: argparse.Namespace) -> int:
    """Print which struts are homed; with a trigger, start the machine's homing and monitor it."""
    import time

    from pkm_post.control import Phase, missing_homes, owned, read_status, start_homing

    if namespace.trigger is None:
        missing = missing_homes(read_status(session, target.settings))
        print(f"not homed: strut {', '.join(map(str, missing))}" if missing else "all struts are homed")
        return int(bool(missing))
    with owned(session, "home"), held_at_the_end(session, target.settings):
        watch = start_homing(session, target.settings, namespace.trigger)
        while True:
            seen = watch.see(read_status(session, target.settings), session.now())
            if seen.phase is not Phase.SEARCHING:
                break
            time.sleep(_WATCH_S)
    print(seen)
    return int(seen.phase is not Phase.DONE)


def jog(session: Session, target: Target, namespace: argparse.Namespace) -> int:
    """Jog the tool or one strut."""
    control = control_of(session, target, namespace)
    plan, told = control.plan_jog(_jog_of(namespace), namespace.feed / 60)
    return carry_out(session, target, namespace, control, plan, told)


def _jog_of(namespace: argparse.Namespace) -> Jog:
    from pkm_post.control import Cartesian, OneStrut

    if namespace.strut is not None:
        return OneStrut(namespace.strut, namespace.by)
    tilt = math.radians(namespace.tilt_x), math.radians(namespace.tilt_y)
    return Cartesian((namespace.x, namespace.y, namespace.z), tilt, math.radians(namespace.spin))


def mdi(session: Session, target: Target, namespace: argparse.Namespace) -> int:
    """Execute a line of G-code."""
    from pkm_post.control import Reading

    control = control_of(session, target, namespace)
    plan, told = control.plan_line(namespace.line, Reading(namespace.work_offset, namespace.axis_words))
    return carry_out(session, target, namespace, control, plan, told)


def approach(session: Session, target: JobTarget, namespace: argparse.Namespace) -> int:
    """Move the tool to the start of a program."""
    from pkm_post.control import off_target, read_status

    if off_target(read_status(session, target.settings), target.job.first) <= _THERE_MM:
        print("the tool is at the start of the program")
        return 0
    control = control_of(session, target, namespace)
    plan, told = control.plan_approach(target.job, namespace.feed / 60)
    return carry_out(session, target, namespace, control, plan, told)


def step(session: Session, target: JobTarget, namespace: argparse.Namespace) -> int:
    """Run a program line by line of its source; each line of the standard input starts one."""
    from pkm_post.control import NotReadyError, blocks_of_program

    control = control_of(session, target, namespace)
    blocks, told = blocks_of_program(namespace.program, target.machine)
    for diagnostic in told:
        print(diagnostic, file=sys.stderr)
    if blocks is None:
        return 1
    if namespace.block > len(blocks):
        raise NotReadyError([f"there is no block {namespace.block}: the program has {len(blocks)}"])
    control.open_blocks(blocks, namespace.block)
    for number in range(namespace.block, len(blocks) + 1):
        print(f"{blocks.shown(number)}; Enter starts it, the end of the input ends here", flush=True)
        if not sys.stdin.readline():
            return 0
        # Only the first line is approached by hand; the others begin where the previous one ended.
        near = namespace.near if number == namespace.block else None
        if carry_out(session, target, namespace, control, *control.plan_step(), near):
            return 1
    print("the program has ended")
    return 0


def go_on(session: Session, target: JobTarget, namespace: argparse.Namespace) -> int:
    """Continue after a stop (M0, M1) of the program."""
    from pkm_post.control import go_on, state_text

    with held_at_the_end(session, target.settings):
        status = go_on(session, target.machine, target.settings, target.job, namespace.stop, namespace.near)
        print(state_text(status))
    return 0


def override(session: Session, target: Target, namespace: argparse.Namespace) -> int:
    """Set the time base of programs."""
    from pkm_post.control import operate

    print(f"override {operate.override(session, target.settings, namespace.percent).override:g} %")
    return 0


ACTIONS: dict[str, tuple[Action, str, tuple[str, ...]]] = {
    "home": (home, "which struts are homed; start and watch the homing of the machine", ("machine",)),
    "jog": (jog, "move the tool or one strut a little, planned and checked", ("machine",)),
    "mdi": (mdi, "carry out a line of G-code, planned and checked", ("machine",)),
    "approach": (approach, "bring the tool to the start of a program, planned and checked", ("machine", "program")),
    "step": (step, "run a program line by line of its source, each to rest", ("machine", "program")),
    "continue": (go_on, "go on after a stop (M0, M1) of a program that was run", ("machine", "program")),
    "override": (override, "how fast time passes in programs, in %%", ("machine",)),
}
"""Same form as ``pmac_actions.ACTIONS``."""

_STARTING = ("run", "stream", "home", "jog", "mdi", "approach", "step", "continue")
_OF_WHAT_RUNS = ("hold", "resume", "abort", "override", "monitor")


def tell_emergency(name: str, connected: bool) -> None:
    """Print what to do when the link is lost and the machine may be moving.

    Args:
        name: of the action.
        connected: whether the controller had answered before.
    """
    from pkm_post.control import STEPS

    if name in _OF_WHAT_RUNS or (connected and name in _STARTING):
        print(*STEPS, sep="\n", file=sys.stderr)
