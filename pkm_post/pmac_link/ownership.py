# SPDX-License-Identifier: LGPL-2.1-or-later
"""Ownership: one client at a time may move a machine or load into its controller; all others may watch, and stop it.

Two clients that load or start at the same time close each other's buffers, or let the struts go where neither wants
them. So who wants to do that takes the right first: a lock file for the clients of this computer, and five variables P
of the controller for those of all computers. They say who has it, what for, since when, and a count that grows as long
as the owner is alive.

The controller takes the right by itself, in one assignment that changes the variable only if it has the value that was
seen before: of two clients that do it at once one finds the other. An owner that was killed leaves its number behind;
it is passed over when nothing was seen of it for a while and the machine rests. An owner that was silent for long looks
whether it is one still before it sends anything.

Enters: a session, and what is to be done. Leaves: the right, for the length of a block, or ``NotOwnerError``.
"""

from __future__ import annotations

import ipaddress
import logging
import os
import random
import socket
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path

from pkm_post.files.lock import Lock, Words, locked, words_of
from pkm_post.model import Diagnostic, Place
from pkm_post.pmac_link.faults import (
    DiagnosedError,
    LinkLostError,
    NotOwnerError,
    PmacError,
    RefusedError,
)
from pkm_post.pmac_link.free_words import free_words
from pkm_post.pmac_link.motion import is_busy
from pkm_post.pmac_link.session import Session

VARIABLES = range(8187, 8192)
"""Numbers of the variables P: owner, count, address of its computer, time since 1970 in s, what it does."""
OWNER, COUNT, *_ = VARIABLES
RECORD = f"P{VARIABLES[0]}..{VARIABLES[-1]}"

BEAT_S = 1.0
"""Seconds after which the owner counts on."""
SILENCE_S = 5.0
"""Seconds without any sign after which an owner is passed over."""
LOOK_S = 0.5
ATTEMPTS = 3
WHAT = ("download", "run", "stream", "jog", "home", "resume", "override", "terminal")
"""What an owner does; the controller keeps the place in this list, from 1. New ones come at its end."""
RESUMED_BY_ALL = ("stream",)
"""A stream has no order to resume: whoever holds it may let it go on."""
_ERR_NOT_OPEN = 5
_log = logging.getLogger(__name__)


@dataclass(frozen=True)
class Record:
    """What the variables of the controller say.

    Attributes:
        owner: a number that is the owner's alone; 0 when there is none.
        count: grows while it is alive.
        address: of its computer, IPv4 as a number; 0 when it has none.
        since: seconds since 1970.
        what: place in ``WHAT``, from 1.
    """

    owner: int
    count: int
    address: int
    since: int
    what: int

    @property
    def action(self) -> str:
        """What the owner does; empty when that is not known."""
        return WHAT[self.what - 1] if 0 < self.what <= len(WHAT) else ""

    def __str__(self) -> str:
        if not self.what:
            return "a client that does not say who it is"
        where = f"at {ipaddress.IPv4Address(self.address)}" if 0 < self.address < 1 << 32 else "without an address"
        return f"a client {where}, {self.action or 'something'}, since {_moment(self.since)}"


class Ownership:
    """The right to move a machine and to load into its controller."""

    def __init__(self, session: Session, lock: Lock | None, owner: int) -> None:
        """The right that was taken.

        Args:
            session: through which.
            lock: on this computer; None for a port that no other process can have.
            owner: the number in the controller; 0 where the controller has none.
        """
        self._session, self._lock, self._owner = session, lock, owner
        self._seen, self._connections, self._is_asking = session.now(), session.connections, False

    def answered(self) -> None:
        """Count on, when it is time and no program buffer is open: the assignment would become a line of it."""
        if self._is_asking or not self._owner or self._session.has_open_buffer or not self._is_older_than(BEAT_S):
            return
        self._is_asking = True
        try:
            self._session.ask(f"P{COUNT}=P{COUNT}+1")
            self._see()
        except (LinkLostError, RefusedError) as fault:  # done again after the next answer; others wait much longer
            _log.warning("the right to move the machine could not be renewed: %s", fault)
        finally:
            self._is_asking = False

    def check(self) -> None:
        """See that nobody has taken the right, when it was not seen lately or the link was lost meanwhile.

        Raises:
            NotOwnerError: somebody has.
            LinkLostError: it cannot be seen.
        """
        if self._is_asking or not self._owner or self.is_sure():
            return
        self._is_asking = True
        try:
            self._see()
        finally:
            self._is_asking = False

    def is_sure(self) -> bool:
        """Whether the right was seen so lately that nobody can have taken it since."""
        is_same_link = self._connections == self._session.connections
        return is_same_link and not self._is_older_than(SILENCE_S / 2)

    def release(self) -> None:
        """Give the right back; what the controller keeps of it is passed over later when it cannot be reached."""
        self._session.keeper = None
        try:
            if self._owner and not self._session.has_open_buffer:
                with self._session.in_a_hurry():
                    self._session.ask(_swap(self._owner, 0))
        except PmacError as fault:
            _log.warning("the right to move the machine could not be given back: %s", fault)
        finally:
            if self._lock is not None:
                self._lock.release()

    def _see(self) -> None:
        there = read_record(self._session)
        if not there.owner and not there.since and free_words(self._session) >= 0:
            self._session.ask(_swap(0, self._owner))  # a controller that was reset has forgotten all of it
            there = read_record(self._session)
        if there.owner != self._owner:
            raise NotOwnerError(_diagnostic(self._session, "C211", str(there)), there.action)
        self._seen, self._connections = self._session.now(), self._session.connections

    def _is_older_than(self, seconds: float) -> bool:
        return self._session.now() - self._seen > seconds


@contextmanager
def owned(session: Session, what: str, beside: tuple[str, ...] = ()) -> Iterator[None]:
    """Have the right to move the machine; the session keeps the one that it has.

    Args:
        session: an open session.
        what: is to be done, one of ``WHAT``.
        beside: what another client may do meanwhile; of any other that is silent the program may go on.

    Raises:
        NotOwnerError: another client has it.
        PmacError: as ``take``.
    """
    if session.keeper is not None:
        yield
        return
    try:
        taken: Ownership | None = take(session, what, beside)
    except NotOwnerError as fault:
        if fault.what not in beside:
            raise
        taken = None
    try:
        yield
    finally:
        if taken is not None:
            taken.release()


def take(session: Session, what: str, beside: tuple[str, ...] = ()) -> Ownership:
    """Take the right to move the machine; a program buffer that nobody fills any more is made empty and closed.

    Args:
        session: an open session that has it not.
        what: is to be done, one of ``WHAT``.
        beside: as ``owned``.

    Raises:
        NotOwnerError: another client has it, or what it began moves the machine still.
        DiagnosedError: the lock cannot be kept.
        LinkLostError: the controller cannot be asked.
        CancelledError: a stop came first.
    """
    lock = _locked(session, what) if session.port_name else None
    try:
        owner = _taken_in_controller(session, what, beside) if session.has_handshake else 0
    except BaseException:
        if lock is not None:
            lock.release()
        raise
    session.keeper = ownership = Ownership(session, lock, owner)
    return ownership


def read_record(session: Session) -> Record:
    """What the controller says of its owner.

    Raises:
        DiagnosedError: the variables hold what no client writes.
        LinkLostError: the answer makes no sense.
    """
    told = session.ask(RECORD)
    try:
        values = [float(line) for line in told]
        if len(values) != len(VARIABLES):
            raise ValueError(f"expected {len(VARIABLES)} lines, got {len(values)}")
    except ValueError as fault:
        raise LinkLostError(f"{RECORD}: {fault}") from None
    if not all(value.is_integer() and value >= 0 for value in values):
        raise DiagnosedError(_diagnostic(session, "C213", f"{RECORD} is {' '.join(told)}"))
    return Record(*map(int, values))


def lock_path(port: str) -> Path:
    """Where the lock file of a port is: the same for all users, and for all names of a serial line."""
    kind, _, address = port.partition(":")
    name = f"{kind}:{os.path.realpath(address) if kind == 'serial' else address.lower()}"
    return Path(tempfile.gettempdir()) / f"pkm-post-{sha256(name.encode()).hexdigest()[:16]}.lock"


def _locked(session: Session, what: str) -> Lock:
    path = lock_path(session.port_name)
    try:
        lock = locked(path)
    except OSError as fault:
        raise DiagnosedError(_diagnostic(session, "C212", f"{path}: {fault.strerror}")) from fault
    if lock is None:
        said = words_of(path)
        raise NotOwnerError(_diagnostic(session, "C210", _process(said)), str(said.get("what", "")))
    lock.say({"user": _user(), "process": os.getpid(), "what": what, "since": int(time.time())})
    return lock


def _taken_in_controller(session: Session, what: str, beside: tuple[str, ...]) -> int:
    """The number of this client, which is in the controller now."""
    before = read_record(session)
    is_open = free_words(session) < 0
    if before.owner or is_open:
        _see_silence(session, before, beside)
    if is_open:
        _close_leftover(session)
    owner, seen = random.SystemRandom().randrange(1, 1 << 30), before.owner
    for _ in range(ATTEMPTS):
        session.ask(_swap(seen, owner))  # as often as need be: it may arrive twice
        there = read_record(session)
        if there.owner not in (0, seen):
            break
        seen = there.owner  # a controller that was reset has forgotten it
    if there.owner != owner:
        raise NotOwnerError(_diagnostic(session, "C210", str(there)), there.action)
    words = (1, _own_address(session.port_name), int(time.time()), WHAT.index(what) + 1)
    session.ask(" ".join(f"P{number}={word}" for number, word in zip(VARIABLES[1:], words, strict=True)))
    return owner


def _swap(old: int, new: int) -> str:
    """The owner becomes another one if it is the one that is known: INT is 1 then, and else 0."""
    return f"P{OWNER}=P{OWNER}+({new}-{old})*INT(1/(ABS(P{OWNER}-{old})+1))"


def _see_silence(session: Session, record: Record, beside: tuple[str, ...]) -> None:
    """Wait until an owner has shown nothing for so long that there is none any more.

    An owner whose machine moves or is held may be busy with a buffer, so it is left alone. Who goes on with what one
    of them began waits for its count alone; it would grow while a program runs, but for those that it may go on beside.

    Raises:
        NotOwnerError: it shows something, or the machine does something.
    """
    known = str(record)
    signs, until = _signs(session, record), session.now() + SILENCE_S
    while True:
        is_left_alone = record.action in beside or (not beside and is_busy(session))
        if is_left_alone or _signs(session, read_record(session)) != signs:
            raise NotOwnerError(_diagnostic(session, "C210", known), record.action if record.owner else "")
        if session.now() >= until:
            break
        session.give_way()
        session.sleep(LOOK_S)
    if record.owner:
        _log.warning("nothing was seen of %s for %g s: it is passed over", known, SILENCE_S)


def _signs(session: Session, record: Record) -> tuple[object, ...]:
    """What changes while an owner is alive: its count, the memory while it loads, the lines while it streams."""
    return record.owner, record.count, session.ask("SIZE"), session.ask("PR")


def _close_leftover(session: Session) -> None:
    """Make a program buffer empty that nobody fills any more, and close it."""
    try:
        session.order("CLEAR")
    except RefusedError as refused:  # of another port; whether CLOSE does it is seen
        if refused.number != _ERR_NOT_OPEN:
            raise
    session.order("CLOSE")
    if free_words(session) < 0:
        raise DiagnosedError(_diagnostic(session, "C214", "SIZE is below zero after CLOSE"))
    _log.warning("a program buffer was open, the rest of a download that was cut: it was made empty")


def _diagnostic(session: Session, code: str, found: str) -> Diagnostic:
    return Diagnostic(code, Place(session.port_name or "controller"), found)


def _process(said: Words) -> str:
    """The process that has the lock of this computer, in words."""
    if not {"user", "process", "what", "since"} <= said.keys():
        return "a process of this computer that does not say who it is"
    return f"process {said['process']} of {said['user']}, {said['what']}, since {_moment(said['since'])}"


def _moment(seconds: object) -> str:
    try:
        return time.strftime("%Y-%m-%d %H:%M:%S", time.localtime(float(str(seconds))))
    except (ValueError, OverflowError, OSError):
        return "an unknown time"


def _user() -> str:
    return os.environ.get("USER") or os.environ.get("USERNAME") or "an unknown user"


def _own_address(port: str) -> int:
    """The address that this computer has towards a controller; 0 where there is none. Nothing is sent."""
    kind, _, address = port.partition(":")
    host, _, number = address.rpartition(":")
    if kind != "tcp":
        return 0
    try:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as asked:
            asked.connect((host, int(number)))
            return int(ipaddress.IPv4Address(asked.getsockname()[0]))
    except OSError:
        return 0  # an IPv6 address has no room in a variable
