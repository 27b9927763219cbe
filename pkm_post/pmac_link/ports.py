# SPDX-License-Identifier: LGPL-2.1-or-later
"""Ports: ``serial:/dev/ttyUSB0`` or ``tcp:HOST[:PORT]`` becomes a link that carries bytes.

Enters: the name of a port. Leaves: the link to it, and the conversation that such a link needs.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Protocol

from pkm_post.pmac_link.ethernet_conversation import EthernetConversation
from pkm_post.pmac_link.exchange import Conversation
from pkm_post.pmac_link.links import Link, SerialLink, TcpLink
from pkm_post.pmac_link.serial_conversation import SerialConversation

TCP_PORT = 1025


class Door(Protocol):
    """What a session needs of a port; tests have doors of their own."""

    @property
    def silence(self) -> float:
        """Seconds without a byte after which the controller has nothing more to say."""

    def link(self) -> Link:
        """A link, not yet connected: ``restart`` does that."""

    def conversation(self) -> Conversation:
        """A conversation as this kind of link needs it."""


@dataclass(frozen=True)
class Port:
    """Where a controller is.

    Attributes:
        kind: ``"serial"`` or ``"tcp"``.
        address: of the device or host.
        number: of the TCP port.
        baud: of a serial line, as I54 of the controller says.
        parity: a key of ``links.PARITIES``.
        handshake: whether the line has RTS and CTS; adapters and pseudo terminals without them would wait for ever.
        timeout: seconds to connect, and to send.
        silence: seconds without a byte after which the controller has nothing more to say.
    """

    kind: str
    address: str
    number: int = TCP_PORT
    baud: int = 38400
    parity: str = "none"
    handshake: bool = False
    timeout: float = 5.0
    silence: float = 0.1

    def link(self) -> Link:
        """A link, not yet connected: ``restart`` does that."""
        if self.kind == "serial":
            return SerialLink(self.address, self.baud, self.parity, self.handshake, self.timeout)
        return TcpLink(self.address, self.number, self.timeout)

    def conversation(self) -> Conversation:
        """A conversation as this kind of link needs it."""
        return SerialConversation(self.silence) if self.kind == "serial" else EthernetConversation(self.silence)


_FORMS = (
    re.compile(r"(?P<kind>serial):(?P<address>.+)"),
    re.compile(r"(?P<kind>tcp):(?P<address>[^:\[\]]+|\[[0-9A-Fa-f:.]+\])(?::(?P<number>\d{1,5}))?"),
)


def port_named(name: str) -> Port:
    """The port of a name.

    Args:
        name: ``serial:DEVICE`` or ``tcp:HOST[:PORT]``; an IPv6 address stands in brackets.

    Raises:
        ValueError: the name has another form.
    """
    if name.startswith("ssh:"):
        raise ValueError("ssh: is the Power PMAC's way, which is not built in yet; expected serial: or tcp:")
    for form in _FORMS:
        found = form.fullmatch(name)
        if found:
            parts = {key: value for key, value in found.groupdict().items() if value is not None}
            number = int(parts.pop("number", TCP_PORT))
            if not 0 < number < 1 << 16:
                raise ValueError(f"port: expected 1 to 65535, got {number}")
            return Port(parts["kind"], parts["address"].strip("[]"), number)
    raise ValueError(f"port: expected serial:DEVICE or tcp:HOST[:PORT], got {name!r}")
