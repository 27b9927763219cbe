# SPDX-License-Identifier: LGPL-2.1-or-later
"""The commands ``pmac``: load a program into a Turbo PMAC or a Power PMAC, start, monitor and stop it.

Exit code 0 on success, 1 when controller, machine or link refused; the last lines on the standard error then state the
reason.
"""

from __future__ import annotations

import argparse
import logging
import sys
from collections.abc import Callable, Sequence
from contextlib import closing
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pkm_post.cli import pmac_manual, pmac_measure, pmac_play, pmac_simulate
from pkm_post.cli.inputs import NO_AXIS_WORDS, axis_words, read_machine, sound
from pkm_post.cli.pmac_actions import ACTIONS, NOT_OF_POWER_PMAC, ROTARY_WORDS
from pkm_post.cli.pmac_stop import JobTarget, ProgramTarget, Target
from pkm_post.options import (
    APPROACH_MM_S,
    LONGEST_JOG,
    MANUAL_MOVE_PROGRAM,
    OVERRIDE_PERCENT,
    PARITIES,
    START_TOLERANCE_MM,
    above_zero,
    between,
    count,
    positive,
    tool_length,
    validated,
    whole,
)

if TYPE_CHECKING:
    from pkm_post.control.link import Port, Session

_STOPS = ("hold", "abort")
"""Stops connect by themselves, and reconnect as needed."""


def add_commands(commands: Any) -> None:
    """Add the command ``pmac`` with its actions to a parser, and ``play``, which is one of them."""
    pmac = commands.add_parser("pmac", help="talk to a Turbo PMAC or a Power PMAC, or simulate one")
    actions = pmac.add_subparsers(required=True, metavar="ACTION")
    for name in _ACTIONS:
        _add_action(actions, name)
    pmac_simulate.add_action(actions)
    _add_action(commands, "play")


_ACTIONS = ACTIONS | pmac_manual.ACTIONS | pmac_measure.ACTIONS | pmac_play.ACTIONS


def _add_action(actions: Any, name: str) -> None:
    action, text, needs = _ACTIONS[name]
    parser = actions.add_parser(name, help=text)
    _add_port(parser)
    parser.add_argument("--machine", required="machine" in needs, metavar="NAME_OR_FILE", help="the machine")
    if "program" in needs:
        parser.add_argument("program", type=Path, metavar="PROGRAM.pmc", help="the program, as posted")
        help_text = "accept a program without proof that it is certified for this machine; this is logged"
        parser.add_argument("--uncertified", action="store_true", help=help_text)
    if name in _ARGUMENTS:
        _ARGUMENTS[name](parser)
    parser.set_defaults(run=_run, action=action, name=name, needs=needs)


def _add_port(parser: argparse.ArgumentParser) -> None:
    forms = "serial:DEVICE, tcp:HOST[:PORT] or, for a Power PMAC, ssh:USER@HOST[:PORT]"
    parser.add_argument("--port", required=True, type=_port, metavar="PORT", help=forms)
    parser.add_argument("--baud", type=count, default=38400, help="of the serial line (%(default)s)")
    parser.add_argument("--parity", choices=PARITIES, default="none", help="of the serial line (%(default)s)")
    parser.add_argument("--rtscts", action="store_true", help="the serial line uses RTS and CTS")
    known = "trusted ssh host keys (~/.ssh/known_hosts)"
    parser.add_argument("--known-hosts", type=Path, metavar="FILE", help=known)
    parser.add_argument(
        "--patience", type=above_zero(3600), default=2.0, metavar="S", help="timeout of an answer (%(default)s)"
    )


_one_line = validated(str, lambda text: len(text.splitlines()) < 2, "one line")


def _port(text: str) -> Port:
    from pkm_post.control.link import port_named

    try:
        return port_named(text)
    except ValueError as fault:
        raise argparse.ArgumentTypeError(str(fault).removeprefix("port: ")) from None


_HIGHEST_PROGRAM = 999
"""Numbers from 1000 are the subprograms of the codes."""
_jog_mm = between(-LONGEST_JOG, LONGEST_JOG)
_turn = between(-360, 360)


def _add_home(parser: argparse.ArgumentParser) -> None:
    help_text = "line that starts the homing of this machine, as specified by its builder, such as 'ENABLE PLC 3'"
    parser.add_argument(
        "--trigger", type=_trigger, metavar="LINE", help=f"{help_text} (only print which struts are homed)"
    )


def _add_jog(parser: argparse.ArgumentParser) -> None:
    for name in ("x", "y", "z"):
        parser.add_argument(f"--{name}", type=_jog_mm, metavar="MM", help=f"move the tip along {name.upper()}")
    for name in ("x", "y"):
        help_text = f"tilt the tool axis about {name.upper()} with the tip at rest"
        parser.add_argument(f"--tilt-{name}", type=_turn, metavar="DEG", help=help_text)
    parser.add_argument("--spin", type=_turn, metavar="DEG", help="rotate the platform about the tool axis")
    parser.add_argument("--strut", type=int, choices=range(1, 7), help="move one strut instead of the tool")
    parser.add_argument("--by", type=_jog_mm, metavar="MM", help="change in length of that strut")
    help_text = "of the tip; for a turn in place in degrees per minute (%(default)s)"
    parser.add_argument("--feed", type=positive, default=300.0, metavar="MM/MIN", help=help_text)
    _add_by_hand(parser)


def _add_mdi(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("line", type=_one_line, metavar="LINE", help="a line of G-code, independent of earlier ones")
    parser.add_argument("--work-offset", default="G54", metavar="NAME", help="frame of the line (%(default)s)")
    help_text = "tool axis words of the line; none keeps the axis (%(default)s)"
    parser.add_argument("--axis-words", type=axis_words, default=NO_AXIS_WORDS, metavar="WORDS", help=help_text)
    _add_by_hand(parser)


def _add_approach(parser: argparse.ArgumentParser) -> None:
    help_text = "of the tip; for a turn in place in degrees per minute (%(default)s)"
    parser.add_argument("--feed", type=positive, default=60 * APPROACH_MM_S, metavar="MM/MIN", help=help_text)
    pmac_play.add_solids(parser)
    help_text = "trajectory of the program, for that check (the file of the same name beside it)"
    parser.add_argument("--trajectory", type=Path, metavar="FILE.pkmt", help=help_text)
    _add_by_hand(parser)


def _add_by_hand(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--tool-length", type=tool_length, metavar="MM", help="gauge length (that of the rest pose)")
    parser.add_argument("--check", action="store_true", help="plan and check only; send nothing")
    _add_number(parser)


def _add_step(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--block", type=count, default=1, metavar="N", help="start at this block (%(default)s)")
    _add_near(parser, "each strut and the tip from the start of the first block")
    parser.set_defaults(tool_length=None, check=False)
    _add_number(parser)


def _add_run(parser: argparse.ArgumentParser) -> None:
    _add_near(parser, "each strut and the tip from the first point")
    _add_no_watch(parser)


def _add_stream(parser: argparse.ArgumentParser) -> None:
    rotary = "defined size of the rotary buffer (%(default)s)"
    parser.add_argument("--rotary", type=count, default=ROTARY_WORDS, metavar="WORDS", help=rotary)
    _add_near(parser, "each strut and the tip from the first point")


def _add_continue(parser: argparse.ArgumentParser) -> None:
    help_text = "stop at which the program waits, from 1"
    parser.add_argument("--stop", type=count, required=True, metavar="N", help=help_text)
    _add_near(parser, "each strut from the stop")
    _add_no_watch(parser)


def _add_near(parser: argparse.ArgumentParser, what: str) -> None:
    help_text = f"largest distance of {what} (%(default)s)"
    parser.add_argument("--near", type=positive, default=START_TOLERANCE_MM, metavar="MM", help=help_text)


def _add_no_watch(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--no-watch", action="store_true", help="exit once the program runs")


def _add_abort(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--at-once", action="store_true", help="without a hold first: the struts leave the path")


def _add_monitor(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--tool-length", type=tool_length, metavar="MM", help="gauge length (that of the rest pose)")
    parser.add_argument(
        "--rate", type=between(0.001, 1000), default=10.0, metavar="HZ", help="readings per second (%(default)s)"
    )
    parser.add_argument("--seconds", type=positive, metavar="S", help="duration (until Ctrl-C)")


def _add_measure(parser: argparse.ArgumentParser) -> None:
    pmac_measure.add_arguments(parser)
    parser.add_argument("--tool-length", type=tool_length, metavar="MM", help="to the centre of the ball (rest pose)")
    _add_number(parser)


def _add_number(parser: argparse.ArgumentParser) -> None:
    help_text = "program number to use in the controller (%(default)s)"
    parser.add_argument(
        "--number", type=whole(1, _HIGHEST_PROGRAM), default=MANUAL_MOVE_PROGRAM, metavar="PROG", help=help_text
    )


def _add_override(parser: argparse.ArgumentParser) -> None:
    help_text = "a number from {:g} to {:g}".format(*OVERRIDE_PERCENT)
    parser.add_argument("percent", type=between(*OVERRIDE_PERCENT), metavar="PERCENT", help=help_text)


def _trigger(text: str) -> str:
    from pkm_post.control.numerical_control import check_trigger

    try:
        check_trigger(text)
    except ValueError as fault:
        raise argparse.ArgumentTypeError(str(fault)) from None
    return text


_ARGUMENTS: dict[str, Callable[[argparse.ArgumentParser], None]] = {
    "run": _add_run,
    "stream": _add_stream,
    "abort": _add_abort,
    "monitor": _add_monitor,
    "home": _add_home,
    "jog": _add_jog,
    "mdi": _add_mdi,
    "approach": _add_approach,
    "step": _add_step,
    "continue": _add_continue,
    "override": _add_override,
    "play": pmac_play.add_arguments,
    "measure": _add_measure,
}
"""Functions that add the arguments of an action, where it has some of its own."""


def _run(namespace: argparse.Namespace, arguments: Sequence[str]) -> int:
    from pkm_post.control.link import LinkLostError, PmacError

    logging.basicConfig(level=logging.INFO, format="%(message)s", stream=sys.stderr)
    if namespace.port.is_power and namespace.name in NOT_OF_POWER_PMAC:
        why = NOT_OF_POWER_PMAC[namespace.name]
        print(f"{namespace.name} is not for a Power PMAC: {why}; use run or play", file=sys.stderr)
        return 1
    target = None if namespace.machine is None else _target(namespace)
    session, connected = _session(namespace), False
    try:
        with closing(session):
            if namespace.name not in _STOPS:
                session.open()
            connected = True
            return int(namespace.action(session, target, namespace))
    except PmacError as fault:
        print(fault, file=sys.stderr)
        if isinstance(fault, LinkLostError):
            pmac_manual.print_emergency_steps(namespace.name, connected)
        return 1
    except KeyboardInterrupt:
        print("interrupted; the controller continues what it does", file=sys.stderr)
        if namespace.name in _STOPS:
            pmac_manual.print_emergency_steps(namespace.name, connected)
        return 1


def _session(namespace: argparse.Namespace) -> Session:
    from pkm_post.control.link import OpenBufferPolicy, Session

    port = replace(
        namespace.port,
        baud=namespace.baud,
        parity=namespace.parity,
        handshake=namespace.rtscts,
        known_hosts=namespace.known_hosts,
    )
    open_buffer = OpenBufferPolicy.STOP if namespace.name in _STOPS else OpenBufferPolicy.LEAVE
    return Session(port, namespace.patience, open_buffer=open_buffer)


def _target(namespace: argparse.Namespace) -> Target:
    """Resolve machine and program."""
    from pkm_post.control.loading import job_to_load, program_to_load
    from pkm_post.writing import pmac, power_pmac

    machine = read_machine(namespace.machine)
    settings: Any = sound(*(power_pmac if namespace.port.is_power else pmac).settings_of(machine))
    if "program" not in namespace:
        return Target(machine, settings)
    given = namespace.program, machine, settings, namespace.uncertified
    if namespace.name == "download":
        return ProgramTarget(machine, settings, *sound(*program_to_load(*given)))
    return JobTarget(machine, settings, sound(*job_to_load(*given)))
