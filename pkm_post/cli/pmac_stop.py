# SPDX-License-Identifier: LGPL-2.1-or-later
"""PMAC stops: the actions hold and abort, and the hold when a command that moves the machine ends.

A stop is retried until the machine is at rest. After two seconds, a separate timer prints instructions: a
blocking link must not delay them. Ctrl-C ends the retries.
"""

from __future__ import annotations

import argparse
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from types import FrameType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pkm_post.control.link import PmacJob, PmacProgram, Session, Status
    from pkm_post.model import Machine
    from pkm_post.writing import PmacSettings

_SIGNALS = ("SIGTERM", "SIGHUP", "SIGBREAK")
"""Termination of the process, of its terminal, and of its console on Windows; systems define some of them."""


@dataclass(frozen=True)
class Target:
    """The named machine.

    Attributes:
        machine: the machine.
        settings: of its controller.
    """

    machine: Machine
    settings: PmacSettings


@dataclass(frozen=True)
class ProgramTarget(Target):
    """The named machine and the lines of a program for it, of strut lengths or of tip and axis.

    Attributes:
        program: its lines.
        is_of_struts: whether it needs the set-up of strut lengths.
    """

    program: PmacProgram
    is_of_struts: bool


@dataclass(frozen=True)
class JobTarget(Target):
    """The named machine and a program for it.

    Attributes:
        job: the program file.
    """

    job: PmacJob


def hold(session: Session, target: Target, namespace: argparse.Namespace) -> int:
    """Decelerate the program to rest on its path."""
    from pkm_post.control.link import hold

    with advised():
        status = hold(session, target.settings)
    return _print(session, status)


def abort(session: Session, target: Target, namespace: argparse.Namespace) -> int:
    """Abort the program."""
    from pkm_post.control.link import abort

    with advised():
        status = abort(session, target.settings, namespace.at_once)
    return _print(session, status)


def _print(session: Session, status: Status) -> int:
    from pkm_post.control.link import state_text

    print(state_text(status))
    return 0


@contextmanager
def advised() -> Iterator[None]:
    """Print advice for the operator if the stop inside has not ended in time."""
    from pkm_post.control.link import REST_DEADLINE_S

    timer = threading.Timer(REST_DEADLINE_S, _advise)
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()


def _advise() -> None:
    from pkm_post.control.link import NOT_AT_REST

    print(*NOT_AT_REST, sep="\n", file=sys.stderr, flush=True)


@contextmanager
def held_at_the_end(session: Session, settings: PmacSettings) -> Iterator[None]:
    """Hold the machine when the command that moves it ends: by Ctrl-C, a signal, a closed terminal, or a fault.

    A fault of the link or of the controller propagates unchanged: it has its own instructions.

    Raises:
        CancelledError: it was interrupted; the machine is held.
    """
    from pkm_post.control.link import CancelledError, PmacError

    with signals_interrupt():
        try:
            yield
        except PmacError:
            raise
        except BaseException as fault:
            _hold_machine(session, settings)
            if isinstance(fault, KeyboardInterrupt):
                raise CancelledError("interrupted and held: resume or abort it") from None
            raise


def _hold_machine(session: Session, settings: PmacSettings) -> None:
    from pkm_post.control.link import hold

    with advised():
        hold(session, settings)


@contextmanager
def signals_interrupt() -> Iterator[None]:
    """Turn termination signals into one KeyboardInterrupt inside; a second signal does not end the hold."""
    ended: list[int] = []

    def end(number: int, frame: FrameType | None) -> None:
        if not ended:
            ended.append(number)
            raise KeyboardInterrupt

    known = [getattr(signal, name) for name in _SIGNALS if hasattr(signal, name)]
    before = {number: signal.signal(number, end) for number in known}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
