# SPDX-License-Identifier: LGPL-2.1-or-later
"""The owner's record in the controller: five P-variables that all clients of a machine read and write."""

from __future__ import annotations

import ipaddress
import socket
import time
from dataclasses import dataclass

from pkm_post.control.link.errors import DiagnosedError, LinkLostError
from pkm_post.control.link.queries import parse_number
from pkm_post.control.link.session import Session
from pkm_post.model import Diagnostic, Place

VARIABLES = range(8187, 8192)
"""Numbers of the P-variables: owner, count, address of its computer, time since 1970 in s, operation."""
OWNER, COUNT, *_, OPERATION = VARIABLES
RECORD = f"P{VARIABLES[0]}..{VARIABLES[-1]}"

OPERATIONS = ("download", "run", "stream", "jog", "home", "resume", "override", "terminal", "play")
"""Operations of an owner; the controller stores the index in this list, from 1. Append new ones at its end."""
RESUMED_BY_ALL = ("stream", "play")
"""Operations that another client may resume after a hold, while the owner keeps feeding them."""
_HELD = 64
"""Added to the operation while another client holds it between two motions."""


@dataclass(frozen=True)
class Owner:
    """The contents of the controller's variables.

    Attributes:
        owner: a unique number; 0 if there is none.
        count: heartbeat.
        address: of its computer, IPv4 as a number; 0 if it has none.
        since: seconds since 1970.
        what: index in ``OPERATIONS``, from 1, and whether it is held between two motions.
    """

    owner: int
    count: int
    address: int
    since: int
    what: int

    @property
    def action(self) -> str:
        """The owner's operation; empty if unknown."""
        index = self.what % _HELD
        return OPERATIONS[index - 1] if 0 < index <= len(OPERATIONS) else ""

    @property
    def is_held(self) -> bool:
        """Whether another client holds it between two motions: it starts none until a resume."""
        return self.what >= _HELD

    def __str__(self) -> str:
        if not self.what:
            return "an unidentified client"
        where = f"at {ipaddress.IPv4Address(self.address)}" if 0 < self.address < 1 << 32 else "without an address"
        return f"a client {where}, {self.action or 'something'}, since {time_text(self.since)}"


def read_record(session: Session) -> Owner:
    """Read the owner's record from the controller.

    Raises:
        DiagnosedError: the variables have values that no client writes.
        LinkLostError: the answer is invalid.
    """
    answer = session.query(RECORD)
    try:
        values = [parse_number(line) for line in answer]
        if len(values) != len(VARIABLES):
            raise ValueError(f"expected {len(VARIABLES)} lines, got {len(values)}")
    except ValueError as fault:
        raise LinkLostError(f"{RECORD}: {fault}") from None
    if not all(value.is_integer() and value >= 0 for value in values):
        raise DiagnosedError(owner_diagnostic(session, "C213", f"{RECORD} is {' '.join(answer)}"))
    return Owner(*map(int, values))


def exchange_owner(old: int, new: int) -> str:
    """Replace the owner if it is the expected one: INT is then 1, else 0."""
    return _exchange(OWNER, old, new)


def exchange_hold(record: Owner, is_held: bool) -> str:
    """Hold an operation between two motions, or continue it, unless it has changed meanwhile."""
    index = record.what % _HELD
    return _exchange(OPERATION, index + _HELD * (not is_held), index + _HELD * is_held)


def release_hold(session: Session) -> bool:
    """Continue an operation that is held between two motions; return whether one was."""
    record = read_record(session)
    if record.is_held:
        session.query(exchange_hold(record, False))
    return record.is_held


def _exchange(number: int, old: int, new: int) -> str:
    return f"P{number}=P{number}+({new}-{old})*INT(1/(ABS(P{number}-{old})+1))"


def owner_diagnostic(session: Session, code: str, found: str) -> Diagnostic:
    """A diagnostic of the machine at the port of a session."""
    return Diagnostic(code, Place(session.port_name or "controller"), found)


def time_text(seconds: object) -> str:
    """Local date and time of seconds since 1970, as text."""
    try:
        return time.strftime("%Y-%m-%d %H:%M:%S", time.localtime(float(str(seconds))))
    except (ValueError, OverflowError, OSError):
        return "an unknown time"


def own_address(port: str) -> int:
    """This computer's address towards a controller; 0 if there is none. Nothing is sent."""
    kind, _, address = port.partition(":")
    host, _, number = address.rpartition(":")
    if kind != "tcp":
        return 0
    try:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            probe.connect((host, int(number)))
            return int(ipaddress.IPv4Address(probe.getsockname()[0]))
    except OSError:
        return 0  # an IPv6 address does not fit into a variable
