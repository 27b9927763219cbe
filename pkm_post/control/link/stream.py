# SPDX-License-Identifier: LGPL-2.1-or-later
"""Stream: run a program that exceeds the controller's memory from its rotary buffer while it is being sent.

The program is sent in segments that end with STOP at rest (``gates``). R releases a segment once it is completely in
the buffer and the previous one has ended; while it runs, the next one is sent. So a cut link ends at rest without any
help. When the link is back, the stream waits until the controller rests and queries how many lines lie ahead: that
number shows which of the last lines arrived. If it is inconsistent, or the machine is not where the segment ends, the
stream does not continue.

Enters: a session, settings, a program, the size of the rotary buffer. Leaves: a record of what was executed.
"""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import dataclass

from pkm_post.control.link.faults import CancelledError, PmacError, StreamError
from pkm_post.control.link.gates import segments_of
from pkm_post.control.link.listing import Program
from pkm_post.control.link.motion import settled_status
from pkm_post.control.link.ownership import owned
from pkm_post.control.link.ready import check_start
from pkm_post.control.link.rotary import Progress, RotaryStream
from pkm_post.control.link.session import Session
from pkm_post.control.link.status import Array
from pkm_post.model import Machine
from pkm_post.options import START_TOLERANCE_MM
from pkm_post.writing import PmacSettings

_log = logging.getLogger(__name__)


@dataclass(frozen=True)
class Streamed:
    """A program that was executed to its end.

    Attributes:
        lines: of the program.
        digest: SHA-256 of its lines.
        segments: number of segments.
        resumptions: how often the link failed and the stream continued.
    """

    lines: int
    digest: str
    segments: int
    resumptions: int


def stream(
    session: Session,
    settings: PmacSettings,
    program: Program,
    first: Array,
    words: int,
    near: float = START_TOLERANCE_MM,
    progress: Progress = lambda done, sent, all_lines: None,
    is_cancelled: Callable[[], bool] = lambda: False,
    machine: Machine | None = None,
) -> Streamed:
    """Run a program from the rotary buffer.

    Args:
        session: an open session.
        settings: of the machine's controller.
        program: what to run.
        first: (6,) strut lengths of its first point, mm.
        words: size of the rotary buffer, as defined.
        near: largest distance of each strut from the first point, and from each rest it continues from, mm.
        progress: called with the lines released, loaded, and in total.
        is_cancelled: polled; the machine then rests at the end of the running segment.
        machine: its geometry, to compare the tool pose with the first point as well.

    Raises:
        NotReadyError: the program cannot be streamed, or the machine is not ready; nothing was sent.
        StreamError: it failed; states where the machine rests and whether anything is left in the buffer.
        CancelledError: it was cancelled; the machine rests and nothing is left in the buffer.
        NotOwnerError: another client owns the machine; nothing was sent.
    """
    streaming = RotaryStream(session, settings, segments_of(program, settings, words), words, near)
    streaming.rest = first
    with owned(session, "stream"):
        check_start(settled_status(session, settings), first, near, machine)
        return _streamed(session, streaming, program, progress, is_cancelled)


def _streamed(
    session: Session, streaming: RotaryStream, program: Program, progress: Progress, is_cancelled: Callable[[], bool]
) -> Streamed:
    try:
        streaming.open()
        streaming.run(progress, is_cancelled)
    except (PmacError, KeyboardInterrupt) as fault:
        raise _ended(streaming, fault) from fault
    except BaseException:
        streaming.end(at_once=False)
        raise
    if not streaming.end(at_once=False):
        raise StreamError("the program was carried out, but its buffer could not be closed", streaming.line, False)
    _log.info("%d lines in %d segments, SHA-256 %s", len(program.lines), len(streaming.segments), program.digest)
    return Streamed(len(program.lines), program.digest, len(streaming.segments), streaming.resumptions)


def _ended(streaming: RotaryStream, fault: PmacError | KeyboardInterrupt) -> PmacError:
    """End an incomplete stream; return the exception that describes how it was left."""
    is_empty = streaming.end(at_once=isinstance(fault, KeyboardInterrupt))
    if isinstance(fault, CancelledError | KeyboardInterrupt) and is_empty:
        return CancelledError("the stream was stopped; the machine rests, the rotary buffer is empty")
    return StreamError(str(fault) or "the stream was stopped", streaming.line, is_empty)
