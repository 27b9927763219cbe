# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command ``pmac simulate``: serve a simulated Turbo PMAC or Power PMAC until interrupted."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pkm_post.options import between, whole, whole_from

if TYPE_CHECKING:
    from pkm_post.control.simulator import Controller, PowerPmac, Server

LOWEST_SPEED, HIGHEST_SPEED = 0.01, 100.0
HIGHEST_PORT = 65_535


def add_action(actions: Any) -> None:
    """Add the action to those of the command ``pmac``."""
    simulate = actions.add_parser("simulate", help="be a PMAC with six motors, for tests and training")
    door = simulate.add_mutually_exclusive_group(required=True)
    door.add_argument("--pty", action="store_true", help="be connected to a pseudo terminal, as to a serial port")
    door.add_argument(
        "--tcp",
        type=whole(0, HIGHEST_PORT, "a port"),
        metavar="PORT",
        help="listen at this port of this computer; 0 takes any",
    )
    door.add_argument(
        "--ssh",
        type=whole(0, HIGHEST_PORT, "a port"),
        metavar="PORT",
        help="be a Power PMAC to log in to at this port; the password is taken from PKM_PMAC_PASSWORD",
    )
    simulate.add_argument("--setup", type=Path, metavar="FILE", help="lines of a set-up file to carry out first")
    simulate.add_argument(
        "--speed", type=between(LOWEST_SPEED, HIGHEST_SPEED), default=1.0, help="simulated seconds in a second (1)"
    )
    simulate.add_argument("--memory", type=_words, metavar="WORDS", help="memory for programs, in 48-bit words")
    simulate.set_defaults(run=_simulate)


def _words(text: str) -> int:
    from pkm_post.control.simulator import LEAST_MEMORY

    return whole_from(LEAST_MEMORY, f"{LEAST_MEMORY} words or more")(text)


def _simulate(namespace: argparse.Namespace, arguments: Sequence[str]) -> int:
    from pkm_post.control.simulator import Server

    machine = _power_pmac(namespace) if namespace.ssh is not None else None
    controller = machine.controller if machine is not None else _turbo_pmac(namespace)
    if namespace.setup and not _set_up(machine or controller, namespace.setup):
        return 1
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


def _address(server: Server, machine: PowerPmac | None, namespace: argparse.Namespace) -> str:
    """Open the port and return its name for clients; over ssh print what a client has to know of it.

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
    """Execute the lines of a file; print the first that is refused.

    A set-up from a posting is refused if it has changed since. Without a manifest it may be any other file of lines.
    """
    from pkm_post.control.simulator import refused_line
    from pkm_post.model import errors
    from pkm_post.writing import manifest, read_text

    content, faults = read_text(file)
    faults = (*faults, *errors(manifest.check(file)[1]))
    for fault in faults:
        print(fault, file=sys.stderr)
    if content is None or faults:
        return False
    lines = content.splitlines()
    refused = refused_line(machine, lines)
    if refused is not None:
        place, why = refused
        print(f"{file}:{place + 1}: {why}: {lines[place]}", file=sys.stderr)
    return refused is None
