# SPDX-License-Identifier: LGPL-2.1-or-later
"""The commands ``pmac``: load a program into a Turbo PMAC, start, monitor and stop it.

Exit code 0 on success, 1 when controller, machine or link refused; the last lines on the standard error then state the
reason.
"""

from __future__ import annotations

import argparse
import logging
import sys
from collections.abc import Sequence
from contextlib import closing
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from pkm_post.cli import pmac_control, pmac_control_arguments, pmac_simulate
from pkm_post.cli.pmac_actions import ACTIONS, NOT_OF_POWER_PMAC, OF_POWER_PMAC, JobTarget, Target
from pkm_post.cli.pmac_stream import ROTARY_WORDS
from pkm_post.options import above_zero, between, count, positive, tool_length

if TYPE_CHECKING:
    from pkm_post.control import Port, Session
    from pkm_post.model import Diagnostic

Value = TypeVar("Value")

_STOPS = ("hold", "abort")
"""Stops connect by themselves, and reconnect as needed."""


def add_commands(commands: Any) -> None:
    """Add the command ``pmac`` with its actions to a parser."""
    pmac = commands.add_parser("pmac", help="talk to a Turbo PMAC, or simulate one")
    actions = pmac.add_subparsers(required=True, metavar="ACTION")
    for name, (action, text, needs) in (ACTIONS | pmac_control.ACTIONS).items():
        parser = actions.add_parser(name, help=text)
        _add_port(parser)
        parser.add_argument("--machine", required="machine" in needs, metavar="NAME_OR_FILE", help="the machine")
        if "program" in needs:
            parser.add_argument("program", type=Path, metavar="PROGRAM.pmc")
            told = "take the program though nothing shows that it is certified for this machine; that is logged"
            parser.add_argument("--uncertified", action="store_true", help=told)
        _add_own(parser, name)
        pmac_control_arguments.add_own(parser, name)
        parser.set_defaults(run=_run, action=action, name=name, needs=needs)
    pmac_simulate.add_action(actions)


def _add_port(parser: argparse.ArgumentParser) -> None:
    from pkm_post.options import PARITIES

    forms = "serial:DEVICE, tcp:HOST[:PORT] or, for a Power PMAC, ssh:USER@HOST[:PORT]"
    parser.add_argument("--port", required=True, type=_port, metavar="PORT", help=forms)
    parser.add_argument("--baud", type=count, default=38400, help="of a serial line (%(default)s)")
    parser.add_argument("--parity", choices=PARITIES, default="none", help="of a serial line (%(default)s)")
    parser.add_argument("--rtscts", action="store_true", help="the serial line has RTS and CTS")
    known = "host keys that are trusted over ssh (~/.ssh/known_hosts)"
    parser.add_argument("--known-hosts", type=Path, metavar="FILE", help=known)
    parser.add_argument(
        "--patience", type=above_zero(3600), default=2.0, metavar="S", help="longest silence (%(default)s)"
    )


def _add_own(parser: argparse.ArgumentParser, name: str) -> None:
    if name == "stream":
        rotary = "size of the rotary buffer, as it was defined (%(default)s)"
        parser.add_argument("--rotary", type=count, default=ROTARY_WORDS, metavar="WORDS", help=rotary)
    if name in ("run", "stream"):
        from pkm_post.options import START_TOLERANCE_MM

        near = "how far each strut and the tip may be from the first point (%(default)s)"
        parser.add_argument("--near", type=positive, default=START_TOLERANCE_MM, metavar="MM", help=near)
    elif name == "abort":
        parser.add_argument("--at-once", action="store_true", help="without a hold before: the struts leave the path")
    elif name == "monitor":
        parser.add_argument(
            "--tool-length", type=tool_length, metavar="MM", help="gauge length (that of the rest pose)"
        )
        parser.add_argument(
            "--rate", type=between(0.001, 1000), default=10.0, metavar="HZ", help="readings per second (%(default)s)"
        )
        parser.add_argument("--seconds", type=positive, metavar="S", help="how long (until Ctrl-C)")


def _port(text: str) -> Port:
    from pkm_post.control import port_named

    try:
        return port_named(text)
    except ValueError as fault:
        raise argparse.ArgumentTypeError(str(fault)) from None


def _run(namespace: argparse.Namespace, arguments: Sequence[str]) -> int:
    from pkm_post.control import LinkLostError, PmacError

    logging.basicConfig(level=logging.INFO, format="%(message)s", stream=sys.stderr)
    if namespace.port.is_power and namespace.name not in OF_POWER_PMAC:
        print(f"{namespace.name} is not for a Power PMAC: {NOT_OF_POWER_PMAC}", file=sys.stderr)
        return 1
    target = None if namespace.machine is None else _target(namespace)
    if target is None and namespace.machine is not None:
        return 1
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
            pmac_control.tell_emergency(namespace.name, connected)
        return 1
    except KeyboardInterrupt:
        print("interrupted; the controller goes on with what it does", file=sys.stderr)
        if namespace.name in _STOPS:
            pmac_control.tell_emergency(namespace.name, connected)
        return 1


def _session(namespace: argparse.Namespace) -> Session:
    """Open a session on the given port."""
    from pkm_post.control import Leftover, Session

    port = replace(
        namespace.port,
        baud=namespace.baud,
        parity=namespace.parity,
        handshake=namespace.rtscts,
        known_hosts=namespace.known_hosts,
    )
    leftover = Leftover.STOP if namespace.name in _STOPS else Leftover.LEAVE
    return Session(port, namespace.patience, leftover=leftover)


def _target(namespace: argparse.Namespace) -> Target | None:
    """Resolve machine and program; None when they have faults, which are printed."""
    from pkm_post.control import job_to_load
    from pkm_post.machine import machine_named
    from pkm_post.writing import pmac, power_pmac

    machine = _told(*machine_named(namespace.machine))
    if machine is None:
        return None
    settings: Any = _told(*(power_pmac if namespace.port.is_power else pmac).settings_of(machine))
    if settings is None:
        return None
    if "program" not in namespace:
        return Target(machine, settings)
    job = _told(*job_to_load(namespace.program, machine, settings, namespace.uncertified))
    return None if job is None else JobTarget(machine, settings, job)


def _told(value: Value | None, faults: Sequence[Diagnostic]) -> Value | None:
    """Print the faults and return the value."""
    for fault in faults:
        print(fault, file=sys.stderr)
    return value
