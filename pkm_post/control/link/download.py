# SPDX-License-Identifier: LGPL-2.1-or-later
"""Download: load a program into the controller and verify its listing.

First the existing program of that number is deleted, which the controller must confirm. Then the lines are
sent, the buffer is closed, and the program is listed and compared. If the link fails in between, the controller's
listing decides: if it has complete lines from the first on, the download continues after them, else it starts
over. After any exception the number is empty, or the exception states that this could not be verified.

Input: a session and a program. Output: a record of the loaded program.
"""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import dataclass

from pkm_post.control.link.errors import CancelledError, DownloadError, LinkLostError, PmacError, TooLongError
from pkm_post.control.link.ownership import owned
from pkm_post.control.link.program import ListingComparison, PmacProgram, compare_listing
from pkm_post.control.link.program_memory import memory_of
from pkm_post.control.link.session import Session

ATTEMPTS = 5
"""Attempts of a download."""
CLEAR_S = 20.0
CLEAR_ROUNDS = 12
"""Seconds, and attempts, to clear a program number."""
_LINES_IN_VIEW = 200
_log = logging.getLogger(__name__)

Progress = Callable[[int, int], None]
"""Called with the number of lines in the controller and the total."""


@dataclass(frozen=True)
class DownloadResult:
    """A program whose listing matched the lines sent.

    Attributes:
        program: its number.
        lines: number of lines.
        digest: SHA-256 of its lines.
        resumptions: how often the download continued or restarted after a failure.
    """

    program: int
    lines: int
    digest: str
    resumptions: int


def verify_listing(session: Session, program: PmacProgram) -> ListingComparison:
    """Compare the controller's listing of a program with the program."""
    try:
        return compare_listing(program.lines, memory_of(session).listed(session, program))
    except TooLongError:
        return ListingComparison(0, False, False, "it is far longer")


def download(
    session: Session,
    program: PmacProgram,
    progress: Progress = lambda done, all_lines: None,
    is_cancelled: Callable[[], bool] = lambda: False,
) -> DownloadResult:
    """Load a program into the controller.

    Args:
        progress: called with the lines loaded and the total.
        is_cancelled: polled between lines.

    Raises:
        RefusedError: the buffer could not be opened, since a program runs or another buffer is open; nothing changed.
        DownloadError: it failed; states whether the number is empty.
        CancelledError: it was cancelled, and the number is empty.
        NotOwnerError: another client owns the machine; nothing changed.
    """
    with owned(session, "download"):
        return _download(session, program, progress, is_cancelled)


def _download(
    session: Session, program: PmacProgram, progress: Progress, is_cancelled: Callable[[], bool]
) -> DownloadResult:
    memory = memory_of(session)
    try:
        memory.open(session, program.number)
    except LinkLostError as lost:
        _log.warning("the link failed: %s", lost)
    try:
        clear(session, program.number)
        memory.check_room(session, program)
        resumptions = _fill(session, program, progress, is_cancelled)
    except (PmacError, KeyboardInterrupt) as fault:
        left = _clear_away(session, program.number)
        if isinstance(fault, CancelledError | KeyboardInterrupt) and left:
            raise CancelledError(f"the download was stopped; nothing is left under program {program.number}") from fault
        raise DownloadError(str(fault) or "the download was stopped", left) from fault
    except BaseException:
        _clear_away(session, program.number)
        raise
    _log.info("program %d: %d lines, SHA-256 %s, listed back", program.number, len(program.lines), program.digest)
    return DownloadResult(program.number, len(program.lines), program.digest, resumptions)


def clear(session: Session, number: int) -> None:
    """Delete the program of a number and verify that; retried when the link fails.

    Raises:
        PmacError: the controller refuses, or is unreachable.
    """
    until = session.now() + CLEAR_S
    for _ in range(CLEAR_ROUNDS):
        # Each attempt starts with a closed buffer and ends with a check, so a retry is safe.
        try:
            if _cleared(session, number):
                return
        except PmacError as failed:
            fault = failed
        else:
            fault = PmacError(f"program {number} is still there after CLEAR")
        if session.now() >= until:
            break
    raise fault


def _cleared(session: Session, number: int) -> bool:
    memory = memory_of(session)
    memory.open(session, number)
    memory.empty(session)
    memory.close(session)
    # Checked twice: a missing program shows as a refusal, which a corrupted byte causes as well.
    return memory.is_closed(session) and all(verify_listing(session, PmacProgram(number, ())).same for _ in range(2))


def _clear_away(session: Session, number: int) -> bool:
    try:
        clear(session, number)
    except PmacError as fault:
        _log.error("program %d could not be cleared: %s", number, fault)
        return False
    return True


def _fill(session: Session, program: PmacProgram, progress: Progress, is_cancelled: Callable[[], bool]) -> int:
    """Send the lines until the listing matches; return how often the link failed or the listing differed."""
    held, memory = 0, memory_of(session)
    for attempt in range(ATTEMPTS):
        try:
            _send(session, program, held, progress, is_cancelled)
        except LinkLostError as lost:
            _log.warning("the link failed: %s", lost)
        is_closed = memory.is_closed(session)
        there = verify_listing(session, program)  # queried last, to reveal a reset in between
        if there.same and is_closed:
            return attempt
        _log.warning("the listing differs, or the buffer is still open: %s", there.difference)
        held = there.lines if there.nothing_else and memory.can_append else 0
    raise PmacError(f"sent {ATTEMPTS} times and still not there; {there.difference}")


def _send(
    session: Session, program: PmacProgram, held: int, progress: Progress, is_cancelled: Callable[[], bool]
) -> None:
    """Send the lines after those that the controller has."""
    lines, memory = program.lines, memory_of(session)
    memory.open(session, program.number)
    if not held:
        memory.empty(session)
    while held < len(lines):
        if is_cancelled():
            raise CancelledError("the download was stopped")
        held += session.load(lines[held : held + _LINES_IN_VIEW])
        progress(held, len(lines))
    memory.close(session)
