# SPDX-License-Identifier: LGPL-2.1-or-later
"""Ownership: one client at a time may move a machine or load its controller; all others may monitor and stop it.

Two clients that load or start at the same time close each other's buffers, or move the struts to the wrong place. So a
client first claims ownership for a block of work: with a lock file among the clients of this computer, and with five
P-variables of the controller among all computers. They record owner, operation, start time and a heartbeat count. The
claim is atomic: one assignment in the controller changes the variable only if it still has the value just read, so of
two simultaneous clients one sees the other. A killed owner leaves its number behind; it is overridden if it is silent
for a while and the machine is at rest. An owner that was silent for long verifies its ownership before it sends
anything.
"""

from __future__ import annotations

import getpass
import logging
import os
import random
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from hashlib import sha256
from pathlib import Path

from pkm_post.control.link.errors import DiagnosedError, LinkLostError, NotOwnerError, PmacError, RefusedError
from pkm_post.control.link.owner_record import (
    COUNT,
    OPERATIONS,
    VARIABLES,
    Owner,
    exchange_owner,
    own_address,
    owner_diagnostic,
    read_record,
    time_text,
)
from pkm_post.control.link.session import Session, free_memory
from pkm_post.control.link.status import is_busy
from pkm_post.system import Lock, OwnerRecord, lock_owner, try_lock

BEAT_S = 1.0
"""Heartbeat period of the owner, s."""
SILENCE_S = 5.0
"""Silence in s after which an owner is overridden."""
POLL_S = 0.5
ATTEMPTS = 3
_ERR_NOT_OPEN = 5
_log = logging.getLogger(__name__)


class Ownership:
    """The right to move a machine and to load its controller."""

    def __init__(self, session: Session, lock: Lock | None, owner: int) -> None:
        """Represent ownership that has been claimed.

        Args:
            session: through which it was claimed.
            lock: on this computer; None for a port that no other process can use.
            owner: the number in the controller.
        """
        self._session, self._lock, self._owner = session, lock, owner
        self._verified_at, self._connections, self._is_querying = session.now(), session.connections, False

    def answered(self) -> None:
        """Send a due heartbeat, unless a program buffer is open, which would take the assignment as a line."""
        if self._is_querying or not self._owner or self._session.has_open_buffer or not self._is_older_than(BEAT_S):
            return
        self._is_querying = True
        try:
            self._session.query(f"P{COUNT}=P{COUNT}+1")
            self._verify()
        except (LinkLostError, RefusedError) as fault:  # retried after the next answer; others wait much longer
            _log.warning("ownership of the machine could not be renewed: %s", fault)
        finally:
            self._is_querying = False

    def check(self) -> None:
        """Verify ownership, unless it was verified recently and the link was up since.

        A Power PMAC answers no query of a thread with an open program; the next check is after closing it.

        Raises:
            NotOwnerError: another client has claimed it.
            LinkLostError: it cannot be verified.
        """
        is_mute = self._session.has_open_buffer and not self._session.has_handshake
        if self._is_querying or not self._owner or self.is_certain() or is_mute:
            return
        self._is_querying = True
        try:
            self._verify()
        finally:
            self._is_querying = False

    def is_certain(self) -> bool:
        """Whether ownership was verified so recently that no other client can have claimed it since."""
        is_same_link = self._connections == self._session.connections
        return is_same_link and not self._is_older_than(SILENCE_S / 2)

    def release(self) -> None:
        """Release ownership; if the controller is unreachable, its record expires later."""
        self._session.keeper = None
        try:
            if self._owner and not self._session.has_open_buffer:
                with self._session.short_timeouts():
                    self._session.query(exchange_owner(self._owner, 0))
        except PmacError as fault:
            _log.warning("ownership of the machine could not be released: %s", fault)
        finally:
            if self._lock is not None:
                self._lock.release()

    def _verify(self) -> None:
        there = read_record(self._session)
        if not there.owner and not there.since and not _has_abandoned_buffer(self._session):
            self._session.query(exchange_owner(0, self._owner))  # after a reset of the controller the record is gone
            there = read_record(self._session)
        if there.owner != self._owner:
            by = str(there) if there.owner else "an abort from elsewhere has ended what it did"
            raise NotOwnerError(owner_diagnostic(self._session, "C211", by), there.action)
        self._verified_at, self._connections = self._session.now(), self._session.connections

    def _is_older_than(self, seconds: float) -> bool:
        return self._session.now() - self._verified_at > seconds


@contextmanager
def owned(session: Session, what: str, concurrent: tuple[str, ...] = ()) -> Iterator[None]:
    """Own the machine for a block; a session that already owns it keeps it.

    Args:
        what: the operation, one of ``OPERATIONS``.
        concurrent: operations of another client allowed meanwhile; a silent client's program may continue.

    Raises:
        NotOwnerError: another client has it.
        PmacError: as ``claim``.
    """
    if session.keeper is not None:
        yield
        return
    try:
        claimed: Ownership | None = claim(session, what, concurrent)
    except NotOwnerError as fault:
        if fault.what not in concurrent:
            raise
        claimed = None
    try:
        yield
    finally:
        if claimed is not None:
            claimed.release()


def claim(session: Session, what: str, concurrent: tuple[str, ...] = ()) -> Ownership:
    """Claim ownership; clear and close an abandoned program buffer.

    Args:
        session: an open session without ownership.
        what: the operation, one of ``OPERATIONS``.
        concurrent: as ``owned``.

    Raises:
        NotOwnerError: another client has it, or its operation still moves the machine.
        DiagnosedError: the lock file cannot be used.
        LinkLostError: the controller cannot be queried.
        CancelledError: a stop came first.
    """
    lock = _claim_lock(session, what) if session.port_name else None
    try:
        owner = _claim_in_controller(session, what, concurrent)
    except BaseException:
        if lock is not None:
            lock.release()
        raise
    session.keeper = ownership = Ownership(session, lock, owner)
    return ownership


def lock_path(port: str) -> Path:
    """Path of a port's lock file: the same for all users, and for all names of a serial line."""
    kind, _, address = port.partition(":")
    name = f"{kind}:{os.path.realpath(address) if kind == 'serial' else address.lower()}"
    return Path(tempfile.gettempdir()) / f"pkm-post-{sha256(name.encode()).hexdigest()[:16]}.lock"


def _claim_lock(session: Session, what: str) -> Lock:
    path = lock_path(session.port_name)
    try:
        lock = try_lock(path)
    except OSError as fault:
        raise DiagnosedError(owner_diagnostic(session, "C212", f"{path}: {fault.strerror}")) from fault
    if lock is None:
        record = lock_owner(path)
        raise NotOwnerError(owner_diagnostic(session, "C210", _process(record)), str(record.get("what", "")))
    lock.describe({"user": _user(), "process": os.getpid(), "what": what, "since": int(time.time())})
    return lock


def _claim_in_controller(session: Session, what: str, concurrent: tuple[str, ...]) -> int:
    """Claim ownership in the controller; return the number of this client."""
    before = read_record(session)
    is_open = _has_abandoned_buffer(session)
    if before.owner or is_open:
        _wait_for_silence(session, before, concurrent)
    if is_open:
        _close_abandoned_buffer(session)
    owner, seen = random.SystemRandom().randrange(1, 1 << 30), before.owner
    for _ in range(ATTEMPTS):
        session.query(exchange_owner(seen, owner))  # idempotent, as it may arrive twice
        there = read_record(session)
        if there.owner not in (0, seen):
            break
        seen = there.owner  # 0 after a reset of the controller
    if there.owner != owner:
        raise NotOwnerError(owner_diagnostic(session, "C210", str(there)), there.action)
    words = (1, own_address(session.port_name), int(time.time()), OPERATIONS.index(what) + 1)
    session.query(" ".join(f"P{number}={word}" for number, word in zip(VARIABLES[1:], words, strict=True)))
    return owner


def _wait_for_silence(session: Session, record: Owner, concurrent: tuple[str, ...]) -> None:
    """Wait until an owner has been silent long enough to count as gone.

    An owner whose machine moves or is held may be busy with a buffer, so it keeps ownership. A client that resumes a
    program checks only the owner's count, which would grow while a program runs, except for programs it may resume.

    Raises:
        NotOwnerError: the owner is alive, or the machine is busy.
    """
    known = str(record)
    signs, until = _signs_of_life(session, record), session.now() + SILENCE_S
    while True:
        is_left_alone = record.action in concurrent or (not concurrent and is_busy(session))
        if is_left_alone or _signs_of_life(session, read_record(session)) != signs:
            raise NotOwnerError(owner_diagnostic(session, "C210", known), record.action if record.owner else "")
        if session.now() >= until:
            break
        session.check_preemption()
        session.sleep(POLL_S)
    if record.owner:
        _log.warning("no sign of life from %s for %g s: its ownership is overridden", known, SILENCE_S)


def _signs_of_life(session: Session, record: Owner) -> tuple[object, ...]:
    """Signs of life of an owner: its count, free memory while it loads, lines ahead while it streams."""
    if not session.has_handshake:
        return record.owner, record.count
    return record.owner, record.count, session.query("SIZE"), session.query("PR")


def _has_abandoned_buffer(session: Session) -> bool:
    """Whether a program buffer of a Turbo PMAC is open; that of a Power PMAC belongs to the thread of its client."""
    return session.has_handshake and free_memory(session) < 0


def _close_abandoned_buffer(session: Session) -> None:
    try:
        session.command("CLEAR")
    except RefusedError as refused:  # another port opened it; the check below shows whether CLOSE works
        if refused.number != _ERR_NOT_OPEN:
            raise
    session.command("CLOSE")
    if free_memory(session) < 0:
        raise DiagnosedError(owner_diagnostic(session, "C214", "SIZE is below zero after CLOSE"))
    _log.warning("a program buffer was open after an interrupted download: it was cleared")


def _process(record: OwnerRecord) -> str:
    if not {"user", "process", "what", "since"} <= record.keys():
        return "an unidentified process of this computer"
    return f"process {record['process']} of {record['user']}, {record['what']}, since {time_text(record['since'])}"


def _user() -> str:
    try:
        return getpass.getuser()
    except (ImportError, KeyError, OSError):  # the system has no name for the user
        return "an unknown user"
