# SPDX-License-Identifier: LGPL-2.1-or-later
"""Session: a reliable dialogue with a controller. Queries are retried, sets are not.

Input: the text of commands. Output: the lines of the answers, or an exception: ``RefusedError`` with the controller's
number, ``OutcomeUnknownError`` for a set that may or may not have been executed, ``LinkLostError``, and
``CancelledError`` when something more urgent waits.
"""

from __future__ import annotations

import re
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from types import TracebackType
from typing import Protocol, Self

from pkm_post.control.link.channel import CommandChannel, OpenBufferPolicy, establish_handshake
from pkm_post.control.link.errors import (
    CancelledError,
    LinkLostError,
    NoControllerError,
    OutcomeUnknownError,
    RefusedError,
    TooLongError,
)
from pkm_post.control.link.ports import PortInterface
from pkm_post.control.link.protocol import Answer, CommandKind, ControllerCommand, Lost, Refusal
from pkm_post.model import Diagnostic, Place

QUERY_ATTEMPTS = 5
"""Attempts of a query."""
CONNECT_ATTEMPTS = 3
"""Consecutive attempts to reconnect."""
SHORT_TIMEOUT_S = 0.4
"""Timeout while a stop is sent, which is soon retried."""


class OwnershipKeeper(Protocol):
    """Keeps ownership of the machine; called by the session (``ownership``)."""

    def answered(self) -> None:
        """A query was answered."""

    def check(self) -> None:
        """Called before a set or a load.

        Raises:
            PmacError: ownership is lost.
        """

    def is_certain(self) -> bool:
        """Whether ownership was verified so recently that no other client can have taken it since."""

    def release(self) -> None:
        """Release ownership."""


class Session:
    """A dialogue with a controller.

    Attributes:
        connections: number of connects; a reconnect closes the owner's program buffer.
        keeper: keeps ownership of the machine; None without ownership.
        has_open_buffer: whether lines may go into a program buffer opened by this session.
    """

    def __init__(
        self,
        port: PortInterface,
        answer_timeout: float = 2.0,
        pause: float = 0.5,
        open_buffer: OpenBufferPolicy = OpenBufferPolicy.LEAVE,
        clock: Callable[[], float] = time.monotonic,
        sleep: Callable[[float], None] = time.sleep,
    ) -> None:
        """Create a session; ``open`` connects.

        Args:
            port: of the controller.
            answer_timeout: timeout of an answer: seconds without a byte.
            pause: seconds before a reconnect, longer each time.
            open_buffer: treatment of a program buffer that is open when connecting without ownership.
            clock: monotonic clock, s.
            sleep: waits for seconds of the clock.
        """
        self._answer_timeout, self._pause, self._open_buffer = answer_timeout, pause, open_buffer
        self._clock, self._sleep = clock, sleep
        self._channel = CommandChannel(port, answer_timeout, clock)
        self._is_synchronized, self._is_short = False, False
        self._query_attempts, self._connect_attempts = QUERY_ATTEMPTS, CONNECT_ATTEMPTS
        self.port_name = port.name
        self.keeper: OwnershipKeeper | None = None
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
        return self._channel.messages

    def open(self) -> None:
        """Connect and establish the handshake.

        Raises:
            NoControllerError: no controller answers.
        """
        self._connect()

    def close(self) -> None:
        """Disconnect, and release ownership of the machine."""
        if self.keeper is not None:
            self.keeper.release()
        self._channel.close()
        self._is_synchronized = False

    @property
    def has_handshake(self) -> bool:
        """Whether it is a Turbo PMAC, whose answers need a handshake."""
        return bool(self._channel.handshake)

    def now(self) -> float:
        """Current time of the session's clock, s."""
        return self._clock()

    def sleep(self, seconds: float) -> None:
        """Wait for this many seconds of the session's clock."""
        self._sleep(seconds)

    def preempt_when(self, stop_pending: Callable[[], bool]) -> None:
        """Abandon long operations, and start no motion, while ``stop_pending()`` is true."""
        self._channel.is_preempted = stop_pending

    def stop_pending(self) -> bool:
        """Whether a stop is waiting to be sent."""
        return self._channel.is_preempted()

    def check_preemption(self) -> None:
        """Check that no stop is waiting to be sent.

        Raises:
            CancelledError: a stop is waiting.
        """
        if self.stop_pending():
            raise CancelledError("not executed, or not completed: a stop came first")

    def query(self, text: str, most: int = 1 << 16) -> tuple[str, ...]:
        """Send a query; return the lines of its answer.

        Args:
            text: the query; it must not change anything, as it may be sent several times.
            most: maximum bytes of the answer.

        Raises:
            RefusedError: the controller refuses it.
            LinkLostError: no answer to ``QUERY_ATTEMPTS`` attempts, or one of more bytes (``TooLongError``).
            CancelledError: something more urgent preempts a long query.
        """
        answer = self._query_with_retries(ControllerCommand(text, CommandKind.QUERY, self._answer_timeout, most))
        if self.keeper is not None and not self._is_short:
            self.keeper.answered()
        return answer

    def command(self, text: str) -> tuple[str, ...]:
        """Send a command once; return its answer.

        Raises:
            RefusedError: the controller refused it.
            OutcomeUnknownError: it may or may not have been executed.
            LinkLostError: it certainly was not executed.
            PmacError: ownership is lost; it was not sent. A stop needs no ownership.
        """
        self._check()
        before, self.has_open_buffer = self.has_open_buffer, self.has_open_buffer | text.upper().startswith("OPEN")
        try:
            answer = self._exchange(ControllerCommand(text, CommandKind.SET, self._answer_timeout))
        except RefusedError:
            self.has_open_buffer = before
            raise
        self.has_open_buffer &= text.upper() != "CLOSE"
        return answer

    @contextmanager
    def short_timeouts(self) -> Iterator[None]:
        """No retries, one reconnect and a timeout of ``SHORT_TIMEOUT_S``, for a stop that is retried by its caller."""
        before = self._answer_timeout, self._query_attempts, self._connect_attempts, self._is_short
        self._answer_timeout = min(self._answer_timeout, SHORT_TIMEOUT_S)
        self._query_attempts, self._connect_attempts, self._is_short = 1, 1, True
        self._channel.answer_timeout = self._answer_timeout
        try:
            yield
        finally:
            self._answer_timeout, self._query_attempts, self._connect_attempts, self._is_short = before
            self._channel.answer_timeout = self._answer_timeout

    def interrupt(self, control: int) -> None:
        """Send a control character, which the controller obeys in any state without acknowledging it.

        Args:
            control: its code.

        Raises:
            LinkLostError: it could not be sent, or later answers are invalid.
        """
        if not self._is_synchronized:
            self._channel.restart(control)
            return
        self._is_synchronized = False
        outcome = self._channel.run(None, control)
        if isinstance(outcome, Lost):
            raise LinkLostError(outcome.why)
        self._is_synchronized = True

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
        self._exchange(ControllerCommand("\n".join(lines[:count]), CommandKind.BUFFER, self._answer_timeout))
        return count

    def lines_at_once(self, lines: Sequence[str]) -> int:
        """Number of these lines that ``load`` sends in one exchange."""
        return self._channel.lines_at_once(lines)

    def _check(self) -> None:
        if self.keeper is not None and not self._is_short:
            self.keeper.check()

    def _query_with_retries(self, command: ControllerCommand) -> tuple[str, ...]:
        for _ in range(self._query_attempts - 1):
            try:
                return self._exchange(command)
            except TooLongError:
                raise
            except LinkLostError:
                self.check_preemption()
        return self._exchange(command)

    def _exchange(self, command: ControllerCommand) -> tuple[str, ...]:
        if not self._is_synchronized:
            self._connect()
        self._is_synchronized = False  # until the outcome is known: an interrupt may come at any time
        try:
            outcome = self._channel.run(command)
        except LinkLostError as lost:
            outcome = Lost(lost.args[0])
        self._is_synchronized = not isinstance(outcome, Lost)
        if isinstance(outcome, Answer):
            return outcome.lines
        if isinstance(outcome, Refusal):
            raise RefusedError(command.text.split("\n")[outcome.line], outcome.number, outcome.words)
        if command.kind is CommandKind.QUERY or outcome.untouched:
            kind = TooLongError if outcome.too_long else LinkLostError
            raise kind(f"{command.text[:60]!r}: {outcome.why}")
        raise OutcomeUnknownError(command.text[:60], outcome.why)

    def _connect(self) -> None:
        is_own = self.keeper is not None and self.keeper.is_certain()
        open_buffer = OpenBufferPolicy.CLOSE if is_own else self._open_buffer
        for attempt in range(self._connect_attempts):
            if attempt:
                self.check_preemption()
                self._sleep(self._pause * attempt)
            try:
                establish_handshake(self._channel, open_buffer)
            except (LinkLostError, RefusedError) as fault:
                if attempt == self._connect_attempts - 1:
                    place = Place(self.port_name or "controller")
                    raise NoControllerError(Diagnostic("C216", place, fault.args[0])) from fault
            else:
                self._is_synchronized = True
                self.has_open_buffer &= open_buffer is not OpenBufferPolicy.CLOSE
                self.connections += 1
                return


def free_memory(session: Session) -> int:
    """Words of free memory; negative while a buffer is open.

    Raises:
        LinkLostError: the answer is invalid.
    """
    (answer,) = session.query("SIZE")[:1] or ("",)
    if not re.fullmatch(r"-?[0-9]+", answer.strip()):  # int() takes underscores
        raise LinkLostError(f"SIZE: expected a number of words, got {answer!r}")
    return int(answer)
