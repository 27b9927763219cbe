# SPDX-License-Identifier: LGPL-2.1-or-later
"""Session: a controller that answers. Queries are retried, sets are not.

Enters: the text of commands. Leaves: the lines of the answers, or an exception: ``RefusedError`` with the controller's
number, ``OutcomeUnknownError`` for a set that may or may not have been executed, ``LinkLostError``, and
``CancelledError`` when something more urgent waits.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from types import TracebackType
from typing import Protocol, Self

from pkm_post.control.link.channel import CommandChannel, OpenBufferPolicy, establish_handshake
from pkm_post.control.link.errors import CancelledError, LinkLostError, OutcomeUnknownError, RefusedError
from pkm_post.control.link.ports import PortInterface
from pkm_post.control.link.protocol import Answer, Command, CommandKind, Lost, Refusal

__all__ = ["OpenBufferPolicy", "Session"]

ATTEMPTS = 5
"""How often a query is sent."""
CALLS = 3
"""How many reconnects are tried in a row."""
HURRY_S = 0.4
"""Longest silence while a stop is sent, which is retried soon."""


class Keeper(Protocol):
    """Holds ownership of the machine; the session calls it (``ownership``)."""

    def answered(self) -> None:
        """A query was answered."""

    def check(self) -> None:
        """Called before a set or a load.

        Raises:
            PmacError: ownership is lost.
        """

    def is_sure(self) -> bool:
        """Whether ownership was seen so recently that no other client can have taken it since."""

    def release(self) -> None:
        """Release ownership."""


class Session:
    """A controller that answers.

    Attributes:
        connections: how often it has connected; a reconnect closes the owner's program buffer.
        keeper: holds ownership of the machine; None without it.
        has_open_buffer: whether lines may go into a program buffer opened by this session.
    """

    def __init__(
        self,
        port: PortInterface,
        patience: float = 2.0,
        pause: float = 0.5,
        leftover: OpenBufferPolicy = OpenBufferPolicy.LEAVE,
        clock: Callable[[], float] = time.monotonic,
        sleep: Callable[[float], None] = time.sleep,
    ) -> None:
        """Create a session; ``open`` connects.

        Args:
            port: of the controller.
            patience: seconds without a byte before an answer is given up.
            pause: seconds before a reconnect, longer each time.
            leftover: what to do with a program buffer that is open when connecting without ownership.
            clock: monotonic clock, s.
            sleep: waits that many seconds of the clock.
        """
        self._patience, self._pause, self._leftover = patience, pause, leftover
        self._clock, self._sleep = clock, sleep
        self._dialogue = CommandChannel(port, patience, clock)
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
        """Unsolicited messages from programs in the controller."""
        return self._dialogue.messages

    def open(self) -> None:
        """Connect and establish the handshake.

        Raises:
            LinkLostError: no controller answers.
        """
        self._call()

    def close(self) -> None:
        """Disconnect, and release ownership of the machine."""
        if self.keeper is not None:
            self.keeper.release()
        self._dialogue.close()
        self._in_step = False

    @property
    def has_handshake(self) -> bool:
        """Whether it is a Turbo PMAC, whose answers need a handshake."""
        return bool(self._dialogue.handshake)

    def now(self) -> float:
        """Current time of the session's clock, s."""
        return self._clock()

    def sleep(self, seconds: float) -> None:
        """Wait for this many seconds of the session's clock."""
        self._sleep(seconds)

    def give_way_when(self, is_waited_for: Callable[[], bool]) -> None:
        """Abandon long operations, and start no motion, while ``is_waited_for`` is true."""
        self._dialogue.gives_way = is_waited_for

    def is_waited_for(self) -> bool:
        """Whether something more urgent waits."""
        return self._dialogue.gives_way()

    def give_way(self) -> None:
        """Check that nothing more urgent waits.

        Raises:
            CancelledError: something does.
        """
        if self.is_waited_for():
            raise CancelledError("not carried out, or not to its end: a stop came first")

    def ask(self, text: str, most: int = 1 << 16) -> tuple[str, ...]:
        """Send a query; return the lines of its answer.

        Args:
            text: the query; it must not change anything, as it may be sent several times.
            most: maximum bytes of the answer.

        Raises:
            RefusedError: the controller refuses it.
            LinkLostError: no answer to ``ATTEMPTS`` attempts.
            CancelledError: it takes long, and something more urgent waits.
        """
        told = self._asked(Command(text, CommandKind.QUERY, self._patience, most))
        if self.keeper is not None and not self._in_a_hurry:
            self.keeper.answered()
        return told

    def order(self, text: str) -> tuple[str, ...]:
        """Execute a command, sent once; return its answer.

        Raises:
            RefusedError: the controller refused it.
            OutcomeUnknownError: it may or may not have been executed.
            LinkLostError: it certainly was not executed.
            PmacError: ownership is lost; it was not sent. A stop needs no ownership.
        """
        self._check()
        self.has_open_buffer |= text.startswith("OPEN")
        said = self._exchange(Command(text, CommandKind.SET, self._patience))
        self.has_open_buffer &= text != "CLOSE"
        return said

    @contextmanager
    def in_a_hurry(self) -> Iterator[None]:
        """No retries, one reconnect and a timeout of ``HURRY_S``, for a stop that is retried by its caller."""
        before = self._patience, self._attempts, self._calls, self._in_a_hurry
        self._patience, self._attempts, self._calls, self._in_a_hurry = min(self._patience, HURRY_S), 1, 1, True
        self._dialogue.patience = self._patience
        try:
            yield
        finally:
            self._patience, self._attempts, self._calls, self._in_a_hurry = before
            self._dialogue.patience = self._patience

    def interrupt(self, control: int) -> None:
        """Send a control character, which the controller obeys in any state; it is not acknowledged.

        Args:
            control: its code.

        Raises:
            LinkLostError: it could not be sent, or later answers make no sense.
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
        """Put lines into the open program buffer, as many as one exchange takes; return their number.

        Args:
            lines: at least one.

        Raises:
            RefusedError: a line was refused.
            OutcomeUnknownError: they may or may not be in the buffer.
            LinkLostError: they are certainly not in the buffer.
        """
        count = self.lines_at_once(lines)
        if not count:
            raise ValueError(f"lines: expected lines that fit into one exchange, got {lines[:1]}")
        self._check()
        self._exchange(Command("\n".join(lines[:count]), CommandKind.BUFFER, self._patience))
        return count

    def lines_at_once(self, lines: Sequence[str]) -> int:
        """How many of these lines ``load`` sends in one exchange."""
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
        self._in_step = False  # until the outcome is known: an interrupt may come at any time
        try:
            ended = self._dialogue.run(command)
        except LinkLostError as lost:
            ended = Lost(str(lost))
        self._in_step = not isinstance(ended, Lost)
        if isinstance(ended, Answer):
            return ended.lines
        if isinstance(ended, Refusal):
            raise RefusedError(command.text.split("\n")[ended.line], ended.number, ended.words)
        if command.kind is CommandKind.QUERY or ended.untouched:
            raise LinkLostError(f"{command.text[:60]!r}: {ended.why}")
        raise OutcomeUnknownError(command.text[:60], ended.why)

    def _call(self) -> None:
        """Connect, with retries."""
        is_own = self.keeper is not None and self.keeper.is_sure()
        leftover = OpenBufferPolicy.CLOSE if is_own else self._leftover
        for attempt in range(self._calls):
            if attempt:
                self.give_way()
                self._sleep(self._pause * attempt)
            try:
                establish_handshake(self._dialogue, leftover)
            except (LinkLostError, RefusedError) as fault:
                if attempt == self._calls - 1:
                    raise LinkLostError(f"no controller that can be understood: {fault}") from fault
            else:
                self._in_step = True
                self.has_open_buffer &= leftover is not OpenBufferPolicy.CLOSE
                self.connections += 1
                return


def free_memory(session: Session) -> int:
    """Words of free memory; negative while a buffer is open.

    Raises:
        LinkLostError: the answer makes no sense.
    """
    (told,) = session.ask("SIZE")[:1] or ("",)
    try:
        return int(told)
    except ValueError:
        raise LinkLostError(f"SIZE: expected a number of words, got {told!r}") from None
