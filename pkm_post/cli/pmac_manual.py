# SPDX-License-Identifier: LGPL-2.1-or-later
"""Manual control: the actions home, jog, mdi, approach, step, continue and override of the command ``pmac``.

A plan is printed, executed and awaited, and the position reached is printed; a plan that fails its checks is not sent.
If the command ends while the machine moves, it holds the machine.
"""

from __future__ import annotations

import argparse
import math
import sys
from typing import TYPE_CHECKING

from pkm_post.cli.inputs import tool_length_of
from pkm_post.cli.pmac_stop import Actions, held_at_the_end
from pkm_post.cli.processes import wrong_usage
from pkm_post.cli.terminal import drop_typed_ahead, print_diagnostics
from pkm_post.options import START_TOLERANCE_MM

if TYPE_CHECKING:
    from pkm_post.cli.pmac_stop import JobTarget, Target
    from pkm_post.control.link import Session, Status
    from pkm_post.control.numerical_control import Jog, MovePlan, NumericalControl
    from pkm_post.control.player import PlayContext
    from pkm_post.model import Array, Diagnostics, Trajectory

_SLOWEST_OVERRIDE = 0.05
"""Override for the timeout of a move, which an operator may set meanwhile."""
_START_S = 30.0
"""Added to the timeout for the approach and codes of the machine."""
_HELD = "it is held, by an operator or, a jog, because this computer came too late to renew it; resume or abort it"


def control_of(session: Session, target: Target, namespace: argparse.Namespace) -> NumericalControl:
    """Numerical control of a machine with the given tool.

    Raises:
        NotReadyError: the program number for manual moves is that of the jobs.
    """
    from pkm_post.control.link import NotReadyError
    from pkm_post.control.numerical_control import NumericalControl

    if namespace.number == target.settings.program:
        raise NotReadyError([f"program {namespace.number} is that of the jobs: choose another --number"])
    length = tool_length_of(namespace, target.machine)
    return NumericalControl(session, target.machine, target.settings, length, namespace.number)


def execute_plan(
    session: Session,
    target: Target,
    namespace: argparse.Namespace,
    control: NumericalControl,
    plan: MovePlan | None,
    diagnostics: Diagnostics,
    start_tolerance: float = START_TOLERANCE_MM,
) -> int:
    """Print a plan, execute it, and print the position reached."""
    from pkm_post.control.link import pose_text
    from pkm_post.control.numerical_control import target_deviation

    print_diagnostics(diagnostics)
    if plan is None:
        return 1
    print(f"to {pose_text(plan.end)}; {plan.seconds:.1f} s")
    if namespace.check:
        return 0
    with held_at_the_end(session, target.settings):
        control.execute(plan, start_tolerance)
        if control.silence_s is not None:
            print(f"it rests within {control.silence_s:.1f} s if this computer falls silent, at 100 %", flush=True)
        status = wait_for_end(control, plan.seconds)
    if ended_elsewhere(status, plan.lengths):
        return 1
    if not control.has_ended(plan):
        print("its codes were ended from elsewhere", file=sys.stderr)
        return 1
    print(f"arrived; no strut is off by more than {target_deviation(status, plan.lengths):.4f} mm")
    return 0


def wait_for_end(control: NumericalControl, seconds: float) -> Status:
    """State after a move that takes this many seconds at 100 %."""
    return control.wait_for_rest(_START_S + seconds / _SLOWEST_OVERRIDE)


def ended_elsewhere(status: Status, lengths: Array) -> bool:
    """Whether a move ended away from its target lengths, which is printed."""
    from pkm_post.control.numerical_control import target_deviation
    from pkm_post.options import START_TOLERANCE_MM

    words = [_HELD] if status.held else list(status.fault_texts())
    if not words and target_deviation(status, lengths) > START_TOLERANCE_MM:
        words = [f"it ended {target_deviation(status, lengths):.3f} mm of a strut from where it leads to"]
    print(*words, sep="\n", end="\n" if words else "", file=sys.stderr)
    return bool(words)


def watched(session: Session, target: JobTarget, namespace: argparse.Namespace, status: Status) -> int:
    """Print the state of a program, and watch it until it rests at its end or at one of its stops.

    Args:
        target: with the program.
        namespace: states whether the program is left to itself.
        status: after its start.
    """
    from pkm_post.control.link import state_text, watch_program
    from pkm_post.control.numerical_control import program_stops, target_deviation

    print(state_text(status), flush=True)
    if namespace.no_watch:
        return 0
    status = watch_program(session, target.settings)
    rests = [target.job.motion.length[-1], *(stop.length for stop in program_stops(target.job))]
    if ended_elsewhere(status, min(rests, key=lambda rest: target_deviation(status, rest))):
        return 1
    print(state_text(status))
    return 0


_WATCH_S = 0.2
_PLC_CONTINUES = "; A PLC PROGRAM THAT HOMES MAY MOVE IT AGAIN: stop that with the machine's own means"
_THERE_MM = 1e-3
"""mm of a strut: within this distance of the start of a program no approach is planned."""


def home(session: Session, target: Target, namespace: argparse.Namespace) -> int:
    """Print which struts are homed; with a trigger, start the machine's homing and monitor it."""
    import time

    from pkm_post.control.link import owned, read_status
    from pkm_post.control.numerical_control import HomingPhase, missing_homes, start_homing

    if namespace.trigger is None:
        missing = missing_homes(read_status(session, target.settings))
        print(f"not homed: strut {', '.join(map(str, missing))}" if missing else "all struts are homed")
        return int(bool(missing))
    with owned(session, "home"), held_at_the_end(session, target.settings, _PLC_CONTINUES):
        watch = start_homing(session, target.settings, namespace.trigger)
        while True:
            seen = watch.see(read_status(session, target.settings), session.now())
            if seen.phase is not HomingPhase.SEARCHING:
                break
            time.sleep(_WATCH_S)
    print(seen)
    return int(seen.phase is not HomingPhase.DONE)


def jog(session: Session, target: Target, namespace: argparse.Namespace) -> int:
    """Jog the tool or one strut."""
    if fault := _jog_fault(namespace):
        return wrong_usage("U103", "pmac jog", fault)
    control = control_of(session, target, namespace)
    plan, diagnostics = control.plan_jog(_jog_of(namespace), namespace.feed / 60)
    return execute_plan(session, target, namespace, control, plan, diagnostics)


_OF_TOOL = ("x", "y", "z", "tilt_x", "tilt_y", "spin")


def _jog_fault(namespace: argparse.Namespace) -> str:
    """Why the arguments do not name one jog; empty if they do."""
    foreign = [f"--{name.replace('_', '-')}" for name in _OF_TOOL if getattr(namespace, name) is not None]
    if namespace.strut is not None and foreign:
        return f"expected either --strut or {', '.join(foreign)}"
    return "expected --strut and --by together" if (namespace.strut is None) != (namespace.by is None) else ""


def _jog_of(namespace: argparse.Namespace) -> Jog:
    from pkm_post.control.numerical_control import CartesianJog, StrutJog

    if namespace.strut is not None:
        return StrutJog(namespace.strut, namespace.by)
    x, y, z, *turns = (getattr(namespace, name) or 0.0 for name in _OF_TOOL)
    tilt_x, tilt_y, spin = map(math.radians, turns)
    return CartesianJog((x, y, z), (tilt_x, tilt_y), spin)


def mdi(session: Session, target: Target, namespace: argparse.Namespace) -> int:
    """Execute a line of G-code."""
    from pkm_post.control.numerical_control import MdiSettings

    control = control_of(session, target, namespace)
    plan, diagnostics = control.plan_line(namespace.line, MdiSettings(namespace.work_offset, namespace.axis_words))
    return execute_plan(session, target, namespace, control, plan, diagnostics)


def approach(session: Session, target: JobTarget, namespace: argparse.Namespace) -> int:
    """Move the tool to the start of a program, clear of any named part, stock and fixtures."""
    from pkm_post.control.link import read_status
    from pkm_post.control.numerical_control import target_deviation
    from pkm_post.control.player import approach_faults
    from pkm_post.model import errors
    from pkm_post.toolpath import highest_tip

    control = control_of(session, target, namespace)
    control.standing_pose()  # homed and at rest: otherwise the lengths do not say where the tool is
    if target_deviation(read_status(session, target.settings), target.job.first) <= _THERE_MM:
        print("the tool is at the start of the program")
        return 0
    known, diagnostics = _surroundings(session, target, namespace)
    if errors(diagnostics):
        print_diagnostics(diagnostics)
        return 1
    free = -math.inf
    if known is not None:
        namespace.tool_length = float(known.trajectory.tool_length()[0])
        free = highest_tip(known.trajectory)

    def check(path: Trajectory) -> Diagnostics:
        return () if known is None else approach_faults(known, 0, path)

    plan, found = control.plan_approach(target.job, namespace.feed / 60, free, check)
    return execute_plan(session, target, namespace, control, plan, diagnostics + found)


def _surroundings(
    session: Session, target: JobTarget, namespace: argparse.Namespace
) -> tuple[PlayContext | None, Diagnostics]:
    """The program as a trajectory with any named part, stock and fixtures; and faults of their files.

    Raises:
        NotReadyError: the trajectory starts elsewhere than the program, or with a tool of another length.
    """
    from pkm_post.cli.pmac_play import setup_of
    from pkm_post.control.player import PlayContext, check_start, read_playable

    named, file = namespace.trajectory, namespace.program.with_suffix(".pkmt")
    if not (named or namespace.part or namespace.stock or namespace.fixture):
        return None, ()
    made, _, found = read_playable(named or file, target.machine)
    setup, faults = setup_of(namespace)
    if made is None:
        return None, found + faults
    known = PlayContext(session, target.machine, target.settings, made, setup)
    check_start(known, target.job.first, namespace.tool_length)
    return known, found + faults


def step(session: Session, target: JobTarget, namespace: argparse.Namespace) -> int:
    """Run a program by lines of its source; each line of the standard input starts one."""
    from pkm_post.control.link import NotReadyError
    from pkm_post.control.numerical_control import read_blocks

    control = control_of(session, target, namespace)
    blocks, diagnostics = read_blocks(namespace.program, target.machine)
    print_diagnostics(diagnostics)
    if blocks is None:
        return 1
    if namespace.block > len(blocks):
        raise NotReadyError([f"there is no block {namespace.block}: the program has {len(blocks)}"])
    blocks, diagnostics = blocks.begun_at(namespace.block, target.machine)
    print_diagnostics(diagnostics)
    control.open_blocks(blocks, namespace.block)
    for number in range(namespace.block, len(blocks) + 1):
        drop_typed_ahead()
        print(f"{blocks.shown(number)}; Enter starts it, the end of the input ends here", flush=True)
        if not sys.stdin.readline():
            return 0
        # Only the first line needs an approach; the others start where the previous one ended.
        start_tolerance = namespace.near if number == namespace.block else START_TOLERANCE_MM
        if execute_plan(session, target, namespace, control, *control.plan_step(), start_tolerance):
            return 1
    print("the program has ended")
    return 0


def continue_after_stop(session: Session, target: JobTarget, namespace: argparse.Namespace) -> int:
    """Continue after a stop (M0, M1) of the program, and watch it."""
    from pkm_post.control.numerical_control import continue_after_stop

    with held_at_the_end(session, target.settings):
        status = continue_after_stop(
            session, target.machine, target.settings, target.job, namespace.stop, namespace.near
        )
        return watched(session, target, namespace, status)


def override(session: Session, target: Target, namespace: argparse.Namespace) -> int:
    """Set the time base of programs."""
    from pkm_post.control.link import set_feed_override

    print(f"override {set_feed_override(session, target.settings, namespace.percent).override:g} %")
    return 0


ACTIONS: Actions = {
    "home": (home, "show which struts are homed; start and watch a homing", ("machine",)),
    "jog": (jog, "move the tool or one strut a little, planned and checked", ("machine",)),
    "mdi": (mdi, "execute a line of G-code, planned and checked", ("machine",)),
    "approach": (approach, "bring the tool to the start of a program, planned and checked", ("machine", "program")),
    "step": (step, "run a program one source line at a time, each to rest", ("machine", "program")),
    "continue": (continue_after_stop, "continue after a stop (M0, M1) of a program", ("machine", "program")),
    "override": (override, "set the feed override of programs, in %%", ("machine",)),
}

_STARTING = ("run", "stream", "home", "jog", "mdi", "approach", "step", "continue", "play", "measure")
_OF_WHAT_RUNS = ("hold", "resume", "abort", "override", "monitor")


def print_emergency_steps(name: str, connected: bool) -> None:
    """Print instructions for a lost link while the machine may be moving.

    Args:
        name: of the action.
        connected: whether the controller answered before.
    """
    from pkm_post.control.link import EMERGENCY_STEPS

    if name in _OF_WHAT_RUNS or (connected and name in _STARTING):
        print(*EMERGENCY_STEPS, sep="\n", file=sys.stderr)
