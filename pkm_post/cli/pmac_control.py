# SPDX-License-Identifier: LGPL-2.1-or-later
"""The actions of the command ``pmac`` that operate the machine by hand: home, jog, mdi, step, override.

Each plans what it does first and tells it; what the checks refuse is not sent. Ctrl-C while something moves holds it.
"""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from pkm_post.cli.pmac_actions import JobTarget, Target
    from pkm_post.model import Diagnostic
    from pkm_post.numerical_control.control import NumericalControl
    from pkm_post.numerical_control.moves import Jog
    from pkm_post.numerical_control.plan import Plan
    from pkm_post.pmac_link.session import Session
    from pkm_post.pmac_link.status import Array, Status

    Action = Callable[[Session, Any, argparse.Namespace], int]

_SLOWEST_OVERRIDE = 0.05
"""A move is waited for as long as it would take at this override, which somebody may set meanwhile."""
_START_S = 30.0
"""Added to that: the approach, and codes of the machine."""
_REST_S = 10.0
"""Seconds in which a hold has to bring the machine to rest."""
_WATCH_S = 0.2


def home(session: Session, target: Target, namespace: argparse.Namespace) -> int:
    """Tell which struts have homes; with a trigger, start the homing of the machine and watch it."""
    import time

    from pkm_post.numerical_control.homing import Phase, missing_homes, start_homing
    from pkm_post.pmac_link.status import read_status

    if namespace.trigger is None:
        missing = missing_homes(read_status(session, target.settings))
        print(f"not homed: strut {', '.join(map(str, missing))}" if missing else "all struts are homed")
        return int(bool(missing))
    watch = start_homing(session, target.settings, namespace.trigger)
    while True:
        seen = watch.see(read_status(session, target.settings), session.now())
        if seen.phase is not Phase.SEARCHING:
            break
        time.sleep(_WATCH_S)
    print(seen)
    return int(seen.phase is not Phase.DONE)


def jog(session: Session, target: Target, namespace: argparse.Namespace) -> int:
    """Move the tool or one strut a little."""
    control = _control(session, target, namespace)
    plan, told = control.plan_jog(_jog_of(namespace), namespace.feed / 60)
    return _carry_out(session, target, namespace, control, plan, told)


def _jog_of(namespace: argparse.Namespace) -> Jog:
    from pkm_post.numerical_control.moves import Cartesian, OneStrut

    if namespace.strut is not None:
        return OneStrut(namespace.strut, namespace.by)
    tilt = math.radians(namespace.tilt_x), math.radians(namespace.tilt_y)
    return Cartesian((namespace.x, namespace.y, namespace.z), tilt, math.radians(namespace.spin))


def mdi(session: Session, target: Target, namespace: argparse.Namespace) -> int:
    """Carry out a line of G-code."""
    from pkm_post.numerical_control.mdi import Reading

    control = _control(session, target, namespace)
    plan, told = control.plan_line(namespace.line, Reading(namespace.work_offset, namespace.axis_words))
    return _carry_out(session, target, namespace, control, plan, told)


def step(session: Session, target: JobTarget, namespace: argparse.Namespace) -> int:
    """Run a program from rest to rest; each line of the standard input starts a block."""
    from pkm_post.numerical_control.execute import NEAR_MM
    from pkm_post.numerical_control.single_block import blocks_of
    from pkm_post.pmac_link.faults import NotReadyError

    control = _control(session, target, namespace)
    count = len(blocks_of(target.job, target.settings, namespace.number))
    if namespace.block > count:
        raise NotReadyError([f"there is no block {namespace.block}: the program has {count}"])
    control.open_blocks(target.job, namespace.block)
    for number in range(namespace.block, count + 1):
        print(f"block {number} of {count}: Enter starts it, the end of the input ends here", flush=True)
        if not sys.stdin.readline():
            return 0
        with _held_on_interrupt(control):
            # Only what comes first is begun by hand; the others begin where the one before them ended.
            last = control.step(namespace.near if number == namespace.block else NEAR_MM)
            status = _wait(session, target, target.job.motion.time_ms[-1] / 1000)
        if _stopped(status, last):
            return 1
    print("the program has ended")
    return 0


def override(session: Session, target: Target, namespace: argparse.Namespace) -> int:
    """Set how fast time passes in programs."""
    from pkm_post.pmac_link import operate

    print(f"override {operate.override(session, target.settings, namespace.percent).override:g} %")
    return 0


def _control(session: Session, target: Target, namespace: argparse.Namespace) -> NumericalControl:
    from pkm_post.numerical_control.control import NumericalControl
    from pkm_post.pmac_link.faults import NotReadyError

    if namespace.number == target.settings.program:
        raise NotReadyError([f"program {namespace.number} is that of the jobs: choose another --number"])
    length = target.machine.rest_tool_length if namespace.tool_length is None else namespace.tool_length
    return NumericalControl(session, target.machine, target.settings, length, namespace.number)


def _carry_out(
    session: Session,
    target: Target,
    namespace: argparse.Namespace,
    control: NumericalControl,
    plan: Plan | None,
    told: tuple[Diagnostic, ...],
) -> int:
    """Tell a plan, have it carried out, and tell where it has led."""
    from pkm_post.numerical_control.execute import off_target
    from pkm_post.pmac_link.readout import pose_text

    for diagnostic in told:
        print(diagnostic, file=sys.stderr)
    if plan is None:
        return 1
    print(f"to {pose_text(plan.end)}; {plan.seconds:.1f} s")
    if namespace.check:
        return 0
    with _held_on_interrupt(control):
        control.execute(plan)
        status = _wait(session, target, plan.seconds)
    if _stopped(status, plan.lengths):
        return 1
    print(f"arrived; no strut is off by more than {off_target(status, plan.lengths):.4f} mm")
    return 0


def _wait(session: Session, target: Target, seconds: float) -> Status:
    from pkm_post.numerical_control.execute import wait_for_rest

    return wait_for_rest(session, target.settings, _START_S + seconds / _SLOWEST_OVERRIDE)


def _stopped(status: Status, lengths: Array) -> bool:
    """Whether a move ended otherwise than at the lengths it leads to, which is told."""
    from pkm_post.numerical_control.execute import NEAR_MM, off_target

    words = ["it is held; resume or abort it"] if status.held else list(status.words())
    if not words and off_target(status, lengths) > NEAR_MM:
        words = [f"it ended {off_target(status, lengths):.3f} mm of a strut from where it leads to"]
    print(*words, sep="\n", end="\n" if words else "", file=sys.stderr)
    return bool(words)


@contextmanager
def _held_on_interrupt(control: NumericalControl) -> Iterator[None]:
    """Ctrl-C while the machine moves by hand means: stop."""
    from pkm_post.pmac_link.faults import CancelledError

    try:
        yield
    except KeyboardInterrupt:
        control.hold()
        raise CancelledError("interrupted and held: resume or abort it") from None


ACTIONS: dict[str, tuple[Action, str, tuple[str, ...]]] = {
    "home": (home, "which struts are homed; start and watch the homing of the machine", ("machine",)),
    "jog": (jog, "move the tool or one strut a little, planned and checked", ("machine",)),
    "mdi": (mdi, "carry out a line of G-code, planned and checked", ("machine",)),
    "step": (step, "run a program from rest to rest", ("machine", "program")),
    "override": (override, "how fast time passes in programs, in %%", ("machine",)),
}
"""As ``pmac_actions.ACTIONS``."""

_STARTING = ("run", "stream", "home", "jog", "mdi", "step")
_OF_WHAT_RUNS = ("hold", "resume", "abort", "override", "monitor")


def tell_emergency(name: str, connected: bool) -> None:
    """Say what to do when the link is lost and the machine may be moving.

    Args:
        name: of the action that was carried out.
        connected: whether the controller had answered before.
    """
    from pkm_post.numerical_control.emergency import STEPS

    if name in _OF_WHAT_RUNS or (connected and name in _STARTING):
        print(*STEPS, sep="\n", file=sys.stderr)
