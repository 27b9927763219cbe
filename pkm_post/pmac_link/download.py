# SPDX-License-Identifier: LGPL-2.1-or-later
"""Download: a program into the controller, proven by listing it back.

What stood under the number of the program goes first, and the controller has to show that it is gone. Then the lines
go in, the buffer is closed, and the program is listed and compared. When the link fails in between, the controller is
asked what it holds: if those are whole lines from the first on, it goes on behind them, else it begins anew. Whatever
ends in an exception leaves nothing under the number, or says that this could not be shown.

Enters: a session and a program. Leaves: what was loaded.
"""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import dataclass

from pkm_post.pmac_link.faults import CancelledError, DownloadError, LinkLostError, PmacError, RefusedError
from pkm_post.pmac_link.free_words import free_words
from pkm_post.pmac_link.listing import Comparison, Program, compare
from pkm_post.pmac_link.ownership import owned
from pkm_post.pmac_link.session import Session

ATTEMPTS = 5
"""How often a download is gone on with before it is given up."""
CLEAR_S = 20.0
CLEAR_ROUNDS = 12
"""Seconds, and rounds, in which a number has to be cleared."""
_NO_SUCH_PROGRAM = (3, 5, 15)
_LINES_IN_VIEW = 200
_log = logging.getLogger(__name__)

Progress = Callable[[int, int], None]
"""Called with the lines that are in the controller and with all of them."""


@dataclass(frozen=True)
class Loaded:
    """A program that the controller listed back as it was sent.

    Attributes:
        program: its number.
        lines: how many it has.
        digest: SHA-256 of its lines.
        resumptions: how often the link failed and the download went on or began anew.
    """

    program: int
    lines: int
    digest: str
    resumptions: int


def listing_of(session: Session, program: Program) -> Comparison:
    """What the controller holds under the number of a program, compared with it."""
    most = 3 * sum(map(len, program.lines)) + (1 << 16)
    try:
        listed = session.ask(f"LIST PROG {program.number}", most)
    except RefusedError as refused:
        if refused.number not in _NO_SUCH_PROGRAM:
            raise
        listed = ()
    return compare(program.lines, listed)


def download(
    session: Session,
    program: Program,
    progress: Progress = lambda done, all_lines: None,
    is_cancelled: Callable[[], bool] = lambda: False,
) -> Loaded:
    """Bring a program into the controller.

    Args:
        session: an open session.
        program: what to load.
        progress: is told how far it is.
        is_cancelled: asked between the lines.

    Raises:
        RefusedError: the buffer could not be opened, for a program runs or another buffer is open; nothing changed.
        DownloadError: it failed; says whether anything is left under the number.
        CancelledError: it was stopped, and nothing is left under the number.
        NotOwnerError: another client has the machine; nothing changed.
    """
    with owned(session, "download"):
        return _download(session, program, progress, is_cancelled)


def _download(session: Session, program: Program, progress: Progress, is_cancelled: Callable[[], bool]) -> Loaded:
    try:
        _open(session, program.number)
    except LinkLostError as lost:
        _log.warning("the link failed: %s", lost)
    try:
        clear(session, program.number)
        _check_room(session, program)
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
    return Loaded(program.number, len(program.lines), program.digest, resumptions)


def clear(session: Session, number: int) -> None:
    """Leave nothing under a number, and see that it is so; tried again when the link fails.

    Raises:
        PmacError: the controller does not do it, or cannot be asked.
    """
    until = session.now() + CLEAR_S
    for _ in range(CLEAR_ROUNDS):
        # Each round begins with a closed buffer and ends by looking: doing it again is not guessing.
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
    _open(session, number)
    session.order("CLEAR")
    session.order("CLOSE")
    # Looked at twice: a program that is not there is told by a refusal, which a changed byte brings about as well.
    return free_words(session) >= 0 and all(listing_of(session, Program(number, ())).same for _ in range(2))


def _open(session: Session, number: int) -> None:
    for line in ("CLOSE", "DELETE GATHER", f"OPEN PROG {number}"):
        session.order(line)


def _clear_away(session: Session, number: int) -> bool:
    try:
        clear(session, number)
    except PmacError as fault:
        _log.error("program %d could not be cleared: %s", number, fault)
        return False
    return True


def _check_room(session: Session, program: Program) -> None:
    """Compare the program with the memory that is free when nothing is under its number.

    Raises:
        PmacError: it is too large.
    """
    free = free_words(session)
    if free < program.words:
        raise PmacError(f"the program takes about {program.words} words, the controller has {free}")


def _fill(session: Session, program: Program, progress: Progress, is_cancelled: Callable[[], bool]) -> int:
    """Send the lines until the listing is the program; how often the link failed or the listing differed."""
    held = 0
    for attempt in range(ATTEMPTS):
        try:
            _send(session, program, held, progress, is_cancelled)
        except LinkLostError as lost:
            _log.warning("the link failed: %s", lost)
        is_closed = free_words(session) >= 0
        there = listing_of(session, program)  # the last thing that is asked: a reset in between shows in it
        if there.same and is_closed:
            return attempt
        _log.warning("the listing differs, or the buffer is still open: %s", there.difference)
        held = there.lines if there.nothing_else else 0
    raise PmacError(f"sent {ATTEMPTS} times and still not there; {there.difference}")


def _send(session: Session, program: Program, held: int, progress: Progress, is_cancelled: Callable[[], bool]) -> None:
    """Send the lines behind those that the controller holds."""
    lines = program.lines
    _open(session, program.number)
    if not held:
        session.order("CLEAR")
    while held < len(lines):
        if is_cancelled():
            raise CancelledError("the download was stopped")
        held += session.load(lines[held : held + _LINES_IN_VIEW])
        progress(held, len(lines))
    session.order("CLOSE")
