# SPDX-License-Identifier: LGPL-2.1-or-later
"""PMAC stops: the actions hold and abort, and the hold when a command that moves the machine ends.

A stop is retried until the machine is at rest. After two seconds, a separate timer prints instructions: a
blocking link must not delay them. Ctrl-C ends the retries, a closed terminal does not.
"""

from __future__ import annotations

import argparse
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from types import FrameType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pkm_post.control.link import PmacJob, PmacProgram, Session, Status
    from pkm_post.model import Machine
    from pkm_post.writing import PmacSettings

Actions = dict[str, tuple[Callable[..., int], str, tuple[str, ...]]]
"""For each action its function, its description, and the inputs it needs: a named machine or program."""

_SIGNALS = ("SIGINT", "SIGTERM", "SIGHUP", "SIGBREAK")
"""Ctrl-C, termination of the process, of its terminal, and of its console on Windows; systems define some of them."""


@dataclass(frozen=True)
class Target:
    """The named machine."""

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
    """The named machine and a program for it."""

    job: PmacJob


def hold(session: Session, target: Target, namespace: argparse.Namespace) -> int:
    """Decelerate the program to rest on its path."""
    from pkm_post.control.link import hold

    with _handled(_SIGNALS[1:], signal.SIG_IGN), advised():
        status = hold(session, target.settings)
    return print_state(status)


def abort(session: Session, target: Target, namespace: argparse.Namespace) -> int:
    """Abort the program."""
    from pkm_post.control.link import abort

    with _handled(_SIGNALS[1:], signal.SIG_IGN), advised():
        status = abort(session, target.settings, namespace.at_once)
    return print_state(status)


def print_state(status: Status) -> int:
    """Print a state; return exit code 0."""
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
def held_at_the_end(session: Session, settings: PmacSettings, advice: str = "") -> Iterator[None]:
    """Hold the machine when the command that moves it ends: by Ctrl-C, a signal, a closed terminal, or a fault.

    A fault of the link or of the controller propagates unchanged: it has its own instructions. ``advice`` follows the
    message of an interrupt.

    Raises:
        CancelledError: it was interrupted; the machine is held, or no program ran.
    """
    from pkm_post.control.link import CancelledError, PmacError

    with signals_interrupt() as begin_stop:
        try:
            yield
        except PmacError:
            raise
        except BaseException as fault:
            begin_stop()
            is_held = _hold_machine(session, settings)
            if isinstance(fault, KeyboardInterrupt):
                state = "held: resume or abort it" if is_held else "at rest: no program runs"
                raise CancelledError(f"interrupted and {state}{advice}") from None
            raise


def _hold_machine(session: Session, settings: PmacSettings) -> bool:
    """Whether a program is held then; none need run."""
    from pkm_post.control.link import hold

    with advised():
        return hold(session, settings).held


@contextmanager
def signals_interrupt() -> Iterator[Callable[[], None]]:
    """Turn the first signal inside into a KeyboardInterrupt, after which the machine is stopped.

    Later signals do not end that stop: not a terminal that closes, and Ctrl-C only after the advice of ``advised``,
    since a hasty operator presses it twice. Yields a function to call when a stop begins without a signal.
    """
    from pkm_post.control.link import REST_DEADLINE_S

    begun: list[float] = []

    def begin() -> None:
        begun.append(time.monotonic())

    def interrupt(number: int, frame: FrameType | None) -> None:
        is_advised = bool(begun) and time.monotonic() >= begun[0] + REST_DEADLINE_S
        if not begun or (number == signal.SIGINT and is_advised):
            begin()
            raise KeyboardInterrupt

    with _handled(_SIGNALS, interrupt):
        yield begin


@contextmanager
def _handled(
    names: Sequence[str], handler: Callable[[int, FrameType | None], None] | signal.Handlers
) -> Iterator[None]:
    """Handle those of these signals that the system has; they come to the main thread alone."""
    known = [getattr(signal, name) for name in names if hasattr(signal, name)]
    in_main = threading.current_thread() is threading.main_thread()
    before = {number: signal.signal(number, handler) for number in known if in_main}
    try:
        yield
    finally:
        for number, former in before.items():
            signal.signal(number, former)
