# SPDX-License-Identifier: LGPL-2.1-or-later
"""The action ``pmac stream``: run a program from the rotary buffer while it is sent.

Ctrl-C lets the machine continue to the next point of rest; a second Ctrl-C, the end of the terminal or a signal to this
process hold it on its path and end the program.
"""

from __future__ import annotations

import argparse
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import TYPE_CHECKING

from pkm_post.cli.pmac_stop import signals_interrupt

if TYPE_CHECKING:
    from pkm_post.cli.pmac_actions import JobTarget
    from pkm_post.control import Session

ROTARY_WORDS = 2600
"""Default size of the rotary buffer: 200 lines of 13 words."""


def stream(session: Session, target: JobTarget, namespace: argparse.Namespace) -> int:
    """Run the program from the rotary buffer."""
    from pkm_post.control import check_setup, stream

    check_setup(session, target.settings, target.machine.strut_stroke)
    job = target.job
    progress = _show_progress if sys.stderr.isatty() else _no_progress
    with signals_interrupt(), _interrupted_once() as is_cancelled:
        done = stream(
            session,
            target.settings,
            job.program,
            job.first,
            namespace.rotary,
            namespace.near,
            progress,
            is_cancelled,
            target.machine,
        )
    print(f"{done.lines} lines carried out in {done.segments} segments, SHA-256 {done.digest}")
    if done.resumptions:
        print(f"the link failed {done.resumptions} times, and the program was gone on with from a rest")
    return 0


def _show_progress(done: int, sent: int, lines: int) -> None:
    end = "\n" if done == lines else ""
    print(f"\r{done} of {lines} lines let go, {sent} sent", end=end, file=sys.stderr, flush=True)


def _no_progress(done: int, sent: int, lines: int) -> None:
    """Ignore progress where the output is not a terminal."""


@contextmanager
def _interrupted_once() -> Iterator[Callable[[], bool]]:
    """Yield whether the user has pressed Ctrl-C; the second time raises KeyboardInterrupt."""
    pressed: list[int] = []

    def press(number: int, frame: FrameType | None) -> None:
        if pressed:
            raise KeyboardInterrupt
        pressed.append(number)
        print("\nthe machine stops where it rests next; Ctrl-C again stops it now", file=sys.stderr, flush=True)

    before = signal.signal(signal.SIGINT, press)
    try:
        yield lambda: bool(pressed)
    finally:
        signal.signal(signal.SIGINT, before)
