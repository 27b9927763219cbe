# SPDX-License-Identifier: LGPL-2.1-or-later
"""Ports: turn ``serial:/dev/ttyUSB0``, ``tcp:HOST[:PORT]`` or ``ssh:USER@HOST[:PORT]`` into a link.

Input: the name of a port. Output: its link, and the protocol that this kind of link requires.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from pkm_post.control.link.ethernet_protocol import EthernetProtocol
from pkm_post.control.link.gpascii_protocol import GpasciiProtocol
from pkm_post.control.link.links import Link, SerialLink, TcpLink
from pkm_post.control.link.protocol import CommandProtocol
from pkm_post.control.link.serial_protocol import SerialProtocol
from pkm_post.control.link.ssh_link import SshLink
from pkm_post.model import Phrase

TCP_PORT, SSH_PORT = 1025, 22


class PortInterface(Protocol):
    """The interface of a port to a session; tests supply their own."""

    @property
    def name(self) -> str:
        """Name for ``port_named`` that other clients use; empty if no other client can connect."""

    @property
    def silence(self) -> float:
        """Seconds without a byte that end an answer."""

    def link(self) -> Link:
        """A link, not yet connected: ``restart`` connects."""

    def protocol(self) -> CommandProtocol:
        """A protocol for this kind of link."""


@dataclass(frozen=True)
class Port:
    """The address of a controller.

    Attributes:
        kind: ``"serial"``, ``"tcp"`` or ``"ssh"``; ``"shell"`` is the shell of a simulated Power PMAC in this process.
        address: of the device or host.
        number: of the TCP port.
        baud: of a serial line, as set by I54 of the controller.
        parity: a key of ``options.PARITIES``.
        handshake: whether the line has RTS and CTS; adapters and pseudo terminals without them would block forever.
        timeout: seconds to connect, and to send.
        silence: seconds without a byte that end an answer.
        user: login name for ssh.
        known_hosts: file of trusted host keys; the user's own by default.
    """

    kind: str
    address: str
    number: int = TCP_PORT
    baud: int = 38400
    parity: str = "none"
    handshake: bool = False
    timeout: float = 5.0
    silence: float = 0.1
    user: str = ""
    known_hosts: Path | None = None

    @property
    def name(self) -> str:
        """Name for ``port_named``."""
        if self.kind == "serial":
            return f"serial:{self.address}"
        host = f"[{self.address}]" if ":" in self.address else self.address
        return f"{self.kind}:{self.user}{'@' if self.user else ''}{host}:{self.number}"

    @property
    def is_power(self) -> bool:
        """Whether it leads to a Power PMAC; else to a Turbo PMAC."""
        return self.kind in ("ssh", "shell")

    def link(self) -> Link:
        """A link, not yet connected: ``restart`` connects."""
        if self.kind == "ssh":
            return SshLink(self.address, self.number, self.user, self.known_hosts, self.timeout)
        if self.kind == "serial":
            return SerialLink(self.address, self.baud, self.parity, self.handshake, self.timeout)
        return TcpLink(self.address, self.number, self.timeout)

    def protocol(self) -> CommandProtocol:
        """A protocol for this kind of link."""
        return _PROTOCOLS[self.kind](self.silence)


_PROTOCOLS: dict[str, Callable[[float], CommandProtocol]] = {
    "serial": SerialProtocol,
    "tcp": EthernetProtocol,
    "ssh": GpasciiProtocol,
    "shell": GpasciiProtocol,
}
_HOST = r"(?P<address>[^:@\[\]]+|\[[0-9A-Fa-f:.]+\])(?::(?P<number>\d{1,5}))?"
_FORMS = (
    re.compile(r"(?P<kind>serial):(?P<address>.+)"),
    re.compile(rf"(?P<kind>tcp):{_HOST}"),
    re.compile(rf"(?P<kind>ssh):(?P<user>[^:@\[\]]+)@{_HOST}"),
)
_NAMES = "serial:DEVICE, tcp:HOST[:PORT] or ssh:USER@HOST[:PORT]"


def port_named(name: str) -> Port:
    """Parse the name of a port.

    Args:
        name: ``serial:DEVICE``, ``tcp:HOST[:PORT]`` or ``ssh:USER@HOST[:PORT]``; an IPv6 address in brackets.

    Raises:
        ValueError: the name has another form.
    """
    for form in _FORMS:
        found = form.fullmatch(name)
        if found:
            parts = {key: value for key, value in found.groupdict().items() if value is not None}
            kind = parts["kind"]
            number = int(parts.get("number", SSH_PORT if kind == "ssh" else TCP_PORT))
            if not 0 < number < 1 << 16:
                raise ValueError(Phrase("port: expected 1 to 65535, got {}", number))
            return Port(kind, parts["address"].strip("[]"), number, user=parts.get("user", ""))
    raise ValueError(Phrase("port: expected {}, got {!r}", _NAMES, name))
