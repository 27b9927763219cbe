# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command ``pmac simulate``: serve a simulated Turbo PMAC or Power PMAC until interrupted."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pkm_post.cli.inputs import read_machine, sound, tool_length_of
from pkm_post.cli.processes import wrong_usage
from pkm_post.cli.terminal import print_diagnostics
from pkm_post.options import between, whole, whole_from

if TYPE_CHECKING:
    from pkm_post.control.numerical_control import Body
    from pkm_post.control.simulator import Controller, PowerPmac, Server
    from pkm_post.model import Machine

LOWEST_SPEED, HIGHEST_SPEED = 0.01, 100.0
HIGHEST_PORT = 65_535
PROBE_INPUT = 1000
"""M-variable of a simulated touch probe."""


def add_action(actions: Any) -> None:
    """Add the action to those of the command ``pmac``."""
    simulate = actions.add_parser("simulate", help="simulate a PMAC with six motors, for tests and training")
    door = simulate.add_mutually_exclusive_group(required=True)
    door.add_argument("--pty", action="store_true", help="connect through a pseudo terminal, like a serial port")
    door.add_argument(
        "--tcp",
        type=whole(0, HIGHEST_PORT, "a port"),
        metavar="PORT",
        help="listen on this local port; 0 for any free one",
    )
    door.add_argument(
        "--ssh",
        type=whole(0, HIGHEST_PORT, "a port"),
        metavar="PORT",
        help="simulate a Power PMAC with an ssh login on this port; PKM_PMAC_PASSWORD is the password",
    )
    simulate.add_argument("--setup", type=Path, metavar="FILE", help="set-up file to execute first")
    simulate.add_argument(
        "--speed",
        type=between(LOWEST_SPEED, HIGHEST_SPEED),
        default=1.0,
        metavar="N",
        help="simulated seconds per second (1)",
    )
    simulate.add_argument("--memory", type=_words, metavar="WORDS", help="memory for programs, in 48-bit words")
    _add_probe(simulate)
    simulate.set_defaults(run=_simulate)


def _add_probe(simulate: argparse.ArgumentParser) -> None:
    from pkm_post.options import positive, tool_length

    help_text = "touch probe at M1000 and its target: plane:Z, bore:X,Y,Z,D or boss:X,Y,Z,D in {M}"
    simulate.add_argument("--probed", type=_body, metavar="BODY", help=help_text)
    help_text = "machine with M codes of its own, and with the probe"
    simulate.add_argument("--machine", metavar="NAME_OR_FILE", help=help_text)
    help_text = "gauge length to the centre of the probe ball (that of the rest pose)"
    simulate.add_argument("--tool-length", type=tool_length, metavar="MM", help=help_text)
    simulate.add_argument(
        "--ball", type=positive, default=6.0, metavar="MM", help="diameter of the probe ball (%(default)s)"
    )


def _body(text: str) -> Body:
    from pkm_post.control.numerical_control import body_of

    try:
        return body_of(text)
    except ValueError as fault:
        raise argparse.ArgumentTypeError(str(fault)) from None


def _words(text: str) -> int:
    from pkm_post.control.simulator import LEAST_MEMORY

    return whole_from(LEAST_MEMORY, f"{LEAST_MEMORY} words or more")(text)


def _simulate(namespace: argparse.Namespace, arguments: Sequence[str]) -> int:
    from pkm_post.control.simulator import Server

    if namespace.probed is not None and namespace.machine is None:
        return wrong_usage("U102", "--probed", "--machine")
    machine = _power_pmac(namespace) if namespace.ssh is not None else None
    controller = machine.controller if machine is not None else _turbo_pmac(namespace)
    if namespace.setup and not _set_up(machine or controller, namespace.setup):
        return 1
    if namespace.machine is not None:
        _be_of_machine(controller, namespace)
    server = None
    try:
        server = Server(controller, namespace.speed)
        address = _address(server, machine, namespace)
    except OSError as fault:
        print(f"no connection can be offered: {fault}", file=sys.stderr)
        if server is not None:
            server.close()
        return 1
    kind = "Turbo" if machine is None else "Power"
    print(f"A simulated {kind} PMAC is at {address}; Ctrl-C ends it.", flush=True)
    serve(server, lambda: False)
    return 0


def _turbo_pmac(namespace: argparse.Namespace) -> Controller:
    from pkm_post.control.simulator import Controller, SimulatorSettings

    return Controller(SimulatorSettings(memory_words=namespace.memory) if namespace.memory else SimulatorSettings())


def _power_pmac(namespace: argparse.Namespace) -> PowerPmac:
    from pkm_post.control.simulator import PowerPmac

    return PowerPmac(namespace.memory)


def _be_of_machine(controller: Controller, namespace: argparse.Namespace) -> None:
    """Add the M codes of the machine and a touch probe to the controller."""
    from pkm_post.control.simulator import function_programs

    machine = read_machine(namespace.machine)
    controller.load(function_programs((*machine.functions, *machine.thread_codes)))
    if namespace.probed is not None:
        _connect_probe(controller, machine, namespace)


def _connect_probe(controller: Controller, machine: Machine, namespace: argparse.Namespace) -> None:
    from pkm_post.control.link import ToolPoseReadout
    from pkm_post.control.numerical_control import SimulatedProbe
    from pkm_post.writing import pmac, power_pmac

    kind: Any = pmac if namespace.ssh is None else power_pmac
    settings = sound(*kind.settings_of(machine))
    readout = ToolPoseReadout(machine, tool_length_of(namespace, machine))
    SimulatedProbe(controller, settings, readout, namespace.ball, namespace.probed).connect(PROBE_INPUT)


def _address(server: Server, machine: PowerPmac | None, namespace: argparse.Namespace) -> str:
    """Open the port and return its name for clients; over ssh, print the data that a client needs.

    Raises:
        OSError: the port is taken, or no password is set.
    """
    from pkm_post.control.link import PASSWORD, ssh_package

    if machine is None:
        return f"serial:{server.add_pty()}" if namespace.pty else f"tcp:127.0.0.1:{server.add_tcp(namespace.tcp)}"
    password = os.environ.get(PASSWORD)
    if not password:
        raise OSError(f"set the password of the simulated user in {PASSWORD}, for this command and for its clients")
    door = server.add_ssh(machine, ssh_package(), namespace.ssh, password)
    print(f"its host key, for a file named by --known-hosts:\n{door.known_host}")
    return f"ssh:{door.user}@127.0.0.1:{door.number}"


def serve(server: Server, ended: Callable[[], bool]) -> None:
    """Serve until ``ended`` returns true, or until the user interrupts."""
    try:
        server.run(ended)
    except KeyboardInterrupt:
        print("ended")
    finally:
        server.close()


def _set_up(machine: Controller | PowerPmac, file: Path) -> bool:
    """Execute the lines of a file; print the first refused one.

    A set-up from a posting is refused if it was changed. Without a manifest, any file of lines is accepted.
    """
    from pkm_post.control.simulator import refused_line
    from pkm_post.model import errors
    from pkm_post.writing import manifest, read_text

    content, faults = read_text(file)
    faults = (*faults, *errors(manifest.check(file)[1]))
    print_diagnostics(faults)
    if content is None or faults:
        return False
    lines = content.splitlines()
    refused = refused_line(machine, lines)
    if refused is not None:
        place, why = refused
        print(f"{file}:{place + 1}: {why}: {lines[place]}", file=sys.stderr)
    return refused is None
