# SPDX-License-Identifier: LGPL-2.1-or-later
"""Session: a controller that answers. Queries are asked again, sets are not.

Enters: the text of commands. Leaves: the lines of the answers, or an exception: ``RefusedError`` with the controller's
number, ``OutcomeUnknownError`` for a set that may or may not have been carried out, ``LinkLostError``, and
``CancelledError`` when something more urgent waits.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from types import TracebackType
from typing import Protocol, Self

from pkm_post.pmac_link.dialogue import Dialogue
from pkm_post.pmac_link.exchange import Answer, Command, Kind, Lost, Refusal
from pkm_post.pmac_link.faults import CancelledError, LinkLostError, OutcomeUnknownError, RefusedError
from pkm_post.pmac_link.greeting import Leftover, greet
from pkm_post.pmac_link.ports import Door

__all__ = ["Leftover", "Session"]

ATTEMPTS = 5
"""How often a query is asked."""
CALLS = 3
"""How often a lost link is called back at once."""
HURRY_S = 0.4
"""Longest silence while a stop is sent: it tries again by itself, and soon."""


class Keeper(Protocol):
    """Who keeps the right to move the machine, and is called while the session does so (``ownership``)."""

    def answered(self) -> None:
        """A query was answered."""

    def check(self) -> None:
        """Something is about to be set, or loaded.

        Raises:
            PmacError: the right is gone.
        """

    def is_sure(self) -> bool:
        """Whether the right was seen so lately that nobody can have taken it since."""

    def release(self) -> None:
        """Give the right back."""


class Session:
    """A controller that answers.

    Attributes:
        connections: how often it has connected; the owner's program buffer that was open before is closed since.
        keeper: who keeps the right to move the machine; None while this session has not got it.
        has_open_buffer: whether lines that are sent may go into a program buffer that was opened here.
    """

    def __init__(
        self,
        port: Door,
        patience: float = 2.0,
        pause: float = 0.5,
        leftover: Leftover = Leftover.LEAVE,
        clock: Callable[[], float] = time.monotonic,
        sleep: Callable[[float], None] = time.sleep,
    ) -> None:
        """Make a session; ``open`` connects.

        Args:
            port: where the controller is.
            patience: seconds without a byte until an answer is given up.
            pause: seconds before a lost link is called back, longer each time.
            leftover: what becomes of a program buffer that ``open`` finds open while this session is not the owner.
            clock: seconds of a clock that only grows.
            sleep: waits so many seconds of it.
        """
        self._patience, self._pause, self._leftover = patience, pause, leftover
        self._clock, self._sleep = clock, sleep
        self._dialogue = Dialogue(port, patience, clock)
        self._in_step, self._in_a_hurry = False, False
        self._attempts, self._calls = ATTEMPTS, CALLS
        self.port_name = port.name
        self.keeper: Keeper | None = None
        self.has_open_buffer = False
        self.connections = 0

    def __enter__(self) -> Self:
        self.open()
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None, at: TracebackType | None) -> None:
        self.close()

    @property
    def messages(self) -> list[str]:
        """What programs in the controller sent of their own accord."""
        return self._dialogue.messages

    def open(self) -> None:
        """Connect and agree on the handshake.

        Raises:
            LinkLostError: no controller answers.
        """
        self._call()

    def close(self) -> None:
        """Disconnect, and give back the right to move the machine."""
        if self.keeper is not None:
            self.keeper.release()
        self._dialogue.close()
        self._in_step = False

    @property
    def has_handshake(self) -> bool:
        """Whether it is a Turbo PMAC, of which a handshake is agreed."""
        return bool(self._dialogue.handshake)

    def now(self) -> float:
        """Seconds of the clock of this session."""
        return self._clock()

    def sleep(self, seconds: float) -> None:
        """Let so many seconds of that clock pass."""
        self._sleep(seconds)

    def give_way_when(self, is_waited_for: Callable[[], bool]) -> None:
        """From now on leave what takes long, and begin nothing that moves, while ``is_waited_for`` is true."""
        self._dialogue.gives_way = is_waited_for

    def is_waited_for(self) -> bool:
        """Whether something more urgent waits."""
        return self._dialogue.gives_way()

    def give_way(self) -> None:
        """Go on only when nothing more urgent waits.

        Raises:
            CancelledError: something does.
        """
        if self.is_waited_for():
            raise CancelledError("not carried out, or not to its end: a stop came first")

    def ask(self, text: str, most: int = 1 << 16) -> tuple[str, ...]:
        """The lines of the answer to a query.

        Args:
            text: the query; it changes nothing, for it may be sent several times.
            most: bytes of the answer that are taken.

        Raises:
            RefusedError: the controller does not answer it.
            LinkLostError: it was asked ``ATTEMPTS`` times and got no answer.
            CancelledError: it takes long, and something more urgent waits.
        """
        told = self._asked(Command(text, Kind.QUERY, self._patience, most))
        if self.keeper is not None and not self._in_a_hurry:
            self.keeper.answered()
        return told

    def order(self, text: str) -> tuple[str, ...]:
        """Have a command carried out, once; what it says.

        Raises:
            RefusedError: the controller refused it.
            OutcomeUnknownError: it may or may not have been carried out.
            LinkLostError: it surely was not.
            PmacError: the right to move the machine is gone; it was not sent. A stop needs no right.
        """
        self._check()
        self.has_open_buffer |= text.startswith("OPEN")
        said = self._exchange(Command(text, Kind.SET, self._patience))
        self.has_open_buffer &= text != "CLOSE"
        return said

    @contextmanager
    def in_a_hurry(self) -> Iterator[None]:
        """Ask once, call once and wait ``HURRY_S`` at most, for a stop that tries again by itself."""
        before = self._patience, self._attempts, self._calls, self._in_a_hurry
        self._patience, self._attempts, self._calls, self._in_a_hurry = min(self._patience, HURRY_S), 1, 1, True
        self._dialogue.patience = self._patience
        try:
            yield
        finally:
            self._patience, self._attempts, self._calls, self._in_a_hurry = before
            self._dialogue.patience = self._patience

    def interrupt(self, control: int) -> None:
        """Send a control character, which the controller obeys whatever it is doing; no answer says that it has.

        Args:
            control: its code.

        Raises:
            LinkLostError: it could not be sent, or the controller is not understood after it.
        """
        if not self._in_step:
            self._dialogue.restart(control)
            return
        self._in_step = False
        ended = self._dialogue.run(None, control)
        if isinstance(ended, Lost):
            raise LinkLostError(ended.why)
        self._in_step = True

    def load(self, lines: Sequence[str]) -> int:
        """Put some lines into the open program buffer: as many as one exchange takes; their number.

        Args:
            lines: at least one.

        Raises:
            RefusedError: a line was refused.
            OutcomeUnknownError: they may or may not be in the buffer.
            LinkLostError: they are not.
        """
        count = self.lines_at_once(lines)
        if not count:
            raise ValueError(f"lines: expected lines that fit into one exchange, got {lines[:1]}")
        self._check()
        self._exchange(Command("\n".join(lines[:count]), Kind.BUFFER, self._patience))
        return count

    def lines_at_once(self, lines: Sequence[str]) -> int:
        """How many of these lines ``load`` puts into the buffer in one exchange."""
        return self._dialogue.lines_at_once(lines)

    def _check(self) -> None:
        if self.keeper is not None and not self._in_a_hurry:
            self.keeper.check()

    def _asked(self, command: Command) -> tuple[str, ...]:
        for _ in range(self._attempts - 1):
            try:
                return self._exchange(command)
            except LinkLostError:
                self.give_way()
        return self._exchange(command)

    def _exchange(self, command: Command) -> tuple[str, ...]:
        if not self._in_step:
            self._call()
        self._in_step = False  # until the end is known: an interrupt may come at any time
        try:
            ended = self._dialogue.run(command)
        except LinkLostError as lost:
            ended = Lost(str(lost))
        self._in_step = not isinstance(ended, Lost)
        if isinstance(ended, Answer):
            return ended.lines
        if isinstance(ended, Refusal):
            raise RefusedError(command.text.split("\n")[ended.line], ended.number, ended.words)
        if command.kind is Kind.QUERY or ended.untouched:
            raise LinkLostError(f"{command.text[:60]!r}: {ended.why}")
        raise OutcomeUnknownError(command.text[:60], ended.why)

    def _call(self) -> None:
        """Connect, several times if need be."""
        is_own = self.keeper is not None and self.keeper.is_sure()
        leftover = Leftover.CLOSE if is_own else self._leftover
        for attempt in range(self._calls):
            if attempt:
                self.give_way()
                self._sleep(self._pause * attempt)
            try:
                greet(self._dialogue, leftover)
            except (LinkLostError, RefusedError) as fault:
                if attempt == self._calls - 1:
                    raise LinkLostError(f"no controller that can be understood: {fault}") from fault
            else:
                self._in_step = True
                self.has_open_buffer &= leftover is not Leftover.CLOSE
                self.connections += 1
                return
